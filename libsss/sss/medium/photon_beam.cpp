#include "sss/medium/photon_beam.h"

#include "sss/medium/image_source.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/gauss_legendre.h"
#include "sss/optics/phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {
namespace {

/// Share of an integral below which a panel beyond the maximum is the last.
constexpr double kNegligible = 1e-15;

/// Integral over [0, range] of a positive f with one maximum whose singularities lie on the
/// imaginary axis: panels growing by a factor of 4 from `first`, none longer than `longest`, until
/// one no longer counts.
template <typename Function>
double gradedQuadrature(double first, double longest, double range, const Function& f) {
    double sum = gauss16(0, first, f);
    for (double lo = first; lo < range;) {
        const double hi = std::min({4 * lo, lo + longest, range});
        const double panel = gauss16(lo, hi, f);
        sum += panel;
        if (panel <= kNegligible * sum) break;
        lo = hi;
    }
    return sum;
}

/// Attenuations beyond this are 0: e^-45 = 3e-20.
constexpr double kRange = 45;
/// In mean free paths; products of six such lengths are still numbers.
constexpr double kNearest = 1e-50;

}  // namespace

PhotonBeam::PhotonBeam(const ChannelMedium& medium, Part part, const ProfileOptions& options)
    : Profile(medium.meanFreePathMm()),
      medium_(medium),
      grosjean_(medium, options.boundary == BoundaryModel::Polynomial
                            ? roundedPolynomialFresnelMoments(medium.eta)
                            : exactFresnelMoments(medium.eta)),
      part_(part),
      samples_(options.beamSamples),
      sigmaTPrime_(medium.sigmaTPrime()),
      extinction_(sigmaTPrime_ > 0 ? medium.sigmaT() / sigmaTPrime_ : 1) {}

const RadialQuadrature& PhotonBeam::quadrature() const {
    std::call_once(quadratureOnce_, [this] {
        // Once scattered light goes down to the critical angle's depth and up along it.
        const double eta = medium_.eta;
        const double once = eta > 1 ? eta + std::sqrt((eta - 1) * (eta + 1)) : 1.0;
        const bool multiple = part_ == Part::Multiple;
        const double decay = multiple ? grosjean_.sigmaTr : 2 * once * extinction_;
        // A backward peak shows within 1 + g of the beam.
        const double scale =
            multiple ? scaleMm()
                     : scaleMm() / std::max(extinction_, 1.0) * (1 + std::min(medium_.g, 0.0));
        quadrature_ =
            std::make_unique<RadialQuadrature>([this](double r) { return reflectance(r); }, scale,
                                               4 * scaleMm() / std::max(decay, 1e-300));
    });
    return *quadrature_;
}

double PhotonBeam::total() const {
    return medium_.sigmaS > 0 ? std::min(quadrature().tail(0), 1.0) : 0.0;
}

double PhotonBeam::tail(double aMm) const {
    return medium_.sigmaS > 0 ? std::min(quadrature().tail(aMm), 1.0) : 0.0;
}

double PhotonBeam::reflectance(double rMm) const {
    if (medium_.sigmaS == 0) return 0;
    if (rMm == 0) return std::numeric_limits<double>::infinity();
    const double r = reducedRadius(rMm, sigmaTPrime_);
    double value = 0;
    if (samples_ > 0)
        value = part_ == Part::Multiple ? multipleSampled(r) : singleSampled(r);
    else
        value = part_ == Part::Multiple ? multipleNearAndFar(r) : singleNearAndFar(r);
    return sigmaTPrime_ * sigmaTPrime_ * value;
}

// [HCJ13 Eq. 9, 10]: dipole of a source at `depth`, times kappa alpha'^2.
double PhotonBeam::multipleFromDepth(double r, double depth) const {
    const ImagePair pair(depth, depth + grosjean_.extrapolation, grosjean_.sigmaTr, r);
    const double kappa = -std::expm1(-2 * (slant(r, depth) + depth));
    const double albedo = medium_.reducedAlbedo();
    return kappa * albedo * albedo *
           (grosjean_.fluenceWeight * pair.fluence + grosjean_.fluxWeight * pair.flux) / (4 * kPi);
}

double PhotonBeam::multiple(double r) const {
    return gradedQuadrature(0.25 * std::min(r, 1.0), 8, kRange, [&](double depth) {
        return std::exp(-depth) * multipleFromDepth(r, depth);
    });
}

// Below kNearest the laws at r = 0 hold to every digit, a - b log r and c / r.
double PhotonBeam::multipleNearAndFar(double r) const {
    if (r >= kNearest) return multiple(r);
    const double near = multiple(kNearest), further = multiple(std::sqrt(kNearest));
    return near + (near - further) * 2 * std::log(r / kNearest) / std::log(kNearest);
}

double PhotonBeam::singleNearAndFar(double r) const {
    return r >= kNearest ? single(r) : single(kNearest) * kNearest / r;
}

double PhotonBeam::multipleSampled(double r) const {
    double sum = 0;
    for (int i = 0; i < samples_; ++i) {
        sum += multipleFromDepth(r, -std::log1p(-(i + 0.5) / samples_));
    }
    return sum / samples_;
}

/// Light that reaches `depth`, scatters there and leaves at r, per depth; without sigma_s.
double PhotonBeam::singleFromDepth(double r, double depth) const {
    const double d = slant(r, depth);
    const double cosine = depth / d;
    const double offPeak = medium_.g >= 0 ? 1 + cosine : r / d * (r / (d + depth));
    return std::exp(-extinction_ * (depth + d)) * henyeyGreensteinOffPeak(offPeak, medium_.g) *
           cosine / (d * d);
}

// Integrated over y with depth^2 = t_c^2 + y^2, where t_c is the depth of the critical angle: the
// cosine outside is y / sqrt(y^2 + (r eta)^2), and the root singularity of Fresnel's formulas at
// the critical angle is gone. Below eta = 1 there is no critical angle, t_c = 0.
double PhotonBeam::single(double r) const {
    const double eta = medium_.eta;
    const double critical = eta > 1 ? r * std::sqrt((eta - 1) * (eta + 1)) : 0.0;
    const double reach = kRange / extinction_;
    const double range = std::sqrt(reach * (reach + 2 * critical));
    const double scatter = medium_.sigmaS / sigmaTPrime_;
    const double smallest = std::min({critical > 0 ? critical : r, r, r * eta, 1 / extinction_});
    // Far out depth^2 = t_c^2 + y^2 grows slowly with y.
    const double longest = 4 / extinction_ * std::sqrt(std::max(1.0, critical * extinction_));
    return gradedQuadrature(0.25 * smallest, longest, range, [&](double y) {
        const double depth = slant(critical, y);
        const double reflected = eta > 1
                                     ? fresnelReflectance(y / slant(y, r * eta), eta)
                                     : fresnelReflectanceFromInside(depth / slant(r, depth), eta);
        return scatter * singleFromDepth(r, depth) * (1 - reflected) * (y / depth);
    });
}

double PhotonBeam::singleSampled(double r) const {
    const double eta = medium_.eta;
    const double critical = eta > 1 ? r * std::sqrt((eta - 1) * (eta + 1)) : 0.0;
    double sum = 0;
    for (int i = 0; i < samples_; ++i) {
        const double depth = critical - std::log1p(-(i + 0.5) / samples_) / extinction_;
        const double cosine = depth / slant(r, depth);
        // The sample's density carries e^{-sigma_t (depth - critical)}.
        sum += singleFromDepth(r, depth) * std::exp(extinction_ * (depth - critical)) *
               (1 - fresnelReflectanceFromInside(cosine, eta));
    }
    return medium_.albedo() * sum / samples_;
}

}  // namespace sss
