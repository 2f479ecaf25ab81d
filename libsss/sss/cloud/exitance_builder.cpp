#include "sss/cloud/exitance_builder.h"

#include <algorithm>
#include <bit>

namespace sss {
namespace {

constexpr std::uint8_t kMostLevels = 3;
constexpr std::size_t kProbes = 6;
// Of the tolerance, what interpolation and the sums it starts from may use.
constexpr double kInterpolationShare = 0.5, kSumShare = 1 - kInterpolationShare;
// What halving the segments leaves of a linear grid's error; a quadratic one's shrinks faster.
constexpr double kLeftByHalving = 0.25;

double relative(const Rgb& difference, const Rgb& value) {
    return static_cast<double>(maxComponent(glm::abs(difference) / glm::max(value, Rgb(1e-30f))));
}

// A place between sites where the true value is compared with the interpolated one.
struct Probe {
    double spread;
    std::uint32_t patch;
    Vec2 inPatch;
};

// The small triangles whose corners differ most, relative to their value.
std::vector<Probe> probesOf(const ExitanceGroup& group) {
    std::vector<Probe> all;
    for (std::uint32_t p = 0; p < group.segments.size(); ++p) {
        const std::uint32_t n = group.segments[p];
        const std::uint16_t* site = group.siteOf.data() + group.firstSite[p];
        for (std::uint32_t j = 0; j < n; ++j)
            for (std::uint32_t i = 0; i + j < n; ++i) {
                const Rgb a = group.values[site[gridIndex(i, j, n)]],
                          b = group.values[site[gridIndex(i + 1, j, n)]],
                          c = group.values[site[gridIndex(i, j + 1, n)]];
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

}  // namespace

void ExitanceCounts::add(const ExitanceCounts& other) {
    sums.add(other.sums);
    groups += other.groups;
    sites += other.sites;
    refinements += other.refinements;
    unsettled += other.unsettled;
}

std::size_t ExitanceBuilder::PositionHash::operator()(const Vec3& p) const {
    std::uint64_t h = std::bit_cast<std::uint32_t>(p.x);
    h = (h ^ std::uint64_t{std::bit_cast<std::uint32_t>(p.y)} << 21) * 0x9e3779b97f4a7c15ull;
    h = (h ^ (h >> 29) ^ std::bit_cast<std::uint32_t>(p.z)) * 0xbf58476d1ce4e5b9ull;
    return h ^ (h >> 32);
}

ExitanceBuilder::ExitanceBuilder(const ExitanceSites& sites, const DiffusionSum& sum,
                                 const PointInterpolator* correction, double tolerance)
    : sites_(sites), sum_(sum), correction_(correction), tolerance_(tolerance) {}

Vec3 ExitanceBuilder::positionOf(std::size_t patch, const Vec2& inPatch) const {
    return sites_.position(patches_[patch].face, patches_[patch].at(inPatch));
}

void ExitanceBuilder::sumAt(std::span<const Vec3> positions, std::span<Rgb> values,
                            std::span<ExitanceSlope> slopes, ExitanceCounts& counts) {
    sum_.evaluate(positions, tolerance_ * kSumShare, values, scratch_, counts.sums);
    if (correction_ == nullptr) return;
    correction_->addTo(positions, values, slopes);
    for (Rgb& value : values) value = glm::max(value, Rgb(0));
}

void ExitanceBuilder::layOut(ExitanceCounts& counts) {
    group_.firstSite.clear();
    group_.segments.clear();
    group_.siteOf.clear();
    std::vector<Vec3> fresh;
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        const std::uint32_t n = segmentsOf(p);
        const float step = 1.0f / static_cast<float>(n);
        group_.firstSite.push_back(static_cast<std::uint32_t>(group_.siteOf.size()));
        group_.segments.push_back(static_cast<std::uint8_t>(n));
        for (std::uint32_t j = 0; j <= n; ++j)
            for (std::uint32_t i = 0; i + j <= n; ++i) {
                const Vec3 at =
                    positionOf(p, {static_cast<float>(i) * step, static_cast<float>(j) * step});
                const auto [place, isNew] =
                    known_.try_emplace(at, static_cast<std::uint16_t>(known_.size()));
                if (isNew) fresh.push_back(at);
                group_.siteOf.push_back(place->second);
            }
    }
    const std::size_t old = group_.values.size();
    group_.values.resize(old + fresh.size());
    if (correction_ != nullptr) group_.slopes.resize(group_.values.size());
    sumAt(fresh, std::span(group_.values).subspan(old),
          std::span(group_.slopes).subspan(correction_ != nullptr ? old : 0), counts);
    counts.sites += fresh.size();
}

double ExitanceBuilder::missBetweenCorners(ExitanceCounts& counts) {
    const std::vector<Probe> probes = probesOf(group_);
    std::vector<Vec3> positions;
    for (const Probe& probe : probes) positions.push_back(positionOf(probe.patch, probe.inPatch));
    std::vector<Rgb> truth(probes.size());
    sumAt(positions, truth, {}, counts);
    double worst = 0;
    for (std::size_t k = 0; k < probes.size(); ++k)
        worst = std::max(
            worst, relative(group_.at(probes[k].patch, probes[k].inPatch) - truth[k], truth[k]));
    return worst;
}

double ExitanceBuilder::missOfCoarserGrid(std::size_t patch) const {
    const std::uint32_t n = segmentsOf(patch), coarse = n / 2;
    const std::uint16_t* site = group_.siteOf.data() + group_.firstSite[patch];
    const float step = 1.0f / static_cast<float>(n);
    double worst = 0;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i + j <= n; ++i) {
            if (i % 2 == 0 && j % 2 == 0) continue;  // the coarser grid has it
            const GridStencil stencil =
                gridStencil({static_cast<float>(i) * step, static_cast<float>(j) * step}, coarse);
            Rgb said(0.0f);
            for (std::size_t k = 0; k < stencil.point.size(); ++k) {
                // Points of the coarser grid stand at even places of this one.
                std::uint32_t row = 0, first = 0;
                while (stencil.point[k] - first > coarse - row) first += coarse + 1 - row++;
                said += group_.values[site[gridIndex(2 * (stencil.point[k] - first), 2 * row, n)]] *
                        stencil.weight[k];
            }
            const Rgb value = group_.values[site[gridIndex(i, j, n)]];
            worst = std::max(worst, relative(value - said, value));
        }
    return worst;
}

ExitanceGroup ExitanceBuilder::build(std::uint32_t group, ExitanceCounts& counts) {
    patches_ = sites_.patches(group);
    levels_.assign(patches_.size(), 0);
    known_.clear();
    group_ = {};
    ++counts.groups;
    layOut(counts);
    const double allowed = tolerance_ * kInterpolationShare;
    if (tolerance_ <= 0 || missBetweenCorners(counts) <= allowed) return std::move(group_);
    std::fill(levels_.begin(), levels_.end(), std::uint8_t{1});
    std::size_t refined = patches_.size();
    for (std::uint8_t level = 1; refined > 0; ++level) {
        counts.refinements += refined;
        layOut(counts);
        refined = 0;
        for (std::size_t p = 0; p < patches_.size(); ++p) {
            if (levels_[p] != level || missOfCoarserGrid(p) * kLeftByHalving <= allowed) continue;
            if (level == kMostLevels) {
                ++counts.unsettled;
            } else {
                ++levels_[p];
                ++refined;
            }
        }
    }
    return std::move(group_);
}

}  // namespace sss
