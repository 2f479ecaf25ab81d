#include "sss/scene/medium_reader.h"

#include "sss/base/error.h"
#include "sss/medium/albedo_inversion.h"
#include "sss/medium/measured_media.h"

#include <fmt/format.h>

#include <algorithm>

namespace sss {
namespace {

// mm^-1; from far below water to far above the densest paint.
constexpr Range kCoefficientRange{0, 1e9, false, false, "mm^-1"};
constexpr Range kMeanCosineRange{-1, 1, true, true};
/// Index of refraction where the file gives none: what [JMLH01] take for all media but marble.
constexpr double kDefaultEta = 1.3;

Node member(const Node& material, std::string_view key) { return memberNode(material, key, ""); }

DRgb meanCosine(const Node& material) {
    if (material.value.find("g") == nullptr) return DRgb(0);
    return channels(member(material, "g"), kMeanCosineRange);
}

double etaOr(const Node& material, double otherwise) {
    if (material.value.find("eta") == nullptr) return otherwise;
    return number(member(material, "eta"), kEtaRange);
}

DRgb coefficients(const Node& material, std::string_view key) {
    return channels(member(material, key), kCoefficientRange);
}

void readMeasured(TranslucentMaterial& out, const Node& material) {
    std::vector<std::string_view> names;
    for (const MeasuredMedium& medium : measuredMedia()) names.push_back(medium.name);
    const MeasuredMedium& measured = measuredMedia()[choice(member(material, "medium"), names)];
    out.mediumName = measured.name;
    out.medium = toMedium(measured);
    out.medium.eta = etaOr(material, measured.eta);
}

void readScattering(TranslucentMaterial& out, const Node& material) {
    out.medium.sigmaA = coefficients(material, "sigmaAPerMm");
    out.medium.sigmaS = coefficients(material, "sigmaSPerMm");
    out.medium.g = meanCosine(material);
    out.medium.eta = etaOr(material, kDefaultEta);
}

void readReducedScattering(TranslucentMaterial& out, const Node& material) {
    out.medium.sigmaA = coefficients(material, "sigmaAPerMm");
    out.medium.g = meanCosine(material);
    // sigma'_s = (1 - g) sigma_s
    out.medium.sigmaS = coefficients(material, "sigmaSPrimePerMm") / (1.0 - out.medium.g);
    out.medium.eta = etaOr(material, kDefaultEta);
}

/// The coefficients with which the material's profile returns the colour; a slab's is the colour of
/// its thick limit, the dipole.
void readColour(TranslucentMaterial& out, const Node& material, std::string_view lengthKey,
                RadiusKind lengthKind) {
    const Node colourNode = member(material, "diffuseColor");
    const DRgb colour = channels(colourNode, kFractionRange);
    const DRgb lengthMm = channels(member(material, lengthKey), kMmRange);
    out.medium.g = meanCosine(material);
    out.medium.eta = etaOr(material, kDefaultEta);
    const bool isSlab = out.profileOptions.slabThicknessMm.has_value();
    const std::string_view profile = isSlab ? "dipole" : std::string_view(out.profile);
    for (int c = 0; c < 3; ++c) {
        const DiffuseLook look{colour[c], lengthMm[c], lengthKind, out.medium.g[c], out.medium.eta};
        try {
            const ChannelMedium channel = invertAlbedo(profile, look, out.profileOptions);
            out.medium.sigmaA[c] = channel.sigmaA;
            out.medium.sigmaS[c] = channel.sigmaS;
        } catch (const Error& error) {
            fail(colourNode,
                 "cannot be had: " + std::string(error.what()).substr(error.where().size() + 2));
        }
    }
}

void readColourByTransport(TranslucentMaterial& out, const Node& material) {
    readColour(out, material, "meanFreePathMm", RadiusKind::TransportMfp);
}

void readColourByDiffusion(TranslucentMaterial& out, const Node& material) {
    readColour(out, material, "diffuseMeanFreePathMm", RadiusKind::DiffuseMfp);
}

/// One way to describe a medium: a new one costs a row here, and its keys in kMediumFields.
struct MediumWay {
    std::vector<std::string_view> keys;      ///< all needed
    std::vector<std::string_view> optional;  ///< may stand beside them
    void (*read)(TranslucentMaterial&, const Node& material);
};

const MediumWay kWays[] = {
    {{"medium"}, {"eta"}, readMeasured},
    {{"sigmaAPerMm", "sigmaSPerMm"}, {"g", "eta"}, readScattering},
    {{"sigmaAPerMm", "sigmaSPrimePerMm"}, {"g", "eta"}, readReducedScattering},
    {{"diffuseColor", "meanFreePathMm"}, {"g", "eta"}, readColourByTransport},
    {{"diffuseColor", "diffuseMeanFreePathMm"}, {"g", "eta"}, readColourByDiffusion},
};

constexpr Field<TranslucentMaterial> kMediumFields[] = {
    {"medium"},       {"sigmaAPerMm"},    {"sigmaSPerMm"},           {"sigmaSPrimePerMm"},
    {"diffuseColor"}, {"meanFreePathMm"}, {"diffuseMeanFreePathMm"}, {"g"},
    {"eta"},
};

bool has(const std::vector<std::string_view>& keys, std::string_view key) {
    return std::ranges::find(keys, key) != keys.end();
}

bool fits(const MediumWay& way, const std::vector<std::string_view>& given) {
    return std::ranges::all_of(way.keys, [&](auto key) { return has(given, key); }) &&
           std::ranges::all_of(
               given, [&](auto key) { return has(way.keys, key) || has(way.optional, key); });
}

std::string joined(const std::vector<std::string_view>& keys) {
    std::string text;
    for (const std::string_view key : keys) {
        text += fmt::format("{}\"{}\"", text.empty() ? "" : " + ", key);
    }
    return text;
}

[[noreturn]] void failWay(const Node& material, const std::vector<std::string_view>& given) {
    std::string ways;
    for (const MediumWay& way : kWays) {
        ways += fmt::format("{}{}", ways.empty() ? "" : ", or ", joined(way.keys));
    }
    fail(material,
         given.empty() ? "does not say what its medium is"
                       : fmt::format("describes its medium by {}", joined(given)),
         "give " + ways + "; \"eta\" may be added to each, \"g\" to all but the first");
}

}  // namespace

std::span<const Field<TranslucentMaterial>> mediumFields() { return kMediumFields; }

void readMedium(TranslucentMaterial& out, const Node& material) {
    std::vector<std::string_view> given;
    for (const auto& field : kMediumFields) {
        if (material.value.find(field.key) != nullptr) given.push_back(field.key);
    }
    const auto way =
        std::ranges::find_if(kWays, [&](const MediumWay& w) { return fits(w, given); });
    if (way == std::end(kWays)) failWay(material, given);
    way->read(out, material);
    if (out.medium.sigmaA == DRgb(0) && out.medium.sigmaS == DRgb(0)) {
        fail(material, "has a medium that neither absorbs nor scatters",
             "a translucent material needs some scattering");
    }
}

}  // namespace sss
