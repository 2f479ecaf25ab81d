#pragma once
#include "sss/base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Receivers that lie close together: a run of the tree's order, and the sphere that holds them.
struct ReceiverCell {
    Vec3 centre{};
    float radius = 0;
    std::uint32_t begin = 0, end = 0;
    std::uint32_t child = 0;  ///< index of the first of two children; 0 = a leaf

    bool isLeaf() const { return child == 0; }
    std::uint32_t size() const { return end - begin; }
};

/// The binary tree of a group of receivers, halved along the longest axis down to leaves of at most
/// `most` receivers within `mostRadius`, or of one; the root is cell 0. `order` becomes the
/// receivers' indices, leaf after leaf. A function of the positions only. No receivers give no
/// cells. O(n log n).
void buildReceiverTree(std::span<const Vec3> receivers, std::uint32_t most, float mostRadius,
                       std::vector<ReceiverCell>& cells, std::vector<std::uint32_t>& order);

}  // namespace sss
