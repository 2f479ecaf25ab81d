#include "sss/cloud/exitance_field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace sss {
namespace {

constexpr std::uint32_t kMostRefinements = 3;
constexpr std::size_t kProbes = 6;
// Of the tolerance, what interpolation may use.
constexpr double kInterpolationShare = 0.5;
// Receivers that share one traversal.
constexpr std::size_t kReceiversPerSum = 64;

// Number of grid point (i, j), i + j <= n, row by row.
std::uint32_t siteIndex(std::uint32_t i, std::uint32_t j, std::uint32_t n) {
    return j * (n + 1) - j * (j - 1) / 2 + i;
}

// The three sites around a place of a patch and their weights.
struct Stencil {
    std::array<std::uint32_t, 3> site;
    std::array<float, 3> weight;
};

Stencil stencilAt(const Vec2& inPatch, std::uint32_t n) {
    const Vec2 scaled = inPatch * static_cast<float>(n);
    std::uint32_t i = std::min(static_cast<std::uint32_t>(scaled.x), n - 1);
    std::uint32_t j = std::min(static_cast<std::uint32_t>(scaled.y), n - 1);
    while (i + j > n - 1) (i > 0 ? i : j) -= 1;
    const float x = scaled.x - static_cast<float>(i), y = scaled.y - static_cast<float>(j);
    if (x + y <= 1.0f || i + j == n - 1)
        return {{siteIndex(i, j, n), siteIndex(i + 1, j, n), siteIndex(i, j + 1, n)},
                {1.0f - x - y, x, y}};
    return {{siteIndex(i + 1, j + 1, n), siteIndex(i, j + 1, n), siteIndex(i + 1, j, n)},
            {x + y - 1.0f, 1.0f - x, 1.0f - y}};
}

struct PositionHash {
    std::size_t operator()(const Vec3& p) const {
        std::uint64_t h = std::bit_cast<std::uint32_t>(p.x);
        h = (h ^ std::uint64_t{std::bit_cast<std::uint32_t>(p.y)} << 21) * 0x9e3779b97f4a7c15ull;
        h = (h ^ (h >> 29) ^ std::bit_cast<std::uint32_t>(p.z)) * 0xbf58476d1ce4e5b9ull;
        return h ^ (h >> 32);
    }
};

float relative(const Rgb& difference, const Rgb& value) {
    return maxComponent(glm::abs(difference) / glm::max(value, Rgb(1e-30f)));
}

// A place between sites where the true value is compared with the interpolated one.
struct Probe {
    float spread;
    std::uint32_t patch;
    Vec2 inPatch;
};

}  // namespace

// Values of a group: the unique sites, and for each patch which of them make up its grid.
struct ExitanceField::Group {
    std::vector<std::uint32_t> firstSite;  // per patch, into siteOf
    std::vector<std::uint8_t> segments;    // per patch, refined
    std::vector<std::uint16_t> siteOf;     // into values
    std::vector<Rgb> values;

    Rgb at(std::uint32_t patch, const Vec2& inPatch) const {
        const Stencil stencil = stencilAt(inPatch, segments[patch]);
        const std::uint16_t* site = siteOf.data() + firstSite[patch];
        return values[site[stencil.site[0]]] * stencil.weight[0] +
               values[site[stencil.site[1]]] * stencil.weight[1] +
               values[site[stencil.site[2]]] * stencil.weight[2];
    }

    // Lays out the grids of all patches; returns the positions of the unique sites.
    std::vector<Vec3> layOut(const ExitanceSites& sites,
                             std::span<const ExitanceSites::Patch> patches,
                             std::uint32_t refinement) {
        std::unordered_map<Vec3, std::uint16_t, PositionHash> known;
        std::vector<Vec3> positions;
        for (const ExitanceSites::Patch& patch : patches) {
            const std::uint32_t n = patch.segments << refinement;
            const float step = 1.0f / static_cast<float>(n);
            firstSite.push_back(static_cast<std::uint32_t>(siteOf.size()));
            segments.push_back(static_cast<std::uint8_t>(n));
            for (std::uint32_t j = 0; j <= n; ++j)
                for (std::uint32_t i = 0; i + j <= n; ++i) {
                    const Vec3 p = sites.position(
                        patch.face,
                        patch.at({static_cast<float>(i) * step, static_cast<float>(j) * step}));
                    const auto [place, isNew] =
                        known.try_emplace(p, static_cast<std::uint16_t>(positions.size()));
                    if (isNew) positions.push_back(p);
                    siteOf.push_back(place->second);
                }
        }
        return positions;
    }

    // The small triangles whose corners differ most, relative to their value: where linear
    // interpolation is most likely to miss.
    std::vector<Probe> probes() const {
        std::vector<Probe> all;
        for (std::uint32_t p = 0; p < segments.size(); ++p) {
            const std::uint32_t n = segments[p];
            const std::uint16_t* site = siteOf.data() + firstSite[p];
            for (std::uint32_t j = 0; j < n; ++j)
                for (std::uint32_t i = 0; i + j < n; ++i) {
                    const Rgb a = values[site[siteIndex(i, j, n)]],
                              b = values[site[siteIndex(i + 1, j, n)]],
                              c = values[site[siteIndex(i, j + 1, n)]];
                    const Rgb lo = glm::min(a, glm::min(b, c)), hi = glm::max(a, glm::max(b, c));
                    const Vec2 centre =
                        Vec2(static_cast<float>(i), static_cast<float>(j)) + Vec2(1.0f / 3.0f);
                    all.push_back({relative(hi - lo, hi), p, centre / static_cast<float>(n)});
                }
        }
        const std::size_t count = std::min(kProbes, all.size());
        std::stable_sort(all.begin(), all.end(),
                         [](const Probe& a, const Probe& b) { return a.spread > b.spread; });
        all.resize(count);
        return all;
    }
};

namespace {

// Marks a group that some thread is computing.
template <typename T>
const T* busy() {
    static const char marker = 0;
    return reinterpret_cast<const T*>(&marker);
}

// Sums in runs of receivers that stay close together.
void sumAt(const DiffusionSum& sum, std::span<const Vec3> positions, double tolerance,
           std::span<Rgb> values, SumCounts& counts) {
    thread_local DiffusionSum::Scratch scratch;
    for (std::size_t begin = 0; begin < positions.size(); begin += kReceiversPerSum) {
        const std::size_t count = std::min(kReceiversPerSum, positions.size() - begin);
        sum.evaluate(positions.subspan(begin, count), tolerance, values.subspan(begin, count),
                     scratch, counts);
    }
}

}  // namespace

ExitanceField::ExitanceField(const TriangleMesh& mesh, const DiffusionSum& sum, double segmentMm,
                             double tolerance)
    : sum_(sum), sites_(mesh, segmentMm), tolerance_(tolerance), groups_(sites_.groupCount()) {}

ExitanceField::~ExitanceField() {
    for (const auto& entry : groups_) delete entry.load();
}

std::unique_ptr<ExitanceField::Group> ExitanceField::compute(std::uint32_t index) const {
    const std::vector<ExitanceSites::Patch> patches = sites_.patches(index);
    ExitanceCounts spent;
    spent.groups = 1;
    std::unique_ptr<Group> result;
    for (std::uint32_t refinement = 0; refinement <= kMostRefinements; ++refinement) {
        result = std::make_unique<Group>();
        const std::vector<Vec3> positions = result->layOut(sites_, patches, refinement);
        result->values.resize(positions.size());
        sumAt(sum_, positions, tolerance_, result->values, spent.sums);
        spent.sites += positions.size();
        if (refinement == kMostRefinements || tolerance_ <= 0 ||
            interpolationError(*result, patches, spent) <= tolerance_ * kInterpolationShare)
            break;
        ++spent.refinements;
    }
    const std::scoped_lock lock(countsMutex_);
    counts_.sums.add(spent.sums);
    counts_.groups += spent.groups;
    counts_.sites += spent.sites;
    counts_.refinements += spent.refinements;
    return result;
}

double ExitanceField::interpolationError(const Group& group,
                                         std::span<const ExitanceSites::Patch> patches,
                                         ExitanceCounts& spent) const {
    const std::vector<Probe> probes = group.probes();
    std::vector<Vec3> positions;
    for (const Probe& probe : probes) {
        const ExitanceSites::Patch& patch = patches[probe.patch];
        positions.push_back(sites_.position(patch.face, patch.at(probe.inPatch)));
    }
    std::vector<Rgb> truth(probes.size());
    sumAt(sum_, positions, tolerance_, truth, spent.sums);
    float worst = 0;
    for (std::size_t k = 0; k < probes.size(); ++k)
        worst = std::max(
            worst, relative(group.at(probes[k].patch, probes[k].inPatch) - truth[k], truth[k]));
    return worst;
}

const ExitanceField::Group& ExitanceField::group(std::uint32_t index) const {
    std::atomic<const Group*>& entry = groups_[index];
    const Group* found = entry.load(std::memory_order_acquire);
    if (found != nullptr && found != busy<Group>()) return *found;
    const Group* absent = nullptr;
    if (entry.compare_exchange_strong(absent, busy<Group>())) {
        found = compute(index).release();
        entry.store(found, std::memory_order_release);
        entry.notify_all();
        return *found;
    }
    while ((found = entry.load(std::memory_order_acquire)) == busy<Group>()) entry.wait(found);
    return *found;
}

Rgb ExitanceField::at(FaceIndex face, const Vec2& barycentrics) const {
    const ExitanceSites::Location where = sites_.locate(face, barycentrics);
    return group(where.group).at(where.patch, where.inPatch);
}

ExitanceCounts ExitanceField::counts() const {
    const std::scoped_lock lock(countsMutex_);
    return counts_;
}

}  // namespace sss
