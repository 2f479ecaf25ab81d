#pragma once
#include "sss/base/distribution.h"
#include "sss/light/light.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace sss {

/// Chooses one of several lights with a probability proportional to its importance for a target,
/// and never less than a tenth of an equal share, since importance is only an estimate. Lights that
/// scattering finds better (Light::bestFoundByScattering) are never chosen: their pmf is 0.
class LightPicker {
public:
    LightPicker(std::span<const std::unique_ptr<Light>> lights, const Bounds& target);

    struct Pick {
        std::size_t index;
        float pmf;  ///< > 0
        float u;    ///< a fresh number in [0, 1), made from what the choice left of the old one
    };
    /// Whether there is a light to pick.
    bool empty() const { return !choice_; }
    /// Whether there are several to choose from: else pick() does not look at its number.
    bool hasChoice() const { return hasChoice_; }
    /// Must not be empty().
    Pick pick(float u) const;
    /// Probability with which pick() chooses the light.
    float pmf(std::size_t index) const { return choice_ ? choice_->mass(index) : 0.0f; }
    std::size_t size() const { return choice_ ? choice_->cellCount() : 0; }

private:
    std::optional<PiecewiseConstant1D> choice_;
    bool hasChoice_ = false;
    std::size_t first_ = 0;  // the first that can be picked
};

}  // namespace sss
