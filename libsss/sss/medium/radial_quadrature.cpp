#include "sss/medium/radial_quadrature.h"

#include "sss/base/vec.h"
#include "sss/optics/gauss_legendre.h"

#include <algorithm>

namespace sss {

RadialQuadrature::RadialQuadrature(std::function<double(double)> function, double scale,
                                   double longestPanel)
    : function_(std::move(function)), edges_{0, 1e-4 * scale} {
    std::vector<double> panels{panel(edges_[0], edges_[1])};
    double sum = panels[0];
    // Without absorption the tail falls only like 1/r: the panels then go on for 13 decades.
    while (panels.back() > 1e-14 * sum || edges_.back() < scale) {
        const double lo = edges_.back();
        if (lo > 1e14 * scale) break;
        const double hi = std::min(4 * lo, lo + longestPanel);
        panels.push_back(panel(lo, hi));
        edges_.push_back(hi);
        sum += panels.back();
    }
    tails_.assign(edges_.size(), 0.0);
    for (std::size_t i = panels.size(); i-- > 0;) tails_[i] = tails_[i + 1] + panels[i];
}

double RadialQuadrature::panel(double lo, double hi) const {
    return 2 * kPi * gauss16(lo, hi, [this](double r) { return r * function_(r); });
}

double RadialQuadrature::tail(double a) const {
    const auto next = std::upper_bound(edges_.begin(), edges_.end(), a);
    if (next == edges_.end()) return 0;
    const auto i = static_cast<std::size_t>(next - edges_.begin());
    return tails_[i] + (a == edges_[i - 1] ? tails_[i - 1] - tails_[i] : panel(a, *next));
}

}  // namespace sss
