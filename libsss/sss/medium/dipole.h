#pragma once
#include "sss/medium/profile.h"

namespace sss {

/// A = (1 + F_dr)/(1 - F_dr) of the extrapolated boundary, which lies 2 A D above the surface.
double dipoleBoundaryFactor(double eta, BoundaryModel boundary);

/// The classic dipole [JMLH01 Eq. 4], with the 1/sigma'_t of its second term dropped (it is
/// dimensionally wrong as printed) and F_dr exact unless the polynomial is asked for. Finite at
/// r = 0. Its alpha' contains the first scattering event: see energy.h.
class Dipole final : public Profile {
public:
    explicit Dipole(const ChannelMedium& medium, BoundaryModel boundary = BoundaryModel::Exact);
    using Profile::reflectance;
    double reflectance(double rMm) const override;
    double tail(double aMm) const override;
    double total() const override;

private:
    // In transport mean free paths, so that nothing over- or underflows at any scale.
    double sigmaTPrime_;    ///< mm^-1, turns mm into mean free paths
    double reducedAlbedo_;  ///< alpha'
    double sigmaTr_;        ///< times the mean free path
    double virtualHeight_;  ///< z_v / mean free path; z_r is 1
};

}  // namespace sss
