#include "sss/cloud/surface_strata.h"

#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/cloud/face_order.h"

#include <algorithm>
#include <numeric>

namespace sss {
namespace {

double radicalInverse(std::uint32_t i) {
    double result = 0, digit = 0.5;
    for (; i; i >>= 1, digit *= 0.5) result += (i & 1u) ? digit : 0.0;
    return result;
}

// Area-preserving map of the unit square to barycentrics with low distortion [Heitz 2019].
DVec2 triangleFromSquare(double x, double y) {
    if (y > x) {
        x *= 0.5;
        y -= x;
    } else {
        y *= 0.5;
        x -= y;
    }
    return {x, y};
}

}  // namespace

SurfaceStrata makeStrata(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
    const std::vector<FaceIndex> order = facesInSpaceOrder(mesh);
    std::vector<double> cumulative(order.size() + 1, 0.0);
    for (std::size_t k = 0; k < order.size(); ++k)
        cumulative[k + 1] = cumulative[k] + mesh.faceArea(order[k]);
    const double total = cumulative.back();

    SurfaceStrata strata;
    strata.areaMm2 = total / static_cast<double>(count);
    strata.positions.resize(count);
    strata.faces.resize(count);
    strata.barycentrics.resize(count);
    const double start = Rng(combineSeeds(seed, count)).uniformDouble();
    parallelFor(count, 4096, [&](std::size_t begin, std::size_t end) {
        std::size_t k = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const double along =
                (static_cast<double>(i) + start) / static_cast<double>(count) * total;
            if (i == begin)
                k = static_cast<std::size_t>(
                        std::upper_bound(cumulative.begin(), cumulative.end() - 1, along) -
                        cumulative.begin()) -
                    1;
            while (k + 1 < order.size() && cumulative[k + 1] <= along) ++k;
            const double faceShare = cumulative[k + 1] - cumulative[k];
            const double x = std::clamp((along - cumulative[k]) / faceShare, 0.0, 1.0);
            // A per-face rotation keeps the Hammersley sets of neighbouring faces from lining up.
            const double shift = Rng(combineSeeds(seed ^ 0x5bd1e995u, order[k])).uniformDouble();
            double y = radicalInverse(static_cast<std::uint32_t>(i)) + shift;
            y -= std::floor(y);
            const DVec2 b = triangleFromSquare(x, y);
            strata.faces[i] = order[k];
            strata.barycentrics[i] = Vec2(b);
            strata.positions[i] = Vec3(mesh.positionAt(order[k], b));
        }
    });
    return strata;
}

}  // namespace sss
