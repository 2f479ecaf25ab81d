#pragma once
#include "sss/medium/profile.h"

namespace sss {

/// The three fits of [CB15] for the shape parameter s.
enum class NormalizedFit {
    IdealDiffuse,   ///< volume mean free path, ideal diffuse transmission (their Eq. 6)
    Perpendicular,  ///< volume mean free path, perpendicular searchlight (their Eq. 5)
    DiffuseMfp,     ///< diffuse mean free path 1/sigma_tr, searchlight (their Eq. 8)
};

/// s of the fit, for a surface albedo in [0, 1].
double normalizedDiffusionShape(NormalizedFit fit, double surfaceAlbedo);

/// Normalized diffusion [CB15]: R_d = A (e^{-r/d} + e^{-r/(3d)}) / (8 pi d r), d = l/s. Its total
/// is A exactly; it grows like 1/r at r = 0. The mean free path is the transport one, 1/sigma'_t.
class NormalizedDiffusion final : public Profile {
public:
    /// `lengthMm` is the l of the fit, > 0.
    NormalizedDiffusion(NormalizedFit fit, double surfaceAlbedo, double lengthMm);
    /// With A from the options or else from the classic dipole's total. Throws Error{BadInput} for
    /// DiffuseMfp without absorption, where 1/sigma_tr is infinite.
    NormalizedDiffusion(NormalizedFit fit, const ChannelMedium& medium,
                        const ProfileOptions& options);
    using Profile::reflectance;
    double reflectance(double rMm) const override;
    double tail(double aMm) const override;
    double total() const override { return albedo_; }
    bool singularAtZero() const override { return albedo_ > 0; }

private:
    double albedo_;
    double lengthMm_;  ///< d
};

}  // namespace sss
