#pragma once
#include "sss/integrate/body_cloud.h"
#include "sss/integrate/body_optics.h"
#include "sss/integrate/entered_beams.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Light that leaves a body and comes straight back to it. Pass 1 lights a body before it is known
/// what it sends out, and lets it send what its diffuse limit would: nothing where light comes out
/// that has entered elsewhere. With what was solved, this says what is missing.
class ReturningLight {
public:
    /// Looks around from every point, a few rays each. Parallel; deterministic.
    ReturningLight(const World& world, int body, const BodyOptics& optics,
                   const BodyCloud::View& cloud);
    /// Whether the body sees itself nowhere.
    bool isNone() const { return sights_.empty(); }
    /// Irradiance by point, W m^-2: what entered as pass 1 says, and what comes back of `exitance`
    /// (by point) in place of the diffuse limit's. What is added goes round as often as the scene's
    /// bounces allow, by the diffuse limit.
    std::vector<Rgb> irradiance(std::span<const Rgb> exitance) const;
    /// Points that have most of their light from the body itself get beams along it.
    EnteredBeams beams(const EnteredBeams& before, std::span<const Rgb> irradiance) const;

private:
    /// From where a point is seen which other, and which part of its exitance enters there.
    struct Sight {
        std::uint32_t at, seen;
        float share;
        std::uint32_t beam;  ///< body space, encodeUnitVector
    };
    std::vector<DRgb> gathered(std::span<const DRgb> exitance) const;

    const BodyCloud::View& cloud_;
    Rgb limit_;
    int bounces_;
    std::vector<Sight> sights_;  ///< in the order of `at`
};

}  // namespace sss
