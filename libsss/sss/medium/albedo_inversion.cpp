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

/// Profiles whose light stays on its side of the medium: their totals depend on no length.
bool isOfHalfSpace(std::string_view profile) { return !profile.starts_with("multipole"); }

double totalOf(std::string_view profile, const ChannelMedium& medium,
               const ProfileOptions& options) {
    if (!isOfHalfSpace(profile)) return makeProfile("multipole", medium, options)->total();
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

/// 1 - alpha' at which `total`, a function of the logit of 1 - alpha' that starts at `most`, is the
/// color.
template <typename Total>
double absorptionFor(double color, double most, const Total& total) {
    if (color == 0) return 1;
    if (color >= most) return 0;
    constexpr double kRange = 80;  // 1 - alpha' from 1e-35 to 1 - 1e-35
    // Logarithms of both, so that false position sees a function that is nearly straight.
    const auto excess = [&](double x) { return std::log(total(x) / color); };
    const double x = decreasingRoot(-kRange, kRange, std::log(most / color), -100, excess);
    return 1 / (1 + std::exp(-x));
}

void checkColor(double color) {
    if (color >= 0 && color <= 1) return;
    throw Error(ErrorKind::BadInput, "albedo inversion",
                fmt::format("the diffuse color {} is not in [0, 1]", color));
}

/// What a color may exceed by rounding.
constexpr double kRounding = 1e-12;

ChannelMedium scaled(double reducedAbsorption, const DiffuseLook& look) {
    const double transport = reducedAbsorption;  // sigma_a at sigma'_t = 1
    const double scattering = (1 - reducedAbsorption) / (1 - look.g);
    double sigmaTPrime = 1 / look.radiusMm;
    if (look.radiusKind == RadiusKind::VolumeMfp) sigmaTPrime /= transport + scattering;
    if (look.radiusKind == RadiusKind::DiffuseMfp) sigmaTPrime /= std::sqrt(3 * transport);
    return {transport * sigmaTPrime, scattering * sigmaTPrime, look.g, look.eta};
}

/// 1 - alpha' of a slab of the options' thickness, whose total depends on the radius asked for.
double slabAbsorption(std::string_view profile, const DiffuseLook& look,
                      const ProfileOptions& options) {
    // The limit without absorption; by diffuse mean free path that of dense, clear media.
    constexpr double kClear = 1e-30;
    const auto totalAt = [&](double absorption) {
        return totalOf(profile, scaled(absorption, look), options);
    };
    const double most = totalAt(look.radiusKind == RadiusKind::DiffuseMfp ? kClear : 0.0);
    if (look.color > most + kRounding) {
        throw Error(ErrorKind::BadInput, "albedo inversion",
                    fmt::format("the diffuse color {} is above {:.6g}, which a slab of {} mm "
                                "returns without absorption: the other light passes through it",
                                look.color, most, *options.slabThicknessMm),
                    "take a darker color, a thicker slab or a shorter mean free path");
    }
    return absorptionFor(look.color, most,
                         [&](double x) { return totalAt(1 / (1 + std::exp(-x))); });
}

}  // namespace

double invertReducedAbsorption(std::string_view profile, double color, double g, double eta,
                               const ProfileOptions& options) {
    checkColor(color);
    const double most = totalOf(profile, {0, 1 / (1 - g), g, eta}, options);
    if (!(most > 0)) {
        throw Error(ErrorKind::BadInput, "albedo inversion",
                    fmt::format("the profile \"{}\" returns {:.6g} without absorption at eta {}: "
                                "the polynomials of its boundary do not reach that far",
                                profile, most, eta),
                    "take the exact boundary");
    }
    if (color > most + kRounding) {
        const bool isBeam = profile.starts_with("photon_beam");
        throw Error(ErrorKind::BadInput, "albedo inversion",
                    fmt::format("the diffuse color {} is above {:.6g}, which the profile \"{}\" "
                                "returns without absorption at eta {} and g {}{}",
                                color, most, profile, eta, g,
                                isBeam ? ": it is a part of the light, and single and multiple "
                                         "scattering return the color together only"
                                       : ""),
                    "take a darker color or another profile");
    }
    return absorptionFor(color, most,
                         [&](double x) { return totalOf(profile, mediumAt(x, g, eta), options); });
}

ChannelMedium invertAlbedo(std::string_view profile, const DiffuseLook& look,
                           const ProfileOptions& options) {
    checkColor(look.color);
    const double absorption =
        isOfHalfSpace(profile)
            ? invertReducedAbsorption(profile, look.color, look.g, look.eta, options)
            : slabAbsorption(profile, look, options);
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
