#include "sss/scene/material_reader.h"

#include "sss/base/near_name.h"
#include "sss/scene/medium_reader.h"
#include "sss/scene/metal_table.h"

namespace sss {
namespace {

void readProfile(TranslucentMaterial& material, const Node& node) {
    std::vector<std::string_view> names;
    for (const ProfileKind& kind : profileTable()) names.push_back(kind.name);
    material.profile = names[choice(node, names)];
}

// In the order of BoundaryModel.
constexpr std::string_view kBoundaries[] = {"exact", "polynomial"};

// In the order of EnergyConvention.
constexpr std::string_view kEnergies[] = {"consistent", "jensen"};

constexpr std::string_view kDiffusions[] = {"profile", "shape"};

constexpr Field<TranslucentMaterial> kTranslucentFields[] = {
    {"type"},
    {"profile", readProfile},
    {"boundary",
     [](TranslucentMaterial& m, const Node& n) {
         m.profileOptions.boundary = static_cast<BoundaryModel>(choice(n, kBoundaries));
     }},
    {"energy",
     [](TranslucentMaterial& m, const Node& n) {
         m.energy = static_cast<EnergyConvention>(choice(n, kEnergies));
     }},
    {"diffusion",
     [](TranslucentMaterial& m, const Node& n) { m.onShape = choice(n, kDiffusions) == 1; }},
    {"slabThicknessMm",
     [](TranslucentMaterial& m, const Node& n) {
         m.profileOptions.slabThicknessMm = number(n, kMmRange);
     }},
    {"roughness",
     [](TranslucentMaterial& m, const Node& n) { m.roughness = number(n, kFractionRange); }},
    {"surfaceReflection",
     [](TranslucentMaterial& m, const Node& n) { m.surfaceReflection = yesOrNo(n); }},
    {"singleScattering",
     [](TranslucentMaterial& m, const Node& n) { m.singleScattering = yesOrNo(n); }},
    {"multipleScattering",
     [](TranslucentMaterial& m, const Node& n) { m.multipleScattering = yesOrNo(n); }},
};

void addTranslucent(Material& material, FieldSet& fields) {
    auto& translucent = std::get<TranslucentMaterial>(material);
    fields.add(translucent, kTranslucentFields);
    fields.add(translucent, mediumFields());
}

void finishTranslucent(Material& material, const Node& node) {
    auto& translucent = std::get<TranslucentMaterial>(material);
    const bool isSlab = translucent.profile.starts_with("multipole");
    if (isSlab != translucent.profileOptions.slabThicknessMm.has_value()) {
        fail(node,
             isSlab ? "takes a profile of a slab without saying how thick the slab is"
                    : "gives a \"slabThicknessMm\" to a profile that has no slab",
             "\"slabThicknessMm\" and the multipole profiles go together");
    }
    readMedium(translucent, node);
}

constexpr Field<LambertianMaterial> kLambertianFields[] = {
    {"type"},
    {"reflectance",
     [](LambertianMaterial& m, const Node& n) { m.reflectance = rgb(n, kFractionRange); }, true},
};

void readMetalName(MetalMaterial& material, const Node& node) {
    std::vector<std::string_view> names;
    for (const MetalKind& metal : metalTable()) names.push_back(metal.name);
    const MetalKind& metal = metalTable()[choice(node, names)];
    material.eta = metal.eta;
    material.k = metal.k;
}

// Wider than any metal's at visible wavelengths.
constexpr Range kMetalEtaRange{1e-3, 100};
constexpr Range kMetalKRange{0, 100};

constexpr Field<MetalMaterial> kMetalFields[] = {
    {"type"},
    {"metal", readMetalName},
    {"eta", [](MetalMaterial& m, const Node& n) { m.eta = rgb(n, kMetalEtaRange); }},
    {"k", [](MetalMaterial& m, const Node& n) { m.k = rgb(n, kMetalKRange); }},
    {"roughness", [](MetalMaterial& m, const Node& n) { m.roughness = number(n, kFractionRange); }},
};

void checkMetal(Material&, const Node& node) {
    const bool named = node.value.find("metal") != nullptr;
    const bool eta = node.value.find("eta") != nullptr;
    const bool k = node.value.find("k") != nullptr;
    if (eta == k && named != eta) return;
    fail(node, "says its metal incompletely or twice",
         "give either \"metal\" or both \"eta\" and \"k\"");
}

constexpr Field<EmitterMaterial> kEmitterFields[] = {
    {"type"},
    {"radiance", [](EmitterMaterial& m, const Node& n) { m.radiance = rgb(n, kLightRange); }, true},
    {"twoSided", [](EmitterMaterial& m, const Node& n) { m.twoSided = yesOrNo(n); }},
};

const Kind<Material> kMaterialKinds[] = {
    {"translucent", TranslucentMaterial{}, addTranslucent, finishTranslucent},
    {"lambertian", LambertianMaterial{}, addRows<LambertianMaterial, kLambertianFields>},
    {"metal", MetalMaterial{}, addRows<MetalMaterial, kMetalFields>, checkMetal},
    {"emitter", EmitterMaterial{}, addRows<EmitterMaterial, kEmitterFields>},
};

}  // namespace

std::vector<NamedMaterial> readMaterials(const Node& node) {
    if (!node.value.isObject() || node.value.members().empty()) {
        fail(node, "names no material", "write { \"name\": { \"type\": ... }, ... }");
    }
    std::vector<NamedMaterial> materials;
    for (const JsonMember& member : node.value.members()) {
        if (member.key.empty()) fail(node, member.keyPlace, "a material has an empty name");
        const Node entry{member.value, "material " + inQuotes(member.key), node.context};
        const auto& kind = kindOf<Material>(entry, "type", kMaterialKinds);
        materials.push_back({member.key, readKind(kind, entry)});
    }
    return materials;
}

void listMaterialKeys(std::vector<KeyList>& out) {
    listKinds<Material>("material", kMaterialKinds, out);
}

}  // namespace sss
