#pragma once
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/transmitted_light.h"

#include <vector>

namespace sss {

/// Radiative transfer itself, by unidirectional path tracing (VolumePath): no diffusion, no cache,
/// any number of scatterings, of reflections inside, and of bodies on the way. Unbiased but for
/// rounding, and for light that opaque surfaces reflect more often than `bounces` allows; the judge
/// of all profiles. Its layers compare with those of the cached integrator, but for `single`, which
/// here follows light exactly, and has light that is reflected inside as well.
class VolumeIntegrator : public Integrator {
public:
    /// Throws Error{BadInput} for bodies that are open, and, where one has a smooth boundary that
    /// refracts, for lights without size: paths cannot find those behind it.
    explicit VolumeIntegrator(const IntegratorInput& input);
    FilmSample trace(const Ray& ray, Sampler& sampler, PathCounts& counts) const override;

private:
    const World& world_;
    std::span<const std::unique_ptr<BodyOptics>> optics_;
    std::vector<BodyMedium> media_;
};

}  // namespace sss
