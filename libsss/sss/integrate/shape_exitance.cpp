#include "sss/integrate/shape_exitance.h"

#include "sss/base/parallel.h"
#include "sss/integrate/body_field.h"

namespace sss {
namespace {

constexpr std::size_t kReceiversPerSum = 512;

// What the profile gives at the points themselves.
std::vector<Rgb> profileExitance(const BodyField& field, const BodyCloud::View& cloud,
                                 double tolerance) {
    std::vector<Vec3> places;
    places.reserve(cloud.cloud.points.size());
    for (const SurfacePoint& p : cloud.cloud.points) places.push_back(p.position);
    std::vector<Rgb> exitance(places.size());
    parallelFor(places.size(), kReceiversPerSum, [&](std::size_t begin, std::size_t end) {
        DiffusionSum::Scratch scratch;
        SumCounts counts;
        field.sum().evaluate(std::span(places).subspan(begin, end - begin), tolerance,
                             std::span(exitance).subspan(begin, end - begin), scratch, counts);
    });
    return exitance;
}

FresnelMoments momentsOf(const TranslucentMaterial& material) {
    return material.profileOptions.boundary == BoundaryModel::Exact
               ? exactFresnelMoments(material.medium.eta)
               : polynomialFresnelMoments(material.medium.eta);
}

}  // namespace

ShapeExitance solveShape(const World& world, int bodyIndex, const BodyOptics& optics,
                         const BodyCloud::View& cloud, const EnteredBeams& beams,
                         std::span<const Rgb> once) {
    const Body& body = world.bodies()[static_cast<std::size_t>(bodyIndex)];
    const double tolerance = world.scene().quality.tolerance;
    const DiffusionConstants medium =
        diffusionConstants(optics.material.medium, momentsOf(optics.material));
    const BodyField field(body, optics, cloud, tolerance);
    const std::vector<Rgb> flat = profileExitance(field, cloud, tolerance);
    const BeamSources light = placeBeamSources(world, bodyIndex, cloud, beams, medium);
    const ShapeSolver solver(cloud.cloud, cloud.nodes, medium, cloud.spacingMm,
                             body.mesh.bounds().diagonal() * 1.01, tolerance);
    std::vector<DRgb> fluence(flat.size());
    for (std::size_t i = 0; i < flat.size(); ++i) fluence[i] = DRgb(flat[i]) * medium.impedance;

    ShapeExitance result;
    result.report = solver.solve(light.sources, fluence);
    result.correction.reserve(flat.size());
    DRgb all{0}, single{0};
    for (std::size_t i = 0; i < flat.size(); ++i) {
        DRgb exitance(0);
        for (int c = 0; c < 3; ++c)
            if (medium.scatters[c]) exitance[c] = fluence[i][c] / medium.impedance[c];
        const double area = cloud.cloud.points[i].areaMm2;
        all += exitance * area;
        if (!once.empty()) {
            single += DRgb(once[i]) * area;
            exitance -= DRgb(once[i]);
        }
        result.correction.push_back(Rgb(exitance - DRgb(flat[i])));
    }
    for (int c = 0; c < 3; ++c) {
        if (!(light.entered[c] > 0)) continue;
        result.leaves[c] = (all[c] - single[c]) / light.entered[c];
        result.single[c] = single[c] / light.entered[c];
        result.unscattered[c] = light.unscattered[c] / light.entered[c];
        result.absorbed[c] = 1 - (all[c] + light.unscattered[c]) / light.entered[c];
    }
    return result;
}

}  // namespace sss
