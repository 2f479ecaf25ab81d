#pragma once
#include "sss/integrate/irradiance_estimator.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Which way light goes on inside a body from each of its points: a few refracted directions a
/// point, each for an equal share of what enters there.
struct EnteredBeams {
    static constexpr std::size_t kPerPoint = 4;
    std::vector<std::uint32_t> directions;  ///< body space, encodeUnitVector

    std::span<std::uint32_t> of(std::size_t point) {
        return std::span(directions).subspan(point * kPerPoint, kPerPoint);
    }
    std::span<const std::uint32_t> of(std::size_t point) const {
        return std::span(directions).subspan(point * kPerPoint, kPerPoint);
    }
};

/// Picks a point's beams from its light samples: those at equal steps of the light that they have
/// brought so far, all channels together. Of a light of one colour here and another there, a
/// channel's mean direction is that of the sum.
class BeamPicker {
public:
    BeamPicker(float eta, const RigidTransform& worldFromBody)
        : eta_(eta), bodyFromWorld_(worldFromBody.inverse()) {}
    void clear();
    void add(const SurfaceHit& hit, const IrradianceEstimator::Arrivals& light);
    /// A point that no light reaches gets beams along nothing in particular.
    void pick(std::span<std::uint32_t> beams) const;

private:
    struct Candidate {
        float upTo;  ///< of the light so far
        Vec3 from, normal;
    };
    void add(const IrradianceEstimator::Arrival& light, const Vec3& normal);

    float eta_;
    RigidTransform bodyFromWorld_;
    std::vector<Candidate> candidates_;
    float total_ = 0;
};

}  // namespace sss
