#include "material_argument.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"
#include "sss/medium/albedo_inversion.h"
#include "sss/medium/measured_media.h"
#include "sss/scene/scene_reader.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace {

using namespace sss;

constexpr const char* kWhere = "--profile";
constexpr double kDefaultEta = 1.3;  // as in a scene file

[[noreturn]] void badArgument(const std::string& what, const std::string& hint = {}) {
    throw Error(ErrorKind::Usage, kWhere, what, hint);
}

struct Key {
    std::string_view name;
    double low, high;
    bool openLow, openHigh;
    bool oneValue = false;
};

// sigma_prime_s is the other common spelling of sigma_s_prime.
constexpr Key kKeys[] = {
    {"sigma_a", 0, 1e9, false, false},       {"sigma_s", 0, 1e9, false, false},
    {"sigma_s_prime", 0, 1e9, false, false}, {"sigma_prime_s", 0, 1e9, false, false},
    {"color", 0, 1, false, false},           {"mfp", 0, 1e9, true, false},
    {"dmfp", 0, 1e9, true, false},           {"g", -1, 1, true, true},
    {"eta", 0.1, 10, false, false, true},
};

double numberOf(const std::string& text, const Key& key) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool whole = !text.empty() && *end == '\0' && std::isfinite(value);
    if (!whole) badArgument(fmt::format("{} of \"{}\" is not a number", inQuotes(text), key.name));
    if (value < key.low || value > key.high || (key.openLow && value == key.low) ||
        (key.openHigh && value == key.high))
        badArgument(fmt::format("{} = {} is not in {}{}, {}{}", key.name, text,
                                key.openLow ? '(' : '[', key.low, key.high,
                                key.openHigh ? ')' : ']'));
    return value;
}

std::vector<std::string> split(const std::string& text, std::string_view separators) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = text.find_first_of(separators, begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string::npos) return parts;
        begin = end + 1;
    }
}

using Values = std::map<std::string_view, DRgb>;

Values valuesOf(const std::string& text) {
    std::vector<std::string_view> names;
    for (const Key& key : kKeys) names.push_back(key.name);
    Values values;
    for (const std::string& part : split(text, ",;")) {
        const std::size_t equals = part.find('=');
        const std::string name = part.substr(0, equals);
        const Key* key = nullptr;
        for (const Key& k : kKeys)
            if (k.name == name) key = &k;
        if (key == nullptr || equals == std::string::npos)
            badArgument(fmt::format("{} is no KEY=VALUE of a medium", inQuotes(part)),
                        nameHint(name, names));
        const auto numbers = split(part.substr(equals + 1), "/");
        if (numbers.size() != 1 && (numbers.size() != 3 || key->oneValue))
            badArgument(fmt::format("\"{}\" has {} values", name, numbers.size()),
                        key->oneValue ? "give one" : "give one, or three as RED/GREEN/BLUE");
        DRgb value;
        for (int c = 0; c < 3; ++c)
            value[c] =
                numberOf(numbers[numbers.size() == 3 ? static_cast<std::size_t>(c) : 0], *key);
        if (!values.emplace(key->name, value).second)
            badArgument(fmt::format("\"{}\" is given twice", name));
    }
    return values;
}

Medium mediumOfNumbers(const std::string& text, const std::string& model,
                       const ProfileOptions& options) {
    Values values = valuesOf(text);
    const auto has = [&](std::string_view key) { return values.count(key) != 0; };
    if (has("sigma_prime_s") && !has("sigma_s_prime"))
        values["sigma_s_prime"] = values.extract("sigma_prime_s").mapped();
    Medium medium;
    medium.g = has("g") ? values["g"] : DRgb(0);
    medium.eta = has("eta") ? values["eta"].x : kDefaultEta;
    const int optional = (has("g") ? 1 : 0) + (has("eta") ? 1 : 0);
    if (static_cast<int>(values.size()) == optional + 2) {
        if (has("sigma_a") && (has("sigma_s") || has("sigma_s_prime"))) {
            medium.sigmaA = values["sigma_a"];
            medium.sigmaS =
                has("sigma_s") ? values["sigma_s"] : values["sigma_s_prime"] / (1.0 - medium.g);
            return medium;
        }
        if (has("color") && (has("mfp") || has("dmfp"))) {
            const RadiusKind kind = has("mfp") ? RadiusKind::TransportMfp : RadiusKind::DiffuseMfp;
            const DRgb length = has("mfp") ? values["mfp"] : values["dmfp"];
            for (int c = 0; c < 3; ++c) {
                const ChannelMedium channel = invertAlbedo(
                    model, {values["color"][c], length[c], kind, medium.g[c], medium.eta}, options);
                medium.sigmaA[c] = channel.sigmaA;
                medium.sigmaS[c] = channel.sigmaS;
            }
            return medium;
        }
    }
    badArgument(
        fmt::format("{} does not describe a medium in one way", inQuotes(text)),
        "give sigma_a and sigma_s or sigma_s_prime (mm^-1), or color and mfp or dmfp (mm); eta "
        "and g may be added");
}

// FILE:NAME at the first colon behind which stands a file; empty if no part before a colon does.
std::size_t colonBehindFile(const std::string& text) {
    for (std::size_t i = text.find(':'); i != std::string::npos; i = text.find(':', i + 1)) {
        std::error_code ignored;
        if (std::filesystem::is_regular_file(text.substr(0, i), ignored)) return i;
    }
    return text.rfind(':');
}

const TranslucentMaterial& materialOf(const Scene& scene, const std::string& name) {
    std::vector<std::string_view> names;
    for (const NamedMaterial& material : scene.materials) {
        const auto* translucent = std::get_if<TranslucentMaterial>(&material.material);
        if (translucent != nullptr) names.push_back(material.name);
        if (material.name != name) continue;
        if (translucent == nullptr)
            badArgument(fmt::format("material {} of {} is not translucent: it has no profile",
                                    inQuotes(name), scene.file.string()));
        return *translucent;
    }
    badArgument(fmt::format("{} has no material {}", scene.file.string(), inQuotes(name)),
                nameHint(name, names));
}

[[noreturn]] void refuseName(const std::string& name) {
    std::vector<std::string_view> names;
    for (const MeasuredMedium& medium : measuredMedia()) names.push_back(medium.name);
    const std::string near = nearestName(name, names);
    badArgument(fmt::format("there is no measured medium {}", inQuotes(name)),
                (near.empty() ? std::string() : fmt::format("did you mean \"{}\"? ", near)) +
                    "see sss-render --list-materials; a scene's material is FILE:NAME, numbers are "
                    "sigma_a=...,sigma_s_prime=...");
}

}  // namespace

ProfileSubject readSubject(const ProfileRequest& request, std::optional<double> metersPerUnit) {
    ProfileSubject subject;
    const std::string& text = request.material;
    if (const MeasuredMedium* measured = findMeasuredMedium(text)) {
        subject.source = fmt::format("{}: {}", measured->name, measured->source);
        subject.medium = toMedium(*measured);
        subject.model = "dipole";
    } else if (text.find(':') != std::string::npos) {
        const std::size_t colon = colonBehindFile(text);
        const Scene scene = readScene(text.substr(0, colon), metersPerUnit);
        const std::string name = text.substr(colon + 1);
        const TranslucentMaterial& material = materialOf(scene, name);
        subject.source = fmt::format("material {} of {}", inQuotes(name), scene.file.string());
        if (!material.mediumName.empty()) subject.source += ", measured " + material.mediumName;
        subject.medium = material.medium;
        subject.model = material.profile;
        subject.options = material.profileOptions;
    } else if (text.find('=') == std::string::npos) {
        refuseName(text);
    } else {
        subject.source = text;
        subject.model = "dipole";
    }
    if (!request.model.empty()) subject.model = request.model;
    if (request.boundary) subject.options.boundary = *request.boundary;
    if (request.thicknessMm) subject.options.slabThicknessMm = request.thicknessMm;
    if (subject.source == text)
        subject.medium = mediumOfNumbers(text, subject.model, subject.options);
    return subject;
}
