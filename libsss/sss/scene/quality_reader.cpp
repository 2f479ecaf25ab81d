#include "sss/scene/quality_reader.h"

#include <cmath>

namespace sss {
namespace {

/// A whole number up to 2^53 - 1: the largest range in which JSON numbers are exact.
std::uint64_t readSeed(const Node& node) {
    const double value = number(node, {0, 9007199254740991.0});
    if (value != std::trunc(value)) fail(node, "has a fraction", "a seed is a whole number");
    return static_cast<std::uint64_t>(value);
}

constexpr Field<QualitySettings> kQualityFields[] = {
    {"tolerance",
     [](QualitySettings& q, const Node& n) {
         q.tolerance = number(n, {0, 0.5, true, false});
     }},
    {"spacingMm", [](QualitySettings& q, const Node& n) { q.spacingMm = number(n, kMmRange); }},
    {"irradianceSamples",
     [](QualitySettings& q, const Node& n) { q.irradianceSamples = wholeNumber(n, 1, 65536); }},
    {"bounces", [](QualitySettings& q, const Node& n) { q.bounces = wholeNumber(n, 0, 64); }},
    {"seed", [](QualitySettings& q, const Node& n) { q.seed = readSeed(n); }},
    {"integrator",
     [](QualitySettings& q, const Node& n) {
         q.integrator = text(n);
         q.integratorLine = n.value.place.line;
         q.integratorColumn = n.value.place.column;
     }},
};

}  // namespace

QualitySettings readQuality(const Node& node) {
    QualitySettings quality;
    FieldSet fields;
    fields.add(quality, kQualityFields);
    fields.read(node);
    return quality;
}

KeyList qualityKeys() { return listRows<QualitySettings>("quality", kQualityFields); }

}  // namespace sss
