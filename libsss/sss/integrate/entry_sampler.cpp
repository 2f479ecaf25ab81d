#include "sss/integrate/entry_sampler.h"

#include <array>
#include <cmath>

namespace sss {
namespace {

double reachOf(const Body& body) { return body.mesh.bounds().diagonal() * 1.01; }

float wrapped(float u) { return u < 1.0f ? u : u - 1.0f; }

}  // namespace

/// Chooses one of the places that it is offered with a probability in proportion to their terms.
class EntrySampler::Choice {
public:
    /// `u` in [0, 1) makes all decisions.
    Choice(const EntrySampler& sampler, const SurfaceHit& exit, const Frame& frame, float u)
        : sampler_(sampler), exit_(exit), frame_(frame), u_(u) {}

    void offer(const Hit& hit) {
        const SurfaceHit place = sampler_.world_.surfaceAt(hit);
        if (place.body != exit_.body) return;
        const Rgb term = termOf(place);
        const float share = meanComponent(term);
        if (!(share > 0)) return;
        sum_ += share;
        const float probability = share / sum_;
        if (u_ < probability) {
            chosen_ = {place, term / share};
            u_ /= probability;
        } else {
            u_ = (u_ - probability) / (1.0f - probability);
        }
    }
    EntryPlace chosen() const { return {chosen_.hit, chosen_.weight * sum_}; }

private:
    /// R_d / p.
    Rgb termOf(const SurfaceHit& place) const {
        const Vec3 offset = frame_.toLocal(place.position - exit_.position);
        const Vec3 squares = offset * offset;
        const Vec3 cosines = glm::abs(frame_.toLocal(place.geometricNormal));
        // Where the place itself is met: R_d and p may both be infinite.
        const float least = 1e-14f * sampler_.reach_ * sampler_.reach_;
        float density = 0;
        for (int a = 0; a < kProbes; ++a) {
            const float aside = squares[(a + 1) % 3] + squares[(a + 2) % 3];
            density += cosines[a] * sampler_.radius_.density(std::sqrt(std::max(aside, least)));
        }
        if (!(density > 0)) return Rgb(0);
        const float distance = std::sqrt(std::max(squares.x + squares.y + squares.z, least));
        return sampler_.reflectance(distance) / density;
    }

    const EntrySampler& sampler_;
    const SurfaceHit& exit_;
    const Frame& frame_;
    float u_;
    float sum_ = 0;
    EntryPlace chosen_;
};

EntrySampler::EntrySampler(const World& world, int body, const BodyOptics& optics)
    : world_(world),
      optics_(optics),
      mask_(bodyMask(body)),
      reach_(static_cast<float>(reachOf(world.bodies()[static_cast<std::size_t>(body)]))),
      radius_(optics.profilePointers(), static_cast<double>(reach_)) {}

Rgb EntrySampler::reflectance(float distanceMm) const {
    Rgb value;
    for (int c = 0; c < 3; ++c)
        optics_.profiles[static_cast<std::size_t>(c)]->reflectance(std::span(&distanceMm, 1),
                                                                   std::span(&value[c], 1));
    return value;
}

EntryPlace EntrySampler::sample(const SurfaceHit& exit, Sampler& sampler) const {
    const Frame frame(exit.geometricNormal);
    const Vec2 u = sampler.next2D();
    Choice choice(*this, exit, frame, sampler.next1D());
    const std::array<Vec3, kProbes> axes{frame.tangent, frame.bitangent, frame.normal};
    for (std::size_t a = 0; a < kProbes; ++a) {
        // The same numbers, moved on: three probes that are unlike each other.
        const float shift = static_cast<float>(a) / kProbes;
        const float r = radius_.sample(wrapped(u.x + shift));
        const float phi = 2 * kPiF * wrapped(u.y + shift);
        const Vec3 aside =
            axes[(a + 1) % 3] * (r * std::cos(phi)) + axes[(a + 2) % 3] * (r * std::sin(phi));
        Ray probe;
        probe.origin = exit.position + aside - axes[a] * reach_;
        probe.direction = axes[a];
        probe.tMax = 2 * reach_;
        world_.rays().forEachHit(
            probe, [&choice](const Hit& hit) { choice.offer(hit); }, mask_);
    }
    return choice.chosen();
}

}  // namespace sss
