#include "sss/optics/phase.h"

#include "sss/base/vec.h"

#include <algorithm>
#include <cmath>

namespace sss {
namespace {

template <typename T>
T toPeak(T cosTheta, T g) {
    return g >= 0 ? 1 - cosTheta : 1 + cosTheta;
}

template <typename T>
T value(T distance, T g) {
    // 1 + g^2 - 2 g cos, written as a sum of positive terms.
    const T away = 1 - std::abs(g);
    const T d = away * away + 2 * std::abs(g) * std::max(distance, T(0));
    constexpr T kInverse4Pi = T(1 / (4 * kPi));
    return kInverse4Pi * (1 - g) * (1 + g) / (d * std::sqrt(d));
}

template <typename T>
T sample(T u, T g) {
    const T s = 2 * u - 1;
    T cosTheta;
    if (std::abs(g) < T(0.5)) {
        // The inverse of the distribution with its division by g carried out.
        const T scale = 1 + g * s;
        cosTheta = (2 * s + g * (3 + s * s + g * (2 * s - g * (1 - s * s)))) / (2 * scale * scale);
    } else {
        const T ratio = (1 - g) * (1 + g) / (1 - g + 2 * g * u);
        cosTheta = (1 + g * g - ratio * ratio) / (2 * g);
    }
    return std::clamp(cosTheta, T(-1), T(1));
}

}  // namespace

double henyeyGreenstein(double cosTheta, double g) { return value(toPeak(cosTheta, g), g); }
double henyeyGreensteinOffPeak(double distance, double g) { return value(distance, g); }
float henyeyGreenstein(float cosTheta, float g) { return value(toPeak(cosTheta, g), g); }
double sampleHenyeyGreenstein(double u, double g) { return sample(u, g); }
float sampleHenyeyGreenstein(float u, float g) { return sample(u, g); }

}  // namespace sss
