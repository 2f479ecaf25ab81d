#include "sss/shape/diffusion_constants.h"

#include "sss/medium/grosjean.h"

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
    }
    return out;
}

}  // namespace sss
