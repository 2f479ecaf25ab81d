#include "sss/integrate/volume_path.h"

#include "sss/integrate/arriving_light.h"
#include "sss/integrate/smooth_boundary.h"
#include "sss/integrate/volume_lobes.h"
#include "sss/optics/phase.h"

#include <algorithm>

namespace sss {
namespace {

// A path whose weight falls below this is continued by chance, at twice this weight.
constexpr float kRouletteWeight = 0.25f;
// More events than any path needs: a guard against one that light cannot leave.
constexpr int kMostEvents = 1 << 24;

int pickChannel(float u) { return std::min(2, static_cast<int>(u * 3.0f)); }

}  // namespace

VolumePath::VolumePath(const World& world, std::span<const BodyMedium> media, Sampler& sampler,
                       PathCounts& counts)
    : world_(world),
      media_(media),
      sampler_(sampler),
      counts_(counts),
      weight_(pickChannel(sampler.next1D())) {}

void VolumePath::follow(const Ray& ray, FilmSample& sample) {
    sample_ = &sample;
    ray_ = ray;
    start_ = ray.origin;
    for (int event = 0; event < kMostEvents; ++event)
        if (!(isInside() ? throughMedium() : throughSpace())) return;
    ++counts_.lost;
}

const TranslucentMaterial& VolumePath::firstMaterial() const {
    return world_.materialOf(world_.bodies()[static_cast<std::size_t>(firstBody_)]);
}

bool VolumePath::reflects(int body) const {
    return world_.materialOf(world_.bodies()[static_cast<std::size_t>(body)]).surfaceReflection;
}

// A body without single scattering shows all that is scattered as diffusion, as by its profile.
VolumePath::Layer VolumePath::scatteredLayer() const {
    if (firstBody_ < 0 || scatterings_ == 0) return Layer::Surface;
    return scatterings_ == 1 && firstMaterial().singleScattering ? Layer::Single : Layer::Diffusion;
}

void VolumePath::add(const Rgb& radiance) {
    if (isZero(radiance)) return;
    const Rgb weighted = radiance * weight_.value();
    switch (layer_ == Layer::Undecided ? scatteredLayer() : layer_) {
        case Layer::Single:
            sample_->single += weighted;
            return;
        case Layer::Diffusion:
            if (firstMaterial().multipleScattering) sample_->diffusion += weighted;
            return;
        case Layer::Surface:
        case Layer::Undecided:
            sample_->surface += weighted;
            return;
    }
}

void VolumePath::startFrom(const Vec3& place, const Vec3& origin, Vec3 direction) {
    start_ = place;
    ray_ = Ray{};
    ray_.origin = origin;
    ray_.direction = direction;
}

bool VolumePath::throughSpace() {
    Hit found;
    ++counts_.rays;
    const bool isHit = world_.rays().intersect(ray_, found);
    const float distance = isHit ? found.t : std::numeric_limits<float>::infinity();
    add(radianceOfLights(world_, ray_, distance, origin_));
    if (world_.hasVolumes()) {
        ++counts_.volumeStretches;
        const VolumeSegment volumes = world_.volumesAlong(ray_, distance);
        add(radianceOfVolumes(world_, volumes, ray_, origin_));
        const float collision = volumes.sampleCollision(weight_.hero(), sampler_.next1D());
        if (std::isfinite(collision)) return scatterInVolumes(volumes, collision);
        const Rgb passed = exponential(volumes.depth()[weight_.hero()] - volumes.depth());
        weight_.choose(passed, passed);
    }
    if (!isHit) return false;
    const SurfaceHit hit = world_.surfaceAt(found);
    if (hit.body >= 0) return cross(hit);
    add(radianceOfEmitter(world_, ray_, hit, origin_));
    if (opaqueArrivals_++ > world_.scene().quality.bounces) return false;
    return reflectOpaque(hit);
}

bool VolumePath::scatterInVolumes(const VolumeSegment& segment, float distanceMm) {
    const Rgb depth = segment.depthTo(distanceMm);
    const Rgb reached = exponential(depth[weight_.hero()] - depth);
    weight_.choose(reached, segment.sigmaT(distanceMm) * reached);
    const VolumeLobes lobes(segment, distanceMm);
    const float uPick = sampler_.next1D(), uLobe = sampler_.next1D();
    const Vec2 uLight = sampler_.next2D(), uPhase = sampler_.next2D();
    if (lobes.isEmpty(weight_.hero())) return false;
    ++counts_.scatterings;
    settle(Layer::Surface);
    const Vec3 along = ray_.direction, place = ray_.at(distanceMm);
    const DirectSample direct = sampleDirect(world_, place, uPick, uLight);
    if (direct.pdf > 0) {
        const float cosine = glm::dot(along, direct.direction);
        const float weight = direct.isDelta ? 1.0f : powerHeuristic(direct.pdf, lobes.pdf(cosine));
        add(lobes.value(cosine) * direct.radianceOverPdf * weight *
            transmittedShare(world_, media_, {place, -1}, direct, counts_.rays));
    }
    startFrom(place, place, lobes.sample(along, uLobe, uPhase, weight_.hero()));
    const float cosine = glm::dot(along, ray_.direction);
    const Rgb density(lobes.pdf(cosine, 0), lobes.pdf(cosine, 1), lobes.pdf(cosine, 2));
    if (!(density[weight_.hero()] > 0)) return false;
    weight_.choose(lobes.value(cosine), density);
    origin_ = {place, lobes.pdf(cosine)};
    return survives();
}

// The nearest opaque surface, or place where the ray leaves the body, within the ray's reach.
bool VolumePath::intersectInside(SurfaceHit& hit) {
    const float reach = ray_.tMax;
    Hit found;
    while (++counts_.rays, world_.rays().intersect(ray_, found, bodyMask(body_) | 1u)) {
        hit = world_.surfaceAt(found);
        const bool isOwn = hit.body == body_;
        const float cosine = glm::dot(hit.geometricNormal, ray_.direction);
        if (hit.body < 0 || (isOwn && cosine > 0)) return true;
        // Another body inside this one, or a place that rounding had put just outside.
        if (isOwn) ++counts_.leaks;
        ray_.origin = world_.leave(hit, cosine > 0 ? hit.geometricNormal : -hit.geometricNormal);
        ray_.tMax = reach - glm::distance(start_, ray_.origin);
        if (!(ray_.tMax > 0)) return false;
    }
    return false;
}

bool VolumePath::throughMedium() {
    const MediumCoefficients& medium = mediumOf(body_).medium;
    const float distance = sampleFreePath(medium, weight_.hero(), sampler_.next1D());
    ray_.tMax = distance;
    SurfaceHit hit;
    if (!intersectInside(hit)) return std::isfinite(distance) ? collideAfter(distance) : leak();
    passThrough(medium, glm::distance(start_, hit.position), weight_);
    if (hit.body >= 0) return cross(hit);
    add(radianceOfEmitter(world_, ray_, hit, origin_));
    return reflectOpaque(hit);
}

// No way out: through a crack, or from a place that rounding had put just outside. Rare enough that
// it does not matter how the path goes on, as long as it does.
bool VolumePath::leak() {
    ++counts_.leaks;
    settle(scatteredLayer());
    body_ = -1;
    ray_.tMax = std::numeric_limits<float>::infinity();
    return true;
}

bool VolumePath::collideAfter(float distanceMm) {
    const BodyMedium& inside = mediumOf(body_);
    const MediumCoefficients& medium = inside.medium;
    const Vec3 along = ray_.direction, place = start_ + along * distanceMm;
    if (glm::distance(place, inside.centre) > inside.radius) return leak();
    collide(medium, distanceMm, weight_);
    ++scatterings_;
    ++counts_.scatterings;
    startFrom(place, place, along);
    if (inside.eta == 1.0f) lightScattered(medium);
    ray_.direction = scatter(medium, along, sampler_.next2D(), weight_);
    origin_ = {};
    if (inside.eta == 1.0f)
        origin_ = {place,
                   henyeyGreenstein(glm::dot(along, ray_.direction), meanComponent(medium.g))};
    return survives();
}

// Light sampling at the place just reached, weighted against the phase function of the mean g:
// any weights do that both techniques agree on.
void VolumePath::lightScattered(const MediumCoefficients& medium) {
    const float uPick = sampler_.next1D();
    const DirectSample direct = sampleDirect(world_, start_, uPick, sampler_.next2D());
    if (!(direct.pdf > 0)) return;
    const Rgb share = transmittedShare(world_, media_, {start_, body_}, direct, counts_.rays);
    if (isZero(share)) return;
    const float cosTheta = glm::dot(ray_.direction, direct.direction);
    const float weight =
        direct.isDelta
            ? 1.0f
            : powerHeuristic(direct.pdf, henyeyGreenstein(cosTheta, meanComponent(medium.g)));
    add(phaseBetween(medium, ray_.direction, direct.direction) * share * direct.radianceOverPdf *
        weight);
}

bool VolumePath::cross(const SurfaceHit& hit) {
    const float eta = mediumOf(hit.body).eta;
    if (firstBody_ < 0) firstBody_ = hit.body;
    const bool wasInside = glm::dot(hit.geometricNormal, ray_.direction) > 0;
    if (eta == 1.0f) {
        if (wasInside) settle(scatteredLayer());
        body_ = wasInside ? -1 : hit.body;
        const Vec3 side = wasInside ? hit.geometricNormal : -hit.geometricNormal;
        startFrom(hit.position, world_.leave(hit, side), ray_.direction);
        return true;  // straight on, and light sampling knows the way
    }
    const Ggx& ggx = mediumOf(hit.body).boundary;
    BoundaryEvent event;
    if (ggx.isSpecular()) {
        event = sampleBoundary(hit, ray_.direction, eta, sampler_.next1D());
    } else {
        const RoughBoundary boundary(hit, ray_.direction, eta, ggx);
        if (mediumOf(hit.body).samplesLights) lightAtBoundary(hit, boundary);
        event = boundary.sample(sampler_);
    }
    if (event.isReflected && !wasInside) {
        settle(Layer::Surface);
        if (!reflects(hit.body)) return false;
    } else if (!event.isReflected) {
        // Radiance over eta^2 is what refraction keeps.
        weight_.scale(wasInside ? eta * eta : 1.0f / (eta * eta));
        if (wasInside) settle(scatteredLayer());
    }
    body_ = event.isInside ? hit.body : -1;
    origin_ = {};
    startFrom(hit.position, world_.leave(hit, event.side), event.direction);
    return true;
}

// Lights without size, which no path meets: all of them, and no others, are left to this.
void VolumePath::lightAtBoundary(const SurfaceHit& hit, const RoughBoundary& boundary) {
    const bool wasInside = glm::dot(hit.geometricNormal, ray_.direction) > 0;
    const Vec3 from = world_.leave(hit, hit.geometricNormal);
    const float uPick = sampler_.next1D();
    const DirectSample direct = sampleDirect(world_, from, uPick, sampler_.next2D());
    if (!direct.isDelta || !(direct.pdf > 0)) return;
    if (!(glm::dot(hit.geometricNormal, direct.direction) > 0)) return;
    if (!wasInside && !reflects(hit.body)) return;
    const float density = boundary.density(direct.direction, sampler_);
    if (!(density > 0)) return;
    const float eta = mediumOf(hit.body).eta;
    add(density * (wasInside ? eta * eta : 1.0f) * direct.radianceOverPdf *
        transmittedShare(world_, media_, {from, -1}, direct, counts_.rays));
}

bool VolumePath::reflectOpaque(const SurfaceHit& hit) {
    if (!isInside()) settle(Layer::Surface);
    const Bsdf bsdf(world_, hit, -ray_.direction, nullptr, Bsdf::BodyShading::Surface);
    if (bsdf.isBlack()) return false;
    const Vec3 from = world_.leave(hit, bsdf.geometricNormal());
    const float uPick = sampler_.next1D();
    const Vec2 uLight = sampler_.next2D(), uScatter = sampler_.next2D();
    if (bsdf.hasSmoothPart()) {
        const DirectSample direct = sampleDirect(world_, from, uPick, uLight);
        const auto [value, pdf] = direct.pdf > 0 ? bsdf.evaluate(direct.direction) : Bsdf::Value{};
        if (!isZero(value)) {
            const float weight = direct.isDelta ? 1.0f : powerHeuristic(direct.pdf, pdf);
            add(value * direct.radianceOverPdf * weight *
                transmittedShare(world_, media_, {from, body_}, direct, counts_.rays));
        }
    }
    const Bsdf::Sample next = bsdf.sample(uScatter);
    if (!(next.pdf > 0) || isZero(next.weight)) return false;
    weight_.scale(next.weight);
    startFrom(hit.position, from, next.wi);
    origin_ = next.isDelta ? ScatterOrigin{} : ScatterOrigin{from, next.pdf};
    return survives();
}

bool VolumePath::survives() {
    // Inside, weights are by 1/eta^2 smaller only until the path leaves.
    const float scale = isInside() ? mediumOf(body_).eta * mediumOf(body_).eta : 1.0f;
    const float weight = maxComponent(weight_.value()) * scale;
    if (weight >= kRouletteWeight) return true;
    const float survival = weight / (2 * kRouletteWeight);
    if (!(sampler_.next1D() < survival)) return false;
    weight_.scale(1.0f / survival);
    return true;
}

}  // namespace sss
