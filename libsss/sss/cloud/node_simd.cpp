// The vector code that reads octree nodes: verdicts, and lists of sources. Compiled once for every
// instruction set that Highway knows for this processor family, chosen when it first runs.
#include "sss/cloud/candidates.h"
#include "sss/cloud/interactions.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sss/cloud/node_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sss::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Verdict judgeAny(const KernelTable& table, std::span<const OctreeNode> nodes,
                 std::span<const std::uint32_t> indices, const CellTest& cell, ErrorBound& error) {
    return judgeScalar(table, nodes, indices, cell, error);
}
void packAny(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
             InteractionList::Block& to) {
    packScalar(nodes, indices, to);
}
#else

namespace hn = hwy::HWY_NAMESPACE;

// A node as floats.
constexpr std::size_t kNodeFloats = sizeof(OctreeNode) / sizeof(float);
static_assert(offsetof(OctreeNode, flux) == 3 * sizeof(float) &&
              offsetof(OctreeNode, moments) == 7 * sizeof(float) &&
              offsetof(OctreeNode, chromaticMoment) == 13 * sizeof(float) &&
              offsetof(OctreeNode, lean) == 16 * sizeof(float) &&
              offsetof(OctreeNode, count) == 23 * sizeof(float));

// Four floats of each of the records, from each of the columns on, to four arrays a column: a
// transposition four records at a time, cheaper than gathers. `count` is a multiple of four.
template <std::size_t kColumns>
HWY_ATTR void readColumns(const float* records, std::size_t stride, const std::uint32_t* index,
                          std::size_t count, const std::size_t (&columns)[kColumns],
                          float* const (&to)[kColumns][4]) {
    const hn::FixedTag<float, 4> d;
    for (std::size_t i = 0; i < count; i += 4) {
        const float* from[4];
        for (std::size_t k = 0; k < 4; ++k) from[k] = records + stride * index[i + k];
        for (std::size_t g = 0; g < kColumns; ++g) {
            const auto a = hn::LoadU(d, from[0] + columns[g]),
                       b = hn::LoadU(d, from[1] + columns[g]),
                       c = hn::LoadU(d, from[2] + columns[g]),
                       e = hn::LoadU(d, from[3] + columns[g]);
            const auto ab = hn::InterleaveLower(d, a, b), ce = hn::InterleaveLower(d, c, e);
            const auto abUp = hn::InterleaveUpper(d, a, b), ceUp = hn::InterleaveUpper(d, c, e);
            hn::Store(hn::ConcatLowerLower(d, ce, ab), d, to[g][0] + i);
            hn::Store(hn::ConcatUpperUpper(d, ce, ab), d, to[g][1] + i);
            hn::Store(hn::ConcatLowerLower(d, ceUp, abUp), d, to[g][2] + i);
            hn::Store(hn::ConcatUpperUpper(d, ceUp, abUp), d, to[g][3] + i);
        }
    }
}

// At most a block of indices, filled up to a multiple of `step` with the last; how many these are.
std::size_t fillUp(std::span<const std::uint32_t> indices, std::size_t step, std::uint32_t* to) {
    std::copy(indices.begin(), indices.end(), to);
    std::size_t count = indices.size();
    for (; count % step != 0; ++count) to[count] = indices.back();
    return count;
}

HWY_ATTR void packAny(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
                      InteractionList::Block& to) {
    std::uint32_t index[InteractionList::kBlock];
    const std::size_t whole = fillUp(indices, 4, index);
    alignas(64) float unused[InteractionList::kBlock];
    const float* records = &nodes.front().centroid.x;
    auto& m = to.moments;
    readColumns(records, kNodeFloats, index, whole, {0, 7, 9},
                {{to.x, to.y, to.z, unused}, {m[0], m[1], m[2], m[3]}, {m[2], m[3], m[4], m[5]}});
    // Flux and area; the area is not a fourth channel. The six floats of the leans, two of them
    // twice.
    const hn::FixedTag<float, 4> d;
    const auto isChannel = hn::FirstN(d, 3);
    auto leans = hn::Zero(d);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const float* node = records + kNodeFloats * indices[i];
        hn::Store(hn::IfThenElseZero(isChannel, hn::LoadU(d, node + 3)), d, to.flux[i]);
        leans = hn::Or(leans, hn::Or(hn::LoadU(d, node + 16), hn::LoadU(d, node + 18)));
    }
    to.isColoured = !hn::AllTrue(d, hn::Eq(leans, hn::Zero(d)));
    if (to.isColoured) packLeans(nodes, indices, to);
}

// What the nodes have to be judged by, each quantity a row.
struct alignas(64) Judged {
    float x[kMostJudged], y[kMostJudged], z[kMostJudged];
    float flux[3][kMostJudged];
    float difference[kMostJudged], extent[kMostJudged];
    float radius[kMostJudged], size[kMostJudged];          // count, the bits of a float
    std::uint32_t row[kMostJudged];                        // of the bounds
    float bounds[KernelTable::kBoundFloats][kMostJudged];  // [3 derivative + channel]
    float unused[kMostJudged];
};

template <class D, class Mask>
HWY_ATTR std::uint64_t bitsOf(D d, Mask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < (hn::Lanes(d) + 7) / 8; ++k)
        bits |= std::uint64_t{bytes[k]} << 8 * k;
    return bits;
}

// Finds the rows of the bounds; true if no node's channels differ.
HWY_ATTR bool measure(const KernelTable& table, const CellTest& cell, std::size_t count,
                      Judged& j) {
    const hn::CappedTag<float, kMostJudged> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto u0 = hn::Set(d, table.offsetMm2());
    const auto base = hn::Set(di, table.baseRow());
    const auto lastRow = hn::Set(di, static_cast<std::int32_t>(table.rowCount()) - 1);
    auto colour = hn::Zero(d);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto x = hn::Load(d, j.x + i), y = hn::Load(d, j.y + i), z = hn::Load(d, j.z + i);
        const auto dx = hn::Sub(x, hn::Set(d, cell.centre.x)),
                   dy = hn::Sub(y, hn::Set(d, cell.centre.y)),
                   dz = hn::Sub(z, hn::Set(d, cell.centre.z));
        const auto distance = hn::Sqrt(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
        const auto away = hn::Add(hn::Load(d, j.radius + i), hn::Set(d, cell.radius));
        const auto nearest = hn::Max(hn::Zero(d), hn::Sub(distance, away));
        const auto bits = hn::BitCast(di, hn::MulAdd(nearest, nearest, u0));
        const auto row = hn::Min(hn::Sub(hn::ShiftRight<KernelTable::kShift>(bits), base), lastRow);
        hn::Store(hn::BitCast(du, row), du, j.row + i);
        colour = hn::Add(colour, hn::Load(d, j.difference + i));
    }
    return hn::AllTrue(d, hn::Eq(colour, hn::Zero(d)));
}

HWY_ATTR Verdict judgeAny(const KernelTable& table, std::span<const OctreeNode> nodes,
                          std::span<const std::uint32_t> indices, const CellTest& cell,
                          ErrorBound& error) {
    const hn::CappedTag<float, kMostJudged> d;
    const hn::RebindToSigned<decltype(d)> di;
    const std::size_t count = indices.size(), lanes = hn::Lanes(d);
    // Whole vectors are judged.
    std::uint32_t index[kMostJudged];
    const std::size_t whole = fillUp(indices, lanes, index);
    Judged j;
    readColumns(&nodes.front().centroid.x, kNodeFloats, index, whole, {0, 4, 12, 20},
                {{j.x, j.y, j.z, j.flux[0]},
                 {j.flux[1], j.flux[2], j.unused, j.unused},
                 {j.unused, j.difference, j.extent, j.radius},
                 {j.unused, j.unused, j.unused, j.size}});
    const bool isGrey = measure(table, cell, whole, j);
    auto& b = j.bounds;
    const float* rows = table.boundRows();
    constexpr std::size_t kStride = KernelTable::kBoundStride;
    readColumns(rows, kStride, j.row, whole, {0, 8},
                {{b[0], b[1], b[2], b[3]}, {b[8], b[9], b[10], b[11]}});
    if (!isGrey) readColumns(rows, kStride, j.row, whole, {4}, {{b[4], b[5], b[6], b[7]}});

    const auto zero = hn::Zero(d), reach = hn::Set(d, cell.reach);
    const Rgb scales = shareScale(cell.threshold);
    decltype(hn::Zero(d)) changing[3] = {zero, zero, zero}, steady[3] = {zero, zero, zero};
    Verdict verdict;
    for (std::size_t i = 0; i < count; i += lanes) {
        const auto bound = [&](int order, int c) {
            return hn::Load(d, j.bounds[3 * order + c] + i);
        };
        // thirdOrder()
        const auto extent = hn::Load(d, j.extent + i), both = hn::Add(extent, reach);
        const auto third =
            hn::MulSub(hn::Mul(both, hn::Set(d, kReachWeight / 6.0f)), hn::Mul(both, both),
                       hn::Mul(hn::Mul(extent, hn::Set(d, (kReachWeight - 1.0f) / 6.0f)),
                               hn::Mul(extent, extent)));
        const auto second = hn::Mul(hn::Load(d, j.difference + i), hn::Set(d, 0.5f));
        const auto isThere =
            hn::Lt(hn::Iota(d, static_cast<float>(i)), hn::Set(d, static_cast<float>(count)));
        auto isDark = isThere, isTaken = isThere;
        decltype(hn::Zero(d)) c3[3], c2[3];
        for (int c = 0; c < 3; ++c) {
            const auto flux = hn::Load(d, j.flux[c] + i);
            const auto threshold = hn::Set(d, cell.threshold[c]);
            const auto isDarkHere = hn::Le(hn::Mul(flux, bound(0, c)),
                                           hn::Mul(threshold, hn::Set(d, kNegligibleShare)));
            isDark = hn::And(isDark, isDarkHere);
            c3[c] = hn::Mul(flux, hn::Mul(bound(3, c), third));
            // chromaticFlux()
            const auto others =
                hn::Add(hn::Load(d, j.flux[(c + 1) % 3] + i), hn::Load(d, j.flux[(c + 2) % 3] + i));
            c2[c] = isGrey ? zero : hn::Mul(hn::Min(flux, others), hn::Mul(bound(2, c), second));
            isTaken = hn::And(
                isTaken, hn::Le(hn::MulAdd(c2[c], hn::Set(d, kSteadyWeight), c3[c]), threshold));
            if (!(cell.threshold[c] > 0)) isTaken = hn::And(isTaken, isDarkHere);
        }
        isTaken = hn::AndNot(isDark, isTaken);
        for (int c = 0; c < 3; ++c) {
            const auto scale = hn::Set(d, scales[c]);
            const auto part = hn::IfThenElseZero(isTaken, hn::Mul(c3[c], scale));
            changing[c] = hn::MulAdd(part, part, changing[c]);
            steady[c] = hn::Add(steady[c], hn::IfThenElseZero(isTaken, hn::Mul(c2[c], scale)));
        }
        const auto isLeaf =
            hn::RebindMask(d, hn::Lt(hn::BitCast(di, hn::Load(d, j.size + i)), hn::Zero(di)));
        const auto isSmall = hn::Lt(hn::Load(d, j.radius + i), hn::Set(d, cell.radius));
        verdict.taken |= bitsOf(d, isTaken) << i;
        verdict.dark |= bitsOf(d, isDark) << i;
        verdict.fine |= bitsOf(d, hn::And(isThere, hn::Or(isLeaf, isSmall))) << i;
    }
    for (int c = 0; c < 3; ++c) {
        error.changing[c] += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, changing[c])));
        error.steady[c] += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, steady[c])));
    }
    return verdict;
}

#endif

}  // namespace
}  // namespace sss::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sss {

HWY_EXPORT(judgeAny);
HWY_EXPORT(packAny);

Verdict judge(const KernelTable& table, std::span<const OctreeNode> nodes,
              std::span<const std::uint32_t> indices, const CellTest& cell, ErrorBound& error) {
    return HWY_DYNAMIC_DISPATCH(judgeAny)(table, nodes, indices, cell, error);
}

void pack(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
          InteractionList::Block& to) {
    HWY_DYNAMIC_DISPATCH(packAny)(nodes, indices, to);
}

}  // namespace sss
#endif
