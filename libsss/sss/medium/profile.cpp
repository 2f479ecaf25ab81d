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

double Profile::meanOverDisk(double areaMm2) const {
    const double radius = std::sqrt(areaMm2 / kPi);
    // For a disk far below the mean free path total - tail would cancel; R_d is flat there, or
    // r R_d nearly so.
    if (!singularAtZero() && radius < 1e-3 * scaleMm_) return reflectance(std::sqrt(0.5) * radius);
    if (singularAtZero() && radius < 1e-5 * scaleMm_) {
        return 2 * kPi / areaMm2 *
               gauss16(0, radius, [this](double r) { return r * reflectance(r); });
    }
    return (total() - tail(radius)) / areaMm2;
}

}  // namespace sss
