#include "sss/medium/half_space.h"

#include "sss/base/vec.h"
#include "sss/medium/small_matrix.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/gauss_legendre.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

/// A direction inside, with the weight of its part of the hemisphere and the boundary's
/// reflectance.
struct Direction {
    double cosine, weight, reflectance;
};

constexpr std::size_t kLegendreTerms = 24;
constexpr double kThinLayer = 1e-8;
/// 1 - alpha' below which the rounding of the thin layer would count as absorption.
constexpr double kLeastAbsorption = 1e-5;

/// Above the critical angle in the cosine outside, where Fresnel's formulas are smooth, and below
/// it in the cosine inside; last comes the normal, with weight 0: light may start there.
std::vector<Direction> directionsInside(double eta) {
    std::vector<Direction> directions;
    const double critical = eta > 1 ? std::sqrt((eta - 1) * (eta + 1)) / eta : 0.0;
    for (const GaussPoint& point : kGauss16) {
        if (eta > 1) {
            const double mu = critical * point.node;
            directions.push_back({mu, critical * point.weight, 1.0});
        } else {
            const double mu = 0.5 * point.node;
            directions.push_back({mu, 0.5 * point.weight, fresnelReflectanceFromInside(mu, eta)});
        }
    }
    for (const GaussPoint& point : kGauss16) {
        if (eta > 1) {
            const double outside = point.node;
            const double mu = refractedCosine(outside, eta);
            const double slope = outside / (eta * eta * mu);  // d mu / d outside
            directions.push_back({mu, slope * point.weight, fresnelReflectance(outside, eta)});
        } else {
            const double mu = 0.5 + 0.5 * point.node;
            directions.push_back({mu, 0.5 * point.weight, fresnelReflectanceFromInside(mu, eta)});
        }
    }
    directions.push_back({1.0, 0.0, fresnelReflectance(1.0, eta)});
    return directions;
}

/// Azimuthal mean of the phase function, times 4 pi, for light that keeps its sense of depth (same)
/// and that turns back, with the forward peak taken out; columns conserve flux exactly.
struct Redistribution {
    SmallMatrix same, turned;
};

Redistribution redistribution(const std::vector<Direction>& directions, double g, double peak) {
    const std::size_t n = directions.size();
    Redistribution p{SmallMatrix(n), SmallMatrix(n)};
    std::vector<double> before(n, 0.0), now(n, 1.0);  // Legendre polynomials l - 1 and l
    double moment = 1;
    for (std::size_t l = 0; l < kLegendreTerms; ++l) {
        const double degree = static_cast<double>(l);
        const double term = (2 * degree + 1) * (moment - peak) / (1 - peak);
        const double sign = l % 2 == 0 ? 1 : -1;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                p.same(i, j) += term * now[i] * now[j];
                p.turned(i, j) += sign * term * now[i] * now[j];
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            const double next =
                ((2 * degree + 1) * directions[i].cosine * now[i] - degree * before[i]) /
                (degree + 1);
            before[i] = now[i];
            now[i] = next;
        }
        moment *= g;
    }
    for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
            sum += 0.5 * directions[i].weight * (p.same(i, j) + p.turned(i, j));
        }
        for (std::size_t i = 0; i < n; ++i) {
            p.same(i, j) /= sum;
            p.turned(i, j) /= sum;
        }
    }
    return p;
}

/// Reflection operator of the half-space without its boundary: element (i, j) is the share of the
/// flux in direction j that comes back in direction i.
SmallMatrix bareReflection(const std::vector<Direction>& directions, double g, double absorption) {
    const double albedo = 1 - absorption;
    const double peak = std::pow(g, static_cast<double>(kLegendreTerms));
    // delta-M: what is scattered into the peak is not scattered.
    const double reduced = albedo * (1 - peak) / (absorption + albedo * (1 - peak));
    const Redistribution p = redistribution(directions, g, peak);
    const std::size_t n = directions.size();
    SmallMatrix reflect(n), transmit = SmallMatrix::identity(n);
    for (std::size_t j = 0; j < n; ++j) {
        const double path = kThinLayer / directions[j].cosine;
        transmit(j, j) = std::exp(-path);
        const double scattered = -std::expm1(-path) * reduced;
        for (std::size_t i = 0; i < n; ++i) {
            const double share = 0.5 * scattered * directions[i].weight;
            reflect(i, j) = share * p.turned(i, j);
            transmit(i, j) += share * p.same(i, j);
        }
    }
    // The layer doubles until what it lets through no longer matters; 54 times is 2e8 mean free
    // paths, beyond which rounding gains on the remainder.
    for (int i = 0; i < 54 && transmit.largest() > 1e-12; ++i) {
        const SmallMatrix between = SmallMatrix::solveIdentityMinus(reflect * reflect, transmit);
        reflect += transmit * (reflect * between);
        transmit = transmit * between;
    }
    return reflect;
}

/// Flux that leaves in the end, of the flux `inside` that starts downwards just below the boundary.
double leaving(const SmallMatrix& reflect, const std::vector<Direction>& directions,
               const std::vector<double>& inside) {
    const std::size_t n = directions.size();
    SmallMatrix back(n), first(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            back(i, j) = reflect(i, j) * directions[j].reflectance;
            first(i, 0) += reflect(i, j) * inside[j];
        }
    }
    const SmallMatrix up = SmallMatrix::solveIdentityMinus(back, first);
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += (1 - directions[i].reflectance) * up(i, 0);
    return sum;
}

/// Transmitted diffuse light by direction inside: dE = 2 c (1 - F) dc = 2 eta^2 mu (1 - F) dmu.
std::vector<double> diffuseEntry(const std::vector<Direction>& directions) {
    std::vector<double> flux;
    double sum = 0;
    for (const Direction& d : directions) {
        flux.push_back(d.cosine * d.weight * (1 - d.reflectance));
        sum += flux.back();
    }
    for (double& f : flux) f /= sum;
    return flux;
}

}  // namespace

HalfSpaceTotals halfSpaceTotals(const ChannelMedium& medium) {
    if (medium.sigmaS == 0) return {0, 0};
    if (medium.sigmaA == 0) return {1, 1};
    if (const double absorption = medium.reducedAbsorption(); absorption < kLeastAbsorption) {
        // log R is linear in sqrt(1 - alpha') there, up to (1 - alpha')^1.5.
        ChannelMedium other = medium;
        other.sigmaA = 1.001 * kLeastAbsorption / (1 - kLeastAbsorption) * medium.sigmaSPrime();
        const HalfSpaceTotals at = halfSpaceTotals(other);
        const double power = std::sqrt(absorption / other.reducedAbsorption());
        return {std::pow(at.normal, power), std::pow(at.diffuse, power)};
    }
    const std::vector<Direction> directions = directionsInside(medium.eta);
    const double absorption = medium.sigmaA / medium.sigmaT();
    const SmallMatrix reflect = bareReflection(directions, medium.g, absorption);
    std::vector<double> along(directions.size(), 0.0);
    along.back() = 1;
    return {leaving(reflect, directions, along),
            leaving(reflect, directions, diffuseEntry(directions))};
}

}  // namespace sss
