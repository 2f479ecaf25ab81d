#pragma once
#include "sss/base/vec.h"

#include <array>
#include <string>

namespace sss {

/// One channel of a homogeneous medium. Coefficients in mm^-1; symbols as in formulas of
/// [JMLH01]. Absorption and scattering are stored apart, so that 1 - alpha' never cancels.
struct ChannelMedium {
    double sigmaA = 0;  ///< absorption, mm^-1, >= 0
    double sigmaS = 0;  ///< scattering (not reduced), mm^-1, >= 0
    double g = 0;       ///< mean cosine of the scattering angle, in (-1, 1)
    double eta = 1;     ///< index of refraction inside over outside, > 0

    double sigmaSPrime() const { return (1.0 - g) * sigmaS; }
    double sigmaT() const { return sigmaA + sigmaS; }
    double sigmaTPrime() const { return sigmaA + sigmaSPrime(); }
    /// Transport mean free path 1/sigma'_t in mm; infinite in vacuum.
    double meanFreePathMm() const { return 1.0 / sigmaTPrime(); }
    double albedo() const { return sigmaT() > 0 ? sigmaS / sigmaT() : 0.0; }
    double reducedAlbedo() const { return sigmaTPrime() > 0 ? sigmaSPrime() / sigmaTPrime() : 0.0; }
    /// 1 - alpha', without cancellation.
    double reducedAbsorption() const { return sigmaTPrime() > 0 ? sigmaA / sigmaTPrime() : 1.0; }
    bool operator==(const ChannelMedium&) const = default;
};

/// A medium by colour channel.
struct Medium {
    DRgb sigmaA{0};
    DRgb sigmaS{0};
    DRgb g{0};
    double eta = 1;

    ChannelMedium channel(int c) const { return {sigmaA[c], sigmaS[c], g[c], eta}; }
    /// The shortest transport mean free path over the channels, mm.
    double smallestMeanFreePathMm() const;
    DRgb meanFreePathMm() const;
    bool operator==(const Medium&) const = default;
};

}  // namespace sss
