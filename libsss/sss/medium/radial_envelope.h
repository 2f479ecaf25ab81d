#pragma once
#include <array>
#include <functional>
#include <vector>

namespace sss {

/// Upper bounds of the first three derivatives of a decaying function of r > 0, over [r, infinity):
/// the function is differentiated numerically on a grid of ratio 2^(1/16) between 1e-5 and 1e4
/// times `scale`, and the running maximum from the right is kept. Below the grid the bound grows
/// like 1/r^(1+k) if the function is singular at 0, else it stays.
class RadialEnvelope {
public:
    RadialEnvelope(const std::function<double(double)>& function, double scale,
                   bool singularAtZero);
    double bound(int order, double r) const;

private:
    double firstRadius_;
    bool singularAtZero_;
    std::array<std::vector<double>, 3> bounds_;
};

}  // namespace sss
