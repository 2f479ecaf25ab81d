#include "sss/cloud/receiver_clusters.h"

#include "sss/base/bounds.h"
#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sss {
namespace {

TEST(ReceiverClusters, HoldEveryReceiverOnceAndLieCloseTogether) {
    Rng rng(5);
    std::vector<Vec3> receivers;
    for (int i = 0; i < 64; ++i) receivers.emplace_back(rng.uniform(), rng.uniform(), 0.0f);
    std::vector<std::uint32_t> order;
    const std::vector<std::size_t> ends = clusterReceivers(receivers, 8, order);
    ASSERT_EQ(ends.size(), 8u);
    ASSERT_EQ(ends.back(), receivers.size());
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        ASSERT_GT(end, begin);
        ASSERT_LE(end - begin, 8u);
        Bounds box;
        for (std::size_t k = begin; k < end; ++k) box.add(receivers[order[k]]);
        EXPECT_LT(maxComponent(box.size()), 0.75f);  // of a unit square
        begin = end;
    }
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < receivers.size(); ++i) ASSERT_EQ(order[i], i);
}

TEST(ReceiverClusters, FewOrCoincidentReceivers) {
    std::vector<std::uint32_t> order;
    EXPECT_EQ(clusterReceivers(std::vector<Vec3>(3), 8, order), std::vector<std::size_t>{3});
    EXPECT_EQ(clusterReceivers(std::vector<Vec3>(40, Vec3(1)), 8, order).back(), 40u);
    EXPECT_EQ(order.size(), 40u);
}

}  // namespace
}  // namespace sss
