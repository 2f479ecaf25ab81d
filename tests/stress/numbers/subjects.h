#pragma once
#include "numbers/report.h"

namespace sss::stress {

// One subject a file. Each adds its rows; none throws.

/// Boundaries and phase functions over all indices, angles and anisotropies.
void stressOptics(Report& report, Scope scope);
/// Profiles over all media: finite, not negative, no more than comes in, scale-free, and the
/// dipole against its formula in extended precision.
void stressMedia(Report& report, Scope scope);
/// The octree and the sum over it: degenerate, dark, huge and tiny clouds.
void stressSums(Report& report, Scope scope);
/// Points on surfaces: needles, single triangles, coarse against fine.
void stressSurfaces(Report& report, Scope scope);
/// Whole passes: far from the origin, at any size, lit by almost nothing and by far too much.
void stressScenes(Report& report, Scope scope);
/// Caches cut short, damaged, and written by a liar.
void stressCaches(Report& report, Scope scope);
/// Folders of stages with one of the files damaged.
void stressStages(Report& report, Scope scope);
/// Pass 1 with one of its allocations failing.
void stressAllocations(Report& report, Scope scope);
/// Every input that tests/stress/corpus holds, as the fuzzers feed it.
void stressCorpus(Report& report, Scope scope);

/// Many more, made from those, the same in every run.
void stressMutations(Report& report, Scope scope);

}  // namespace sss::stress
