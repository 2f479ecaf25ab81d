#include "sss/image/png_file.h"

#include "sss/base/error.h"
#include "sss/base/rng.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace sss {
namespace {

class PngFile : public ::testing::Test {
protected:
    testing::TemporaryFolder folder_;
};

Picture8 noise(int channels) {
    Picture8 picture{13, 7, channels, {}};
    picture.values.resize(static_cast<std::size_t>(13 * 7 * channels));
    Rng rng(5);
    for (std::uint8_t& value : picture.values) value = static_cast<std::uint8_t>(rng.next32());
    return picture;
}

TEST_F(PngFile, ComesBackExactly) {
    for (const int channels : {3, 4}) {
        const Picture8 picture = noise(channels);
        writePng(folder_ / "a.png", picture);
        const Picture8 back = readPng(folder_ / "a.png");
        EXPECT_EQ(back.width, 13);
        EXPECT_EQ(back.height, 7);
        EXPECT_EQ(back.channels, channels);
        EXPECT_EQ(back.values, picture.values);
    }
}

TEST_F(PngFile, FailureLeavesNothing) {
    EXPECT_THROW(writePng(folder_.path() / "none" / "a.png", noise(3)), Error);
    Picture8 wrong = noise(3);
    wrong.values.pop_back();
    EXPECT_THROW(writePng(folder_ / "a.png", wrong), Error);
    // Wider than libpng writes, which says so itself.
    constexpr int kTooWide = 1000001;
    try {
        writePng(folder_ / "a.png", {kTooWide, 1, 3, std::vector<std::uint8_t>(3 * kTooWide)});
        FAIL() << "written";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("a.png: cannot encode: "), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(folder_.fileCount(), 0u);
}

// Of a chunk's type and data.
std::uint32_t crcOf(std::string_view bytes) {
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes) {
        crc ^= static_cast<std::uint8_t>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

void putBigEndian(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

TEST_F(PngFile, DamageIsAnError) {
    const auto expectWords = [&](const std::string& bytes, const std::string& words) {
        testing::writeFile(folder_ / "bad.png", bytes);
        try {
            readPng(folder_ / "bad.png");
            ADD_FAILURE() << "accepted where it should have said: " << words;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
            EXPECT_NE(std::string(error.what()).find("bad.png: " + words), std::string::npos)
                << error.what();
        }
    };
    EXPECT_THROW(readPng(folder_ / "none.png"), Error);
    writePng(folder_ / "a.png", noise(3));
    const std::string whole = testing::readFile(folder_ / "a.png");
    expectWords("", "cannot be read as PNG: ");
    expectWords(whole.substr(0, 9), "cannot be read as PNG: ");
    expectWords(whole.substr(0, whole.size() / 2), "is damaged: ");
    // The signature, the header's length and type, then width and height; its checksum follows.
    std::string absurd = whole;
    putBigEndian(absurd, 16, 100000);
    putBigEndian(absurd, 20, 100000);
    putBigEndian(absurd, 29, crcOf(std::string_view(absurd).substr(12, 17)));
    expectWords(absurd, "states 100000 x 100000 pixels, too many");
}

TEST_F(PngFile, AnyDamageShows) {
    EXPECT_FALSE(isWholePng(folder_ / "none.png"));
    EXPECT_FALSE(isWholePng(folder_.path()));
    writePng(folder_ / "noise.png", noise(4));
    EXPECT_TRUE(isWholePng(folder_ / "noise.png"));
    writePng(folder_ / "a.png", {2, 1, 3, {1, 2, 3, 4, 5, 6}});
    EXPECT_TRUE(isWholePng(folder_ / "a.png"));
    const std::string whole = testing::readFile(folder_ / "a.png");
    const auto isWhole = [&](const std::string& bytes) {
        testing::writeFile(folder_ / "b.png", bytes);
        return isWholePng(folder_ / "b.png");
    };
    EXPECT_FALSE(isWhole(whole + '\0'));
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_FALSE(isWhole(whole.substr(0, i))) << i << " bytes";
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 1 << i % 8);
        EXPECT_FALSE(isWhole(damaged)) << "byte " << i;
    }
}

}  // namespace
}  // namespace sss
