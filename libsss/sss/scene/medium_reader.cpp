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
/// Of a radius: a channel without scattering is not meant by 0.
constexpr Range kScaleRange{1e-9, 1e9};
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

/// The profile that a colour is inverted by: the material's. The photon beam is only a part of the
/// light; where single scattering is added to come to the transfer total, that total is inverted,
/// which is "tabulated"'s.
std::string_view invertedProfile(const TranslucentMaterial& material) {
    const bool isShared =
        material.singleScattering && material.energy == EnergyConvention::Consistent;
    if (material.profile == "photon_beam" && isShared) return "tabulated";
    return material.profile;
}

/// Runs an inversion; what it refuses is refused at the colour.
template <typename Inversion>
void invertAt(const Node& colourNode, const Inversion& inversion) {
    try {
        inversion();
    } catch (const Error& error) {
        fail(colourNode,
             "cannot be had: " + std::string(error.what()).substr(error.where().size() + 2));
    }
}

void readColour(TranslucentMaterial& out, const Node& material, std::string_view lengthKey,
                RadiusKind lengthKind) {
    const Node colourNode = member(material, "diffuseColor");
    const DRgb colour = channels(colourNode, kFractionRange);
    const DRgb lengthMm = channels(member(material, lengthKey), kMmRange);
    out.medium.g = meanCosine(material);
    out.medium.eta = etaOr(material, kDefaultEta);
    out.diffuseColor = colour;
    invertAt(colourNode, [&] {
        for (int c = 0; c < 3; ++c) {
            const ChannelMedium channel =
                invertAlbedo(invertedProfile(out),
                             {colour[c], lengthMm[c], lengthKind, out.medium.g[c], out.medium.eta},
                             out.profileOptions);
            out.medium.sigmaA[c] = channel.sigmaA;
            out.medium.sigmaS[c] = channel.sigmaS;
        }
    });
}

void readColourByTransport(TranslucentMaterial& out, const Node& material) {
    readColour(out, material, "meanFreePathMm", RadiusKind::TransportMfp);
}

void readColourByDiffusion(TranslucentMaterial& out, const Node& material) {
    readColour(out, material, "diffuseMeanFreePathMm", RadiusKind::DiffuseMfp);
}

double numberOr(const Node& material, std::string_view key, const Range& range, double otherwise) {
    return material.value.find(key) != nullptr ? number(member(material, key), range) : otherwise;
}

DRgb channelsOr(const Node& material, std::string_view key, const Range& range, const DRgb& other) {
    return material.value.find(key) != nullptr ? channels(member(material, key), range) : other;
}

/// `key` or our own "roughness", which readers of the other keys have in hand; else the default of
/// the shader whose names are used.
void readRoughness(TranslucentMaterial& out, const Node& material, std::string_view key,
                   double otherwise) {
    if (key != "roughness" && material.value.find("roughness") != nullptr) return;
    out.roughness = numberOr(material, key, kFractionRange, otherwise);
}

/// OpenPBR 1.1 and Blender's Principled shader, their names, units and defaults.
void readOpenPbr(TranslucentMaterial& out, const Node& material) {
    OpenPbrSubsurface p;
    const Node colour = member(material, "subsurface_color");
    p.color = channels(colour, kFractionRange);
    p.radius = numberOr(material, "subsurface_radius", kSizeRange, p.radius);
    p.radiusScale = channelsOr(material, "subsurface_radius_scale", kScaleRange, p.radiusScale);
    p.anisotropy =
        numberOr(material, "subsurface_scatter_anisotropy", kMeanCosineRange, p.anisotropy);
    p.ior = numberOr(material, "specular_ior", kEtaRange, p.ior);
    readRoughness(out, material, "specular_roughness", p.roughness);
    out.diffuseColor = p.color;
    invertAt(colour, [&] {
        out.medium = mediumFromOpenPbr(p, material.context.mmPerUnit, invertedProfile(out),
                                       out.profileOptions);
    });
}

void readPrincipled(TranslucentMaterial& out, const Node& material) {
    PrincipledSubsurface p;
    const Node colour = member(material, "base_color");
    p.baseColor = channels(colour, kFractionRange);
    p.radius = channelsOr(material, "subsurface_radius", kSizeRange, p.radius);
    p.scale = numberOr(material, "subsurface_scale", kSizeRange, p.scale);
    p.anisotropy = numberOr(material, "subsurface_anisotropy", kMeanCosineRange, p.anisotropy);
    p.ior = numberOr(material, "subsurface_ior", kEtaRange, p.ior);
    readRoughness(out, material, "roughness", p.roughness);
    out.diffuseColor = p.baseColor;
    invertAt(colour, [&] {
        out.medium = mediumFromPrincipled(p, material.context.mmPerUnit, invertedProfile(out),
                                          out.profileOptions);
    });
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
    {{"subsurface_color"},
     {"subsurface_radius", "subsurface_radius_scale", "subsurface_scatter_anisotropy",
      "specular_ior", "specular_roughness"},
     readOpenPbr},
    {{"base_color"},
     {"subsurface_radius", "subsurface_scale", "subsurface_anisotropy", "subsurface_ior"},
     readPrincipled},
};

constexpr Field<TranslucentMaterial> kMediumFields[] = {
    {"medium"},
    {"sigmaAPerMm"},
    {"sigmaSPerMm"},
    {"sigmaSPrimePerMm"},
    {"diffuseColor"},
    {"meanFreePathMm"},
    {"diffuseMeanFreePathMm"},
    {"g"},
    {"eta"},
    {"subsurface_color"},
    {"subsurface_radius"},
    {"subsurface_radius_scale"},
    {"subsurface_scatter_anisotropy"},
    {"specular_ior"},
    {"specular_roughness"},
    {"base_color"},
    {"subsurface_scale"},
    {"subsurface_anisotropy"},
    {"subsurface_ior"},
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
         "give " + ways + "; scenes/README.md says what may stand beside them");
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
    if (has(given, "specular_roughness") && material.value.find("roughness") != nullptr) {
        fail(material, "says its roughness twice",
             "\"roughness\" and \"specular_roughness\" are the same");
    }
    way->read(out, material);
    if (out.medium.sigmaA == DRgb(0) && out.medium.sigmaS == DRgb(0)) {
        fail(material, "has a medium that neither absorbs nor scatters",
             "a translucent material needs some scattering");
    }
}

}  // namespace sss
