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

/// Whether `name` is "shape"; "profile" is the other. Throws Error{Usage}, saying where it stands.
bool diffusionOnShape(std::string_view name, const std::string& where);

/// Makes all translucent materials of a scene have their diffusion solved on the shape, or not.
void setDiffusion(Scene& scene, bool onShape);

}  // namespace sss
