#pragma once
#include "sss/base/vec.h"

// Rotations carry rounding of some 1e-16 into what is meant to be free of them. Cut to multiples of
// a unit far below anything visible, the same thing is the same to the bit wherever it stands.
namespace sss {

/// To 2^-36 of the largest entry.
DMat3 withoutRounding(const DMat3& m);
/// To 2^-30 mm, or 2^-36 of the largest coordinate if that is more.
DVec3 withoutRounding(const DVec3& mm);

}  // namespace sss
