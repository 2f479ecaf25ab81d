#pragma once
#include "sss/integrate/body_cloud.h"
#include "sss/integrate/entered_beams.h"
#include "sss/shape/diffusion_constants.h"
#include "sss/shape/source_cloud.h"

#include <vector>

namespace sss {

/// Where light that has entered a body scatters first, and what becomes of the rest. Powers are
/// those of irradiance x area, W m^-2 mm^2.
struct BeamSources {
    std::vector<VolumeSource> sources;
    DRgb entered{0};      ///< all light
    DRgb scattered{0};    ///< first collisions that scatter, in the reduced sense: all sources
    DRgb unscattered{0};  ///< leaves the body straight
};

/// Follows every beam from its point through the body, by reflection at the boundary too, to where
/// it leaves, and places sources along it (DepthRule). Light that crosses the body without a
/// collision is no source: it is seen by looking through the body. Parallel; deterministic.
BeamSources placeBeamSources(const World& world, int body, const BodyCloud::View& cloud,
                             const EnteredBeams& beams, const DiffusionConstants& medium);

}  // namespace sss
