#include "sss/base/frame_list.h"

#include "sss/base/error.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

using Frames = std::vector<int>;

TEST(FrameList, NamesFramesAsFarmsDo) {
    const auto frames = [](const char* text) { return parseFrames(text, "--frames"); };
    EXPECT_EQ(frames("5"), Frames({5}));
    EXPECT_EQ(frames("1-4"), Frames({1, 2, 3, 4}));
    EXPECT_EQ(frames("1-10x4"), Frames({1, 5, 9}));
    EXPECT_EQ(frames("1-10y3"), Frames({2, 3, 5, 6, 8, 9}));
    EXPECT_EQ(frames("1-10:4"), Frames({1, 5, 9, 3, 7, 2, 4, 6, 8, 10}));
    EXPECT_EQ(frames("4-1x-1"), Frames({4, 3, 2, 1}));
    EXPECT_EQ(frames("10-1x-4"), Frames({10, 6, 2}));
    EXPECT_EQ(frames("1,5,9-12"), Frames({1, 5, 9, 10, 11, 12}));
    EXPECT_EQ(frames("-3--1"), Frames({-3, -2, -1}));
    EXPECT_EQ(frames("3,1-4"), Frames({3, 1, 2, 4}));  // each once, in the order written
    EXPECT_EQ(frames("7-7x9"), Frames({7}));
    EXPECT_EQ(frames("1-100x2").size(), 50u);
}

TEST(FrameList, RefusesWhatNamesNoFrames) {
    for (const char* text : {"",        ",",     "1,",   "a",      "1-",
                             "1-3x",    "1-3x0", "3-1",  "1-3x-1", "3-1x1",
                             "3-1y-1",  "1-3z2", "1.5",  "1 2",    "1-3x2x2",
                             "9999999", "+1",    "0x10", "1-1y1",  "1-999999,-999999-0"}) {
        SCOPED_TRACE(text);
        try {
            parseFrames(text, "--frames");
            FAIL() << "not refused";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage);
            EXPECT_EQ(error.where(), "--frames");
        }
    }
}

TEST(FrameName, PutsTheNumberInItsPlace) {
    EXPECT_EQ(frameName("a.####.exr", 7), "a.0007.exr");
    EXPECT_EQ(frameName("a.%04d.exr", 7), "a.0007.exr");
    EXPECT_EQ(frameName("a.%d.exr", 7), "a.7.exr");
    EXPECT_EQ(frameName("a.##.exr", 12345), "a.12345.exr");
    EXPECT_EQ(frameName("a.####.exr", -7), "a.-007.exr");
    EXPECT_EQ(frameName("##/####.exr", 3), "03/0003.exr");
    for (const char* plain : {"a.exr", "a#1.exr", "100%.exr", "50%half.exr", "%s", "%", ""}) {
        EXPECT_EQ(frameName(plain, 7), plain);
        EXPECT_FALSE(hasFrameField(plain)) << plain;
    }
    EXPECT_TRUE(hasFrameField("a.####.exr"));
    EXPECT_TRUE(hasFrameField("%03d"));
}

}  // namespace
}  // namespace sss
