#include "sss/image/flip.h"

#include "sss/base/vec.h"
#include "sss/image/metrics.h"
#include "sss/image/tone_map.h"

#include <algorithm>
#include <array>

namespace sss {
namespace {

// A 4K screen 0.7 m wide seen from 0.7 m.
constexpr double kPixelsPerDegree = 3840 * kPi / 180;
// Section 4.1 and 4.2 of the paper: exponents and bends of the colour and the feature pipeline.
constexpr double kColourPower = 0.7, kColourBend = 0.4, kColourBendValue = 0.95;
constexpr double kFeaturePower = 0.5, kFeatureWidthDegrees = 0.082;

// A plane of one value a pixel.
struct Plane {
    int width, height;
    std::vector<double> values;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};
// One dimension of a filter, from -radius to radius.
using Kernel = std::vector<double>;

Plane convolved(const Plane& in, const Kernel& kernel, bool alongX) {
    const int radius = static_cast<int>(kernel.size()) / 2;
    Plane out{in.width, in.height, std::vector<double>(in.values.size())};
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x) {
            double sum = 0;
            for (std::size_t i = 0; i < kernel.size(); ++i) {
                const int k = static_cast<int>(i) - radius;
                // Beyond the border its pixels repeat.
                const int u = alongX ? std::clamp(x + k, 0, in.width - 1) : x;
                const int v = alongX ? y : std::clamp(y + k, 0, in.height - 1);
                sum += kernel[i] * in.values[in.index(u, v)];
            }
            out.values[out.index(x, y)] = sum;
        }
    return out;
}
Plane convolved(const Plane& in, const Kernel& kernelX, const Kernel& kernelY) {
    return convolved(convolved(in, kernelX, true), kernelY, false);
}

template <typename Function>
Kernel sampled(int radius, const Function& function) {
    Kernel kernel;
    for (int k = -radius; k <= radius; ++k) kernel.push_back(function(static_cast<double>(k)));
    return kernel;
}
double sumOf(const Kernel& kernel) {
    double sum = 0;
    for (const double k : kernel) sum += k;
    return sum;
}

// ---- Colour spaces, D65 -------------------------------------------------------------------------

const DMat3& xyzFromRgb() {
    static const DMat3 matrix(DVec3(0.4124564, 0.2126729, 0.0193339),
                              DVec3(0.3575761, 0.7151522, 0.1191920),
                              DVec3(0.1804375, 0.0721750, 0.9503041));
    return matrix;
}
DVec3 white() { return xyzFromRgb() * DVec3(1); }

// Opponent space: linear, of L*a*b* without its cube roots.
DVec3 opponentFromRgb(const DRgb& rgb) {
    const DVec3 t = xyzFromRgb() * rgb / white();
    return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}
DRgb rgbFromOpponent(const DVec3& opponent) {
    static const DMat3 rgbFromXyz = glm::inverse(xyzFromRgb());
    const double y = (opponent.x + 16) / 116;
    return rgbFromXyz * (DVec3(y + opponent.y / 500, y, y - opponent.z / 200) * white());
}
// L*a*b*, chroma scaled by lightness after Hunt.
DVec3 huntLab(const DRgb& rgb) {
    DVec3 t = xyzFromRgb() * rgb / white();
    constexpr double kDelta = 6.0 / 29.0;
    for (int c = 0; c < 3; ++c)
        t[c] = t[c] > kDelta * kDelta * kDelta ? std::cbrt(t[c])
                                               : t[c] / (3 * kDelta * kDelta) + 4.0 / 29.0;
    const double lightness = 116 * t.y - 16;
    return {lightness, 0.01 * lightness * 500 * (t.x - t.y), 0.01 * lightness * 200 * (t.y - t.z)};
}
double hybridDistance(const DVec3& a, const DVec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// ---- Colour pipeline ----------------------------------------------------------------------------

// Contrast sensitivity of a channel: two Gaussians, b in degrees^2.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities{
    {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};
constexpr double kWidest = 0.04;

Plane seenFromAfar(const Plane& in, const Sensitivity& s) {
    const int radius =
        static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * kPixelsPerDegree));
    const auto gauss = [&](double b) {
        return sampled(radius, [b](double k) {
            const double degrees = k / kPixelsPerDegree;
            return std::exp(-kPi * kPi * degrees * degrees / b);
        });
    };
    const Kernel first = gauss(s.b1), second = gauss(s.b2);
    const double weight1 = s.a1 * std::sqrt(kPi / s.b1), weight2 = s.a2 * std::sqrt(kPi / s.b2);
    const double sum1 = sumOf(first), sum2 = sumOf(second);
    const double total = weight1 * sum1 * sum1 + weight2 * sum2 * sum2;
    Plane out = convolved(in, first, first);
    for (double& v : out.values) v *= weight1 / total;
    if (weight2 == 0) return out;
    const Plane rest = convolved(in, second, second);
    for (std::size_t i = 0; i < out.values.size(); ++i)
        out.values[i] += weight2 / total * rest.values[i];
    return out;
}

std::vector<DVec3> perceived(const std::array<Plane, 3>& opponent) {
    std::array<Plane, 3> filtered;
    for (std::size_t c = 0; c < 3; ++c) filtered[c] = seenFromAfar(opponent[c], kSensitivities[c]);
    std::vector<DVec3> lab;
    for (std::size_t i = 0; i < filtered[0].values.size(); ++i) {
        const DVec3 value(filtered[0].values[i], filtered[1].values[i], filtered[2].values[i]);
        lab.push_back(huntLab(glm::clamp(rgbFromOpponent(value), DRgb(0), DRgb(1))));
    }
    return lab;
}

double colourDifference(const DVec3& a, const DVec3& b) {
    static const double largest =
        std::pow(hybridDistance(huntLab({0, 1, 0}), huntLab({0, 0, 1})), kColourPower);
    const double difference = std::pow(hybridDistance(a, b), kColourPower);
    const double bend = kColourBend * largest;
    if (difference < bend) return kColourBendValue / bend * difference;
    return kColourBendValue + (difference - bend) / (largest - bend) * (1 - kColourBendValue);
}

// ---- Feature pipeline ---------------------------------------------------------------------------

// Scaled so that what is above 0 sums to 1, and what is below to -1.
Kernel balanced(Kernel kernel) {
    double above = 0, below = 0;
    for (const double k : kernel) (k > 0 ? above : below) += std::abs(k);
    for (double& k : kernel) k /= k > 0 ? above : below;
    return kernel;
}

struct Features {
    Plane edges, points;
};

Features featuresOf(const Plane& opponentY) {
    Plane grey = opponentY;
    for (double& v : grey.values) v = (v + 16) / 116;
    const double deviation = 0.5 * kFeatureWidthDegrees * kPixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gauss = [deviation](double k) {
        return std::exp(-k * k / (2 * deviation * deviation));
    };
    Kernel smooth = sampled(radius, gauss);
    const double sum = sumOf(smooth);
    for (double& k : smooth) k /= sum;
    const auto magnitude = [&](const Kernel& kernel) {
        Plane x = convolved(grey, kernel, smooth);
        const Plane y = convolved(grey, smooth, kernel);
        for (std::size_t i = 0; i < x.values.size(); ++i)
            x.values[i] = std::hypot(x.values[i], y.values[i]);
        return x;
    };
    return {magnitude(balanced(sampled(radius, [&](double k) { return -k * gauss(k); }))),
            magnitude(balanced(sampled(radius, [&](double k) {
                return (k * k / (deviation * deviation) - 1) * gauss(k);
            })))};
}

std::array<Plane, 3> opponentPlanes(const ImageLayer& layer, int width) {
    const std::size_t channels = layer.channels.size();
    const std::size_t pixels = layer.values.size() / channels;
    const Plane empty{width, static_cast<int>(pixels) / width, std::vector<double>(pixels)};
    std::array<Plane, 3> planes{empty, empty, empty};
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* v = &layer.values[i * channels];
        const DVec3 opponent =
            opponentFromRgb(glm::clamp(DRgb(v[0], v[1], v[2]), DRgb(0), DRgb(1)));
        for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)].values[i] = opponent[c];
    }
    return planes;
}

ImageLayer shown(const ImageLayer& layer, double exposure) {
    ImageLayer display{layer.name, {"R", "G", "B"}, {}, false};
    for (std::size_t i = 0; i < layer.values.size(); i += layer.channels.size()) {
        const Rgb colour = toneMapped(
            Rgb(DRgb(layer.values[i], layer.values[i + 1], layer.values[i + 2]) * exposure));
        display.values.insert(display.values.end(), {colour.x, colour.y, colour.z});
    }
    return display;
}

}  // namespace

std::vector<double> flipMap(const ImageLayer& picture, const ImageLayer& reference, int width) {
    const std::array<Plane, 3> a = opponentPlanes(picture, width);
    const std::array<Plane, 3> b = opponentPlanes(reference, width);
    const std::vector<DVec3> labA = perceived(a), labB = perceived(b);
    const Features featuresA = featuresOf(a[0]), featuresB = featuresOf(b[0]);
    std::vector<double> map;
    for (std::size_t i = 0; i < labA.size(); ++i) {
        const double features =
            std::max(std::abs(featuresA.edges.values[i] - featuresB.edges.values[i]),
                     std::abs(featuresA.points.values[i] - featuresB.points.values[i]));
        map.push_back(std::pow(colourDifference(labA[i], labB[i]),
                               1 - std::pow(features / std::sqrt(2.0), kFeaturePower)));
    }
    return map;
}

double meanFlip(const ImageLayer& picture, const ImageLayer& reference, int width,
                const ImageLayer* mask) {
    const ImageDifference difference = compareLayers(picture, reference, mask);
    if (difference.pixels == 0 || std::isnan(difference.relativeRmse))
        return difference.relativeRmse;
    const double mean = difference.referenceMean;
    const double exposure = mean > 0 ? 0.18 / mean : 1.0;
    const std::vector<double> map =
        flipMap(shown(picture, exposure), shown(reference, exposure), width);
    double sum = 0;
    for (std::size_t i = 0; i < map.size(); ++i)
        if (!mask || mask->values[i * mask->channels.size()] > 0) sum += map[i];
    return sum / static_cast<double>(difference.pixels);
}

}  // namespace sss
