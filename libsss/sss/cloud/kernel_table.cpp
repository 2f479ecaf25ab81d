#include "sss/cloud/kernel_table.h"

#include "sss/base/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sss {
namespace {

constexpr double kNegligible = 1e-30;  // of the peak
constexpr int kMostRows = 16 * 60;

}  // namespace

KernelTable::KernelTable(const std::array<const Profile*, 3>& profiles, double reachMm,
                         double cellRadiusMm) {
    const Regularised regularised{RegularisedProfile(*profiles[0], cellRadiusMm),
                                  RegularisedProfile(*profiles[1], cellRadiusMm),
                                  RegularisedProfile(*profiles[2], cellRadiusMm)};
    // The scale below which the profiles are flat: where they have fallen to half their peak.
    double scale = reachMm;
    for (const RegularisedProfile& f : regularised) {
        const double peak = f(0.0);
        if (!(peak > 0.0)) continue;
        double r = reachMm;
        while (r > reachMm * 1e-12 && f(r) < 0.5 * peak) r *= 0.8;
        scale = std::min(scale, r);
    }
    scale = std::max(scale, 1e-15 * reachMm);
    halfWidthMm_ = static_cast<float>(scale);
    const double wanted = 0.25 * scale * scale;
    // A power of two, so that rows start at round places.
    u0_ = std::exp2(static_cast<float>(std::clamp(std::floor(std::log2(wanted)), -120.0, 120.0)));
    base_ = static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(u0_) >> kShift);
    fitRows(regularised);
    const double reachSquared = reachMm * reachMm;
    const std::size_t needed = rowOf(static_cast<float>(std::min(reachSquared, 1e37))) + 2;
    if (needed < rows_.size()) rows_.resize(needed);
    if (!isZero(evaluate(static_cast<float>(std::min(reachSquared, 1e37))))) rows_.push_back(Row{});
    boundDerivatives(regularised);
}

namespace {

// The first channel with the same profile: its rows serve for both.
std::size_t sameAs(const std::array<RegularisedProfile, 3>& profiles, std::size_t channel) {
    std::size_t first = 0;
    while (!profiles[first].isSameAs(profiles[channel])) ++first;
    return first;
}

// u + u0 at position t in [0, 1] of a row.
double edgeOf(std::int32_t absoluteRow, double t) {
    const auto bits = static_cast<std::uint32_t>(absoluteRow) << KernelTable::kShift;
    const double lo = std::bit_cast<float>(bits);
    const double hi =
        std::bit_cast<float>((static_cast<std::uint32_t>(absoluteRow) + 1u) << KernelTable::kShift);
    return lo + t * (hi - lo);
}

// Cubic through the four Chebyshev nodes of [0, 1]: error within 3 % of the best cubic's.
std::array<double, 4> fitCubic(const std::array<double, 4>& x, const std::array<double, 4>& y) {
    // Newton's divided differences, then expanded to powers.
    std::array<double, 4> d = y;
    for (std::size_t k = 1; k < 4; ++k)
        for (std::size_t i = 3; i >= k; --i) d[i] = (d[i] - d[i - 1]) / (x[i] - x[i - k]);
    std::array<double, 4> c{d[3], 0, 0, 0};
    for (std::size_t k = 3; k-- > 0;) {
        for (std::size_t i = 3; i > 0; --i) c[i] = c[i - 1] - x[k] * c[i];
        c[0] = d[k] - x[k] * c[0];
    }
    return c;
}

}  // namespace

void KernelTable::fitRows(const Regularised& profiles) {
    std::array<double, 4> nodes;
    for (std::size_t k = 0; k < 4; ++k)
        nodes[k] = 0.5 - 0.5 * std::cos((2.0 * static_cast<double>(k) + 1.0) / 8.0 * kPi);
    std::array<double, 3> peak;
    for (std::size_t c = 0; c < 3; ++c) peak[c] = profiles[c](0.0);
    constexpr std::size_t kBatch = 64;
    while (rows_.size() < static_cast<std::size_t>(kMostRows)) {
        const std::size_t begin = rows_.size();
        rows_.resize(begin + kBatch);
        parallelFor(kBatch, 4, [&](std::size_t lo, std::size_t hi) {
            for (std::size_t i = begin + lo; i < begin + hi; ++i) {
                for (std::size_t c = 0; c < 3; ++c) {
                    if (const std::size_t same = sameAs(profiles, c); same < c) {
                        for (auto& power : rows_[i].c) power[c] = power[same];
                        continue;
                    }
                    std::array<double, 4> values;
                    for (std::size_t k = 0; k < 4; ++k) {
                        const double u =
                            edgeOf(base_ + static_cast<std::int32_t>(i), nodes[k]) - u0_;
                        const double f = profiles[c](std::sqrt(std::max(u, 0.0)));
                        values[k] = f > kNegligible * peak[c] ? f : 0.0;
                    }
                    const std::array<double, 4> cubic = fitCubic(nodes, values);
                    for (std::size_t k = 0; k < 4; ++k)
                        rows_[i].c[k][c] = static_cast<float>(cubic[k]);
                }
                for (auto& power : rows_[i].c) power[3] = 0.0f;
            }
        });
        const Row& last = rows_.back();
        if (last.c[0][0] == 0.0f && last.c[0][1] == 0.0f && last.c[0][2] == 0.0f) break;
    }
}

namespace {

// Value and first derivatives of a profile by r, by five-point differences of the even function
// f(|r|).
struct Slopes {
    double f, d1, d2, d3;
    Slopes(const RegularisedProfile& profile, double r, double h) {
        std::array<double, 5> y;
        for (std::size_t k = 0; k < y.size(); ++k)
            y[k] = profile(std::abs(r + (static_cast<double>(k) - 2) * h));
        f = y[2];
        d1 = (y[0] - 8 * y[1] + 8 * y[3] - y[4]) / (12 * h);
        d2 = (-y[0] + 16 * y[1] - 30 * y[2] + 16 * y[3] - y[4]) / (12 * h * h);
        d3 = (-y[0] + 2 * y[1] - 2 * y[3] + y[4]) / (2 * h * h * h);
    }
};

// Norms of f and its first three derivatives as a function of a 3-D offset of length r, where
// u + u0 = `u`. Along a unit vector at cosine x to the radius the second is f'' x^2 + f'/r (1 -
// x^2) and the third f''' x^3 + 3 (f''/r - f'/r^2) x (1 - x^2), with |x (1 - x^2)| <= 0.385. The
// largest values of its two parts are added: up to half too much, which covers an edge between
// samples.
std::array<double, 4> derivativeNorms(const RegularisedProfile& profile, double r, double u) {
    // What r = 0 is compared with, in steps of the differences.
    constexpr double kNearZero = 16;
    const double h = 4e-3 * std::sqrt(u);
    const Slopes at(profile, r, h);
    // At r = 0 f'/r is f'', and the third is what f'' changes by: nothing, but where the profile
    // has an edge there.
    const bool isAtZero = r < h;
    const double turn = isAtZero ? at.d2 : at.d1 / r;
    const double mixed = isAtZero ? (at.d2 - Slopes(profile, kNearZero * h, h).d2) / (kNearZero * h)
                                  : (at.d2 - turn) / r;
    return {at.f, std::abs(at.d1), std::max(std::abs(at.d2), std::abs(turn)),
            std::abs(at.d3) + 3 * 0.385 * std::abs(mixed)};
}

}  // namespace

void KernelTable::boundDerivatives(const Regularised& profiles) {
    bounds_.assign(rows_.size(), {});
    constexpr int kSamples = 3;
    constexpr double kSafety = 1.05;  // between the samples of a row, 2 % apart in r
    parallelFor(rows_.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (int c = 0; c < 3; ++c) {
                const std::size_t same = sameAs(profiles, static_cast<std::size_t>(c));
                if (static_cast<int>(same) < c) {
                    for (Rgb& bound : bounds_[i].derivative)
                        bound[c] = bound[static_cast<int>(same)];
                    continue;
                }
                for (int s = 0; s < kSamples; ++s) {
                    const double u = edgeOf(base_ + static_cast<std::int32_t>(i),
                                            static_cast<double>(s) / (kSamples - 1));
                    const std::array<double, 4> norms =
                        derivativeNorms(profiles[static_cast<std::size_t>(c)],
                                        std::sqrt(std::max(u - u0_, 0.0)), u);
                    Rgb* out = bounds_[i].derivative;
                    for (std::size_t k = 0; k < 4; ++k)
                        out[k][c] = std::max(out[k][c], static_cast<float>(kSafety * norms[k]));
                }
            }
    });
    for (std::size_t i = bounds_.size() - 1; i-- > 0;)
        for (int k = 0; k < 4; ++k)
            bounds_[i].derivative[k] =
                glm::max(bounds_[i].derivative[k], bounds_[i + 1].derivative[k]);
}

Rgb KernelTable::evaluate(float distanceSquaredMm2) const {
    const Place place = placeOf(distanceSquaredMm2);
    const float t = place.t;
    const auto& c = place.row->c;
    Rgb f;
    for (int k = 0; k < 3; ++k) f[k] = c[0][k] + t * (c[1][k] + t * (c[2][k] + t * c[3][k]));
    return f;
}

}  // namespace sss
