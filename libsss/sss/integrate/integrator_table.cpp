#include "sss/integrate/integrator_table.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"
#include "sss/integrate/bssrdf_integrator.h"
#include "sss/integrate/cached_integrator.h"
#include "sss/integrate/diffuse_limit_integrator.h"
#include "sss/integrate/volume_integrator.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <vector>

namespace sss {
namespace {

template <typename Kind>
std::unique_ptr<Integrator> make(const IntegratorInput& input) {
    return std::make_unique<Kind>(input);
}

constexpr std::array kKinds{
    IntegratorKind{"cached", true, make<CachedIntegrator>},
    IntegratorKind{"bssrdf", false, make<BssrdfIntegrator>},
    IntegratorKind{"brdf", false, make<DiffuseLimitIntegrator>},
    IntegratorKind{"lambertian", false, make<LambertianIntegrator>},
    IntegratorKind{"volume", false, make<VolumeIntegrator>},
};

}  // namespace

std::span<const IntegratorKind> integratorTable() { return kKinds; }

const IntegratorKind* findIntegrator(std::string_view name) {
    const auto* row = std::ranges::find(kKinds, name, &IntegratorKind::name);
    return row == kKinds.end() ? nullptr : row;
}

const IntegratorKind& integratorOf(const Scene& scene) {
    const QualitySettings& quality = scene.quality;
    const std::string& name = quality.integrator;
    if (const IntegratorKind* kind = findIntegrator(name)) return *kind;
    std::vector<std::string_view> names;
    for (const IntegratorKind& kind : kKinds) names.push_back(kind.name);
    std::string where = scene.file.string();
    if (quality.integratorLine > 0)
        where += fmt::format(":{}:{}", quality.integratorLine, quality.integratorColumn);
    throw Error(ErrorKind::BadInput, where,
                fmt::format("there is no integrator called {}", inQuotes(name)),
                nameHint(name, names));
}

}  // namespace sss
