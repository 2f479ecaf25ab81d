#include "sss/image/exr_header.h"

#include "sss/base/error.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

namespace sss {
namespace {

using testing::TemporaryFolder;
using testing::writeFile;

std::string number(std::uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value,
                      std::uint32_t statedMore = 0) {
    return name + '\0' + type + '\0' +
           number(static_cast<std::uint32_t>(value.size()) + statedMore) + value;
}

std::string channel(const std::string& name) { return name + '\0' + std::string(16, '\1'); }

std::string window(std::int32_t xMax, std::int32_t yMax) {
    return attribute("dataWindow", "box2i",
                     number(0) + number(0) + number(static_cast<std::uint32_t>(xMax)) +
                         number(static_cast<std::uint32_t>(yMax)));
}

const std::string kMagic = std::string("\x76\x2f\x31\x01") + number(2);
const std::string kParts = std::string("\x76\x2f\x31\x01") + number(2 | 0x1000);
const std::string kChannels =
    attribute("channels", "chlist", channel("B") + channel("G") + std::string(1, '\0'));
const std::string kEnd(1, '\0');

class ExrHeaderTest : public ::testing::Test {
protected:
    ExrHeader header(const std::string& bytes) {
        writeFile(folder_ / "a.exr", bytes);
        return checkExrHeaders(folder_ / "a.exr");
    }
    /// What is said of the bytes; empty if they are accepted.
    std::string refusal(const std::string& bytes) {
        try {
            header(bytes);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
            return error.what();
        }
        return {};
    }
    TemporaryFolder folder_;
};

TEST_F(ExrHeaderTest, TellsSizeAndChannelsOfTheFirstPart) {
    const std::string preview =
        attribute("preview", "preview", number(2) + number(3) + std::string(24, 'x'));
    const std::string texts =
        attribute("views", "stringvector", number(4) + "left" + number(5) + "right");
    const std::string first = texts + window(7, 4) + preview + kChannels + kEnd;
    const std::string second = window(99, 99) + kChannels + kEnd;
    for (const std::string& bytes : {kMagic + first, kParts + first + second + kEnd}) {
        const ExrHeader is = header(bytes);
        EXPECT_EQ(is.width, 8);
        EXPECT_EQ(is.height, 5);
        EXPECT_EQ(is.channels, 2u);
    }
}

TEST_F(ExrHeaderTest, RefusesWhatWouldBeAllocatedOrReadElsewhere) {
    const struct {
        std::string bytes, words;
    } cases[] = {
        {kMagic + attribute("x", "mine", "abc", 1u << 31) + window(1, 1) + kChannels + kEnd,
         "attribute \"x\" states 2147483651 bytes"},
        {kMagic + attribute("x", "float", "abcdefgh") + window(1, 1) + kChannels + kEnd,
         "attribute \"x\" of type float states 8 bytes"},
        {kMagic + attribute("preview", "preview", number(1u << 30) + number(1u << 30)) + kEnd,
         "damaged in its preview"},
        {kMagic + attribute("preview", "preview", "abc") + kEnd, "damaged in its preview"},
        {kMagic + attribute("texts", "stringvector", number(3) + "abcd") + kChannels + kEnd,
         "truncated in its header"},
        {kMagic + attribute("texts", "stringvector", number(5) + "abcd") + kChannels + kEnd,
         "damaged in a list of texts"},
        {kMagic + window(1, 1) + attribute("channels", "chlist", channel("B") + kEnd + "more") +
             kEnd,
         "damaged in its list of channels"},
        {kMagic + window(-2, 1) + kChannels + kEnd, "states -1 x 2 pixels"},
        {kMagic + window(1, 1) + attribute("channels", "chlist", kEnd) + kEnd, "holds no channels"},
        {kMagic + kChannels + kEnd, "has no data window"},
        {kMagic + window(1, 1) + kChannels, "truncated in its header"},
        {kMagic + std::string(300, 'n'), "a name in its header has no end"},
        {kParts + window(1, 1) + kChannels + kEnd + "half", "truncated in its header"},
    };
    for (const auto& wrong : cases) {
        const std::string said = refusal(wrong.bytes);
        EXPECT_NE(said.find(wrong.words), said.npos) << wrong.words << ": " << said;
    }
}

}  // namespace
}  // namespace sss
