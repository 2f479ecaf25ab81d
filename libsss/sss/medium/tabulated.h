#pragma once
#include "sss/medium/profile.h"
#include "sss/medium/radial_quadrature.h"
#include "sss/medium/radial_table.h"

#include <optional>

namespace sss {

/// The profile that a Monte Carlo simulation of the half-space itself gives: every order of
/// scattering, any g, eta and albedo; the truth for the flat case to the stated standard error.
/// Grows like 1/r at r = 0, from the light scattered once.
///
/// By default the light comes from outside in a Lambertian way, because that is what an irradiance
/// cache has when it no longer knows directions: the total is then right for diffuse light, and up
/// to 2 % above that of light along the normal (marble 0.8048 against 0.7994).
/// Illumination::Normal is the searchlight problem of the literature.
///
/// The total is not the simulation's but that of adding-doubling, which has no noise
/// (half_space.h); the simulation gives the shape. g > 0.98 is simulated as g = 0.98 with the same
/// sigma'_s, so that no medium takes more than a minute of one core.
class Tabulated final : public Profile {
public:
    Tabulated(const ChannelMedium& medium, const ProfileOptions& options);
    double reflectance(double rMm) const override;
    double tail(double aMm) const override;
    double total() const override { return total_; }
    bool singularAtZero() const override { return total_ > 0; }
    void reflectance(std::span<const float> rMm, std::span<float> out) const override;
    /// The simulation's own total for min(g, 0.98), and its 1 sigma.
    double simulatedTotal() const { return simulatedTotal_; }
    double simulatedError() const { return simulatedError_; }

private:
    double sigmaTPrime_;
    double total_ = 0, simulatedTotal_ = 0, simulatedError_ = 0;
    double correction_ = 0;             ///< makes the profile's integral the total
    std::optional<RadialTable> table_;  // in transport mean free paths
    std::optional<RadialQuadrature> quadrature_;
};

}  // namespace sss
