#include "numbers/subjects.h"
#include "sss/base/parallel.h"
#include "sss/cloud/surface_sampler.h"
#include "sss/geom/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace sss::stress {
namespace {

TriangleMesh triangle(const DVec3& a, const DVec3& b, const DVec3& c) {
    TriangleMesh mesh;
    mesh.positions = {a, b, c};
    mesh.faces = {{0, 1, 2}};
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
    for (DVec3& p : mesh.positions) p *= factor;
    return mesh;
}

// A strip of needles, each 1e6 times as long as wide.
TriangleMesh needles() {
    TriangleMesh mesh;
    constexpr std::uint32_t kCount = 50;
    for (std::uint32_t i = 0; i <= kCount; ++i) {
        mesh.positions.emplace_back(0, 1e-5 * i, 0);
        mesh.positions.emplace_back(10, 1e-5 * i, 0);
    }
    for (std::uint32_t i = 0; i < kCount; ++i) {
        mesh.faces.emplace_back(2 * i, 2 * i + 1, 2 * i + 3);
        mesh.faces.emplace_back(2 * i, 2 * i + 3, 2 * i + 2);
    }
    return mesh;
}

// A large face among ten thousand that together are a millionth of it.
TriangleMesh unequalFaces() {
    TriangleMesh mesh = makeRectangle(1e-2, 1e-2, 1.4e-4);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.normals.clear();
    for (const DVec3& p : {DVec3(1, 0, 0), DVec3(15, 0, 0), DVec3(1, 14, 0)})
        mesh.positions.push_back(p);
    mesh.faces.emplace_back(first, first + 1, first + 2);
    return mesh;
}

struct Surface {
    const char* name;
    TriangleMesh mesh;
    double spacing;
};

// `fine` is by how much spacings are smaller than in brief.
std::vector<Surface> hardSurfaces(double fine) {
    std::vector<Surface> all{
        {"one triangle", triangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0}), 0.8},
        {"a needle of 1e6 : 1", triangle({0, 0, 0}, {1e3, 0, 0}, {1e3, 1e-3, 0}), 0.1},
        {"a strip of needles", needles(), 1e-2},
        {"one face and 10,000 tiny ones", unequalFaces(), 0.6},
        {"a ball of 1e-6 mm", makeSphere(1e-6), 2e-7},
        {"a ball of 1e6 mm", makeSphere(1e6), 2e5},
        {"a box of 12 faces", makeBox(DVec3(1, 2, 3)), 0.2},
        {"a sheet of 1e-5 thickness", makeBox(DVec3(10, 10, 1e-4)), 0.6},
        {"spacing far above the body", makeSphere(1), 1e9},
        {"far from the origin",
         [] {
             TriangleMesh mesh = makeSphere(1);
             for (DVec3& p : mesh.positions) p += DVec3(1e3, -2e3, 3e3);
             return mesh;
         }(),
         0.2},
    };
    for (Surface& surface : all) surface.spacing /= fine;
    return all;
}

bool sameBytes(const std::vector<SurfacePoint>& a, const std::vector<SurfacePoint>& b) {
    return a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), a.size() * sizeof(SurfacePoint)) == 0;
}

void checkPoints(const Surface& surface, const SurfaceSamples& samples, Row& sound, Row& area) {
    const auto where = [&] { return std::string(surface.name); };
    const DBounds box = surface.mesh.bounds();
    const double slack = 1e-6 * (box.diagonal() + glm::length(box.lo));
    double sum = 0;
    for (const SurfacePoint& p : samples.points) {
        const DVec3 at(p.position);
        bool isInside = isFinite(p.position) && p.face < surface.mesh.faceCount();
        for (int axis = 0; axis < 3; ++axis)
            isInside &= at[axis] >= box.lo[axis] - slack && at[axis] <= box.hi[axis] + slack;
        sound.expect(isInside && std::isfinite(p.areaMm2) && p.areaMm2 >= 0, where);
        sum += double{p.areaMm2};
    }
    area.add(std::abs(sum / surface.mesh.area() - 1), where);
}

}  // namespace

void stressSurfaces(Report& report, Scope scope) {
    Row sound("surfaces", "points: finite, on the surface, of a face", 0);
    Row area("surfaces", "areas of points make up the surface", 1e-5);
    // On what is narrower than the spacing, points keep their distance along one direction only:
    // there may be as many as there are candidates, six for one announced.
    Row count("surfaces", "number of points against what was announced", 6);
    Row threads("surfaces", "any number of threads: the same points", 0);
    for (const Surface& surface : hardSurfaces(scope == Scope::Full ? 4 : 1)) {
        const SamplerOptions options{.spacingMm = surface.spacing, .seed = 1};
        const SurfaceSamples samples = sampleSurface(surface.mesh, options);
        const auto where = [&] { return std::string(surface.name); };
        checkPoints(surface, samples, sound, area);
        const double expected =
            static_cast<double>(expectedPointCount(surface.mesh.area(), options));
        const double times = static_cast<double>(samples.size()) / expected;
        count.add(std::max(times, 1 / times), where);
        const ThreadLimit limit(scope == Scope::Full ? 8 : 1);
        threads.expect(sameBytes(samples.points, sampleSurface(surface.mesh, options).points),
                       where);
    }
    report.add(sound);
    report.add(area);
    report.add(count);
    report.add(threads);

    Row fine("surfaces", "12 faces are sampled as densely as 5,000", 0.03);
    const double spacing = scope == Scope::Full ? 0.05 : 0.1;
    for (const double scale : {1e-3, 1.0, 1e3}) {
        const SamplerOptions options{.spacingMm = spacing * scale, .seed = 1};
        const auto coarse = sampleSurface(scaled(makeBox(DVec3(2)), scale), options).size();
        const auto many = sampleSurface(scaled(makeBox(DVec3(2), 0.1), scale), options).size();
        fine.add(std::abs(static_cast<double>(coarse) / static_cast<double>(many) - 1),
                 [&] { return fmt::format("scale {}: {} and {} points", scale, coarse, many); });
    }
    report.add(fine);
}

}  // namespace sss::stress
