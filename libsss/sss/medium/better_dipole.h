#pragma once
#include "sss/medium/profile.h"

namespace sss {

/// The better dipole [d'Eon 2012]: Grosjean's diffusion coefficient and the consistent boundary
/// terms C_phi, C_E. Finite at r = 0. Scaled by alpha'^2: light scattered twice or more.
class BetterDipole final : public Profile {
public:
    explicit BetterDipole(const ChannelMedium& medium,
                          BoundaryModel boundary = BoundaryModel::Exact);
    using Profile::reflectance;
    double reflectance(double rMm) const override;
    double tail(double aMm) const override;
    double total() const override;

private:
    // In transport mean free paths.
    double sigmaTPrime_;  ///< mm^-1
    double strength_;     ///< alpha'^2
    double sigmaTr_;
    double virtualHeight_;
    double fluenceWeight_;  ///< C_phi / D
    double fluxWeight_;     ///< C_E
};

}  // namespace sss
