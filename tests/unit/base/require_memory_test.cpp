#include "sss/base/require_memory.h"

#include "sss/base/error.h"
#include "sss/base/memory.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

TEST(RequireMemory, SaysWhatIsNeededAndWhatThereIs) {
    const std::uint64_t limit = memoryLimitBytes();
    EXPECT_NO_THROW(requireMemory("here", "a thing", limit, "make it smaller"));
    try {
        requireMemory("here", "a thing", limit + 1, "make it smaller");
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Resource);
        const std::string words = error.what();
        EXPECT_EQ(words.find("here: a thing would need "), 0u) << words;
        EXPECT_NE(words.find(" GB of memory; there are "), std::string::npos) << words;
        EXPECT_NE(words.find("; make it smaller"), std::string::npos) << words;
    }
}

TEST(SaysOutOfMemory, KnowsTheWordsOfOtherLibraries) {
    for (const char* words : {"std::bad_alloc", "out of memory", "zlib: insufficient memory",
                              "pthread_create has failed: Resource temporarily unavailable"})
        EXPECT_TRUE(saysOutOfMemory(words)) << words;
    for (const char* words : {"", "bad chunk", "Resource temporarily unavailable"})
        EXPECT_FALSE(saysOutOfMemory(words)) << words;
}

}  // namespace
}  // namespace sss
