#include "sss/medium/normalized_diffusion.h"

#include "sss/base/error.h"
#include "sss/medium/dipole.h"

#include <cmath>
#include <limits>

namespace sss {
namespace {

double fitLengthMm(NormalizedFit fit, const ChannelMedium& medium) {
    if (fit != NormalizedFit::DiffuseMfp) return medium.meanFreePathMm();
    if (medium.sigmaA == 0 && medium.sigmaS > 0) {
        throw Error(ErrorKind::BadInput, "normalized_diffusion_dmfp",
                    "the medium does not absorb (sigma_a = 0), so its diffuse mean free path is "
                    "infinite and this fit has no length",
                    "use normalized_diffusion, which is built on the volume mean free path");
    }
    // Two roots: the product of small coefficients would be 0.
    return 1 / (std::sqrt(3 * medium.sigmaA) * std::sqrt(medium.sigmaTPrime()));
}

double albedoOf(const ChannelMedium& medium, const ProfileOptions& options) {
    if (options.surfaceAlbedo) return *options.surfaceAlbedo;
    return Dipole(medium, options.boundary).total();
}

}  // namespace

double normalizedDiffusionShape(NormalizedFit fit, double surfaceAlbedo) {
    const double a = surfaceAlbedo;
    switch (fit) {
        case NormalizedFit::IdealDiffuse:
            return 1.9 - a + 3.5 * (a - 0.8) * (a - 0.8);
        case NormalizedFit::Perpendicular: {
            const double x = std::abs(a - 0.8);
            return 1.85 - a + 7 * x * x * x;
        }
        case NormalizedFit::DiffuseMfp: {
            const double x = (a - 0.33) * (a - 0.33);
            return 3.5 + 100 * x * x;
        }
    }
    return 1;
}

NormalizedDiffusion::NormalizedDiffusion(NormalizedFit fit, double surfaceAlbedo, double lengthMm)
    : Profile(lengthMm),
      albedo_(surfaceAlbedo),
      lengthMm_(lengthMm / normalizedDiffusionShape(fit, surfaceAlbedo)) {}

NormalizedDiffusion::NormalizedDiffusion(NormalizedFit fit, const ChannelMedium& medium,
                                         const ProfileOptions& options)
    : NormalizedDiffusion(fit, albedoOf(medium, options), fitLengthMm(fit, medium)) {}

double NormalizedDiffusion::reflectance(double rMm) const {
    if (albedo_ == 0) return 0;
    if (rMm == 0) return std::numeric_limits<double>::infinity();
    const double x = rMm / lengthMm_;
    return albedo_ * (std::exp(-x) + std::exp(-x / 3)) / (8 * kPi * lengthMm_) / rMm;
}

double NormalizedDiffusion::tail(double aMm) const {
    if (albedo_ == 0) return 0;
    const double x = aMm / lengthMm_;
    return albedo_ * (0.25 * std::exp(-x) + 0.75 * std::exp(-x / 3));
}

}  // namespace sss
