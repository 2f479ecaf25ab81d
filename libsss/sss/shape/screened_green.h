#pragma once
#include "sss/medium/profile.h"

namespace sss {

/// The field of a unit source of the screened Poisson equation, G(r) = exp(-k r) / (4 pi r), mm^-1,
/// as a radial function that the sums over points know how to handle: its "total" is the integral
/// over a plane through the source out to `reachMm` (over all of it there is none where k = 0).
class ScreenedGreen : public Profile {
public:
    ScreenedGreen(double screening, double reachMm);
    using Profile::reflectance;
    double reflectance(double rMm) const override;
    double tail(double aMm) const override;
    double total() const override { return tail(0); }
    bool singularAtZero() const override { return true; }

private:
    double k_, reach_;
};

}  // namespace sss
