#pragma once
#include "sss/medium/grosjean.h"
#include "sss/medium/profile.h"
#include "sss/medium/radial_quadrature.h"

#include <memory>
#include <mutex>

namespace sss {

/// Photon beam diffusion [HCJ13]: extended source along the refracted beam of normal incidence,
/// integrated to convergence, or with the paper's N exponential samples. Also for eta < 1, where
/// every direction inside leaves. Grows like log r (multiple) or 1/r (single) at r = 0.
class PhotonBeam final : public Profile {
public:
    enum class Part {
        Multiple,  ///< the diffused part, with the paper's correction kappa
        Single,    ///< light scattered exactly once
    };

    PhotonBeam(const ChannelMedium& medium, Part part, const ProfileOptions& options);
    using Profile::reflectance;
    double reflectance(double rMm) const override;
    double tail(double aMm) const override;
    double total() const override;
    bool singularAtZero() const override { return medium_.sigmaS > 0; }
    void reflectance(std::span<const float> rMm, std::span<float> out) const override {
        reflectanceByTable(rMm, out);
    }

private:
    /// Made at the first call: it costs some hundred evaluations of the profile.
    const RadialQuadrature& quadrature() const;
    double multipleNearAndFar(double r) const;
    double singleNearAndFar(double r) const;
    double multiple(double r) const;
    double multipleFromDepth(double r, double depth) const;
    double single(double r) const;
    double singleFromDepth(double r, double depth) const;
    double singleSampled(double r) const;
    double multipleSampled(double r) const;

    ChannelMedium medium_;
    GrosjeanMedium grosjean_;
    Part part_;
    int samples_;  ///< 0 = converged
    // In transport mean free paths.
    double sigmaTPrime_;  ///< mm^-1
    double extinction_;   ///< sigma_t / sigma'_t
    mutable std::once_flag quadratureOnce_;
    mutable std::unique_ptr<const RadialQuadrature> quadrature_;
};

}  // namespace sss
