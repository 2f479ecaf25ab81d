#pragma once
#include "sss/scene/node.h"

namespace sss {

/// Checks that something at `from` that looks at `to` has a view: the two points differ, and `up`
/// is not along the line between them. An `up` that the file does not give is turned to +z where
/// the view runs along +-y, so that a camera or lamp that looks straight down needs no `up`.
/// Throws Error{BadInput} naming the key ("position" or "centre") of `from`.
void checkView(const Node& object, std::string_view fromKey, const DVec3& from, const DVec3& to,
               DVec3& up);

}  // namespace sss
