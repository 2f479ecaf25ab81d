#pragma once
#include "sss/base/reporter.h"
#include "sss/image/film.h"
#include "sss/integrate/body_field.h"
#include "sss/integrate/path_tracer.h"

#include <span>

namespace sss {

struct RenderResult {
    LayeredImage image;
    PathCounts counts;
    Film::Dropped dropped;
};

/// The picture of `world` by the integrator that its quality block names; `fields` by body (null
/// where BodyOptics::inDiffuseLimit), or none if that needs none. Throws Error{BadInput} for what
/// the integrator refuses. Tiles are independent; the bytes depend on the scene, its seed and
/// sample count only.
RenderResult render(const World& world, std::span<const std::unique_ptr<BodyOptics>> optics,
                    std::span<const std::unique_ptr<BodyField>> fields, Reporter& reporter);

}  // namespace sss
