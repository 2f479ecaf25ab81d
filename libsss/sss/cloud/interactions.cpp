#include "sss/cloud/interactions.h"

#include <bit>

namespace sss {

InteractionList::Block& InteractionList::room() {
    if (used_ == 0 || blocks_[used_ - 1].count == kBlock) {
        if (used_ == blocks_.size()) blocks_.emplace_back();
        blocks_[used_++].count = 0;
    }
    return blocks_[used_ - 1];
}

void InteractionList::addPoint(const Vec3& position, const Rgb& flux) {
    Block& block = room();
    const std::size_t i = block.count++;
    block.x[i] = position.x;
    block.y[i] = position.y;
    block.z[i] = position.z;
    for (int c = 0; c < 3; ++c) block.flux[i][c] = flux[c];
    block.flux[i][3] = 0.0f;
}

void InteractionList::addNode(const OctreeNode& node) {
    addPoint(node.centroid, node.flux);
    Block& block = blocks_[used_ - 1];
    for (std::size_t k = 0; k < 6; ++k) block.moments[k][block.count - 1] = node.moments[k];
}

std::size_t InteractionList::size() const {
    return used_ == 0 ? 0 : (used_ - 1) * kBlock + blocks_[used_ - 1].count;
}

void InteractionList::pad() {
    if (used_ == 0) return;
    Block& block = blocks_[used_ - 1];
    for (std::size_t i = block.count; i < kBlock; ++i) {
        block.x[i] = block.x[0];
        block.y[i] = block.y[0];
        block.z[i] = block.z[0];
        for (auto& m : block.moments) m[i] = 0.0f;
        for (float& f : block.flux[i]) f = 0.0f;
    }
}

namespace {

Rgb evaluateOne(const KernelTable& table, const InteractionList::Block& block, std::size_t i,
                bool withMoments, const Vec3& receiver) {
    const float dx = receiver.x - block.x[i], dy = receiver.y - block.y[i],
                dz = receiver.z - block.z[i];
    const float u = dx * dx + dy * dy + dz * dz + table.offsetMm2();
    const auto bits = std::bit_cast<std::uint32_t>(u);
    const auto row =
        std::min(static_cast<std::int32_t>(bits >> KernelTable::kShift) - table.baseRow(),
                 static_cast<std::int32_t>(table.rowCount()) - 1);
    const KernelTable::Row& c = table.rows()[row];
    constexpr std::uint32_t mask = (1u << KernelTable::kShift) - 1;
    const float t = static_cast<float>(bits & mask) * (1.0f / static_cast<float>(mask + 1));
    float a = 0, b = 0;
    if (withMoments) {
        const auto& m = block.moments;
        // dt/du: segments an octave over the power of two below u.
        const float s = std::bit_cast<float>((254u << 23) - (bits & 0x7f800000u)) *
                        static_cast<float>(1 << KernelTable::kSegmentBits);
        const float trace = m[0][i] + m[1][i] + m[2][i];
        const float along = m[0][i] * dx * dx + m[1][i] * dy * dy + m[2][i] * dz * dz +
                            2.0f * (m[3][i] * dx * dy + m[4][i] * dx * dz + m[5][i] * dy * dz);
        a = s * trace;
        b = 2.0f * s * s * along;
    }
    const float k1 = t + a;
    const float k2 = t * t + 2.0f * (t * a + b);
    const float k3 = t * (t * t + 3.0f * t * a + 6.0f * b);
    Rgb sum;
    for (int ch = 0; ch < 3; ++ch)
        sum[ch] =
            block.flux[i][ch] * (c.c[0][ch] + k1 * c.c[1][ch] + k2 * c.c[2][ch] + k3 * c.c[3][ch]);
    return sum;
}

}  // namespace

void accumulateScalar(const KernelTable& table, const InteractionList& list, bool withMoments,
                      std::span<const Vec3> receivers, std::span<DRgb> sums) {
    for (std::size_t r = 0; r < receivers.size(); ++r)
        for (const InteractionList::Block& block : list.blocks())
            for (std::size_t i = 0; i < block.count; ++i)
                sums[r] += DRgb(evaluateOne(table, block, i, withMoments, receivers[r]));
}

}  // namespace sss
