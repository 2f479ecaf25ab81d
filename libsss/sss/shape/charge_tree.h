#pragma once
#include "sss/cloud/octree.h"
#include "sss/cloud/point_cloud.h"

#include <span>
#include <vector>

namespace sss {

/// The charges of a cloud, seen from afar, to second order around a node's centre; four lanes (R,
/// G, B, unused) a number. A point carries a charge q and a dipole m along its normal.
struct alignas(16) ChargeNode {
    float charge[4];         ///< sum q
    float dipole[3][4];      ///< sum q d + m, by axis; d = point - centre
    float quadrupole[6][4];  ///< sum q d d / 2 + sym(m d): xx yy zz xy xz yz
};

/// What of a node does not change with the charges.
struct NodeShape {
    Vec3 centre{};
    float radius = 0;      ///< of the sphere around the centre that holds all points
    float secondMean = 0;  ///< area mean of |d|^2, mm^2
    float thirdMean = 0;   ///< area mean of |d|^3, mm^3
    float extent = 0;      ///< its cube root, mm; not below the root of secondMean
};

/// The points below a node: a run, since they stand in the tree's order.
struct PointRange {
    std::uint32_t begin = 0, end = 0;
    std::uint32_t size() const { return end - begin; }
};

/// Moments of signed charges on the octree of a cloud. Const but for setFluence(); O(N).
class ChargeTree {
public:
    /// Both must outlive the tree.
    ChargeTree(const CloudView& cloud, std::span<const OctreeNode> nodes);

    /// Charges A phi / b and dipoles A phi n for a fluence phi, W m^-2, at every point. `perLength`
    /// is 1 / b by point, mm^-1.
    void setFluence(std::span<const DRgb> fluence, std::span<const DRgb> perLength);

    std::span<const OctreeNode> nodes() const { return nodes_; }
    std::span<const PointRange> ranges() const { return ranges_; }
    std::span<const NodeShape> shapes() const { return shapes_; }
    std::span<const ChargeNode> charges() const { return charges_; }
    /// Sum of A |phi| below each node.
    std::span<const Rgb> weights() const { return weights_; }
    /// A phi of a point.
    const Rgb& areaFluence(std::size_t point) const { return areaFluence_[point]; }
    /// A phi / b of a point.
    const Rgb& charge(std::size_t point) const { return pointCharges_[point]; }
    const Vec3& normal(std::size_t point) const { return normals_[point]; }
    const CloudView& cloud() const { return cloud_; }

private:
    void fromPoints(std::size_t node);
    void fromChildren(std::size_t node);

    CloudView cloud_;
    std::span<const OctreeNode> nodes_;
    std::vector<PointRange> ranges_;
    std::vector<Vec3> normals_;
    std::vector<NodeShape> shapes_;
    std::vector<ChargeNode> charges_;
    std::vector<Rgb> weights_, areaFluence_, pointCharges_;
};

}  // namespace sss
