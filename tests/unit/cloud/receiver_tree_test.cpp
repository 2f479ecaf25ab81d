#include "sss/cloud/receiver_tree.h"

#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sss {
namespace {

struct Tree {
    std::vector<ReceiverCell> cells;
    std::vector<std::uint32_t> order;
    Tree(std::span<const Vec3> receivers, std::uint32_t most, float mostRadius = 1e9f) {
        buildReceiverTree(receivers, most, mostRadius, cells, order);
    }
};

TEST(ReceiverTree, HoldsEveryReceiverOnceAndCellsAreSmall) {
    Rng rng(5);
    std::vector<Vec3> receivers;
    for (int i = 0; i < 64; ++i) receivers.emplace_back(rng.uniform(), rng.uniform(), 0.0f);
    Tree tree(receivers, 8);
    ASSERT_EQ(tree.cells.size(), 15u);  // 8 leaves
    EXPECT_EQ(tree.cells[0].size(), receivers.size());
    std::uint32_t leaves = 0;
    for (const ReceiverCell& cell : tree.cells) {
        for (std::uint32_t k = cell.begin; k < cell.end; ++k)
            EXPECT_LE(glm::length(receivers[tree.order[k]] - cell.centre), 1.00001f * cell.radius);
        if (cell.isLeaf()) {
            ++leaves;
            EXPECT_LE(cell.size(), 8u);
            EXPECT_LT(cell.radius, 0.5f);  // of a unit square
            continue;
        }
        const ReceiverCell &a = tree.cells[cell.child], &b = tree.cells[cell.child + 1];
        EXPECT_EQ(a.begin, cell.begin);
        EXPECT_EQ(a.end, b.begin);
        EXPECT_EQ(b.end, cell.end);
        EXPECT_LE(b.size() - a.size(), 1u);
    }
    EXPECT_EQ(leaves, 8u);
    std::sort(tree.order.begin(), tree.order.end());
    for (std::uint32_t i = 0; i < receivers.size(); ++i) ASSERT_EQ(tree.order[i], i);
}

TEST(ReceiverTree, LeavesAreSmallInSpaceToo) {
    const std::vector<Vec3> receivers{{0, 0, 0}, {0.1f, 0, 0}, {5, 0, 0}, {9, 0, 0}};
    int single = 0;
    for (const ReceiverCell& cell : Tree(receivers, 8, 0.2f).cells) {
        EXPECT_EQ(cell.isLeaf(), cell.radius <= 0.2f);
        single += cell.size() == 1;
    }
    EXPECT_EQ(single, 2);
}

TEST(ReceiverTree, FewOrCoincidentReceivers) {
    EXPECT_TRUE(Tree({}, 8).cells.empty());
    EXPECT_EQ(Tree(std::vector<Vec3>(3), 8).cells.size(), 1u);
    const Tree same(std::vector<Vec3>(40, Vec3(1)), 8);
    EXPECT_EQ(same.order.size(), 40u);
    for (const ReceiverCell& cell : same.cells) {
        EXPECT_EQ(cell.radius, 0.0f);
        EXPECT_EQ(cell.isLeaf(), cell.size() <= 8);
    }
}

}  // namespace
}  // namespace sss
