#pragma once
#include "sss/base/reporter.h"
#include "sss/scene/scene.h"
#include "sss/volume/volume.h"

#include <memory>

namespace sss {

/// Opens and places a volume, in the space of a world whose origin is at `originMm`. Throws
/// Error{Io, BadInput}: of its mesh, which must be closed, and of its grid.
std::unique_ptr<Volume> loadVolume(const VolumeSettings& settings, const Scene& scene,
                                   const DVec3& originMm, Reporter& reporter);

}  // namespace sss
