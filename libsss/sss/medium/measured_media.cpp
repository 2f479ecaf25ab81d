#include "sss/medium/measured_media.h"

#include <fmt/format.h>

#include <algorithm>

namespace sss {
namespace {

constexpr std::array kChannelNames{"red", "green", "blue"};
/// Below this reduced albedo absorption is no small correction to scattering.
constexpr double kLeastReducedAlbedo = 0.8;
/// Objects thinner than this many mean free paths let light through before it is diffuse.
constexpr double kLeastMeanFreePaths = 10;
/// Indices of refraction for which the boundary's polynomials were made, and where they are within
/// 0.01 of the totals.
constexpr double kLeastFittedEta = 0.5, kMostFittedEta = 2.4;

std::string letters(std::string_view name) {
    std::string out;
    for (const char c : name) {
        if (c == ' ' || c == '_' || c == '-') continue;
        out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return out;
}

/// The channels for which `fails`, as "red, green".
template <typename Fails>
std::string channelsThat(const Fails& fails) {
    std::string list;
    for (int c = 0; c < 3; ++c) {
        if (!fails(c)) continue;
        list += fmt::format("{}{}", list.empty() ? "" : ", ", kChannelNames[std::size_t(c)]);
    }
    return list;
}

}  // namespace

const MeasuredMedium* findMeasuredMedium(std::string_view name) {
    const std::string wanted = letters(name);
    const auto media = measuredMedia();
    const auto found = std::find_if(media.begin(), media.end(), [&](const MeasuredMedium& medium) {
        return letters(medium.name) == wanted;
    });
    return found == media.end() ? nullptr : &*found;
}

Medium toMedium(const MeasuredMedium& measured) {
    Medium medium;
    medium.eta = measured.eta;
    for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(c);
        medium.sigmaA[c] = measured.sigmaA[i];
        medium.sigmaS[c] = measured.hasScattering ? measured.sigmaS[i] : measured.sigmaSPrime[i];
        medium.g[c] = measured.hasScattering ? measured.g[i] : 0.0;
    }
    return medium;
}

std::vector<std::string> diffusionWarnings(const Medium& medium, double objectSizeMm,
                                           BoundaryModel boundary) {
    std::vector<std::string> sentences;
    const auto scatters = [&](int c) { return medium.channel(c).sigmaSPrime() > 0; };
    const std::string clear = channelsThat([&](int c) { return !scatters(c); });
    if (!clear.empty()) {
        sentences.push_back(fmt::format(
            "the medium does not scatter ({}: sigma_s = 0), so nothing comes back by diffusion",
            clear));
    }
    const auto albedoFails = [&](int c) {
        return scatters(c) && medium.channel(c).reducedAlbedo() < kLeastReducedAlbedo;
    };
    const std::string dark = channelsThat(albedoFails);
    if (!dark.empty()) {
        double least = 1;
        for (int c = 0; c < 3; ++c) {
            if (albedoFails(c)) least = std::min(least, medium.channel(c).reducedAlbedo());
        }
        sentences.push_back(fmt::format(
            "absorption is not small against scattering ({}: reduced albedo down to {:.3g}, below "
            "{:.1f}): most light leaves after few scattering events, which diffusion describes "
            "badly",
            dark, least, kLeastReducedAlbedo));
    }
    const auto tooThin = [&](int c) {
        return scatters(c) &&
               objectSizeMm < kLeastMeanFreePaths * medium.channel(c).meanFreePathMm();
    };
    const std::string thin = channelsThat(tooThin);
    if (!thin.empty()) {
        double longest = 0;
        for (int c = 0; c < 3; ++c) {
            if (tooThin(c)) longest = std::max(longest, medium.channel(c).meanFreePathMm());
        }
        sentences.push_back(fmt::format(
            "the object is thin ({}: {:.3g} mm is {:.2g} mean free paths of {:.3g} mm, fewer than "
            "{:.0f}): light crosses it before it is diffuse, and a profile of the half-space does "
            "not see the far side",
            thin, objectSizeMm, objectSizeMm / longest, longest, kLeastMeanFreePaths));
    }
    if (boundary == BoundaryModel::Polynomial &&
        (medium.eta < kLeastFittedEta || medium.eta > kMostFittedEta)) {
        sentences.push_back(fmt::format(
            "the polynomials of the boundary were fitted to indices of refraction from {} to {} "
            "and mean nothing at {}: totals may even be negative; take the exact boundary",
            kLeastFittedEta, kMostFittedEta, medium.eta));
    }
    return sentences;
}

}  // namespace sss
