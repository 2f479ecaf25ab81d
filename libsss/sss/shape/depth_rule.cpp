#include "sss/shape/depth_rule.h"

#include "sss/optics/gauss_legendre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sss {
namespace {

// Channels whose extinction differs by less share their places.
constexpr double kLikeExtinction = 1.6;
// exp(-9) is 1e-4.
constexpr double kEnd = 9.0;

// Screening of this part of the extinction and more is strong absorption: the beam is parted at
// these optical depths.
struct Parting {
    double screening;
    std::array<double, 2> depths;
    std::size_t count;
};
constexpr Parting kPartings[] = {{0.25, {1.6, 0}, 1}, {0.6, {0.8, 2.2}, 2}};

// Integral of (s - about)^power sigma exp(-sigma s) over [from, to].
double moment(double sigma, double from, double to, int power, double about) {
    const double end = std::min(to, from + 40.0 / sigma);
    const int parts = std::max(1, static_cast<int>(std::ceil(0.1 * sigma * (end - from))));
    const double width = (end - from) / parts;
    double sum = 0;
    for (int part = 0; part < parts; ++part)
        sum += gauss16(from + part * width, from + (part + 1) * width, [&](double s) {
            double value = sigma * std::exp(-sigma * s);
            for (int k = 0; k < power; ++k) value *= s - about;
            return value;
        });
    return sum;
}

}  // namespace

DepthRule::DepthRule(const DiffusionConstants& medium) : extinction_(medium.extinction) {
    std::vector<int> channels;
    for (int c = 0; c < 3; ++c)
        if (medium.scatters[c]) channels.push_back(c);
    std::sort(channels.begin(), channels.end(),
              [&](int a, int b) { return extinction_[a] < extinction_[b]; });
    for (const int c : channels) {
        if (groups_.empty() ||
            extinction_[c] > kLikeExtinction * extinction_[groups_.back().channels.front()])
            groups_.emplace_back();
        Group& group = groups_.back();
        group.channels.push_back(c);
        for (const Parting& parting : kPartings) {
            if (medium.screening[c] <= parting.screening * extinction_[c]) continue;
            group.partedAtMm.clear();
            for (std::size_t k = 0; k < parting.count; ++k)
                group.partedAtMm.push_back(parting.depths[k] / extinction_[c]);
        }
    }
    if (!channels.empty()) reachMm_ = kEnd / extinction_[channels.front()];
    for (const Group& group : groups_)
        appendGroup(group, std::numeric_limits<double>::infinity(), endless_);
}

void DepthRule::appendStretch(const Group& group, double fromMm, double toMm,
                              std::vector<Node>& nodes) const {
    // Moments of the group's mean density, and of each channel.
    double total = 0, mean = 0;
    DRgb own{0}, first{0};
    for (const int c : group.channels) {
        own[c] =
            -std::exp(-extinction_[c] * fromMm) * std::expm1(-extinction_[c] * (toMm - fromMm));
        first[c] = moment(extinction_[c], fromMm, toMm, 1, 0.0);
        total += own[c];
        mean += first[c];
    }
    if (!(total > 0)) return;
    mean /= total;
    double variance = 0, third = 0;
    for (const int c : group.channels) {
        variance += moment(extinction_[c], fromMm, toMm, 2, mean) / total;
        third += moment(extinction_[c], fromMm, toMm, 3, mean) / total;
    }
    // The two-point rule with these mean, variance and third moment.
    const double deviation = std::sqrt(variance), skew = third / (variance * deviation);
    const double root = std::sqrt(skew * skew + 4.0);
    const double near = mean + 0.5 * deviation * (skew - root);
    const double far = mean + 0.5 * deviation * (skew + root);
    DRgb farWeight{0};
    for (const int c : group.channels)
        farWeight[c] = std::clamp((first[c] - near * own[c]) / (far - near), 0.0, own[c]);
    nodes.push_back({near, own - farWeight});
    nodes.push_back({far, farWeight});
}

void DepthRule::appendGroup(const Group& group, double lengthMm, std::vector<Node>& nodes) const {
    double from = 0;
    for (const double parted : group.partedAtMm) {
        if (parted >= lengthMm) break;
        appendStretch(group, from, parted, nodes);
        from = parted;
    }
    appendStretch(group, from, lengthMm, nodes);
}

void DepthRule::append(double lengthMm, std::vector<Node>& nodes) const {
    if (lengthMm >= reachMm_) {
        nodes.insert(nodes.end(), endless_.begin(), endless_.end());
        return;
    }
    if (!(lengthMm > 0)) return;
    for (const Group& group : groups_) appendGroup(group, lengthMm, nodes);
}

}  // namespace sss
