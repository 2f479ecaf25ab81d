#pragma once
#include "sss/integrate/smooth_boundary.h"
#include "sss/optics/microsurface.h"

namespace sss {

/// A path that arrives at a body's rough boundary, from either side. Interpolated normals bend
/// light unless that would send it to the wrong side of the face; then the face's own normal does.
class RoughBoundary {
public:
    /// `along` arrives at `hit`; `eta` = inside / outside. `ggx` not specular.
    RoughBoundary(const SurfaceHit& hit, const Vec3& along, float eta, const Ggx& ggx);

    /// Where it goes on; its weight stays what it is, as at a smooth one.
    BoundaryEvent sample(Sampler& sampler) const;
    /// An estimate without bias of the density (sr^-1) of a direction in sample().
    float density(const Vec3& direction, Sampler& sampler) const;

private:
    Vec3 sampleAbout(const Frame& frame, Sampler& sampler) const;
    float densityAbout(const Frame& frame, const Vec3& direction, Sampler& sampler) const;
    /// Whether a direction told from a frame is on the side of the face where the frame has it.
    bool keepsSide(const Frame& frame, const Vec3& direction) const;

    Vec3 along_;
    bool fromInside_;
    Frame face_, shading_;  ///< against `along`
    bool isBent_;           ///< whether the two differ
    Microsurface surface_;
};

}  // namespace sss
