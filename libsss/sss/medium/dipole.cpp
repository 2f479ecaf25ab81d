#include "sss/medium/dipole.h"

#include "sss/medium/image_source.h"
#include "sss/optics/fresnel_moments.h"

#include <algorithm>

namespace sss {
double dipoleBoundaryFactor(double eta, BoundaryModel boundary) {
    if (boundary == BoundaryModel::Polynomial) {
        const double diffuse = polynomialDiffuseReflectance(eta);
        return (1 + diffuse) / (1 - diffuse);
    }
    const FresnelMoments moments = exactFresnelMoments(eta);
    return (1 + moments.twoC1) / moments.transmittanceOut;
}

Dipole::Dipole(const ChannelMedium& medium, BoundaryModel boundary)
    : Profile(medium.meanFreePathMm()),
      sigmaTPrime_(medium.sigmaTPrime()),
      reducedAlbedo_(medium.reducedAlbedo()),
      sigmaTr_(std::sqrt(3 * medium.reducedAbsorption())),
      virtualHeight_(1 + 4.0 / 3.0 * dipoleBoundaryFactor(medium.eta, boundary)) {}

double Dipole::reflectance(double rMm) const {
    const double r = reducedRadius(rMm, sigmaTPrime_);
    const double sum = fluxKernel(1, sigmaTr_, r) + fluxKernel(virtualHeight_, sigmaTr_, r);
    return reducedAlbedo_ * sum / (4 * kPi) * sigmaTPrime_ * sigmaTPrime_;
}

double Dipole::tail(double aMm) const {
    const double a = reducedRadius(aMm, sigmaTPrime_);
    return 0.5 * reducedAlbedo_ *
           (fluxKernelTail(1, sigmaTr_, a) + fluxKernelTail(virtualHeight_, sigmaTr_, a));
}

double Dipole::total() const { return std::min(tail(0), 1.0); }

}  // namespace sss
