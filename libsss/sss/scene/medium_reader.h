#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

namespace sss {

/// The keys of a translucent material that describe its medium; readMedium reads them together.
std::span<const Field<TranslucentMaterial>> mediumFields();

/// Fills the medium (mm^-1) from the one way in which `material` describes it: by measured name, by
/// coefficients, or by colour and mean free path. Needs the profile read before. Throws
/// Error{BadInput} if the keys mix ways or make none.
void readMedium(TranslucentMaterial& out, const Node& material);

}  // namespace sss
