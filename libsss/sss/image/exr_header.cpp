#include "sss/image/exr_header.h"

#include "sss/base/error.h"

#include <fmt/core.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

namespace sss {
namespace {

constexpr std::uint32_t kMultiPart = 0x1000;  // bit of the version field
constexpr std::size_t kLongestName = 255;

/// Attributes whose size is their type's. OpenEXR takes that many bytes whatever the file states,
/// so that it would read all that follows from another place than we do.
struct TypeSize {
    std::string_view type;
    std::uint32_t bytes;
};
constexpr TypeSize kTypeSizes[] = {
    {"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33f", 36},    {"m33d", 72},
    {"m44f", 64},       {"m44d", 128},   {"rational", 8},
    {"timecode", 8},    {"tiledesc", 9}, {"v2i", 8},
    {"v2f", 8},         {"v2d", 16},     {"v3i", 12},
    {"v3f", 12},        {"v3d", 24},     {"deepImageState", 1},
};

/// "OpenEXR File Layout", sections "Header" and "Attribute Layout".
class HeaderWalk {
public:
    explicit HeaderWalk(const std::filesystem::path& path)
        : path_(path), file_(path, std::ios::binary) {
        if (!file_ || std::filesystem::is_directory(path))
            throw Error(ErrorKind::Io, path.string(), "cannot open the picture",
                        "check the path; it is relative to the scene file");
        left_ = std::filesystem::file_size(path);
    }

    ExrHeader run() {
        std::array<char, 4> magic{};
        if (left_ < 4 || !take(magic.data(), 4) ||
            std::string_view(magic.data(), 4) != "\x76\x2f\x31\x01")
            refuse("is not an OpenEXR picture", "convert it to OpenEXR");
        const bool hasParts = (number() & kMultiPart) != 0;
        ExrHeader first;
        oneHeader(first);
        ExrHeader other;
        // Further headers, until an empty one.
        while (hasParts && oneHeader(other)) {
        }
        if (!hasWindow_) refuse("has no data window");
        if (first.channels == 0) refuse("holds no channels");
        return first;
    }

private:
    [[noreturn]] void refuse(const std::string& what,
                             const char* hint = "copy or render it again") const {
        throw Error(ErrorKind::BadInput, path_.string(), what, hint);
    }
    bool take(char* bytes, std::size_t count) {
        if (count > left_) return false;
        left_ -= count;
        return static_cast<bool>(file_.read(bytes, static_cast<std::streamsize>(count)));
    }
    std::uint32_t number() {
        std::array<char, 4> bytes{};
        if (!take(bytes.data(), bytes.size())) refuse("is truncated in its header");
        std::uint32_t value;
        std::memcpy(&value, bytes.data(), sizeof value);
        return value;
    }
    std::string text() {
        std::string read;
        for (char c = 0; read.size() <= kLongestName; read += c) {
            if (!take(&c, 1)) refuse("is truncated in its header");
            if (c == 0) return read;
        }
        refuse("is damaged: a name in its header has no end");
    }

    // False for an empty header.
    bool oneHeader(ExrHeader& header) {
        bool any = false;
        for (std::string name = text(); !name.empty(); name = text(), any = true) {
            attribute(header, name);
        }
        return any;
    }
    void attribute(ExrHeader& header, const std::string& name) {
        const std::string type = text();
        const std::uint32_t size = number();
        if (size > left_)
            refuse(
                fmt::format("is damaged or truncated: its attribute \"{}\" states {} bytes, {} "
                            "follow",
                            name, size, left_));
        for (const TypeSize& known : kTypeSizes)
            if (type == known.type && size != known.bytes)
                refuse(fmt::format("is damaged: its attribute \"{}\" of type {} states {} bytes",
                                   name, type, size));
        if (name == "dataWindow" && type == "box2i")
            dataWindow(header);
        else if (type == "chlist")
            channels(header, size);
        else if (type == "preview")
            preview(size);
        else if (type == "stringvector")
            texts(size);
        else
            skip(size);
    }
    void dataWindow(ExrHeader& header) {
        std::array<std::int32_t, 4> box{};
        for (std::int32_t& side : box) side = static_cast<std::int32_t>(number());
        const std::int64_t width = std::int64_t{box[2]} - box[0] + 1;
        const std::int64_t height = std::int64_t{box[3]} - box[1] + 1;
        constexpr std::int64_t kMost = 0x7fffffff;
        if (width < 1 || height < 1 || width > kMost || height > kMost)
            refuse(fmt::format("is damaged: it states {} x {} pixels", width, height));
        header.width = static_cast<int>(width);
        header.height = static_cast<int>(height);
        hasWindow_ = true;
    }
    // Each a name and 16 bytes; then a zero.
    void channels(ExrHeader& header, std::uint32_t size) {
        const std::uintmax_t end = left_ - size;
        while (!text().empty()) {
            skip(16);
            ++header.channels;
        }
        if (left_ != end) refuse("is damaged in its list of channels");
    }
    // A small picture of 8-bit RGBA.
    void preview(std::uint32_t size) {
        if (size < 8) refuse("is damaged in its preview");
        const std::uint64_t width = number(), height = number();
        if (width > size || height > size || 8 + 4 * width * height != size)
            refuse("is damaged in its preview");
        skip(size - 8);
    }
    void texts(std::uint32_t size) {
        const std::uintmax_t end = left_ - size;
        while (left_ > end) skip(number());
        if (left_ != end) refuse("is damaged in a list of texts");
    }
    void skip(std::uintmax_t bytes) {
        if (bytes > left_) refuse("is truncated in its header");
        left_ -= bytes;
        file_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
    }

    const std::filesystem::path& path_;
    std::ifstream file_;
    std::uintmax_t left_ = 0;
    bool hasWindow_ = false;
};

}  // namespace

ExrHeader checkExrHeaders(const std::filesystem::path& path) { return HeaderWalk(path).run(); }

}  // namespace sss
