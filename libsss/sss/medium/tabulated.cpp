#include "sss/medium/tabulated.h"

#include "sss/medium/grosjean.h"
#include "sss/medium/half_space.h"
#include "sss/medium/image_source.h"
#include "sss/medium/photon_beam.h"
#include "sss/medium/photon_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace sss {
namespace {

/// The true decay length of diffusion against Grosjean's: kappa of alpha' = kappa/atanh(kappa).
double asymptoticDecay(double reducedAbsorption) {
    double lo = 0, hi = 1;
    for (int i = 0; i < 60; ++i) {
        const double kappa = 0.5 * (lo + hi);
        // 1 - kappa/atanh(kappa), by its series where that would cancel
        const double k2 = kappa * kappa;
        const double absorbed =
            kappa < 1e-3 ? k2 / 3 * (1 + k2 * 4 / 15) : 1 - kappa / std::atanh(kappa);
        (absorbed < reducedAbsorption ? lo : hi) = kappa;
    }
    return lo;
}

/// Forward scattering beyond this is simulated with this g and the same sigma'_s, because the walk
/// costs 1/(1 - g).
constexpr double kMostForward = 0.98;

/// exp of the log ratios between rings, by Catmull-Rom cubics in log r; constant below the first
/// ring, and with the true decay instead of the beam's beyond the last.
class RatioCurve {
public:
    RatioCurve(PhotonProfile profile, double excessDecay)
        : profile_(std::move(profile)),
          excessDecay_(excessDecay),
          perLog_(1 / std::log(profile_.stepRatio)) {}

    double operator()(double r) const {
        const auto& y = profile_.logRatios;
        const auto last = static_cast<double>(y.size() - 1);
        const double x = std::log(r / profile_.firstRadius) * perLog_;
        if (x <= 0) return std::exp(y.front());
        if (x >= last) {
            const double end = profile_.firstRadius * std::exp(last / perLog_);
            return std::exp(y.back() - excessDecay_ * (r - end));
        }
        const auto i = static_cast<std::ptrdiff_t>(x);
        const auto at = [&](std::ptrdiff_t k) {
            return y[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, std::ssize(y) - 1))];
        };
        const double t = x - static_cast<double>(i);
        const double a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
        const double cubic =
            b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
        return std::exp(cubic);
    }

private:
    PhotonProfile profile_;
    double excessDecay_, perLog_;
};

/// The simulated profile in transport mean free paths, but for its total: beam diffusion times the
/// ratio to it that the simulation found.
class RatioTimesBeam {
public:
    RatioTimesBeam(const ChannelMedium& unit, const PhotonProfile& simulated)
        : decay(GrosjeanMedium(unit, exactFresnelMoments(unit.eta)).sigmaTr),
          multiple_(
              std::make_shared<PhotonBeam>(unit, PhotonBeam::Part::Multiple, ProfileOptions{})),
          single_(std::make_shared<PhotonBeam>(unit, PhotonBeam::Part::Single, ProfileOptions{})),
          ratio_(simulated, asymptoticDecay(unit.reducedAbsorption()) - decay) {}

    double operator()(double r) const {
        const double beam = multiple_->reflectance(r) + single_->reflectance(r);
        // Far out the ratio may be infinite where the beam is 0.
        return beam > 0 ? ratio_(r) * beam : 0.0;
    }

    double decay;  ///< of the beam, per mean free path

private:
    std::shared_ptr<const PhotonBeam> multiple_, single_;
    RatioCurve ratio_;
};

}  // namespace

Tabulated::Tabulated(const ChannelMedium& medium, const ProfileOptions& options)
    : Profile(medium.meanFreePathMm()), sigmaTPrime_(medium.sigmaTPrime()) {
    if (medium.sigmaS == 0) return;
    PhotonProfileKey key;
    key.reducedAbsorption = medium.reducedAbsorption();
    key.g = std::min(medium.g, kMostForward);
    key.eta = medium.eta;
    key.illumination = options.tabulatedIllumination;
    key.relativeError = options.tabulatedError;
    const PhotonProfile simulated = loadOrSimulatePhotonProfile(
        key, options.tabulatedCacheFolder.empty() ? defaultProfileCacheFolder()
                                                  : options.tabulatedCacheFolder);
    simulatedTotal_ = simulated.total;
    simulatedError_ = simulated.totalError;
    if (!(simulatedTotal_ > 0)) return;
    const HalfSpaceTotals totals = halfSpaceTotals(medium);
    total_ = key.illumination == Illumination::Normal ? totals.normal : totals.diffuse;

    const double absorption = key.reducedAbsorption;
    const ChannelMedium unit{absorption, (1 - absorption) / (1 - key.g), key.g, key.eta};
    const RatioTimesBeam shape(unit, simulated);
    table_.emplace(shape, 1.0);
    quadrature_.emplace([this](double r) { return (*table_)(r); }, 1.0,
                        4 / std::max(shape.decay, 1e-300));
    correction_ = total_ / quadrature_->tail(0);
}

double Tabulated::reflectance(double rMm) const {
    if (!(total_ > 0)) return 0;
    if (rMm == 0) return std::numeric_limits<double>::infinity();
    const double r = reducedRadius(rMm, sigmaTPrime_);
    return correction_ * (*table_)(r)*sigmaTPrime_ * sigmaTPrime_;
}

double Tabulated::tail(double aMm) const {
    return total_ > 0 ? correction_ * quadrature_->tail(reducedRadius(aMm, sigmaTPrime_)) : 0.0;
}

void Tabulated::reflectance(std::span<const float> rMm, std::span<float> out) const {
    Profile::reflectance(rMm, out);
}

}  // namespace sss
