#pragma once
#include "sss/world/world.h"

namespace sss {

/// Whether light that left a body may come to it again within the scene's bounces, so that pass 1
/// of the body depends on what it reflects itself. May say so without need: of shapes from files it
/// is not asked whether they are convex, nor of other objects whether they can see the body.
bool mayComeBack(const World& world, int body);

}  // namespace sss
