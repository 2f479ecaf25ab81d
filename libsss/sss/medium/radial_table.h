#pragma once
#include <functional>
#include <vector>

namespace sss {

/// A positive decaying function of r >= 0, stored as cubic polynomials of log2 f on pieces of a
/// 32nd of an octave of r, between 2^-20 and 2^34 times `scale`: reproduces a smooth f to about
/// 1e-7 at the price of one exp2. Outside of that range, where f has hardly ever anything to say,
/// it is f itself that is called.
class RadialTable {
public:
    RadialTable(std::function<double(double)> function, double scale);
    double operator()(double r) const;

private:
    struct Piece {
        double c0, c1, c2, c3;  ///< log2 f in the fraction of the piece, 0 to 1
    };
    std::function<double(double)> function_;
    double toGrid_;  ///< 1 / first radius
    std::vector<Piece> pieces_;
};

}  // namespace sss
