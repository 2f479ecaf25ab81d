#include "sss/medium/better_dipole.h"

#include "sss/medium/grosjean.h"
#include "sss/medium/image_source.h"

#include <algorithm>

namespace sss {

BetterDipole::BetterDipole(const ChannelMedium& medium, BoundaryModel boundary)
    : Profile(medium.meanFreePathMm()),
      sigmaTPrime_(medium.sigmaTPrime()),
      strength_(medium.reducedAlbedo() * medium.reducedAlbedo()) {
    const GrosjeanMedium grosjean(medium, boundary == BoundaryModel::Polynomial
                                              ? polynomialFresnelMoments(medium.eta)
                                              : exactFresnelMoments(medium.eta));
    sigmaTr_ = grosjean.sigmaTr;
    virtualHeight_ = 1 + grosjean.extrapolation;
    fluenceWeight_ = grosjean.fluenceWeight;
    fluxWeight_ = grosjean.fluxWeight;
}

double BetterDipole::reflectance(double rMm) const {
    const double r = reducedRadius(rMm, sigmaTPrime_);
    const ImagePair pair(1, virtualHeight_, sigmaTr_, r);
    return strength_ * (fluenceWeight_ * pair.fluence + fluxWeight_ * pair.flux) / (4 * kPi) *
           sigmaTPrime_ * sigmaTPrime_;
}

double BetterDipole::tail(double aMm) const {
    const double a = reducedRadius(aMm, sigmaTPrime_);
    const double flux =
        fluxKernelTail(1, sigmaTr_, a) + fluxKernelTail(virtualHeight_, sigmaTr_, a);
    const double fluence = fluenceKernelTail(1, virtualHeight_, sigmaTr_, a);
    return 0.5 * strength_ * (fluenceWeight_ * fluence + fluxWeight_ * flux);
}

double BetterDipole::total() const { return std::min(tail(0), 1.0); }

}  // namespace sss
