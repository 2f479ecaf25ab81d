#pragma once
#include "sss/scene/scene.h"

#include <string>
#include <string_view>

namespace sss {

/// "exact" or "polynomial". Throws Error{Usage} at `where` for another name.
BoundaryModel boundaryModel(std::string_view name, const std::string& where);

/// Gives every translucent material of the scene this boundary. Media that were made from a colour
/// keep the coefficients that they were given.
void setBoundary(Scene& scene, BoundaryModel boundary);

/// Gives all translucent materials of a scene another model of diffusion: a profile by its name, or
/// "shape" (diffusion on the body's own shape). Throws Error{Usage} for another name, and for a
/// slab's profile, which needs a thickness.
void setModel(Scene& scene, const std::string& name, const std::string& where);

}  // namespace sss
