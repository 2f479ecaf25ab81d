#include "sss/medium/multipole.h"

#include "sss/medium/dipole.h"
#include "sss/medium/image_source.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

/// Images summed one by one on each side; the rest is an integral plus the first Euler-Maclaurin
/// term, whose successor is below 1e-12 of the sum.
constexpr int kImages = 64;

/// e^{-sigma |z|} sign(z) - z e^{-sigma d}/d, d = sqrt(a^2 + z^2): twice what one image
/// sends into the disk of radius a.
double imageInDisk(double z, double sigma, double a) {
    const double height = std::abs(z);
    const double d = slant(a, z);
    const double gap = d - height > 0.1 * height ? d - height : a * a / (d + height);
    // e^{-sigma h} [1 - (h/d) e^{-sigma gap}] = e^{-sigma h} [gap/d - (h/d) expm1(-sigma gap)]
    return std::copysign(std::exp(-sigma * height) * (gap - height * std::expm1(-sigma * gap)) / d,
                         z);
}

/// Sum over all i of term(2 i L + first) - term(2 i L + second) for an odd `term`, whose integral
/// from y to infinity is `integral(y)`.
template <typename Term, typename Integral>
double imageSeries(double period, double first, double second, const Term& term,
                   const Integral& integral) {
    const auto pair = [&](int i) {
        const double x = 2 * i * period;
        return (term(x + first) - term(x - first)) - (term(x + second) - term(x - second));
    };
    double sum = term(first) - term(second);
    double last = 0;
    for (int i = 1; i <= kImages; ++i) sum += last = pair(i);
    const double y = (2 * kImages + 1) * period;
    const double rest =
        (integral(y + first) - integral(y - first)) - (integral(y + second) - integral(y - second));
    return sum + rest / (2 * period) + (pair(kImages + 1) - last) / 24;
}

/// cosh(a) sinh(b) / sinh(c) times `scale` in each argument, b < c, a + b - c given: no overflow.
double hyperbolicRatio(double scale, double a, double b, double c) {
    if (scale == 0) return b / c;
    const double shrink = std::exp(scale * (a + b - c));
    return 0.5 * shrink * (1 + std::exp(-2 * scale * a)) * std::expm1(-2 * scale * b) /
           std::expm1(-2 * scale * c);
}

}  // namespace

Multipole::Multipole(const ChannelMedium& medium, double thicknessMm, Face face,
                     BoundaryModel boundary)
    : Profile(medium.meanFreePathMm()),
      sigmaTPrime_(medium.sigmaTPrime()),
      reducedAlbedo_(medium.reducedAlbedo()),
      sigmaTr_(std::sqrt(3 * medium.reducedAbsorption())),
      extrapolation_(2.0 / 3.0 * dipoleBoundaryFactor(medium.eta, boundary)),
      face_(face),
      halfSpaceTotal_(Dipole(medium, boundary).total()),
      literal_(boundary == BoundaryModel::Polynomial) {
    const double thickness = thicknessMm * sigmaTPrime_;
    sourceDepth_ = literal_ || thickness > 1 ? 1.0 : 0.5 * thickness;
    period_ = thickness + 2 * extrapolation_;
    first_ = face == Face::Lit ? sourceDepth_ : thickness - sourceDepth_;
    second_ = face == Face::Lit ? -sourceDepth_ - 2 * extrapolation_
                                : thickness + sourceDepth_ + 2 * extrapolation_;
}

/// Where the images begin to cancel, and the slab's modes have become few.
bool Multipole::isFar(double r) const { return r > period_ * std::max(1.0, sigmaTr_ * period_); }

double Multipole::imageSum(double r) const {
    return imageSeries(
        period_, first_, second_, [&](double z) { return fluxKernel(z, sigmaTr_, r); },
        [&](double y) {
            const double d = slant(r, y);
            return std::exp(-sigmaTr_ * d) / d;
        });
}

double Multipole::imageCumulative(double a) const {
    return imageSeries(
        period_, first_, second_, [&](double z) { return imageInDisk(z, sigmaTr_, a); },
        [&](double y) {
            const double gap = a * a / (slant(a, y) + y);
            return std::exp(-sigmaTr_ * y) * absorbedLength(sigmaTr_, gap);
        });
}

/// Amplitude of mode n: its flux through the face times its value at the source.
double Multipole::modeWeight(int n) const {
    const double k = n * kPi / period_;
    const double weight =
        k * std::cos(k * extrapolation_) * std::sin(k * (extrapolation_ + sourceDepth_));
    // On the far face cos(k (L - z_b)) = (-1)^n cos(k z_b), and the outward normal turns round.
    return face_ == Face::Far && n % 2 == 0 ? -weight : weight;
}

double Multipole::modeSum(double r) const {
    const double decay = slant(sigmaTr_, kPi / period_);
    double sum = 0;
    for (int n = 1;; ++n) {
        const double kappa = slant(sigmaTr_, n * kPi / period_);
        if ((kappa - decay) * r > 40 || kappa * r > 700) break;
        sum += modeWeight(n) * std::cyl_bessel_k(0.0, kappa * r);
    }
    return 4 * sum / period_;
}

double Multipole::modeTail(double a) const {
    const double decay = slant(sigmaTr_, kPi / period_);
    double sum = 0;
    for (int n = 1;; ++n) {
        const double kappa = slant(sigmaTr_, n * kPi / period_);
        if ((kappa - decay) * a > 40 || kappa * a > 700) break;
        sum += modeWeight(n) * a / kappa * std::cyl_bessel_k(1.0, kappa * a);
    }
    return 4 * sum / period_;
}

double Multipole::reflectance(double rMm) const {
    if (reducedAlbedo_ == 0) return 0;
    const double r = reducedRadius(rMm, sigmaTPrime_);
    const double sum = isFar(r) ? modeSum(r) : imageSum(r);
    // Rounding may leave -1e-17 of the peak.
    const double kept = literal_ ? sum : std::max(sum, 0.0);
    return reducedAlbedo_ / (4 * kPi) * kept * sigmaTPrime_ * sigmaTPrime_;
}

double Multipole::tail(double aMm) const {
    if (reducedAlbedo_ == 0) return 0;
    const double a = reducedRadius(aMm, sigmaTPrime_);
    if (a == 0) return total();
    if (isFar(a)) return 0.5 * reducedAlbedo_ * modeTail(a);
    const double outside = total() - 0.5 * reducedAlbedo_ * imageCumulative(a);
    return literal_ ? outside : std::max(outside, 0.0);
}

double Multipole::total() const {
    if (reducedAlbedo_ == 0) return 0;
    const double depth = sourceDepth_ + extrapolation_;
    const double towards = face_ == Face::Lit ? period_ - depth : depth;
    return reducedAlbedo_ * hyperbolicRatio(sigmaTr_, extrapolation_, towards, period_);
}

}  // namespace sss
