#include "deviations.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sss::bench {
namespace {

constexpr double kDark = 1e-25;

// Relative deviations of one channel, or of all.
struct Spread {
    double sum = 0, squares = 0;
    std::size_t count = 0;
    std::vector<double> worst;  // |deviation| by receiver

    void add(double deviation) {
        sum += deviation;
        squares += deviation * deviation;
        ++count;
    }
    JsonValue toJson() {
        std::sort(worst.begin(), worst.end());
        const auto n = static_cast<double>(std::max<std::size_t>(count, 1));
        JsonValue json = JsonValue::object();
        json.set("rms", std::sqrt(squares / n)).set("bias", sum / n);
        if (worst.empty()) return json.set("p999", 0).set("max", 0), json;
        // The smallest value that 99.9 % of the receivers do not exceed.
        const auto rank =
            static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(worst.size())));
        json.set("p999", worst[rank - 1]).set("max", worst.back());
        return json;
    }
};

}  // namespace

JsonValue describeDeviations(std::span<const Rgb> answers, std::span<const DRgb> truth) {
    Spread all, channels[3];
    DRgb mean{0}, meanDeviation{0};
    double squares = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        double worst = 0;
        mean += truth[i];
        for (int c = 0; c < 3; ++c) {
            const double deviation = static_cast<double>(answers[i][c]) - truth[i][c];
            meanDeviation[c] += deviation;
            squares += deviation * deviation;
            if (truth[i][c] < kDark) continue;
            const double relative = deviation / truth[i][c];
            worst = std::max(worst, std::abs(relative));
            all.add(relative);
            channels[c].add(relative);
            channels[c].worst.push_back(std::abs(relative));
        }
        all.worst.push_back(worst);
    }
    const auto n = static_cast<double>(std::max<std::size_t>(truth.size(), 1));
    const double meanTruth = (mean.x + mean.y + mean.z) / (3 * n);
    JsonValue json = all.toJson();
    json.set("rmsOfMean", std::sqrt(squares / (3 * n)) / meanTruth)
        .set("biasOfMean",
             (meanDeviation.x + meanDeviation.y + meanDeviation.z) / (3 * n) / meanTruth);
    JsonValue perChannel = JsonValue::array();
    for (Spread& channel : channels) perChannel.push(channel.toJson());
    json.set("channels", std::move(perChannel)).set("receivers", truth.size());
    return json;
}

}  // namespace sss::bench
