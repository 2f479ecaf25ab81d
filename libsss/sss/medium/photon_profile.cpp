#include "sss/medium/photon_profile.h"

#include "sss/medium/photon_beam.h"
#include "sss/medium/photon_walk.h"
#include "sss/medium/small_matrix.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

constexpr double kFirstRadius = 0.02;
constexpr double kRingsPerDecade = 8;
constexpr std::uint32_t kPhotonsPerBatch = 1000;
constexpr std::uint64_t kBatchesPerRound = 64;
constexpr std::uint64_t kMostBatches = 8192;
/// Some 40 s of one core; the error reached is kept with the profile.
constexpr std::uint64_t kMostCollisions = 1'000'000'000;
/// Rings whose standard error is above this share say nothing about the curve.
constexpr double kUselessError = 0.3;

/// Medium of the key with sigma'_t = 1.
ChannelMedium mediumOf(const PhotonProfileKey& key) {
    return {key.reducedAbsorption, (1 - key.reducedAbsorption) / (1 - key.g), key.g, key.eta};
}

/// Edges from kFirstRadius to where 1e-4 of the light is left, at most 300 mean free paths.
std::vector<double> ringEdges(const PhotonBeam& beam) {
    std::vector<double> edges;
    for (int i = 0;; ++i) {
        edges.push_back(kFirstRadius * std::pow(10.0, i / kRingsPerDecade));
        if (edges.back() > 1 &&
            (beam.tail(edges.back()) < 1e-4 * beam.total() || edges.back() > 300)) {
            return edges;
        }
    }
}

struct RingData {
    std::vector<double> logRatio, weight;  ///< weight = 1/variance, 0 = unknown
};

/// Third differences of `values`, as the rows of a penalty: D^T D.
void addRoughness(SmallMatrix& normal, double stiffness) {
    constexpr double kDifference[4] = {-1, 3, -3, 1};
    for (std::size_t i = 0; i + 3 < normal.size(); ++i) {
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b) {
                normal(i + a, i + b) += stiffness * kDifference[a] * kDifference[b];
            }
        }
    }
}

/// The curve that minimises chi^2 + stiffness * (third differences)^2 [Whittaker 1923].
std::vector<double> smoothCurve(const RingData& data, double stiffness) {
    const std::size_t n = data.weight.size();
    SmallMatrix minusRest(n), right(n);  // I - normal, so that the solver sees the normal matrix
    addRoughness(minusRest, stiffness);
    for (std::size_t i = 0; i < n; ++i) {
        minusRest(i, i) += data.weight[i] + 1e-9;
        right(i, 0) = data.weight[i] * data.logRatio[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) minusRest(i, j) = (i == j ? 1 : 0) - minusRest(i, j);
    }
    const SmallMatrix solution = SmallMatrix::solveIdentityMinus(minusRest, right);
    std::vector<double> curve(n);
    for (std::size_t i = 0; i < n; ++i) curve[i] = solution(i, 0);
    return curve;
}

double chiSquared(const RingData& data, const std::vector<double>& curve) {
    double sum = 0;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double difference = curve[i] - data.logRatio[i];
        sum += data.weight[i] * difference * difference;
    }
    return sum;
}

std::vector<double> stiffestCurve(const RingData& data) {
    const auto known =
        std::count_if(data.weight.begin(), data.weight.end(), [](double w) { return w > 0; });
    double stiffness = 1e10;
    std::vector<double> curve = smoothCurve(data, stiffness);
    while (stiffness > 1 && chiSquared(data, curve) > static_cast<double>(known)) {
        stiffness *= 0.25;
        curve = smoothCurve(data, stiffness);
    }
    return curve;
}

double medianRingError(const PhotonTally& tally) {
    std::vector<double> errors;
    for (const BatchMean& ring : tally.rings) {
        if (ring.sum > 0) errors.push_back(ring.standardError() / ring.mean());
    }
    if (errors.empty()) return 1;
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return *middle;
}

PhotonTally simulate(const PhotonProblem& problem, double relativeError) {
    PhotonTally tally;
    for (std::uint64_t done = 0; done < kMostBatches && tally.collisions < kMostCollisions;
         done += kBatchesPerRound) {
        walkPhotons(problem, done, kBatchesPerRound, kPhotonsPerBatch, tally);
        const double total = tally.reflected.mean();
        if (tally.reflected.standardError() <= relativeError * total &&
            medianRingError(tally) <= 5 * relativeError) {
            break;
        }
    }
    return tally;
}

}  // namespace

PhotonProfile simulatePhotonProfile(const PhotonProfileKey& key) {
    PhotonProfile profile;
    if (key.reducedAbsorption >= 1) return profile;
    const ChannelMedium medium = mediumOf(key);
    const PhotonBeam multiple(medium, PhotonBeam::Part::Multiple, {});
    const PhotonBeam single(medium, PhotonBeam::Part::Single, {});
    const std::vector<double> edges = ringEdges(multiple);

    PhotonProblem problem;
    problem.albedo = medium.albedo();
    problem.g = key.g;
    problem.eta = key.eta;
    problem.illumination = key.illumination;
    for (const double edge : edges) problem.ringEdges.push_back(edge * medium.sigmaT());
    const PhotonTally tally = simulate(problem, key.relativeError);

    RingData data;
    double inner = multiple.total() + single.total();
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double outer = multiple.tail(edges[i]) + single.tail(edges[i]);
        const BatchMean& ring = tally.rings[i];
        const double error = ring.sum > 0 ? ring.standardError() / ring.mean() : 1.0;
        const bool useful = error < kUselessError && inner > outer;
        data.logRatio.push_back(useful ? std::log(ring.mean() / (inner - outer)) : 0.0);
        data.weight.push_back(useful ? 1 / (error * error) : 0.0);
        inner = outer;
    }
    // Beyond the last useful ring the curve would be an extrapolation.
    while (data.weight.size() > 4 && data.weight.back() == 0) {
        data.weight.pop_back();
        data.logRatio.pop_back();
    }
    profile.logRatios = stiffestCurve(data);
    profile.stepRatio = std::pow(10.0, 1 / kRingsPerDecade);
    profile.firstRadius = kFirstRadius / std::sqrt(profile.stepRatio);
    profile.total = key.reducedAbsorption == 0 ? 1.0 : std::min(tally.reflected.mean(), 1.0);
    profile.totalError = key.reducedAbsorption == 0 ? 0.0 : tally.reflected.standardError();
    profile.photons = tally.photons;
    return profile;
}

}  // namespace sss
