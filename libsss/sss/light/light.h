#pragma once
#include "sss/base/bounds.h"
#include "sss/base/vec.h"

#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace sss {

/// A way from a point to a light.
struct LightSample {
    Vec3 direction{};    ///< unit, from the point towards the light
    float distance = 0;  ///< mm to the light; infinity for directional and environment
    Rgb radiance{0.0f};  ///< unoccluded radiance arriving; for delta lights see pdf
    /// Probability density in solid angle (sr^-1) at the point. For a delta light it is 1 and
    /// `radiance` holds the irradiance on a facing surface. 0 = no light from here.
    float pdf = 0;
};

/// A light that can be sampled from any point. Immutable and thread-safe. Lengths are mm in the
/// scene's space; radiance W m^-2 sr^-1.
class Light {
public:
    virtual ~Light() = default;
    virtual LightSample sample(const Vec3& from, const Vec2& u) const = 0;
    /// sample() from several points, which may be cheaper together.
    virtual void sampleTogether(std::span<const Vec3> from, std::span<const Vec2> u,
                                std::span<LightSample> samples) const {
        for (std::size_t i = 0; i < from.size(); ++i) samples[i] = sample(from[i], u[i]);
    }
    /// A delta light cannot be hit by a ray: no multiple importance sampling.
    virtual bool isDelta() const { return false; }
    /// Whether its light comes from infinitely far: what a ray that leaves the scene may see.
    virtual bool isInfinite() const { return false; }
    /// Whether the radiance that arrives from infinity is the same from everywhere.
    virtual bool isUniform() const { return false; }
    /// Its middle, if it has one: whence its light falls off with distance.
    virtual std::optional<Vec3> centre() const { return {}; }
    /// mm along a ray; empty if begin >= end.
    struct Stretch {
        float begin = 0, end = 0;
    };
    /// The part of a stretch that its light can reach: all of it, where that is not easily said.
    virtual Stretch litStretch(const Vec3& /*origin*/, const Vec3& /*direction*/,
                               const Stretch& within) const {
        return within;
    }
    /// The index of the volume (World::volumes) whose emission it stands for; -1 for others.
    virtual int volume() const { return -1; }
    /// What encloses a light that seen() finds at a finite distance; empty for others.
    virtual Bounds visibleBounds() const { return {}; }
    /// Whether directions chosen for how the receiver scatters find it better than sample() does,
    /// as for light that comes evenly from everywhere; LightPicker then never picks it.
    virtual bool bestFoundByScattering() const { return false; }
    /// Radiance that leaves the light's surface, or arrives from infinity, along a ray from `from`
    /// in `direction`, and with it the pdf (sr^-1) with which sample() makes that direction. The
    /// caller knows that nothing is in between. Zero where the ray misses the light; always zero
    /// for delta lights, and for mesh emitters, which are hit as geometry (see MeshLight).
    /// For analytic shapes `distance` receives where the ray meets it (infinity for environments).
    struct Seen {
        Rgb radiance{0.0f};
        float pdf = 0;
        float distance = 0;
    };
    virtual Seen seen(const Vec3& from, const Vec3& direction) const = 0;
    /// Whether nothing of it lies above the plane through `point` with unit `normal`, so that a
    /// surface there gets no light from it. False where that is not known.
    virtual bool isBelow(const Vec3& /*point*/, const Vec3& /*normal*/) const { return false; }
    /// Flux that can reach a sphere around `target`, in relative terms: what a light is picked by.
    /// An estimate of the irradiance on a facing surface within, W m^-2, mean over the channels.
    virtual float importance(const Bounds& target) const = 0;
};

}  // namespace sss
