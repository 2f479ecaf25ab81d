#pragma once
// Bodies lit along their normals, and diffusion solved on them.
#include "cloud_tools.h"
#include "sss/shape/depth_rule.h"
#include "sss/shape/shape_solver.h"

#include <functional>

namespace sss::testing {

inline DiffusionConstants constantsOf(std::string_view medium) {
    const Optics optics(medium);
    return diffusionConstants(optics.medium, exactFresnelMoments(optics.medium.eta));
}

using Where = std::function<bool(const SurfacePoint&)>;
/// How far a beam goes that enters at a point along its normal, mm.
using Length = std::function<double(const SurfacePoint&)>;

// A body lit along its normals where asked, and its solution.
struct Solved {
    LitCloud cloud;
    DiffusionConstants medium;
    std::vector<VolumeSource> sources;
    std::vector<DRgb> fluence;
    DRgb entered{0};
    ShapeReport report;

    Solved(const TriangleMesh& mesh, double spacing, double lengthMm, const DiffusionConstants& m,
           const Where& isLit)
        : Solved(
              mesh, spacing, [&](const auto&) { return lengthMm; }, m, isLit) {}
    Solved(const TriangleMesh& mesh, double spacing, const Length& lengthMm,
           const DiffusionConstants& m, const Where& isLit)
        : cloud(mesh, spacing, white), medium(m) {
        const DepthRule rule(medium);
        std::vector<DepthRule::Node> nodes;
        for (std::uint32_t i = 0; i < cloud.samples.size(); ++i) {
            const SurfacePoint& p = cloud.samples.points[i];
            if (!isLit(p)) continue;
            const Vec3 normal = decodeUnitVector(p.normal);
            const DRgb power(static_cast<double>(p.areaMm2));
            entered += power;
            const double length = lengthMm(p);
            nodes.clear();
            rule.append(length, nodes);
            for (std::uint32_t k = 0; k < nodes.size(); ++k) {
                const auto depth = static_cast<float>(nodes[k].depthMm);
                sources.push_back({p.position - normal * depth,
                                   Rgb(power * nodes[k].weight * medium.reducedAlbedo), k, i});
            }
        }
        const double reach = 1.01 * mesh.bounds().diagonal();
        const ShapeSolver solver(cloud.view(), cloud.nodes, medium, cloud.spacingMm, reach, 1e-3);
        fluence.assign(cloud.samples.size(), 0.5 * medium.impedance);
        report = solver.solve(sources, fluence);
    }
    DRgb exitance(std::size_t i) const { return fluence[i] / medium.impedance; }
    // Mean over the points that `counts` says, weighted by area.
    DRgb mean(const Where& counts) const {
        DRgb sum{0};
        double area = 0;
        for (std::size_t i = 0; i < fluence.size(); ++i) {
            const SurfacePoint& p = cloud.samples.points[i];
            if (!counts(p)) continue;
            sum += exitance(i) * static_cast<double>(p.areaMm2);
            area += p.areaMm2;
        }
        return sum / area;
    }
    double spread(const DRgb& mean) const {
        double squares = 0;
        for (std::size_t i = 0; i < fluence.size(); ++i)
            squares += std::pow(exitance(i).y / mean.y - 1, 2);
        return std::sqrt(squares / static_cast<double>(fluence.size()));
    }
};

inline const auto everywhere = [](const auto&) { return true; };
inline const auto fromAbove = [](const SurfacePoint& p) {
    return decodeUnitVector(p.normal).z > 0.9f;
};

}  // namespace sss::testing
