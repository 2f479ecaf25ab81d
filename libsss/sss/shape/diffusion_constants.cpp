#include "sss/shape/diffusion_constants.h"

#include "sss/medium/grosjean.h"
#include "sss/medium/half_space.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/gauss_legendre.h"

namespace sss {

DiffusionConstants diffusionConstants(const Medium& medium, const FresnelMoments& moments) {
    DiffusionConstants out;
    const double impedance = 2.0 * (1.0 + moments.threeC2) / moments.transmittanceOut;
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = medium.channel(c);
        out.scatters[c] = channel.sigmaSPrime() > 0;
        const double mfp = out.scatters[c] ? channel.meanFreePathMm() : 1.0;
        const GrosjeanMedium grosjean(channel, moments);
        out.diffusionMm[c] = grosjean.diffusion * mfp;
        out.screening[c] = grosjean.sigmaTr / mfp;
        out.impedance[c] = impedance;
        out.boundaryMm[c] = impedance * out.diffusionMm[c];
        out.reducedAlbedo[c] = channel.reducedAlbedo();
        out.extinction[c] = channel.sigmaTPrime();
        out.fading[c] = out.extinction[c] + out.screening[c] * out.screening[c] * mfp;
    }
    return out;
}

double diffuseHalfSpaceShare(const DiffusionConstants& medium, int channel, double eta) {
    const double k = medium.screening[channel] / medium.extinction[channel];
    // Over the cosine outside.
    double entered = 0, returned = 0;
    for (const GaussPoint& point : kGauss16) {
        const double light =
            2 * point.weight * point.node * (1 - fresnelReflectance(point.node, eta));
        const double inside = refractedCosine(point.node, eta);
        entered += light;
        // Mean of exp(-k s) along the beam, which goes down by `inside` of its way.
        if (inside > 0) returned += light / (1 + k * inside);
    }
    const double bk = medium.boundaryMm[channel] * medium.screening[channel];
    return medium.reducedAlbedo[channel] * returned / entered / (1 + bk);
}

DRgb transferScale(const DiffusionConstants& constants, const Medium& medium) {
    DRgb scale{1};
    for (int c = 0; c < 3; ++c)
        if (constants.scatters[c] && constants.screening[c] > 0)
            scale[c] = halfSpaceTotals(medium.channel(c)).diffuse /
                       diffuseHalfSpaceShare(constants, c, medium.eta);
    return scale;
}

}  // namespace sss
