#pragma once
#include <functional>
#include <vector>

namespace sss {

/// Tail integrals of 2 pi r f(r) for a profile without a closed form: panels that grow by a factor
/// of 4 from 1e-4 `scale`, no longer than `longestPanel`, 16 Gauss points each; exact to about
/// 1e-10 of the total for f that is at worst 1/r at 0 and falls at least like 1/r^3.
class RadialQuadrature {
public:
    RadialQuadrature(std::function<double(double)> function, double scale, double longestPanel);
    /// Integral from `a` to infinity.
    double tail(double a) const;

private:
    double panel(double lo, double hi) const;

    std::function<double(double)> function_;
    std::vector<double> edges_;  ///< ascending, from 0
    std::vector<double> tails_;  ///< from each edge
};

}  // namespace sss
