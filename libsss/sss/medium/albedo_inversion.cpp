#include "sss/medium/albedo_inversion.h"

#include "sss/base/error.h"
#include "sss/medium/dipole.h"
#include "sss/medium/half_space.h"

#include <fmt/format.h>

#include <cmath>

namespace sss {
namespace {

/// A medium of reduced albedo 1/(1 + e^x) and 1 - alpha' = 1/(1 + e^-x), sigma'_t = 1: both ends of
/// the albedo keep their digits.
ChannelMedium mediumAt(double x, double g, double eta) {
    return {1 / (1 + std::exp(-x)), 1 / (1 + std::exp(x)) / (1 - g), g, eta};
}

double totalOf(std::string_view profile, const ChannelMedium& medium,
               const ProfileOptions& options) {
    if (profile == "tabulated") {
        const HalfSpaceTotals totals = halfSpaceTotals(medium);
        return options.tabulatedIllumination == Illumination::Normal ? totals.normal
                                                                     : totals.diffuse;
    }
    if (profile.starts_with("normalized_diffusion")) {
        return Dipole(medium, options.boundary).total();
    }
    return makeProfile(profile, medium, options)->total();
}

/// Root of a decreasing function on [lo, hi] by false position, Illinois variant.
template <typename Function>
double decreasingRoot(double lo, double hi, double atLo, double atHi, const Function& f) {
    for (int i = 0; i < 200 && hi - lo > 1e-14 * (1 + std::abs(lo)); ++i) {
        // Every third step halves, so that a lopsided function cannot stall it.
        const double x = i % 3 == 2 ? 0.5 * (lo + hi) : lo + (hi - lo) * atLo / (atLo - atHi);
        const double value = f(x);
        if (std::abs(value) < 1e-14) return x;
        if (value > 0) {
            lo = x;
            atLo = value;
            atHi *= 0.5;
        } else {
            hi = x;
            atHi = value;
            atLo *= 0.5;
        }
    }
    return 0.5 * (lo + hi);
}

ChannelMedium scaled(double reducedAbsorption, const DiffuseLook& look) {
    const double transport = reducedAbsorption;  // sigma_a at sigma'_t = 1
    const double scattering = (1 - reducedAbsorption) / (1 - look.g);
    double sigmaTPrime = 1 / look.radiusMm;
    if (look.radiusKind == RadiusKind::VolumeMfp) sigmaTPrime /= transport + scattering;
    if (look.radiusKind == RadiusKind::DiffuseMfp) sigmaTPrime /= std::sqrt(3 * transport);
    return {transport * sigmaTPrime, scattering * sigmaTPrime, look.g, look.eta};
}

}  // namespace

double invertReducedAbsorption(std::string_view profile, double color, double g, double eta,
                               const ProfileOptions& options) {
    if (!(color >= 0 && color <= 1)) {
        throw Error(ErrorKind::BadInput, "albedo inversion",
                    fmt::format("the diffuse color {} is not in [0, 1]", color));
    }
    const double most = totalOf(profile, {0, 1 / (1 - g), g, eta}, options);
    if (color > most + 1e-12) {
        throw Error(ErrorKind::BadInput, "albedo inversion",
                    fmt::format("the diffuse color {} is above {:.6g}, which the profile \"{}\" "
                                "returns without absorption",
                                color, most, profile),
                    "take a darker color or another profile");
    }
    if (color == 0) return 1;
    if (color >= most) return 0;
    constexpr double kRange = 80;  // 1 - alpha' from 1e-35 to 1 - 1e-35
    const auto excess = [&](double x) {
        // Both logarithms, so that false position sees a function that is nearly straight.
        return std::log(totalOf(profile, mediumAt(x, g, eta), options) / color);
    };
    const double x = decreasingRoot(-kRange, kRange, std::log(most / color), -100, excess);
    return 1 / (1 + std::exp(-x));
}

ChannelMedium invertAlbedo(std::string_view profile, const DiffuseLook& look,
                           const ProfileOptions& options) {
    const double absorption =
        invertReducedAbsorption(profile, look.color, look.g, look.eta, options);
    if (absorption == 0 && look.radiusKind == RadiusKind::DiffuseMfp) {
        throw Error(ErrorKind::BadInput, "albedo inversion",
                    fmt::format("a medium of diffuse color {} does not absorb, so that its diffuse "
                                "mean free path cannot be {} mm",
                                look.color, look.radiusMm),
                    "state the transport mean free path instead");
    }
    return scaled(absorption, look);
}

namespace {

/// What both specifications say, under one name for each of its parts.
struct SubsurfaceLook {
    DRgb color, radiusMm;  ///< radius: volume mean free path
    double g, eta;
};

Medium mediumOf(const SubsurfaceLook& look, std::string_view profile,
                const ProfileOptions& options) {
    Medium medium;
    medium.eta = look.eta;
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = invertAlbedo(
            profile, {look.color[c], look.radiusMm[c], RadiusKind::VolumeMfp, look.g, look.eta},
            options);
        medium.sigmaA[c] = channel.sigmaA;
        medium.sigmaS[c] = channel.sigmaS;
        medium.g[c] = look.g;
    }
    return medium;
}

}  // namespace

Medium mediumFromOpenPbr(const OpenPbrSubsurface& p, double mmPerUnit, std::string_view profile,
                         const ProfileOptions& options) {
    return mediumOf({p.color, p.radiusScale * (p.radius * mmPerUnit), p.anisotropy, p.ior}, profile,
                    options);
}

Medium mediumFromPrincipled(const PrincipledSubsurface& p, double mmPerUnit,
                            std::string_view profile, const ProfileOptions& options) {
    return mediumOf({p.baseColor, p.radius * (p.scale * mmPerUnit), p.anisotropy, p.ior}, profile,
                    options);
}

double openPbrAlbedo(double color, double g) {
    const double s =
        4.09712 + 4.20863 * color - std::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
    return (1 - s * s) / (1 - g * s * s);
}

}  // namespace sss
