#pragma once
#include "arguments.h"
#include "sss/base/json.h"

namespace sss::bench {

/// The measurements, one a subject of the command line; tests/bench/README.md says what each figure
/// means. Times of sums are CPU seconds of one thread.

/// Clock and peak of the machine: frequency, single-precision multiply-adds.
JsonValue measureMachine(const Arguments& arguments);
/// What the camera sees of a body, by brute force over a converged cloud, for two seeds.
JsonValue makeReference(const Arguments& arguments);
/// A cache's errors against such a reference, and where they come from.
JsonValue measureFrame(const Arguments& arguments);
/// What the exitance that the camera sees costs, by the profile and by diffusion on the shape.
JsonValue measureExitance(const Arguments& arguments);
/// Cost of a receiver against the number of points.
JsonValue measureScaling(const Arguments& arguments);
/// Error over time of all methods that sum over the same points.
JsonValue measureHierarchy(const Arguments& arguments);
/// The same at the places that a picture sees, its own cloud against a denser one.
JsonValue measurePicture(const Arguments& arguments);

}  // namespace sss::bench
