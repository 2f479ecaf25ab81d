#include "sss/image/exr_file.h"

#include "sss/base/error.h"
#include "sss/base/rng.h"
#include "support/full_disk.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

namespace sss {
namespace {

namespace fs = std::filesystem;

class ExrFile : public ::testing::Test {
protected:
    fs::path at(const char* name) const { return folder_ / name; }
    static std::string bytes(const fs::path& path) { return testing::readFile(path); }
    static void writeBytes(const fs::path& path, const std::string& content) {
        testing::writeFile(path, content);
    }
    /// The message of the Error that `read` throws; empty if there is none.
    static std::string refusal(const fs::path& path, ErrorKind kind = ErrorKind::BadInput) {
        try {
            readExr(path);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            return error.what();
        }
        return {};
    }
    testing::TemporaryFolder folder_;
};

std::vector<float> noise(std::size_t count, std::uint64_t seed) {
    Rng rng(seed);
    std::vector<float> values(count);
    for (float& value : values) value = rng.uniform() * 10 - 1;
    return values;
}

LayeredImage picture() {
    LayeredImage image{37, 21, {}, {}};
    const std::size_t n = image.pixelCount();
    image.layers = {{"", {"R", "G", "B", "A"}, noise(4 * n, 1), true},
                    {"diffusion", {"R", "G", "B"}, noise(3 * n, 2), true},
                    {"N", {"X", "Y", "Z"}, noise(3 * n, 3), true},
                    {"Z", {"Z"}, noise(n, 4), true}};
    image.metadata["sss/version"] = std::string("0.1.0");
    image.metadata["sss/metersPerUnit"] = 0.5;
    image.metadata["samplesPerPixel"] = 64;
    std::array<double, 16> matrix{};
    for (std::size_t i = 0; i < 16; ++i) matrix[i] = static_cast<double>(i) * 0.25;
    image.metadata["worldToCamera"] = matrix;
    return image;
}

const ImageLayer& layerOf(const LayeredImage& image, const std::string& name) {
    const ImageLayer* layer = image.find(name);
    EXPECT_NE(layer, nullptr) << name;
    static const ImageLayer kNone;
    return layer ? *layer : kNone;
}

TEST_F(ExrFile, FloatLayersAndMetadataComeBackExactly) {
    const LayeredImage image = picture();
    writeExr(at("a.exr"), image);
    const LayeredImage back = readExr(at("a.exr"));
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 21);
    ASSERT_EQ(back.layers.size(), image.layers.size());
    for (const ImageLayer& layer : image.layers) {
        const ImageLayer& read = layerOf(back, layer.name);
        EXPECT_EQ(read.channels, layer.channels);
        EXPECT_EQ(read.values, layer.values);
        EXPECT_TRUE(read.fullPrecision);
    }
    EXPECT_EQ(back.metadata, image.metadata);
}

TEST_F(ExrFile, HalfLayersRoundToElevenBits) {
    LayeredImage image = picture();
    for (ImageLayer& layer : image.layers) layer.fullPrecision = layer.name == "Z";
    writeExr(at("half.exr"), image);
    const LayeredImage back = readExr(at("half.exr"));
    EXPECT_FALSE(layerOf(back, "").fullPrecision);
    EXPECT_EQ(layerOf(back, "Z").values, layerOf(image, "Z").values);
    const auto& wrote = layerOf(image, "").values;
    const auto& read = layerOf(back, "").values;
    for (std::size_t i = 0; i < wrote.size(); ++i)
        ASSERT_NEAR(read[i], wrote[i], std::abs(wrote[i]) * 0x1p-11f + 1e-7f);

    writeExr(at("full.exr"), image, {.halfPrecision = false});
    EXPECT_EQ(layerOf(readExr(at("full.exr")), "").values, wrote);
}

TEST_F(ExrFile, ExtremesStayFinite) {
    const float infinity = std::numeric_limits<float>::infinity();
    LayeredImage image{4, 1, {}, {}};
    const std::vector<float> values{1e9f, -infinity, std::nanf(""), 65519.9f};
    image.layers = {{"", {"Y"}, values, false}, {"Z", {"Z"}, values, true}};
    writeExr(at("a.exr"), image);
    const LayeredImage back = readExr(at("a.exr"));
    EXPECT_EQ(layerOf(back, "").values, (std::vector<float>{65504, -65504, 0, 65504}));
    const float largest = std::numeric_limits<float>::max();
    EXPECT_EQ(layerOf(back, "Z").values, (std::vector<float>{1e9f, -largest, 0, 65519.9f}));
}

TEST_F(ExrFile, SameInputSameBytes) {
    writeExr(at("a.exr"), picture());
    writeExr(at("b.exr"), picture());
    EXPECT_EQ(bytes(at("a.exr")), bytes(at("b.exr")));
    EXPECT_NE(bytes(at("a.exr")).find("chromaticities"), std::string::npos);
    EXPECT_EQ(folder_.fileCount(), 2u);
}

TEST_F(ExrFile, UnwritablePlaceLeavesNothing) {
    EXPECT_THROW(writeExr(at("none") / "a.exr", picture()), Error);
    fs::create_directory(at("folder.exr"));
    EXPECT_THROW(writeExr(at("folder.exr"), picture()), Error);
    EXPECT_EQ(folder_.fileCount(), 1u);
}

TEST_F(ExrFile, AFullDiskIsAnErrorAndTheOldFileStays) {
    writeBytes(at("a.exr"), "old");
    std::string message;
    try {
        const testing::FullDisk disk(100);
        writeExr(at("a.exr"), picture());
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Io);
        message = error.what();
    }
    EXPECT_NE(message.find("a.exr: cannot write the picture: "), std::string::npos) << message;
    EXPECT_EQ(bytes(at("a.exr")), "old");
    EXPECT_EQ(folder_.fileCount(), 1u);
}

TEST_F(ExrFile, BadLayersAndNamesAreRefusedAndTheOldFileStays) {
    writeBytes(at("a.exr"), "old");
    LayeredImage wrongSize = picture();
    wrongSize.layers[1].values.pop_back();
    EXPECT_THROW(writeExr(at("a.exr"), wrongSize), Error);
    LayeredImage reserved = picture();
    reserved.metadata["dataWindow"] = 3;
    EXPECT_THROW(writeExr(at("a.exr"), reserved), Error);
    EXPECT_EQ(bytes(at("a.exr")), "old");
    EXPECT_EQ(folder_.fileCount(), 1u);
}

TEST_F(ExrFile, MissingAndForeignFilesAreNamed) {
    EXPECT_NE(refusal(at("none.exr"), ErrorKind::Io).find("none.exr: cannot open"),
              std::string::npos);
    refusal(folder_.path(), ErrorKind::Io);
    writeBytes(at("a.exr"), "P6 3 3 255 no EXR at all");
    EXPECT_NE(refusal(at("a.exr")).find("not an OpenEXR picture"), std::string::npos);
    writeBytes(at("b.exr"), "");
    EXPECT_NE(refusal(at("b.exr")).find("not an OpenEXR picture"), std::string::npos);
}

TEST_F(ExrFile, TruncationAnywhereIsAnError) {
    writeExr(at("a.exr"), picture());
    const std::string whole = bytes(at("a.exr"));
    for (std::size_t size = 0; size < whole.size(); size += size < 1200 ? 16 : 509) {
        writeBytes(at("cut.exr"), whole.substr(0, size));
        EXPECT_FALSE(refusal(at("cut.exr")).empty()) << size << " of " << whole.size();
    }
    writeBytes(at("cut.exr"), whole.substr(0, whole.size() - 1));
    EXPECT_NE(refusal(at("cut.exr")).find("cut.exr"), std::string::npos);
}

TEST_F(ExrFile, AbsurdSizesAreRefusedBeforeAllocation) {
    writeExr(at("a.exr"), picture());
    const std::string whole = bytes(at("a.exr"));
    // "dataWindow", its type "box2i", its size 16, then xMin yMin xMax yMax.
    const std::size_t window = whole.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
    const std::pair<std::int32_t, const char*> sides[] = {
        {99999, "states 100000 x 100000 pixels with 11 channels, more than is read here"},
        {1999999999, "states 2000000000 x 2000000000 pixels with 11 channels, more than is read"},
        {7999, "states 8000 x 8000 pixels with 11 channels in only"},
        {-5, "states -4 x -4 pixels"}};
    for (const auto& [side, words] : sides) {
        std::string damaged = whole;
        std::memcpy(&damaged[window + 8], &side, 4);
        std::memcpy(&damaged[window + 12], &side, 4);
        writeBytes(at("absurd.exr"), damaged);
        const std::string message = refusal(at("absurd.exr"));
        EXPECT_NE(message.find(words), std::string::npos) << message;
    }
}

TEST_F(ExrFile, WhatOpenExrAndWeDoNotReadIsNamed) {
    LayeredImage image{4, 4, {}, {}};
    image.layers = {{"", {"Y"}, std::vector<float>(16, 1.0f), true}};
    writeExr(at("a.exr"), image);
    const std::string whole = bytes(at("a.exr"));
    const auto expectWords = [&](const std::string& damaged, const char* words) {
        writeBytes(at("b.exr"), damaged);
        const std::string message = refusal(at("b.exr"));
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    // A channel is its name, its type, four bytes of no concern and how it is sampled in x and y.
    std::string subsampled = whole;
    const std::size_t channel = whole.find(std::string("chlist\0", 7)) + 7 + 4 + 2;
    subsampled[channel + 8] = subsampled[channel + 12] = 2;
    expectWords(subsampled, "b.exr: channel Y is subsampled; save it as plain RGB");
    std::string damaged = whole;
    damaged.back() = static_cast<char>(damaged.back() ^ 0x10);  // the checksum of its only block
    expectWords(damaged, "b.exr: cannot be read as OpenEXR: ");
}

}  // namespace
}  // namespace sss
