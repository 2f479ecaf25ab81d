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
        bool isSound = isFinite(node.centroid) && isFinite(node.flux) && isFinite(node.lo) &&
                       isFinite(node.hi) && std::isfinite(node.cubicMean) &&
                       std::isfinite(node.chromaticOffset) && std::isfinite(node.chromaticMoment);
        for (const float moment : node.moments) isSound &= std::isfinite(moment);
        row.expect(isSound, where);
    }
}

// Far below single precision's smallest normal number nothing is asked of the digits.
bool isComparable(double truth) { return truth > 1e-34; }

void compare(const HardCloud& cloud, const testing::Optics& optics, SumRows& rows,
             const std::string& what) {
    const KernelTable table(optics.pointers(), 1e7, 0.5);
    const auto receivers = receiversFor(cloud, 8);
    const auto sums = sumByTree(cloud, table, receivers, kTolerance);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const DRgb truth = sumByProfiles(cloud, optics, receivers[i]);
        for (int c = 0; c < 3; ++c) {
            const auto where = [&] {
                return fmt::format("{}, receiver {} channel {}: {} for {}", what, i, c, sums[i][c],
                                   truth[c]);
            };
            rows.sound.expect(
                std::isfinite(sums[i][c]) && sums[i][c] >= 0 && (truth[c] > 0 || sums[i][c] == 0),
                where);
            if (isComparable(truth[c]))
                rows.truth.add(std::abs(double{sums[i][c]} / truth[c] - 1), where);
        }
    }
}

void checkOrderAndThreads(const HardCloud& cloud, const testing::Optics& optics, SumRows& rows,
                          const std::string& what) {
    const auto where = [&] { return what; };
    const KernelTable table(optics.pointers(), 1e7, 0.5);
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
void checkScales(const HardCloud& cloud, SumRows& rows, const std::string& what) {
    const auto receivers = receiversFor(cloud, 8);
    const testing::Optics optics("Marble");
    const KernelTable table(optics.pointers(), 1e7, 0.5);
    const auto sums = sumByTree(cloud, table, receivers, 0);
    for (const float factor : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
        Medium medium = optics.medium;
        medium.sigmaA /= double{factor};
        medium.sigmaS /= double{factor};
        const testing::Optics otherOptics(medium);
        const KernelTable otherTable(otherOptics.pointers(), 1e7 * double{factor},
                                     0.5 * double{factor});
        const HardCloud other = cloud.scaled(factor);
        std::vector<Vec3> moved;
        for (const Vec3& r : receivers) moved.push_back(r * factor);
        const auto otherSums = sumByTree(other, otherTable, moved, 0);
        for (std::size_t i = 0; i < sums.size(); ++i)
            for (int c = 0; c < 3; ++c)
                if (isComparable(double{sums[i][c]}))
                    rows.scaled.add(std::abs(double{otherSums[i][c]} / double{sums[i][c]} - 1),
                                    [&] {
                                        return fmt::format("{}, factor {}: {} for {}", what, factor,
                                                           otherSums[i][c], sums[i][c]);
                                    });
    }
}

void hardClouds(Report& report, Scope scope) {
    SumRows rows;
    const testing::Optics optics("Marble");
    std::vector<std::uint32_t> counts{1, 2, 8, 9, 200};
    if (scope == Scope::Full) counts = {1, 2, 7, 8, 9, 64, 65, 1000, 20000};
    for (const Arrangement& where : arrangements())
        for (const Lighting& light : lightings())
            for (const std::uint32_t count : counts) {
                const std::string what =
                    fmt::format("{} points {}, {}", count, where.name, light.name);
                const HardCloud cloud = makeCloud(where, light, count);
                checkNodes(cloud, rows.nodes, what);
                compare(cloud, optics, rows, what);
                checkOrderAndThreads(cloud, optics, rows, what);
                if (light.name == lightings().front().name && count > 8 && count < 2000)
                    checkScales(cloud, rows, what);
            }
    std::vector<std::uint32_t> many{20'000};
    if (scope == Scope::Full) many = {1'000'000, 10'000'000};
    for (const std::uint32_t count : many)
        for (const Lighting& light : lightings()) {
            const Arrangement& where = arrangements()[5];
            const std::string what = fmt::format("{} points {}, {}", count, where.name, light.name);
            const HardCloud cloud = makeCloud(where, light, count);
            checkNodes(cloud, rows.nodes, what);
            compare(cloud, optics, rows, what);
            if (count <= 1'000'000) checkOrderAndThreads(cloud, optics, rows, what);
        }
    for (Row* row :
         {&rows.sound, &rows.nodes, &rows.truth, &rows.shuffled, &rows.threads, &rows.scaled})
        report.add(*row);
}

// A ball lit evenly, from far smaller to far larger than the mean free path; where the points are
// dense enough, what leaves is the profile's cumulative total to the ball's diameter.
void balls(Report& report, Scope scope) {
    Row truth("sums", "balls of 1e-3 to 1e6 mean free paths against all points", kLimit);
    Row energy("sums", "balls: no more leaves than enters", 0);
    Row closed("sums", "balls of 1e-3 to 3 mean free paths: closed form", 0.01);
    const testing::Optics optics("Marble");
    const double mfp = optics.medium.channel(0).meanFreePathMm();
    std::vector<double> sizes{1e-3, 3, 1e6};
    if (scope == Scope::Full) sizes = {1e-3, 0.1, 1, 3, 10, 1e3, 1e6};
    for (const double size : sizes) {
        const double radius = size * mfp;
        const testing::LitCloud lit(makeSphere(radius), radius * 0.06, testing::white);
        const HardCloud cloud(lit.samples.points, lit.irradiance);
        const KernelTable table = lit.table(optics, 4 * radius);
        const auto receivers = receiversFor(cloud, 1);
        const auto sums = sumByTree(cloud, table, receivers, kTolerance);
        const DRgb all = sumByProfiles(cloud, optics, receivers[0]);
        for (int c = 0; c < 3; ++c) {
            const auto where = [&] {
                return fmt::format("radius {} mean free paths, channel {}: {} for {}", size, c,
                                   sums[0][c], all[c]);
            };
            truth.add(std::abs(double{sums[0][c]} / all[c] - 1), where);
            if (size > 3) continue;
            const Profile& profile = optics.profile(c);
            const double exact = profile.total() - profile.tail(2 * radius);
            closed.add(std::abs(double{sums[0][c]} / exact - 1), where);
            energy.expect(double{sums[0][c]} <= 1 + kTolerance, where);
        }
    }
    report.add(truth);
    report.add(energy);
    report.add(closed);
}

}  // namespace

void stressSums(Report& report, Scope scope) {
    hardClouds(report, scope);
    balls(report, scope);
}

}  // namespace sss::stress
