#pragma once
#include "sss/cloud/octree.h"

#include <span>

namespace sss {

/// Whether a cloud and its octree, come from a file, can be summed over without harm: the nodes
/// stand breadth first, each the child of exactly one before it, so that no walk is longer than the
/// tree; its leaves hold as many points as there are, all in bounds; every number is finite, every
/// area and flux at least 0, every place within 1e18 mm. Parallel; O(points + nodes), at memory
/// speed.
bool isSound(const CloudView& cloud, std::span<const OctreeNode> nodes);

}  // namespace sss
