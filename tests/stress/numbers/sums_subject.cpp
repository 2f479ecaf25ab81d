#include "numbers/clouds.h"
#include "numbers/subjects.h"
#include "sss/base/parallel.h"
#include "sss/geom/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace sss::stress {
namespace {

constexpr double kTolerance = 0.01;
// What tests/unit/cloud/diffusion_sum_test.cpp states: 99.9 % within it, all within three times.
constexpr double kLimit = 3 * kTolerance;

template <typename T>
bool sameBytes(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

struct SumRows {
    Row sound{"sums", "sums: finite, >= 0; dark where it is dark", 0};
    Row nodes{"sums", "nodes: finite, flux and area of all points", 1e-5};
    Row truth{"sums", "sums against all points in double (tolerance 0.01)", kLimit};
    Row shuffled{"sums", "any order of points: the same bytes", 0};
    Row threads{"sums", "any number of threads: the same bytes", 0};
    Row scaled{"sums", "any unit of length: the same sums", 1e-4};
};

void checkNodes(const HardCloud& cloud, Row& row, const std::string& what) {
    const auto where = [&] { return what; };
    double area = 0;
    DRgb flux{0};
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        area += double{cloud.points[i].areaMm2};
        flux += DRgb(cloud.irradiance[i]) * double{cloud.points[i].areaMm2};
    }
    const OctreeNode& root = cloud.nodes.front();
    row.add(std::abs(double{root.areaMm2} / area - 1), where);
    for (int c = 0; c < 3; ++c)
        row.add(flux[c] > 0 ? std::abs(double{root.flux[c]} / flux[c] - 1) : double{root.flux[c]},
                where);
    for (const OctreeNode& node : cloud.nodes) {
        bool isSound = isFinite(node.centroid) && isFinite(node.flux) && isFinite(node.lean[0]) &&
                       isFinite(node.lean[1]) && std::isfinite(node.radius) &&
                       std::isfinite(node.cubicMean) && std::isfinite(node.chromaticMoment);
        for (const float moment : node.moments) isSound &= std::isfinite(moment);
        row.expect(isSound, where);
    }
}

// What a table is good for, as shares of what the sum would be with all points at the receiver: it
// ends at 1e-30 of the profile's peak, and has four digits down to 1e-8 (kernel_test.cpp).
constexpr double kTableEnds = 1e-28, kTableIsExact = 1e-8;

// Sums below it are not compared: near single precision's smallest normal number nothing is asked
// of the digits, and below `share` nothing of the table.
DRgb leastComparable(const HardCloud& cloud, const KernelTable& table, double share) {
    return glm::max(DRgb(1e-34), share * DRgb(cloud.nodes.front().flux) * DRgb(table.evaluate(0)));
}

void compare(const HardCloud& cloud, const HardOptics& hard, SumRows& rows,
             const std::string& what) {
    const auto receivers = receiversFor(cloud, 8);
    const auto sums = sumByTree(cloud, hard.table, receivers, kTolerance);
    const DRgb least = leastComparable(cloud, hard.table, kTableEnds);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const DRgb truth = sumByProfiles(cloud, hard.optics, hard.cellRadiusMm(), receivers[i]);
        for (int c = 0; c < 3; ++c) {
            const auto where = [&] {
                return fmt::format("{}, receiver {} channel {}: {} for {}", what, i, c, sums[i][c],
                                   truth[c]);
            };
            rows.sound.expect(
                std::isfinite(sums[i][c]) && sums[i][c] >= 0 && (truth[c] > 0 || sums[i][c] == 0),
                where);
            if (truth[c] > least[c])
                rows.truth.add(std::abs(double{sums[i][c]} / truth[c] - 1), where);
        }
    }
}

void checkOrderAndThreads(const HardCloud& cloud, const HardOptics& hard, SumRows& rows,
                          const std::string& what) {
    const auto where = [&] { return what; };
    const KernelTable& table = hard.table;
    const auto receivers = receiversFor(cloud, 4);
    const auto sums = sumByTree(cloud, table, receivers, kTolerance);
    const HardCloud other = cloud.shuffled(cloud.points.size());
    rows.shuffled.expect(sameBytes<OctreeNode>(cloud.nodes, other.nodes), where);
    rows.shuffled.expect(sameBytes<Rgb>(sums, sumByTree(other, table, receivers, kTolerance)),
                         where);
    for (const unsigned threads : {1u, 3u, 8u}) {
        const ThreadLimit limit(threads);
        rows.threads.expect(sameBytes<OctreeNode>(cloud.nodes, buildOctree(cloud.view())), where);
    }
}

// Points, areas and mean free paths in another unit.
void checkScales(const HardCloud& cloud, const HardOptics& one, const HardOptics& other,
                 float factor, Row& row, const std::string& what) {
    std::vector<Vec3> receivers = receiversFor(cloud, 8);
    const auto sums = sumByTree(cloud, one.table, receivers, 0);
    const DRgb least = leastComparable(cloud, one.table, kTableIsExact);
    for (Vec3& r : receivers) r *= factor;
    const auto scaled = sumByTree(cloud.scaled(factor), other.table, receivers, 0);
    for (std::size_t i = 0; i < sums.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (double{sums[i][c]} > least[c])
                row.add(std::abs(double{scaled[i][c]} / double{sums[i][c]} - 1), [&] {
                    return fmt::format("{}, {}, factor {}: {} for {}", what, one.name, factor,
                                       scaled[i][c], sums[i][c]);
                });
}

// In brief an arrangement for each medium.
void scales(Row& row, Scope scope) {
    const std::uint32_t count = scope == Scope::Full ? 1000 : 200;
    const std::size_t all = arrangements().size();
    const Lighting& light = lightings().front();
    const std::span<const HardOptics> optics = hardOptics(scope);
    for (std::size_t k = 0; k < optics.size(); ++k)
        for (const float factor : {1e-6f, 1e-3f, 25.4f, 1e6f}) {
            const HardOptics& one = optics[k];
            const HardOptics other = one.inUnit(double{factor});
            for (std::size_t a = 0; a < all; ++a)
                if (scope == Scope::Full || a == k % all)
                    checkScales(makeCloud(arrangements()[a], light, count), one, other, factor, row,
                                std::string(arrangements()[a].name));
        }
}

/// Clouds that come one after the other, each in another medium than the one before, or each in
/// all.
class HardClouds {
public:
    explicit HardClouds(Scope scope)
        : optics_(hardOptics(scope)), inAllMedia_(scope == Scope::Full) {}

    void tryOut(const Arrangement& where, const Lighting& light, std::uint32_t count,
                SumRows& rows) {
        const HardCloud cloud = makeCloud(where, light, count);
        checkNodes(cloud, rows.nodes, named(where, light, count));
        const std::size_t known = opticsFor(count);
        for (std::size_t k = 0; k < (inAllMedia_ && count <= 1000 ? known : 1); ++k) {
            const HardOptics& hard = optics_[next_++ % known];
            const std::string what = fmt::format("{}, {}", named(where, light, count), hard.name);
            compare(cloud, hard, rows, what);
            if (k == 0 && count <= 1'000'000) checkOrderAndThreads(cloud, hard, rows, what);
        }
    }
    static std::string named(const Arrangement& where, const Lighting& light, std::uint32_t count) {
        return fmt::format("{} points {}, {}", count, where.name, light.name);
    }

private:
    // All points are asked for their profile, which costs where there are many: then dipoles only,
    // which come first, and the last ones, photon beams, for few points.
    std::size_t opticsFor(std::uint32_t count) const {
        return count > 1000  ? 2
               : count > 100 ? std::min<std::size_t>(optics_.size(), 8)
                             : optics_.size();
    }

    std::span<const HardOptics> optics_;
    bool inAllMedia_;
    std::size_t next_ = 0;
};

void hardClouds(Report& report, Scope scope) {
    SumRows rows;
    std::vector<std::uint32_t> counts{1, 2, 9, 200}, many{5000};
    if (scope == Scope::Full) {
        counts = {1, 2, 7, 8, 9, 64, 65, 1000, 20000};
        many = {1'000'000, 10'000'000};
    }
    HardClouds clouds(scope);
    for (const Arrangement& where : arrangements())
        for (const Lighting& light : lightings())
            for (const std::uint32_t count : counts) clouds.tryOut(where, light, count, rows);
    for (const std::uint32_t count : many)
        // The largest take a minute each.
        for (const Lighting& light : lightings().first(count > 1'000'000 ? 3 : lightings().size()))
            clouds.tryOut(arrangements()[5], light, count, rows);
    scales(rows.scaled, scope);
    for (Row* row :
         {&rows.sound, &rows.nodes, &rows.truth, &rows.shuffled, &rows.threads, &rows.scaled})
        report.add(*row);
}

struct BallRows {
    Row truth{"sums", "balls of 1e-3 to 1e6 mean free paths against all points", kLimit};
    Row energy{"sums", "balls: no more leaves than enters", 0};
    Row closed{"sums", "balls of 1e-3 to 3 mean free paths: closed form", 0.01};
};

// A ball lit evenly, from far smaller to far larger than the mean free path; where the points are
// dense enough, what leaves is the profile's cumulative total to the ball's diameter.
void ball(const char* medium, double size, BallRows& rows) {
    const testing::Optics optics(medium);
    const double radius = size * optics.medium.channel(0).meanFreePathMm();
    const testing::LitCloud lit(makeSphere(radius), radius * 0.06, testing::white);
    const HardCloud cloud(lit.samples.points, lit.irradiance);
    const KernelTable table = lit.table(optics, 4 * radius);
    const auto receivers = receiversFor(cloud, 1);
    const auto sums = sumByTree(cloud, table, receivers, kTolerance);
    const DRgb all = sumByProfiles(cloud, optics, lit.spacingMm / std::sqrt(kPi), receivers[0]);
    for (int c = 0; c < 3; ++c) {
        const auto where = [&] {
            return fmt::format("{}, radius {} mean free paths, channel {}: {} for {}", medium, size,
                               c, sums[0][c], all[c]);
        };
        rows.truth.add(std::abs(double{sums[0][c]} / all[c] - 1), where);
        if (size > 3) continue;
        rows.energy.expect(double{sums[0][c]} <= 1 + kTolerance, where);
        // Channels of shorter mean free paths than the first want more points.
        if (lit.spacingMm > 0.5 * optics.medium.channel(c).meanFreePathMm()) continue;
        const Profile& profile = optics.profile(c);
        const double exact = profile.total() - profile.tail(2 * radius);
        rows.closed.add(std::abs(double{sums[0][c]} / exact - 1), where);
    }
}

void balls(Report& report, Scope scope) {
    BallRows rows;
    if (scope == Scope::Full)
        for (const char* medium : {"Marble", "Skimmilk", "Skin1", "Ketchup"})
            for (const double size : {1e-3, 0.1, 1.0, 3.0, 10.0, 1e3, 1e6})
                ball(medium, size, rows);
    else
        for (const auto& [medium, size] :
             {std::pair{"Marble", 1e-3}, {"Skimmilk", 3.0}, {"Skin1", 1e6}})
            ball(medium, size, rows);
    for (const Row* row : {&rows.truth, &rows.energy, &rows.closed}) report.add(*row);
}

}  // namespace

void stressSums(Report& report, Scope scope) {
    hardClouds(report, scope);
    balls(report, scope);
}

}  // namespace sss::stress
