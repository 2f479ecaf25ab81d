#include "sss/image/png_file.h"

#include "sss/base/atomic_file.h"
#include "sss/base/error.h"
#include "sss/base/require_memory.h"

#include <fmt/core.h>
#include <png.h>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

// libpng's simplified interface: it reports errors by value instead of longjmp.
namespace sss {
namespace {

constexpr std::size_t kMaximumPixels = std::size_t{1} << 28;

struct PngImage : png_image {
    PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(this); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
};

std::size_t valueCount(const Picture8& picture) {
    return static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) *
           static_cast<std::size_t>(picture.channels);
}

std::vector<char> contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path))
        throw Error(ErrorKind::Io, path.string(), "cannot open the picture", "check the path");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Big-endian, as all numbers of a PNG.
std::uint32_t numberAt(std::span<const char> bytes, std::size_t at) {
    std::uint32_t n = 0;
    for (const char c : bytes.subspan(at, 4)) n = n << 8 | static_cast<unsigned char>(c);
    return n;
}

// The checksum of a chunk's type and data, which are less than 2^31 bytes.
std::uint32_t chunkChecksum(std::span<const char> bytes) {
    return static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace

void writePng(const std::filesystem::path& path, const Picture8& picture) {
    if (picture.width <= 0 || picture.height <= 0 || picture.values.size() != valueCount(picture))
        throw Error(ErrorKind::Internal, "image",
                    fmt::format("{} values for a PNG of {} x {} x {}", picture.values.size(),
                                picture.width, picture.height, picture.channels));
    PngImage png;
    png.width = static_cast<png_uint_32>(picture.width);
    png.height = static_cast<png_uint_32>(picture.height);
    png.format = picture.channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;

    // A preview: on pictures with noise the slow setting saves a few per cent at several times the
    // cost.
    png.flags = PNG_IMAGE_FLAG_FAST;

    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::byte> bytes(size);
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, picture.values.data(), 0,
                                  nullptr) == 0) {
        if (saysOutOfMemory(png.message)) throw std::bad_alloc();
        throw Error(ErrorKind::Io, path.string(), fmt::format("cannot encode: {}", png.message));
    }
    AtomicFile file(path);
    file.append(std::span(bytes).first(size));
    file.commit();
}

Picture8 readPng(const std::filesystem::path& path) {
    const std::vector<char> bytes = contents(path);
    PngImage png;
    const auto refuse = [&](const std::string& what) -> Error {
        if (saysOutOfMemory(png.message)) throw std::bad_alloc();
        return {ErrorKind::BadInput, path.string(), what, "save it again as PNG"};
    };
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
        throw refuse(fmt::format("cannot be read as PNG: {}", png.message));
    if (std::size_t{png.width} * png.height > kMaximumPixels)
        throw refuse(fmt::format("states {} x {} pixels, too many", png.width, png.height));
    const bool hasAlpha = (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    png.format = hasAlpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    Picture8 picture{
        static_cast<int>(png.width), static_cast<int>(png.height), hasAlpha ? 4 : 3, {}};
    picture.values.resize(valueCount(picture));
    if (png_image_finish_read(&png, nullptr, picture.values.data(), 0, nullptr) == 0)
        throw refuse(fmt::format("is damaged: {}", png.message));
    return picture;
}

bool isWholePng(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return false;
    const std::vector<char> bytes = contents(path);
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n", kEnd = "IEND";
    constexpr std::size_t kAround = 12;  // length, type and checksum of a chunk
    if (!std::string_view(bytes.data(), bytes.size()).starts_with(kSignature)) return false;
    std::span<const char> rest = std::span(bytes).subspan(kSignature.size());
    while (rest.size() >= kAround) {
        const std::size_t length = numberAt(rest, 0);
        if (length > rest.size() - kAround) return false;
        const std::span<const char> summed = rest.subspan(4, 4 + length);
        if (numberAt(rest, 8 + length) != chunkChecksum(summed)) return false;
        rest = rest.subspan(kAround + length);
        if (std::string_view(summed.data(), 4) == kEnd) return rest.empty();
    }
    return false;
}

}  // namespace sss
