#pragma once
#include "sss/base/rng.h"
#include "sss/medium/medium.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>

namespace sss::test {

/// Media for property tests, extremes weighted: every other property is drawn from its limits.
class RandomMedia {
public:
    explicit RandomMedia(std::uint64_t seed) : rng_(seed) {}

    ChannelMedium next() {
        ChannelMedium medium;
        const double sigmaTPrime = std::pow(10.0, between(-6, 6));
        const double absorption = pick({0.0, 1.0, 1e-12, 1e-6, std::pow(10.0, between(-9, 0)),
                                        rng_.uniformDouble(), rng_.uniformDouble()});
        medium.g = pick({0.0, 0.99, -0.9, between(-0.9, 0.99), 0.0, between(-0.5, 0.9)});
        medium.eta = pick({1.0, 0.5, 0.75, 3.0, 4.0, 1 + 1e-12, 1 - 1e-12, between(0.5, 4), 1.3,
                           1.5, between(1, 2)});
        medium.sigmaA = sigmaTPrime * absorption;
        medium.sigmaS = sigmaTPrime * (1 - absorption) / (1 - medium.g);
        return medium;
    }
    double between(double lo, double hi) { return lo + (hi - lo) * rng_.uniformDouble(); }

private:
    double pick(std::initializer_list<double> values) {
        return values.begin()[rng_.next32() % values.size()];
    }
    Rng rng_;
};

inline std::string describe(const ChannelMedium& m) {
    char text[160];
    std::snprintf(text, sizeof text, "sigma_a %.17g sigma_s %.17g g %.17g eta %.17g", m.sigmaA,
                  m.sigmaS, m.g, m.eta);
    return text;
}

}  // namespace sss::test
