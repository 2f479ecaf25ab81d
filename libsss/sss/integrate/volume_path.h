#pragma once
#include "sss/image/film.h"
#include "sss/integrate/path_tracer.h"
#include "sss/integrate/rough_boundary.h"
#include "sss/integrate/spectral_weight.h"
#include "sss/integrate/transmitted_light.h"

#include <span>

namespace sss {

/// One path of the radiative transfer, from the camera on: free paths and Henyey-Greenstein
/// scattering inside bodies and in volumes, reflection or refraction at the boundaries of bodies,
/// BSDFs on opaque surfaces. Lights are found where the path meets them and, from everything that
/// scatters and is not sealed by a refracting boundary, by light sampling as well; lights without
/// size also from rough boundaries. Bodies and
/// volumes are entered any number of times: where little is left of a path, chance decides whether
/// it ends. The scene's `bounces` limits reflections by opaque surfaces only.
class VolumePath {
public:
    /// All outlive the path. `media` by body.
    VolumePath(const World& world, std::span<const BodyMedium> media, Sampler& sampler,
               PathCounts& counts);

    /// Follows the path to its end and adds its radiance to the layers of `sample`: what has been
    /// scattered inside the first body met, once or more often, before it leaves that body, to
    /// `single` and `diffusion`; everything else to `surface`.
    void follow(const Ray& ray, FilmSample& sample);

private:
    enum class Layer { Undecided, Surface, Single, Diffusion };

    bool throughSpace();
    bool scatterInVolumes(const VolumeSegment& segment, float distanceMm);
    bool throughMedium();
    bool intersectInside(SurfaceHit& hit);
    bool collideAfter(float distanceMm);
    bool leak();
    bool cross(const SurfaceHit& hit);
    void lightAtBoundary(const SurfaceHit& hit, const RoughBoundary& boundary);
    bool reflectOpaque(const SurfaceHit& hit);
    void lightScattered(const MediumCoefficients& medium);
    bool survives();

    bool isInside() const { return body_ >= 0; }
    const BodyMedium& mediumOf(int body) const { return media_[static_cast<std::size_t>(body)]; }
    const TranslucentMaterial& firstMaterial() const;
    bool reflects(int body) const;
    Layer scatteredLayer() const;
    void settle(Layer layer) {
        if (layer_ == Layer::Undecided) layer_ = layer;
    }
    /// `radiance` arrives along the path, but for its weight.
    void add(const Rgb& radiance);
    void startFrom(const Vec3& place, const Vec3& origin, Vec3 direction);

    const World& world_;
    std::span<const BodyMedium> media_;
    Sampler& sampler_;
    PathCounts& counts_;
    FilmSample* sample_ = nullptr;

    SpectralWeight weight_;
    Ray ray_;
    Vec3 start_{};  // where the ray's segment begins, without the step off the surface
    ScatterOrigin origin_;
    int body_ = -1;           // whose medium the path is in
    int firstBody_ = -1;      // that the path entered
    int opaqueArrivals_ = 0;  // from outside of bodies
    int scatterings_ = 0;
    Layer layer_ = Layer::Undecided;
};

}  // namespace sss
