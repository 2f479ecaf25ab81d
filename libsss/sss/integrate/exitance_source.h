#pragma once
#include "sss/base/sampler.h"
#include "sss/world/world.h"

namespace sss {

struct PathCounts;

/// What multiple scattering sends out of bodies: each way to know it is one of these. Const and
/// thread-safe.
class ExitanceSource {
public:
    virtual ~ExitanceSource() = default;
    /// M at a place of a body, W m^-2, or an unbiased estimate of it, by the profile alone (not
    /// scaled); where it is known how light leans as it leaves, what M would be if all of it left
    /// as that which goes to `wo` (unit, world space). Of a body that is seen through
    /// (BodyOptics::seesThrough) it is what would leave if all lines of sight ended within: times
    /// the share of this one that does.
    virtual Rgb exitance(const SurfaceHit& hit, const Vec3& wo, Sampler& sampler,
                         PathCounts& counts) const = 0;
};

}  // namespace sss
