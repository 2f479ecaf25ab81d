#include "sss/integrate/entry_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

// Share of a profile's total that is left out, beyond the reach of the probes.
constexpr double kBeyond = 1e-6;
constexpr double kStep = 1.1;

bool endsWithin(const Profile& profile, double r) {
    return profile.tail(r) <= kBeyond * profile.total();
}

// The size of the body, or less where all profiles have ended before.
double reachOf(const Body& body, const BodyOptics& optics) {
    const double size = body.mesh.bounds().diagonal() * 1.01;
    const auto isEnd = [&](double r) {
        return std::ranges::all_of(optics.profiles,
                                   [r](const auto& profile) { return endsWithin(*profile, r); });
    };
    double reach = size;
    while (reach > 1e-9 * size && isEnd(reach / kStep)) reach /= kStep;
    return reach;
}

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
    /// R_d / p; 0 out of reach, where some probes end and others do not.
    Rgb termOf(const SurfaceHit& place) const {
        const Vec3 offset = frame_.toLocal(place.position - exit_.position);
        const Vec3 squares = offset * offset;
        const float square = squares.x + squares.y + squares.z;
        if (square > sampler_.reach_ * sampler_.reach_) return Rgb(0);
        const Vec3 cosines = glm::abs(frame_.toLocal(place.geometricNormal));
        // Where the place itself is met: R_d and p may both be infinite.
        const float least = 1e-14f * sampler_.reach_ * sampler_.reach_;
        const auto along = [&](int axis) {
            const float aside = squares[(axis + 1) % 3] + squares[(axis + 2) % 3];
            return cosines[axis] * sampler_.radius_.density(std::sqrt(std::max(aside, least)));
        };
        // One of the two tangents is probed at a time.
        const float density = 0.5f * (along(0) + along(1)) + along(2);
        if (!(density > 0)) return Rgb(0);
        return sampler_.reflectance(std::sqrt(std::max(square, least))) / density;
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
      reach_(static_cast<float>(reachOf(world.bodies()[static_cast<std::size_t>(body)], optics))),
      radius_(optics.profilePointers(), static_cast<double>(reach_)) {}

Rgb EntrySampler::reflectance(float distanceMm) const {
    Rgb value;
    for (int c = 0; c < 3; ++c)
        optics_.profiles[static_cast<std::size_t>(c)]->reflectance(std::span(&distanceMm, 1),
                                                                   std::span(&value[c], 1));
    return value;
}

void EntrySampler::probe(const Vec3& place, const Axis& axis, const Vec2& u, Choice& choice) const {
    const float r = radius_.sample(u.x), phi = 2 * kPiF * u.y;
    const Vec3 aside = axis.across * (r * std::cos(phi)) + axis.beside * (r * std::sin(phi));
    Ray ray;
    ray.origin = place + aside - axis.along * reach_;
    ray.direction = axis.along;
    ray.tMax = 2 * reach_;
    world_.rays().forEachHit(
        ray, [&choice](const Hit& hit) { choice.offer(hit); }, mask_);
}

EntryPlace EntrySampler::sample(const SurfaceHit& exit, Sampler& sampler) const {
    const Frame frame(exit.geometricNormal);
    const Axis normal{frame.normal, frame.tangent, frame.bitangent};
    const Axis tangents[]{{frame.tangent, frame.bitangent, frame.normal},
                          {frame.bitangent, frame.normal, frame.tangent}};
    const Vec2 u = sampler.next2D(), picks = sampler.next2D();
    Choice choice(*this, exit, frame, picks.x);
    probe(exit.position, normal, u, choice);
    // The same numbers, moved on: a probe that is unlike the other.
    const Vec2 moved(wrapped(u.x + 0.5f), wrapped(u.y + 0.5f));
    probe(exit.position, tangents[picks.y < 0.5f ? 0 : 1], moved, choice);
    return choice.chosen();
}

}  // namespace sss
