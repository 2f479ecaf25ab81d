#include "sss/shape/charge_tree.h"

#include "sss/base/parallel.h"

#include <array>
#include <cmath>

namespace sss {
namespace {

// Axes of the six numbers of a symmetric tensor.
constexpr int kFirst[6] = {0, 1, 2, 0, 0, 1}, kSecond[6] = {0, 1, 2, 1, 2, 2};

// The points below every node: runs, since they stand in the tree's order.
std::vector<PointRange> rangesOf(std::span<const OctreeNode> nodes) {
    std::vector<PointRange> ranges(nodes.size());
    for (std::size_t n = nodes.size(); n-- > 0;) {
        const OctreeNode& node = nodes[n];
        if (node.isLeaf())
            ranges[n] = {node.first, node.first + node.size()};
        else
            ranges[n] = {ranges[node.first].begin, ranges[node.first + node.size() - 1].end};
    }
    return ranges;
}

NodeShape shapeOf(std::span<const SurfacePoint> points) {
    DVec3 centre{0};
    double area = 0;
    for (const SurfacePoint& p : points) {
        centre += DVec3(p.position) * static_cast<double>(p.areaMm2);
        area += p.areaMm2;
    }
    NodeShape shape;
    shape.centre = area > 0 ? Vec3(centre / area) : points.front().position;
    double second = 0, third = 0, radius = 0;
    for (const SurfacePoint& p : points) {
        const double d = glm::length(DVec3(p.position) - DVec3(shape.centre));
        second += p.areaMm2 * d * d;
        third += p.areaMm2 * d * d * d;
        radius = std::max(radius, d);
    }
    shape.radius = static_cast<float>(radius);
    if (area > 0) {
        shape.secondMean = static_cast<float>(second / area);
        shape.thirdMean = static_cast<float>(third / area);
        shape.extent = static_cast<float>(std::cbrt(third / area));
    }
    return shape;
}

// Moments in double, until they are stored.
struct Sums {
    DRgb charge{0};
    std::array<DRgb, 3> dipole{DRgb(0), DRgb(0), DRgb(0)};
    std::array<DRgb, 6> quadrupole{DRgb(0), DRgb(0), DRgb(0), DRgb(0), DRgb(0), DRgb(0)};

    // Charges q, dipole p and quadrupole t around a place at d from the centre.
    void add(const DRgb& q, const std::array<DRgb, 3>& p, const std::array<DRgb, 6>& t,
             const DVec3& d) {
        charge += q;
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            dipole[axis] += p[axis] + q * d[k];
        }
        for (std::size_t k = 0; k < 6; ++k) {
            const int i = kFirst[k], j = kSecond[k];
            quadrupole[k] += t[k] + q * (0.5 * d[i] * d[j]) +
                             0.5 * (p[static_cast<std::size_t>(i)] * d[j] +
                                    p[static_cast<std::size_t>(j)] * d[i]);
        }
    }
    void store(ChargeNode& node) const {
        const auto put = [](const DRgb& v, float* lanes) {
            for (int c = 0; c < 3; ++c) lanes[c] = static_cast<float>(v[c]);
            lanes[3] = 0.0f;
        };
        put(charge, node.charge);
        for (std::size_t k = 0; k < 3; ++k) put(dipole[k], node.dipole[k]);
        for (std::size_t k = 0; k < 6; ++k) put(quadrupole[k], node.quadrupole[k]);
    }
};

DRgb lanes(const float* v) { return {v[0], v[1], v[2]}; }

}  // namespace

ChargeTree::ChargeTree(const CloudView& cloud, std::span<const OctreeNode> nodes)
    : cloud_(cloud),
      nodes_(nodes),
      ranges_(rangesOf(nodes)),
      shapes_(nodes.size()),
      charges_(nodes.size()),
      weights_(nodes.size(), Rgb(0)),
      areaFluence_(cloud.size(), Rgb(0)),
      pointCharges_(cloud.size(), Rgb(0)) {
    normals_.reserve(cloud.size());
    for (const SurfacePoint& p : cloud.points) normals_.push_back(decodeUnitVector(p.normal));
    parallelFor(nodes.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            shapes_[n] = shapeOf(cloud.points.subspan(ranges_[n].begin, ranges_[n].size()));
    });
}

void ChargeTree::fromPoints(std::size_t n) {
    const OctreeNode& node = nodes_[n];
    Sums sums;
    DRgb weight{0};
    for (std::uint32_t i = node.first; i < node.first + node.size(); ++i) {
        const DRgb m(areaFluence_[i]);
        const DVec3 normal(normals_[i]);
        sums.add(DRgb(pointCharges_[i]), {m * normal.x, m * normal.y, m * normal.z}, {},
                 DVec3(cloud_.points[i].position) - DVec3(shapes_[n].centre));
        weight += glm::abs(m);
    }
    sums.store(charges_[n]);
    weights_[n] = Rgb(weight);
}

void ChargeTree::fromChildren(std::size_t n) {
    const OctreeNode& node = nodes_[n];
    Sums sums;
    DRgb weight{0};
    for (std::uint32_t k = node.first; k < node.first + node.size(); ++k) {
        const ChargeNode& child = charges_[k];
        std::array<DRgb, 3> p;
        std::array<DRgb, 6> t;
        for (std::size_t i = 0; i < 3; ++i) p[i] = lanes(child.dipole[i]);
        for (std::size_t i = 0; i < 6; ++i) t[i] = lanes(child.quadrupole[i]);
        sums.add(lanes(child.charge), p, t, DVec3(shapes_[k].centre) - DVec3(shapes_[n].centre));
        weight += DRgb(weights_[k]);
    }
    sums.store(charges_[n]);
    weights_[n] = Rgb(weight);
}

void ChargeTree::setFluence(std::span<const DRgb> fluence, std::span<const DRgb> perLength) {
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
        const DRgb areaFluence = fluence[i] * static_cast<double>(cloud_.points[i].areaMm2);
        areaFluence_[i] = Rgb(areaFluence);
        pointCharges_[i] = Rgb(areaFluence * perLength[i]);
    }
    parallelFor(nodes_.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            if (nodes_[n].isLeaf()) fromPoints(n);
    });
    // Children stand behind their parents.
    for (std::size_t n = nodes_.size(); n-- > 0;)
        if (!nodes_[n].isLeaf()) fromChildren(n);
}

}  // namespace sss
