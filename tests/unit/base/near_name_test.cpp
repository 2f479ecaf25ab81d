#include "sss/base/near_name.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace sss {
namespace {

constexpr std::array<std::string_view, 5> kKeys{"sigmaAPerMm", "sigmaSPerMm", "sigmaSPrimePerMm",
                                                "eta", "k"};

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
    EXPECT_EQ(editDistance("", ""), 0u);
    EXPECT_EQ(editDistance("", "abc"), 3u);
    EXPECT_EQ(editDistance("abc", ""), 3u);
    EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
    EXPECT_EQ(editDistance("radius", "raduis"), 1u);
    // Where Damerau-Levenshtein differs from the restricted (optimal string alignment) distance, 3.
    EXPECT_EQ(editDistance("ca", "abc"), 2u);
    EXPECT_EQ(editDistance("abc", "ca"), 2u);
}

TEST(NearestName, FindsSlipsWhateverTheCaseAndUnderscores) {
    EXPECT_EQ(nearestName("sigma_a_per_mm", kKeys), "sigmaAPerMm");
    EXPECT_EQ(nearestName("sigmaApermm", kKeys), "sigmaAPerMm");
    EXPECT_EQ(nearestName("sigma_s_prime", kKeys), "sigmaSPrimePerMm");
    EXPECT_EQ(nearestName("eat", kKeys), "eta");
    EXPECT_EQ(nearestName("K", kKeys), "k");
    EXPECT_EQ(nearestName("sig", kKeys), "sigmaAPerMm");  // cut short
}

TEST(NearestName, IsEmptyWhenNothingIsNear) {
    EXPECT_EQ(nearestName("roughness", kKeys), "");
    EXPECT_EQ(nearestName("x", kKeys), "");
    EXPECT_EQ(nearestName("", kKeys), "");
    EXPECT_EQ(nearestName("eta", {}), "");
    EXPECT_EQ(nearestName(std::string(1u << 20, 'e'), kKeys), "");
}

TEST(NearestName, TakesTheFirstOfEquallyNearOnes) {
    constexpr std::array<std::string_view, 2> kPair{"mesh1", "mesh2"};
    EXPECT_EQ(nearestName("mesh3", kPair), "mesh1");
}

TEST(NameHint, NamesTheNearestOrAll) {
    EXPECT_EQ(nameHint("etta", kKeys), "did you mean \"eta\"?");
    constexpr std::array<std::string_view, 2> kPair{"box", "tent"};
    EXPECT_EQ(nameHint("lanczos", kPair), "known: \"box\", \"tent\"");
}

TEST(InQuotes, KeepsAMessageOnOneShortLine) {
    EXPECT_EQ(inQuotes("a b"), "\"a b\"");
    EXPECT_EQ(inQuotes("a\n\x1b[0m"), "\"a\\u000a\\u001b[0m\"");
    EXPECT_EQ(inQuotes(std::string(100, 'x')), '"' + std::string(60, 'x') + "...\"");
    // Not cut within a character.
    EXPECT_EQ(inQuotes(std::string(59, 'x') + "\xC3\xA9y"),
              '"' + std::string(59, 'x') + "\xC3\xA9...\"");
}

}  // namespace
}  // namespace sss
