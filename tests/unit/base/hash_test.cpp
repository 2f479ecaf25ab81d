#include "sss/base/hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace sss {
namespace {

TEST(Hasher, SizesAreHashedWithTheContents) {
    EXPECT_NE(Hasher().add("ab").add("c").finish(), Hasher().add("a").add("bc").finish());
    EXPECT_NE(Hasher().add("").add("a").finish(), Hasher().add("a").add("").finish());
    EXPECT_NE(Hasher().finish(), Hasher().add("").finish());
}

TEST(Hasher, OrderAndEveryValueCount) {
    EXPECT_NE(Hasher().add(1.0).add(2.0).finish(), Hasher().add(2.0).add(1.0).finish());
    EXPECT_NE(Hasher().add(1.0).finish(), Hasher().add(std::nextafter(1.0, 2.0)).finish());
    EXPECT_NE(Hasher().add(std::uint64_t{1}).finish(), Hasher().add(1.0).finish());
    EXPECT_EQ(Hasher().add(1.0).add("x").finish(), Hasher().add(1.0).add("x").finish());
}

TEST(Hasher, ZerosOfBothSignsAreOneNumber) {
    EXPECT_EQ(Hasher().add(0.0).finish(), Hasher().add(-0.0).finish());
}

TEST(Hasher, FingerprintsNest) {
    const Fingerprint inner = Hasher().add("mesh").finish();
    EXPECT_EQ(Hasher().add(inner).finish(), Hasher().add(inner).finish());
    EXPECT_NE(Hasher().add(inner).finish(), Hasher().add(Fingerprint{inner.hi, inner.lo}).finish());
}

TEST(Hasher, NoCollisionsAmongNeighbours) {
    std::set<std::string> seen;
    for (std::uint64_t i = 0; i < 10'000; ++i) seen.insert(Hasher().add(i).finish().hex());
    EXPECT_EQ(seen.size(), 10'000u);
}

TEST(Hasher, SpansAreTheirBytes) {
    const std::vector<std::uint32_t> values{1, 2, 3};
    const std::vector<std::uint32_t> same{1, 2, 3};
    EXPECT_EQ(Hasher().add(std::span(values)).finish(), Hasher().add(std::span(same)).finish());
    EXPECT_NE(Hasher().add(std::span(values)).finish(),
              Hasher().add(std::span(values).first(2)).finish());
}

TEST(Fingerprint, HexIsHighThenLow) {
    EXPECT_EQ((Fingerprint{0x1, 0xabcdef0123456789}).hex(), "abcdef01234567890000000000000001");
}

// Values of the reference implementation, xxHash's own sanity test vectors: files must stay
// readable for ever, on any machine.
TEST(Checksum, MatchesPublishedXxh3Vectors) {
    EXPECT_EQ(checksum({}), 0x2D06800538D394C2ull);
    std::vector<std::byte> buffer;
    std::uint64_t generator = 2654435761u;
    for (int i = 0; i < 222; ++i) {
        buffer.push_back(static_cast<std::byte>(generator >> 56));
        generator *= 11400714785074694797ull;
    }
    const std::span<const std::byte> bytes(buffer);
    EXPECT_EQ(checksum(bytes.first(1)), 0xC44BDFF4074EECDBull);
    EXPECT_EQ(checksum(bytes.first(6)), 0x27B56A84CD2D7325ull);
    EXPECT_EQ(checksum(bytes.first(12)), 0xA713DAF0DFBB77E7ull);
    EXPECT_EQ(checksum(bytes.first(24)), 0xA3FE70BF9D3510EBull);
    EXPECT_EQ(checksum(bytes.first(48)), 0x397DA259ECBA1F11ull);
    EXPECT_EQ(checksum(bytes.first(80)), 0xBCDEFBBB2C47C90Aull);
    EXPECT_EQ(checksum(bytes.first(195)), 0xCD94217EE362EC3Aull);
}

}  // namespace
}  // namespace sss
