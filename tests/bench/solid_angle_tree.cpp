#include "solid_angle_tree.h"

#include "sss/base/bounds.h"
#include "sss/base/error.h"
#include "sss/medium/dipole.h"

#include <cmath>

namespace sss::bench {
namespace {

// Enough for any octree: 64 levels of Morton code at most, seven brothers each.
constexpr std::size_t kStack = 512;

bool inside(const Vec3& p, const Vec3& lo, const Vec3& hi) {
    return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z;
}

}  // namespace

// R_d = alpha' / (4 pi) sum over both sources of z (1 + sigma_tr d) exp(-sigma_tr d) / d^3
// [JMLH01 Eq. 4, without the 1 / sigma'_t printed in its second term].
SolidAngleTree::ClosedForm::ClosedForm(const Medium& medium, const ProfileOptions& options,
                                       const std::array<const Profile*, 3>& profiles) {
    const double boundary = dipoleBoundaryFactor(medium.eta, options.boundary);
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = medium.channel(c);
        const double mfp = channel.meanFreePathMm();
        sigmaTr_[c] = static_cast<float>(std::sqrt(3 * channel.sigmaA / mfp));
        realHeight_[c] = static_cast<float>(mfp);
        virtualHeight_[c] = static_cast<float>(mfp * (1 + 4.0 / 3.0 * boundary));
        scale_[c] = static_cast<float>(channel.reducedAlbedo() / (4 * kPi));
        for (const double r : {0.0, 0.3 * mfp, 2 * mfp, 7 * mfp}) {
            const double expected = profiles[static_cast<std::size_t>(c)]->reflectance(r);
            const auto value = static_cast<double>(evaluate(static_cast<float>(r * r))[c]);
            if (std::abs(value - expected) > 1e-5 * expected)
                throw Error(ErrorKind::BadInput, "profile", "is not the medium's dipole",
                            "give the scene's material \"profile\": \"dipole\"");
        }
    }
}

Rgb SolidAngleTree::ClosedForm::evaluate(float distanceSquaredMm2) const {
    Rgb value;
    for (int c = 0; c < 3; ++c) {
        const float zr = realHeight_[c], zv = virtualHeight_[c];
        const float dr2 = distanceSquaredMm2 + zr * zr, dv2 = distanceSquaredMm2 + zv * zv;
        const float dr = std::sqrt(dr2), dv = std::sqrt(dv2);
        const float sr = sigmaTr_[c] * dr, sv = sigmaTr_[c] * dv;
        value[c] = scale_[c] * (zr * (1 + sr) * std::exp(-sr) / (dr2 * dr) +
                                zv * (1 + sv) * std::exp(-sv) / (dv2 * dv));
    }
    return value;
}

SolidAngleTree::SolidAngleTree(const CloudView& cloud, std::span<const OctreeNode> nodes) {
    std::vector<Bounds> boxes(nodes.size());
    for (std::size_t n = nodes.size(); n-- > 0;)  // children stand behind their parents
        for (std::uint32_t k = nodes[n].first; k < nodes[n].first + nodes[n].size(); ++k)
            if (nodes[n].isLeaf())
                boxes[n].add(cloud.points[k].position);
            else
                boxes[n].add(boxes[k]);
    nodes_.reserve(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const OctreeNode& node = nodes[n];
        nodes_.push_back({node.centroid, node.areaMm2, node.flux, node.first, boxes[n].lo,
                          node.count, boxes[n].hi});
    }
    points_.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        points_.push_back({cloud.points[i].position, cloud.flux(i)});
}

template <typename Kernel>
Rgb SolidAngleTree::evaluate(const Kernel& kernel, const Vec3& receiver, float solidAngleLimit,
                             Counts& counts) const {
    Rgb sum(0);
    if (nodes_.empty()) return sum;
    std::array<std::uint32_t, kStack> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        ++counts.nodesVisited;
        const Vec3 d = node.centroid - receiver;
        const float distanceSquared = glm::dot(d, d);
        if (node.areaMm2 < solidAngleLimit * distanceSquared &&
            !inside(receiver, node.lo, node.hi)) {
            sum += node.flux * kernel.evaluate(distanceSquared);
            ++counts.nodeInteractions;
        } else if ((node.count & OctreeNode::kLeaf) != 0) {
            const std::uint32_t size = node.count & ~OctreeNode::kLeaf;
            for (std::uint32_t i = node.first; i < node.first + size; ++i) {
                const Vec3 offset = points_[i].position - receiver;
                sum += points_[i].flux * kernel.evaluate(glm::dot(offset, offset));
            }
            counts.pointInteractions += size;
        } else {
            for (std::uint32_t k = 0; k < node.count; ++k) stack[depth++] = node.first + k;
        }
    }
    return sum;
}

template Rgb SolidAngleTree::evaluate(const ClosedForm&, const Vec3&, float, Counts&) const;
template Rgb SolidAngleTree::evaluate(const KernelTable&, const Vec3&, float, Counts&) const;

}  // namespace sss::bench
