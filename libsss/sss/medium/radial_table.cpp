#include "sss/medium/radial_table.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace sss {
namespace {

constexpr int kPieceBits = 5;  // pieces per octave: 2^5
// Diffusion without absorption falls like 1/r^3: to 1e-30 of its value at a mean free path.
constexpr int kOctaves = 54;
constexpr int kFirstExponent = -20;
/// log2 f where f has underflown: exp2 of it is 0 in single precision.
constexpr double kFloor = -1000;

/// Cubic through four values at fractions 0, 1/3, 2/3, 1, in powers of the fraction.
std::array<double, 4> cubicThrough(double f0, double f1, double f2, double f3) {
    return {f0, (-11 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 2, 9 * (2 * f0 - 5 * f1 + 4 * f2 - f3) / 2,
            9 * (-f0 + 3 * f1 - 3 * f2 + f3) / 2};
}

double logOf(double value) { return value > 1e-300 ? std::log2(value) : kFloor; }

}  // namespace

RadialTable::RadialTable(std::function<double(double)> function, double scale)
    : function_(std::move(function)) {
    const double first = std::ldexp(scale, kFirstExponent);
    toGrid_ = 1 / first;
    constexpr int kPerOctave = 1 << kPieceBits;
    pieces_.reserve(kOctaves * kPerOctave);
    double atLo = logOf(function_(first));
    for (int i = 0; i < kOctaves * kPerOctave; ++i) {
        const double octave = std::ldexp(first, i / kPerOctave);
        const double lo = octave * (1 + static_cast<double>(i % kPerOctave) / kPerOctave);
        const double step = octave / kPerOctave / 3;
        const double atHi = atLo > kFloor ? logOf(function_(lo + 3 * step)) : kFloor;
        if (atHi > kFloor) {
            const auto c = cubicThrough(atLo, logOf(function_(lo + step)),
                                        logOf(function_(lo + 2 * step)), atHi);
            pieces_.push_back({c[0], c[1], c[2], c[3]});
        } else {
            pieces_.push_back({kFloor, 0, 0, 0});
        }
        atLo = atHi;
    }
}

double RadialTable::operator()(double r) const {
    const double x = r * toGrid_;
    if (x < 1) return function_(r);
    // Exponent and leading mantissa bits of x number the piece; the other bits are the fraction.
    constexpr int kShift = 52 - kPieceBits;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t index = (bits - std::bit_cast<std::uint64_t>(1.0)) >> kShift;
    if (index >= pieces_.size()) return function_(r);
    const std::uint64_t mask = (std::uint64_t{1} << kShift) - 1;
    const double fraction = static_cast<double>(bits & mask) * std::ldexp(1.0, -kShift);
    const Piece& p = pieces_[index];
    return std::exp2(p.c0 + fraction * (p.c1 + fraction * (p.c2 + fraction * p.c3)));
}

}  // namespace sss
