#include "sss/medium/single_scatter.h"

#include "sss/base/vec.h"
#include "sss/medium/photon_beam.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/gauss_legendre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace sss;

namespace {

const ChannelMedium kMarbleG{0.0041, 2.62, 0, 1.5};
const ChannelMedium kSkimmilkG{0.0025, 1.22, 0, 1.3};

TEST(SingleScattering, AgreesWithMonteCarloFromTheFormulas) {
    // Exit flux per INCIDENT flux at normal incidence, formulas.md section 7.
    const auto perIncident = [](const ChannelMedium& medium) {
        const double entry =
            (medium.eta - 1) * (medium.eta - 1) / ((medium.eta + 1) * (medium.eta + 1));
        return (1 - entry) * singleScatterAlbedo(medium, Illumination::Normal);
    };
    EXPECT_NEAR(perIncident(kMarbleG), 0.051399, 1e-6);
    EXPECT_NEAR(perIncident(kSkimmilkG), 0.074280, 1e-6);
    EXPECT_NEAR(perIncident({0.0046, 20.3826, 0.714, 1.33}), 0.0077298, 2e-6);
}

TEST(SingleScattering, IsTheIntegralOfTheBeamsSingleProfile) {
    for (const ChannelMedium& medium :
         {kMarbleG, ChannelMedium{0.1, 2, 0.6, 1.3}, ChannelMedium{0.1, 2, -0.8, 0.8},
          ChannelMedium{0.2, 1, 0, 1}}) {
        const PhotonBeam beam(medium, PhotonBeam::Part::Single, {});
        const double expected = singleScatterAlbedo(medium, Illumination::Normal);
        EXPECT_NEAR(beam.total(), expected, 1e-7 * expected);
    }
}

TEST(SingleScattering, ClosedFormWithoutBoundary) {
    // Isotropic, matched: (albedo/2) int mu/(1 + mu) = (albedo/2)(1 - ln 2); diffuse light:
    // albedo int int mu mu'/(mu + mu') = albedo (2/3)(1 - ln 2).
    const ChannelMedium medium{0.3, 0.7, 0, 1};
    EXPECT_NEAR(singleScatterAlbedo(medium, Illumination::Normal), 0.35 * (1 - std::log(2)), 1e-9);
    EXPECT_NEAR(singleScatterAlbedo(medium, Illumination::Diffuse), 0.7 * 2 / 3 * (1 - std::log(2)),
                1e-9);
}

/// Integral over [lo, hi] by panels that halve towards both ends.
template <typename Function>
double towardsBothEnds(double lo, double hi, double finest, const Function& f) {
    const double half = 0.5 * (hi - lo);
    double sum = 0;
    for (double w = half; w > 0;) {
        const double next = w > finest ? 0.5 * w : 0;
        sum += gauss16(lo + next, lo + w, f) + gauss16(hi - w, hi - next, f);
        w = next;
    }
    return sum;
}

/// The same share in other coordinates: the scattered direction by its angle beta from straight
/// back and by the turn psi about that axis, where the phase function depends on beta alone.
class AboutTheRetroDirection {
public:
    explicit AboutTheRetroDirection(const ChannelMedium& medium)
        : medium_(medium),
          critical_(medium.eta > 1 ? std::acos(std::sqrt(1 - 1 / (medium.eta * medium.eta)))
                                   : kPi / 2) {}

    double diffuse() const {
        double flux = 0, sum = 0;
        // Angles outside or inside, whichever make Fresnel's formulas smooth.
        const auto inside = [&](double angle) {
            return medium_.eta > 1 ? std::asin(std::sin(angle) / medium_.eta) : angle;
        };
        const auto entering = [&](double angle) {
            return std::sin(angle) * std::cos(angle) * passes(std::cos(inside(angle)));
        };
        flux = towardsBothEnds(0, kPi / 2, 0.02, entering);
        sum = towardsBothEnds(0, kPi / 2, 0.02,
                              [&](double angle) { return entering(angle) * out(inside(angle)); });
        return medium_.albedo() * sum / flux;
    }

private:
    double passes(double cosInside) const {
        return 1 - fresnelReflectanceFromInside(cosInside, medium_.eta);
    }
    double leaving(double in, double cosOut) const {
        return passes(cosOut) * cosOut / (in + cosOut);
    }
    double out(double theta) const {
        const double g = medium_.g, c = std::cos(theta), s = std::sin(theta);
        const auto density = [&](double beta) {
            const double d = (1 + g) * (1 + g) - 4 * g * std::pow(std::sin(0.5 * beta), 2);
            return 0.5 * (1 - g * g) * std::sin(beta) / (d * std::sqrt(d));
        };
        const auto ring = [&](double beta) {
            const double along = c * std::cos(beta), across = s * std::sin(beta);
            // Those psi at which the light passes the boundary; the end is a square root.
            const double least = (std::cos(critical_) - along) / across;
            const double last = std::acos(std::clamp(least, -1.0, 1.0));
            return density(beta) / kPi * gauss16(0, 1, [&](double t) {
                       const double psi = last * (1 - t * t);
                       return 2 * t * last * leaving(c, along + across * std::cos(psi));
                   });
        };
        const double whole = std::abs(critical_ - theta), most = critical_ + theta;
        const double finest = 0.02 * (1 - std::abs(g));
        return towardsBothEnds(0, whole, finest, ring) + towardsBothEnds(whole, most, finest, ring);
    }

    ChannelMedium medium_;
    double critical_;  ///< angle inside, from which on nothing passes
};

TEST(SingleScattering, SharpPeaksInOtherCoordinates) {
    for (const ChannelMedium& medium :
         {ChannelMedium{0.1, 1, -0.95, 1.3}, ChannelMedium{0, 1, -0.99, 0.8},
          ChannelMedium{0.1, 1, -0.999, 1.5}, ChannelMedium{0.1, 1, 0.95, 1},
          ChannelMedium{0.1, 1, 0.99, 1.5}, ChannelMedium{0.1, 1, 0.999, 0.75}}) {
        const double expected = AboutTheRetroDirection(medium).diffuse();
        EXPECT_NEAR(singleScatterAlbedo(medium, Illumination::Diffuse), expected, 1e-6 * expected)
            << "g " << medium.g << " eta " << medium.eta;
    }
}

}  // namespace
