#pragma once
#include <functional>
#include <vector>

namespace sss {

/// A positive decaying function of r >= 0, stored as cubic polynomials of log2 f on pieces of a
/// 32nd of an octave of r, between 2^-20 and 2^13 times `scale`: reproduces a smooth f to about
/// 1e-7 at the price of one exp2. Below its range f is continued as constant, or as 1/r where
/// singular; beyond it as 1/r^3, which is how diffusion without absorption falls.
class RadialTable {
public:
    RadialTable(const std::function<double(double)>& function, double scale, bool singularAtZero);
    double operator()(double r) const;

private:
    struct Piece {
        double c0, c1, c2, c3;  ///< log2 f in the fraction of the piece, 0 to 1
    };
    double toGrid_;  ///< 1 / first radius
    double last_;    ///< f at the end of the range
    bool singularAtZero_;
    std::vector<Piece> pieces_;
};

}  // namespace sss
