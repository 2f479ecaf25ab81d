#include "sss/medium/photon_walk.h"

#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/optics/fresnel.h"
#include "sss/optics/fresnel_moments.h"
#include "sss/optics/phase.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr double kDeepMeanFreePaths = 30;
constexpr double kDeepAbsorption = 1e-5;
/// Transport mean free paths below which many small turns are taken together, and the g above which
/// that pays.
constexpr double kCondensedMeanFreePaths = 2;
constexpr double kCondensedG = 0.6;

/// One way to scatter: per mean free path 1/sigma_t of the medium proper.
struct Scattering {
    double extinction;  ///< collisions, absorbed ones included
    double albedo;      ///< share that scatters
};

/// What all photons share.
struct Walk {
    explicit Walk(const PhotonProblem& p) : problem(p) {
        const double absorption = 1 - p.albedo;
        const double transport = absorption + p.albedo * (1 - p.g);  // sigma'_t / sigma_t
        const FresnelMoments moments = exactFresnelMoments(p.eta);
        hemispherical = p.eta * p.eta * moments.transmittanceOut;
        plain = {1, p.albedo};
        if (p.g > kCondensedG && std::isinf(p.thickness)) {
            // n and the rate for which moments one and two relax as they do in the medium:
            // 1 - m_1 = 2/(n + 2), 1 - m_2 = 6 (n + 1)/((n + 2)(n + 3)).
            const double n = 3 * p.g / (2 - p.g);
            const double rate = p.albedo * (1 - p.g) * (n + 2) / 2;
            condensed = {absorption + rate, rate / (absorption + rate)};
            inverseExponent = 1 / (n + 1);
            condensedDepth = kCondensedMeanFreePaths / transport;
        }
        if (std::isinf(p.thickness) && absorption < kDeepAbsorption * transport) {
            deep = kDeepMeanFreePaths / transport;
            sigmaTr = std::sqrt(3 * absorption * transport);
            const double factor = (1 + moments.threeC2) / moments.transmittanceOut;
            extrapolation = 2.0 / 3.0 * factor / transport;
        }
    }

    const PhotonProblem& problem;
    double hemispherical;  ///< share of diffuse light that enters
    double deep = std::numeric_limits<double>::infinity();
    double sigmaTr = 0, extrapolation = 0;
    Scattering plain{}, condensed{};
    double condensedDepth = std::numeric_limits<double>::infinity();
    double inverseExponent = 1;  ///< 1/(n + 1) of the phase function (1 + cos)^n
};

struct BatchResult {
    double reflected = 0, once = 0, transmitted = 0, unscattered = 0;
    std::uint64_t collisions = 0;
    std::vector<double> rings;
};

/// One photon, followed until its weight is spent.
class Photon {
public:
    Photon(const Walk& walk, Rng& rng, BatchResult& result)
        : walk_(walk), rng_(rng), result_(result) {}

    /// `stratum` in [0, 1) chooses the direction of diffuse illumination.
    void run(double stratum) {
        enter(stratum);
        while (weight_ > 0) step();
    }

private:
    void enter(double stratum) {
        const PhotonProblem& p = walk_.problem;
        if (p.illumination == Illumination::Normal) return;
        const double outside = std::sqrt(stratum);  // cosine-weighted
        weight_ = (1 - fresnelReflectance(outside, p.eta)) / walk_.hemispherical;
        direction_.z = refractedCosine(outside, p.eta);
        direction_.x = std::sqrt(std::max(0.0, 1 - direction_.z * direction_.z));
    }

    void step() {
        const PhotonProblem& p = walk_.problem;
        const Scattering& here = below_ ? walk_.condensed : walk_.plain;
        const double free = -std::log1p(-rng_.uniformDouble()) / here.extinction;
        const double z = position_.z + free * direction_.z;
        if (below_ != (z > walk_.condensedDepth)) {
            // Free paths have no memory: the next one starts here, with the other rate.
            moveTo(walk_.condensedDepth);
            below_ = !below_;
        } else if (z < 0 || z > p.thickness) {
            cross(z < 0 ? 0.0 : p.thickness);
        } else {
            position_ += free * direction_;
            weight_ *= here.albedo;
            ++result_.collisions;
            scatterings_ += below_ ? 2 : 1;
            if (z > walk_.deep) {
                leaveByDiffusion();
                return;
            }
            scatter(below_ ? 2 * std::pow(rng_.uniformDouble(), walk_.inverseExponent) - 1
                           : sampleHenyeyGreenstein(rng_.uniformDouble(), p.g));
        }
        // Russian roulette between the weight after one scattering and half of it: near albedo 1
        // that is almost analog capture (a light photon costs as much as a heavy one), at low
        // albedo no photon is lost before it had its chance to leave.
        if (weight_ < 0.5 * p.albedo) {
            weight_ = rng_.uniformDouble() * p.albedo < weight_ ? p.albedo : 0.0;
        }
    }

    void moveTo(double depth) {
        position_ += (depth - position_.z) / direction_.z * direction_;
        position_.z = depth;
    }

    /// Reaches the face at depth `face`: what Fresnel lets out is counted, the rest turns back.
    void cross(double face) {
        moveTo(face);
        const double reflectance = fresnelReflectanceFromInside(direction_.z, walk_.problem.eta);
        const double leaves = weight_ * (1 - reflectance);
        if (face > 0) {
            (scatterings_ == 0 ? result_.unscattered : result_.transmitted) += leaves;
        } else {
            countReflected(leaves, std::hypot(position_.x, position_.y));
            if (scatterings_ == 1 && !turned_) result_.once += leaves;
        }
        weight_ *= reflectance;
        direction_.z = -direction_.z;
        turned_ = true;
    }

    void countReflected(double share, double radius) {
        result_.reflected += share;
        const auto& edges = walk_.problem.ringEdges;
        const auto ring = std::upper_bound(edges.begin(), edges.end(), radius) - edges.begin();
        result_.rings[static_cast<std::size_t>(ring)] += share;
    }

    void scatter(double c) {
        const double s = std::sqrt(std::max(0.0, (1 - c) * (1 + c)));
        double x, y, norm;  // a point in the unit disk, for the azimuth without sine and cosine
        do {
            x = 2 * rng_.uniformDouble() - 1;
            y = 2 * rng_.uniformDouble() - 1;
            norm = x * x + y * y;
        } while (norm > 1 || norm < 1e-12);
        const double scale = s / std::sqrt(norm);
        const DVec3 d = direction_;
        const double sign = std::copysign(1.0, d.z);
        const double a = -1 / (sign + d.z);
        const double b = d.x * d.y * a;
        const DVec3 tangent{1 + sign * d.x * d.x * a, sign * b, -sign * d.x};
        const DVec3 bitangent{b, sign + d.y * d.y * a, -d.y};
        direction_ = d * c + (tangent * x + bitangent * y) * scale;
        direction_ *= 1.5 - 0.5 * glm::dot(direction_, direction_);  // rounding does not pile up
    }

    /// The diffuse answer to a source this deep: image heights z and z + 2 z_b, each with tail
    /// e^{-sigma (d - z)} z / d in the distance d, which is inverted for one radius.
    void leaveByDiffusion() {
        const double real = position_.z;
        const double image = real + 2 * walk_.extrapolation;
        const double fromReal = 0.5 * std::exp(-walk_.sigmaTr * real);
        const double fromImage = 0.5 * std::exp(-walk_.sigmaTr * image);
        const double both = fromReal + fromImage;
        const double height = rng_.uniformDouble() * both < fromReal ? real : image;
        const double u = 1 - rng_.uniformDouble();
        // Solve (z/d) e^{-sigma (d - z)} = u for x = z/d in (0, 1]; the left side grows with x.
        double lo = 0, hi = 1;
        for (int i = 0; i < 50; ++i) {
            const double x = 0.5 * (lo + hi);
            const double value = x * std::exp(-walk_.sigmaTr * height * (1 / x - 1));
            (value < u ? lo : hi) = x;
        }
        const double radius = height * std::sqrt(std::max(0.0, 1 / (hi * hi) - 1));
        const double azimuth = 2 * kPi * rng_.uniformDouble();
        countReflected(weight_ * both, std::hypot(position_.x + radius * std::cos(azimuth),
                                                  position_.y + radius * std::sin(azimuth)));
        weight_ = 0;
    }

    const Walk& walk_;
    Rng& rng_;
    BatchResult& result_;
    DVec3 position_{0};
    DVec3 direction_{0, 0, 1};  ///< z is depth
    double weight_ = 1;
    int scatterings_ = 0;
    bool turned_ = false;  ///< has met a face from inside
    bool below_ = false;   ///< the depth from which on turns are taken together
};

BatchResult runBatch(const Walk& walk, std::uint64_t batch, std::uint32_t photons) {
    BatchResult result;
    result.rings.assign(walk.problem.ringEdges.size() + 1, 0.0);
    Rng rng(combineSeeds(walk.problem.seed, batch));
    for (std::uint32_t i = 0; i < photons; ++i) {
        Photon(walk, rng, result).run((i + rng.uniformDouble()) / photons);
    }
    return result;
}

}  // namespace

void BatchMean::add(double value) {
    sum += value;
    squares += value * value;
    ++batches;
}

double BatchMean::mean() const { return batches > 0 ? sum / static_cast<double>(batches) : 0.0; }

double BatchMean::standardError() const {
    if (batches < 2) return std::numeric_limits<double>::infinity();
    const auto n = static_cast<double>(batches);
    const double variance = std::max(0.0, squares / n - mean() * mean());
    return std::sqrt(variance / (n - 1));
}

void walkPhotons(const PhotonProblem& problem, std::uint64_t first, std::uint64_t count,
                 std::uint32_t photonsPerBatch, PhotonTally& tally) {
    const Walk walk(problem);
    std::vector<BatchResult> results(count);
    parallelFor(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            results[i] = runBatch(walk, first + i, photonsPerBatch);
        }
    });
    tally.rings.resize(problem.ringEdges.size() + 1);
    for (const BatchResult& result : results) {
        const double each = 1.0 / photonsPerBatch;
        tally.reflected.add(result.reflected * each);
        tally.reflectedOnce.add(result.once * each);
        tally.transmitted.add(result.transmitted * each);
        tally.unscattered.add(result.unscattered * each);
        for (std::size_t i = 0; i < result.rings.size(); ++i) {
            tally.rings[i].add(result.rings[i] * each);
        }
        tally.photons += photonsPerBatch;
        tally.collisions += result.collisions;
    }
}

}  // namespace sss
