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
/// there is surface: probes are whole lines through the body, along the normal of the place and
/// two tangents at right angles [King et al. 2013, "BSSRDF Importance Sampling"], each at a
/// distance from the place drawn by ProbeRadius, all three every time. Of a point x with normal n
/// the three together meet, per mm^2,
///   p(x) = sum over axes a  density(distance of x from the axis) |n . a|,
/// so that the sum of R_d / p over all they meet is an unbiased estimate of the integral of R_d
/// (the balance heuristic), with no term above 4 times the sum of the channels' totals. On a plane
/// and for grey media it has no noise. Of what they meet one place is chosen by its term. Const
/// and thread-safe.
class EntrySampler {
public:
    /// All must outlive the sampler.
    EntrySampler(const World& world, int body, const BodyOptics& optics);

    static constexpr int kProbes = 3;  ///< rays a sample
    bool isEmpty() const { return radius_.isEmpty(); }
    EntryPlace sample(const SurfaceHit& exit, Sampler& sampler) const;

private:
    class Choice;
    Rgb reflectance(float distanceMm) const;
    const World& world_;
    const BodyOptics& optics_;
    std::uint32_t mask_;
    float reach_;  ///< mm; no two places of the body are further apart
    ProbeRadius radius_;
};

}  // namespace sss
