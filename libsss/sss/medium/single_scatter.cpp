#include "sss/medium/single_scatter.h"

#include "sss/base/vec.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/gauss_legendre.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sss {
namespace {

/// A direction inside through which light passes, with the weight of its part of the hemisphere.
struct Direction {
    double cosine, sine, weight, transmittance;
};

/// At an angle to the normal outside for eta > 1, where Fresnel's formulas are smooth, else inside.
Direction directionAt(double angle, double angleWeight, double eta) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    if (eta <= 1)
        return {cosine, sine, sine * angleWeight, 1 - fresnelReflectanceFromInside(cosine, eta)};
    const double inside = refractedCosine(cosine, eta);
    return {inside, sine / eta, sine * angleWeight * cosine / (eta * eta * inside),
            1 - fresnelReflectance(cosine, eta)};
}

/// Mean over the azimuth of the Henyey-Greenstein phase function for light that comes in and goes
/// back out on the same side of the normal: with d = 1 + g^2 - 2 g cos Theta between dLeast and
/// dMost, the mean of d^-3/2 is (2/pi) E(k) / (dLeast sqrt(dMost)), k^2 = 1 - dLeast/dMost,
/// E the complete elliptic integral of the second kind. Nothing here cancels.
double azimuthalMean(const Direction& in, const Direction& out, double g) {
    const double off = 1 - std::abs(g);
    const double across = g < 0 ? in.cosine - out.cosine : in.cosine + out.cosine;
    const double gap = in.sine - out.sine;
    const double dLeast = off * off + std::abs(g) * (across * across + gap * gap);
    const double spread = 4 * std::abs(g) * in.sine * out.sine;
    const double dMost = dLeast + spread;
    const double elliptic = std::comp_ellint_2(std::sqrt(std::min(spread / dMost, 1.0)));
    return (1 - g) * (1 + g) / (4 * kPi) * (2 / kPi) * elliptic / (dLeast * std::sqrt(dMost));
}

constexpr double kRightAngle = kPi / 2;

/// Panels of angles that grow by a factor of 4 away from grazing, where Fresnel's formulas vary
/// fast for eta near 1 and a forward peak shows, from `finest` on.
std::vector<double> gradedFromGrazing(double finest) {
    std::vector<double> edges{0, kRightAngle};
    for (double e = std::min(finest, 1e-3); e < kRightAngle; e *= 4)
        edges.push_back(kRightAngle - e);
    return edges;
}

std::vector<Direction> directionsOn(std::vector<double> edges, double eta) {
    std::sort(edges.begin(), edges.end());
    std::vector<Direction> directions;
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        const double width = edges[k + 1] - edges[k];
        for (const GaussPoint& point : kGauss16)
            directions.push_back(
                directionAt(edges[k] + width * point.node, width * point.weight, eta));
    }
    return directions;
}

/// Share of the light that comes in at `angle` and leaves after one scattering, per albedo.
double scatteredOut(double angle, const ChannelMedium& medium) {
    const double g = medium.g, finest = 0.25 * (1 - std::abs(g));
    std::vector<double> edges = gradedFromGrazing(finest);
    // A backward peak goes back where the light came from.
    for (double e = finest; g < 0 && e < kRightAngle; e *= 4)
        for (const double edge : {angle - e, angle + e})
            if (edge > 0 && edge < kRightAngle) edges.push_back(edge);
    if (g < 0) edges.push_back(angle);
    const Direction in = directionAt(angle, 0, medium.eta);
    double sum = 0;
    for (const Direction& out : directionsOn(std::move(edges), medium.eta))
        sum += azimuthalMean(in, out, g) * out.transmittance * out.weight * out.cosine /
               (in.cosine + out.cosine);
    return 2 * kPi * sum;
}

}  // namespace

double singleScatterAlbedo(const ChannelMedium& medium, Illumination illumination) {
    if (medium.sigmaS == 0) return 0;
    if (illumination == Illumination::Normal) return medium.albedo() * scatteredOut(0, medium);
    // Transmitted diffuse light by direction inside: dE = 2 eta^2 mu (1 - F) dmu.
    std::vector<double> edges = gradedFromGrazing(0.25 * (1 - std::abs(medium.g)));
    std::sort(edges.begin(), edges.end());
    double entered = 0, sum = 0;
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        for (const GaussPoint& point : kGauss16) {
            const double width = edges[k + 1] - edges[k];
            const double angle = edges[k] + width * point.node;
            const Direction in = directionAt(angle, width * point.weight, medium.eta);
            const double flux = in.cosine * in.weight * in.transmittance;
            entered += flux;
            sum += flux * scatteredOut(angle, medium);
        }
    }
    return medium.albedo() * sum / entered;
}

}  // namespace sss
