#include "sss/medium/profile.h"

#include "sss/medium/radial_envelope.h"
#include "sss/medium/radial_table.h"
#include "sss/optics/gauss_legendre.h"

#include <cmath>

namespace sss {

Profile::Profile(double scaleMm)
    : scaleMm_(std::isfinite(scaleMm) && scaleMm > 0 ? scaleMm : 1.0) {}

Profile::~Profile() = default;

double Profile::derivativeBound(int order, double rMm) const {
    std::call_once(envelopeOnce_, [this] {
        envelope_ = std::make_unique<RadialEnvelope>([this](double r) { return reflectance(r); },
                                                     scaleMm_, singularAtZero());
    });
    return envelope_->bound(order, rMm);
}

void Profile::reflectance(std::span<const float> rMm, std::span<float> out) const {
    for (std::size_t i = 0; i < rMm.size(); ++i) {
        out[i] = static_cast<float>(reflectance(static_cast<double>(rMm[i])));
    }
}

void Profile::reflectanceByTable(std::span<const float> rMm, std::span<float> out) const {
    std::call_once(tableOnce_, [this] {
        table_ =
            std::make_unique<RadialTable>([this](double r) { return reflectance(r); }, scaleMm_);
    });
    for (std::size_t i = 0; i < rMm.size(); ++i) {
        out[i] = static_cast<float>((*table_)(static_cast<double>(rMm[i])));
    }
}

double Profile::cumulative(double rMm) const {
    const double inside = total() - tail(rMm);
    // Where the difference would cancel, r lies below every height and length of the profile, so
    // that R_d varies there like a power series, with log r or 1/r at most: smooth in r^(1/4).
    constexpr double kCancels = 0.01;
    if (std::abs(inside) > kCancels * std::abs(total())) return inside;
    constexpr double kNothing = 1e-200;  // of the total at most, in what follows
    if (rMm < kNothing * scaleMm_) return 0;
    return 8 * kPi * gauss16(0, 1, [&](double root) {
               const double share = root * root * root, r = share * root * rMm;
               return share * rMm * (r * reflectance(r));
           });
}

}  // namespace sss
