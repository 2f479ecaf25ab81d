#pragma once
#include "sss/base/sampler.h"
#include "sss/integrate/body_optics.h"
#include "sss/integrate/probe_radius.h"

namespace sss {

/// Where light entered that leaves a body elsewhere.
struct EntryPlace {
    SurfaceHit hit;
    /// R_d of the distance over the density of the place, per channel: its mean, times whatever
    /// `hit` receives, is the integral of that times R_d over the body's surface. 0: no place.
    Rgb weight{0.0f};
};

/// Samples the surface of a body around a place on it by R_d of the straight distance, wherever
/// there is surface. Probes are lines through the body at a distance from the place drawn by
/// ProbeRadius: two at a time, one along the normal of the place, one along either of two tangents
/// at right angles [King et al. 2013, "BSSRDF Importance Sampling", has one at a time]. Of a point
/// x with normal n they meet, per mm^2,
///   p(x) = sum over the axes a  share(a) density(distance of x from the axis) |n . a|,
/// share 1 and 1/2, so that the sum of R_d / p over all they meet is an unbiased estimate of the
/// integral of R_d (the balance heuristic), with no term above 6 times the largest of the totals.
/// On a plane and for grey media it has no noise. Of what they meet one place is chosen by its
/// term. What lies beyond all but 1e-6 of every channel's total is left out. Const and thread-safe.
class EntrySampler {
public:
    /// All must outlive the sampler.
    EntrySampler(const World& world, int body, const BodyOptics& optics);

    static constexpr int kProbes = 2;  ///< rays a sample
    bool isEmpty() const { return radius_.isEmpty(); }
    EntryPlace sample(const SurfaceHit& exit, Sampler& sampler) const;

private:
    class Choice;
    struct Axis {
        Vec3 along, across, beside;  ///< unit, at right angles
    };
    void probe(const Vec3& place, const Axis& axis, const Vec2& u, Choice& choice) const;
    Rgb reflectance(float distanceMm) const;
    const World& world_;
    const BodyOptics& optics_;
    std::uint32_t mask_;
    float reach_;  ///< mm; beyond, there is no body, or nothing to speak of comes from there
    ProbeRadius radius_;
};

}  // namespace sss
