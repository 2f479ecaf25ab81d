#include "sss/base/inline_vector.h"

#include "sss/base/vec.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

TEST(InlineVector, HoldsWhatWasAddedInPlace) {
    InlineVector<DVec3, 4> list;
    EXPECT_EQ(list.size(), 0u);
    EXPECT_EQ(list.begin(), list.end());
    DVec3& first = list.add(1.0, 2.0, 3.0);
    list.add(4.0);
    EXPECT_EQ(&first, &list[0]);
    first.x = 7;
    double sum = 0;
    for (const DVec3& v : list) sum += v.x + v.y + v.z;
    EXPECT_EQ(sum, 7 + 2 + 3 + 12);
    EXPECT_EQ(list.span().size(), 2u);
    EXPECT_EQ(list.span()[1], DVec3(4.0));
}

struct Counted {
    explicit Counted(int& made) { ++made; }
    alignas(32) char room[32];
};

TEST(InlineVector, MakesOnlyWhatIsAdded) {
    int made = 0;
    InlineVector<Counted, 100> list;
    for (int i = 0; i < 3; ++i) list.add(made);
    EXPECT_EQ(made, 3);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(list.begin()) % 32, 0u);
}

}  // namespace
}  // namespace sss
