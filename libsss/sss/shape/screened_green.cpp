#include "sss/shape/screened_green.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sss {

ScreenedGreen::ScreenedGreen(double screening, double reachMm)
    : Profile(reachMm), k_(screening), reach_(reachMm) {}

double ScreenedGreen::reflectance(double rMm) const {
    if (!(rMm > 0)) return std::numeric_limits<double>::infinity();
    return std::exp(-k_ * rMm) / (4.0 * kPi * rMm);
}

// Half the integral of exp(-k r) over [a, reach].
double ScreenedGreen::tail(double aMm) const {
    const double length = std::max(0.0, reach_ - aMm), x = k_ * length;
    const double mean = x > 1e-8 ? -std::expm1(-x) / x : 1.0 - 0.5 * x;
    return 0.5 * std::exp(-k_ * aMm) * length * mean;
}

}  // namespace sss
