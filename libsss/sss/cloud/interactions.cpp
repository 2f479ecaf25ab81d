#include "sss/cloud/interactions.h"

#include <algorithm>

namespace sss {

InteractionList::Block& InteractionList::room() {
    if (used_ == 0 || blocks_[used_ - 1].count == kBlock) {
        if (used_ == blocks_.size()) blocks_.emplace_back();
        blocks_[used_].isColoured = false;
        blocks_[used_++].count = 0;
    }
    return blocks_[used_ - 1];
}

std::size_t InteractionList::addPoints(std::span<const SurfacePoint> points,
                                       std::span<const Rgb> irradiance) {
    std::size_t added = 0;
    for (std::size_t next = 0; next < points.size();) {
        Block& block = room();
        // A dark point is written, too, and then over it the next: no branch to be mispredicted.
        std::size_t i = block.count;
        for (; next < points.size() && i < kBlock; ++next) {
            const SurfacePoint& point = points[next];
            const Rgb flux = irradiance[next] * point.areaMm2;
            block.x[i] = point.position.x;
            block.y[i] = point.position.y;
            block.z[i] = point.position.z;
            for (int c = 0; c < 3; ++c) block.flux[i][c] = flux[c];
            block.flux[i][3] = 0.0f;
            i += isZero(flux) ? 0 : 1;
        }
        added += i - block.count;
        block.count = i;
    }
    return points.size() - added;
}

void InteractionList::setNodes(std::span<const OctreeNode> nodes,
                               std::span<const std::uint32_t> indices) {
    clear();
    for (; !indices.empty(); indices = indices.subspan(std::min(kBlock, indices.size()))) {
        Block& block = room();
        block.count = std::min(kBlock, indices.size());
        pack(nodes, indices.first(block.count), block);
    }
}

std::size_t InteractionList::size() const {
    return used_ == 0 ? 0 : (used_ - 1) * kBlock + blocks_[used_ - 1].count;
}

void InteractionList::pad() {
    if (used_ == 0) return;
    Block& block = blocks_[used_ - 1];
    for (std::size_t i = block.count; i % kPad != 0; ++i) {
        block.x[i] = block.x[0];
        block.y[i] = block.y[0];
        block.z[i] = block.z[0];
        for (auto& m : block.moments) m[i] = 0.0f;
        for (float& f : block.flux[i]) f = 0.0f;
        if (!block.isColoured) continue;
        for (auto& axis : block.lean)
            for (float& lean : axis[i]) lean = 0.0f;
        block.meanFlux[i] = 0.0f;
    }
}

void packScalar(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
                InteractionList::Block& to) {
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const OctreeNode& node = nodes[indices[i]];
        to.x[i] = node.centroid.x;
        to.y[i] = node.centroid.y;
        to.z[i] = node.centroid.z;
        for (std::size_t k = 0; k < 6; ++k) to.moments[k][i] = node.moments[k];
        for (int c = 0; c < 3; ++c) to.flux[i][c] = node.flux[c];
        to.flux[i][3] = 0.0f;
    }
    to.isColoured = std::ranges::any_of(
        indices, [&](std::uint32_t index) { return nodes[index].isColoured(); });
    if (to.isColoured) packLeans(nodes, indices, to);
}

void packLeans(std::span<const OctreeNode> nodes, std::span<const std::uint32_t> indices,
               InteractionList::Block& to) {
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const OctreeNode& node = nodes[indices[i]];
        const auto& [red, blue] = node.lean;
        for (int axis = 0; axis < 3; ++axis) {
            float* lean = to.lean[axis][i];
            lean[0] = red[axis];
            lean[1] = -red[axis] - blue[axis];
            lean[2] = blue[axis];
            lean[3] = 0.0f;
        }
        to.meanFlux[i] = node.meanFlux();
    }
}

float quadraticForm(const InteractionList::Block& block, std::size_t i, const Vec3& d) {
    const auto& m = block.moments;
    return m[0][i] * d.x * d.x + m[1][i] * d.y * d.y + m[2][i] * d.z * d.z +
           2.0f * (m[3][i] * d.x * d.y + m[4][i] * d.x * d.z + m[5][i] * d.y * d.z);
}

Vec3 leanOf(const InteractionList::Block& block, std::size_t i, int channel) {
    return {block.lean[0][i][channel], block.lean[1][i][channel], block.lean[2][i][channel]};
}

namespace {

Rgb evaluateOne(const KernelTable& table, const InteractionList::Block& block, std::size_t i,
                bool withMoments, const Vec3& receiver) {
    const Vec3 d(receiver.x - block.x[i], receiver.y - block.y[i], receiver.z - block.z[i]);
    const auto [row, t, s] = table.placeOf(glm::dot(d, d));
    float a = 0, b = 0;
    if (withMoments) {
        const auto& m = block.moments;
        a = s * (m[0][i] + m[1][i] + m[2][i]);
        b = 2.0f * s * s * quadraticForm(block, i, d);
    }
    const bool isColoured = withMoments && block.isColoured;
    const float k1 = t + a;
    const float k2 = t * t + 2.0f * (t * a + b);
    const float k3 = t * (t * t + 3.0f * t * a + 6.0f * b);
    Rgb sum;
    for (int ch = 0; ch < 3; ++ch) {
        const float c1 = row->c[1][ch], c2 = row->c[2][ch], c3 = row->c[3][ch];
        sum[ch] = block.flux[i][ch] * (row->c[0][ch] + k1 * c1 + k2 * c2 + k3 * c3);
        if (isColoured)
            sum[ch] -= 2.0f * s * (c1 + t * (2.0f * c2 + 3.0f * t * c3)) *
                       glm::dot(d, leanOf(block, i, ch)) * block.meanFlux[i];
    }
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
