#pragma once
#include "sss/cloud/octree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Whether a cloud and its octree, come from a file, can be summed over without harm: the nodes
// stand breadth first, each the child of exactly one before it, so that no walk is longer than the
// tree; its leaves hold as many points as there are, all in bounds; every number is finite, every
// area and flux at least 0, every place within 1e18 mm. All of it can be told part by part, given
// what came before each part.
namespace sss {

/// What the nodes before a part of an octree hold.
struct NodesBefore {
    std::uint32_t children = 1;  ///< their children, and the root: where the next child is
    std::uint32_t points = 0;    ///< in their leaves
    bool operator==(const NodesBefore&) const = default;
};
static_assert(sizeof(NodesBefore) == 8);

/// By part of 2^shift nodes.
std::vector<NodesBefore> nodesBefore(std::span<const OctreeNode> nodes, unsigned shift);

/// How many there are of what nodes speak of.
struct OctreeSize {
    std::size_t nodes = 0, points = 0;
};
/// Whether such a list fits a tree of this size: all that is there is in it, and no part claims
/// what another does.
bool isSound(std::span<const NodesBefore> parts, const OctreeSize& size);
/// Whether the nodes from `first` on are sound; `before` and `after` are what comes before them,
/// and before those behind them.
bool isSound(std::span<const OctreeNode> nodes, std::size_t first, NodesBefore before,
             const NodesBefore& after, const OctreeSize& size);

bool areSound(std::span<const SurfacePoint> points);
bool areSound(std::span<const Rgb> irradiance);

}  // namespace sss
