#include "numbers/subjects.h"
#include "sss/base/vec.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "sss/optics/gauss_legendre.h"
#include "sss/optics/phase.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace sss::stress {
namespace {

constexpr double kIndices[] = {0.25,     0.5,    0.8, 1 - 1e-9, 1 - 1e-15, 1, 1 + 1e-15,
                               1 + 1e-9, 1.0001, 1.3, 1.5,      2.5,       4};

// Cosines at which something happens: both ends, the critical angle and its neighbours.
std::vector<double> cosinesFor(double eta) {
    std::vector<double> cosines{0, 1, 1e-300, 1e-30, 1e-12, 1e-6, 1 - 1e-12, 1 - 1e-16};
    for (int i = 1; i < 64; ++i) cosines.push_back(i / 64.0);
    const double inverse = eta < 1 ? eta : 1 / eta;
    const double critical = std::sqrt(std::max(0.0, 1 - inverse * inverse));
    double below = critical, above = critical;
    for (int i = 0; i < 8; ++i) {
        cosines.push_back(below);
        cosines.push_back(above);
        below = std::nextafter(below, 0.0);
        above = std::nextafter(above, 1.0);
    }
    for (double& c : cosines) c = std::min(c, 1.0);
    return cosines;
}

// By how much a share lies outside [0, 1]; infinite if it is NaN.
double outside(double share) {
    if (!std::isfinite(share)) return std::numeric_limits<double>::infinity();
    return std::max({0.0, -share, share - 1});
}

void reflectances(Report& report) {
    Row range("optics", "reflectance and refracted cosine in [0, 1]", 0);
    Row both("optics", "reflectance from either side agrees", 1e-7);
    for (const double eta : kIndices)
        for (const double mu : cosinesFor(eta)) {
            const auto where = [&] { return fmt::format("eta {} cosine {}", eta, mu); };
            const float eta1 = static_cast<float>(eta), mu1 = static_cast<float>(mu);
            for (const double value :
                 {fresnelReflectance(mu, eta), fresnelReflectanceFromInside(mu, eta),
                  refractedCosine(mu, eta), refractedCosineFromInside(mu, eta),
                  double{fresnelReflectance(mu1, eta1)},
                  double{fresnelReflectanceFromInside(mu1, eta1)},
                  double{refractedCosine(mu1, eta1)}, double{refractedCosineFromInside(mu1, eta1)},
                  conductorReflectance(mu, eta, 3.0),
                  double{conductorReflectance(mu1, eta1, 3.0f)}})
                range.add(outside(value), where);
            // The cosine inside loses digits near grazing; ask only where it has them.
            const double inside = refractedCosine(mu, eta);
            if (inside > 0.01 && mu > 0.01)
                both.add(std::abs(fresnelReflectance(mu, eta) -
                                  fresnelReflectanceFromInside(inside, eta)),
                         where);
        }
    report.add(range);
    report.add(both);
}

void moments(Report& report, Scope scope) {
    Row range("optics", "hemispherical means in [0, 1], T_int = T_ext / eta^2", 1e-12);
    const int steps = scope == Scope::Full ? 3500 : 70;
    for (int i = 0; i <= steps; ++i) {
        const double eta = 0.5 + 3.5 * i / steps;
        const FresnelMoments m = exactFresnelMoments(eta);
        const double outward = hemisphericalTransmittance(eta) / (eta * eta);
        const auto where = [&] { return fmt::format("eta {}", eta); };
        for (const double share : {m.twoC1, m.threeC2, m.transmittanceOut})
            range.add(outside(share), where);
        range.add(std::abs(m.transmittanceOut - outward), where);
    }
    report.add(range);
}

void phaseFunctions(Report& report) {
    Row values("optics", "phase function finite, positive, of integral 1", 1e-9);
    Row samples("optics", "sampled cosines in [-1, 1], increasing", 0);
    for (const double g : {-0.99, -0.9, -0.5, -1e-6, -1e-300, 0.0, 1e-12, 1e-6, 0.5, 0.9, 0.99}) {
        // The peak is as narrow as (1 - |g|)^2: panels halve towards it.
        double sum = 0;
        for (double hi = 2; hi > 1e-17; hi /= 2)
            sum += 2 * kPi * gauss16(hi / 2, hi, [&](double distance) {
                       return henyeyGreensteinOffPeak(distance, g);
                   });
        values.add(std::abs(sum - 1), [&] { return fmt::format("g {}", g); });
        for (const double cosine : {-1.0, -1 + 1e-16, -0.5, 0.0, 0.5, 1 - 1e-16, 1.0}) {
            const float single =
                henyeyGreenstein(static_cast<float>(cosine), static_cast<float>(g));
            values.add(single > 0 && std::isfinite(single) ? 0 : 1,
                       [&] { return fmt::format("g {} cosine {}", g, cosine); });
        }
        double last = -1;
        for (const double u :
             {0.0, 1e-300, 1e-12, 0.1, 0.25, 0.5, 0.75, 0.9, 1 - 1e-12, 1 - 1e-16}) {
            const double cosine = sampleHenyeyGreenstein(u, g);
            const float single = sampleHenyeyGreenstein(
                std::min(static_cast<float>(u), 0.99999994f), static_cast<float>(g));
            const auto where = [&] { return fmt::format("g {} u {}", g, u); };
            samples.expect(cosine >= last && cosine <= 1, where);
            samples.expect(single >= -1 && single <= 1, where);
            last = cosine;
        }
    }
    report.add(values);
    report.add(samples);
}

}  // namespace

void stressOptics(Report& report, Scope scope) {
    reflectances(report);
    moments(report, scope);
    phaseFunctions(report);
}

}  // namespace sss::stress
