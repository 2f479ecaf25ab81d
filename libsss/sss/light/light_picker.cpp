#include "sss/light/light_picker.h"

#include "sss/base/assert.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sss {
namespace {

constexpr double kEqualShare = 0.1;

}  // namespace

LightPicker::LightPicker(std::span<const std::unique_ptr<Light>> lights, const Bounds& target) {
    std::vector<double> weights;
    double total = 0, pickable = 0;
    for (const std::unique_ptr<Light>& light : lights) {
        const auto weight = static_cast<double>(light->importance(target));
        weights.push_back(std::isfinite(weight) ? std::max(weight, 0.0) : 0.0);
        if (light->bestFoundByScattering()) continue;
        total += weights.back();
        pickable += 1;
    }
    if (pickable == 0) return;
    const double share = kEqualShare / pickable;
    for (std::size_t k = 0; k < weights.size(); ++k)
        weights[k] = lights[k]->bestFoundByScattering()
                         ? 0.0
                         : share + (total > 0 ? (1 - kEqualShare) * weights[k] / total : 0.0);
    choice_.emplace(weights);
    hasChoice_ = pickable > 1;
    while (weights[first_] == 0) ++first_;
}

LightPicker::Pick LightPicker::pick(float u) const {
    SSS_ASSERT_GE(size(), std::size_t{1});
    if (!hasChoice_) return {first_, 1.0f, u};
    const PiecewiseConstant1D::Sample chosen = choice_->sample(u);
    return {chosen.cell, choice_->mass(chosen.cell), chosen.within};
}

}  // namespace sss
