#include "sss/base/error.h"
#include "sss/geom/mesh_sieve.h"
#include "sss/geom/text_scan.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>

namespace sss {

namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;

std::uint32_t facesInHeader(std::string_view bytes) {
    std::uint32_t faces = 0;
    if (bytes.size() >= kHeader) std::memcpy(&faces, bytes.data() + 80, sizeof faces);
    return faces;
}

/// By the size, not by the first word: binary files often start with "solid" as well.
bool isBinary(std::string_view bytes) {
    if (bytes.size() == kHeader + kRecord * facesInHeader(bytes)) return true;
    std::string word(bytes.substr(0, 5));
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return word != "solid";
}

std::size_t checkBinary(std::string_view bytes, const std::string& where) {
    const std::size_t faces = facesInHeader(bytes);
    if (bytes.size() < kHeader)
        throw Error(
            ErrorKind::BadInput, where,
            fmt::format("truncated: {} bytes, less than the header of an STL file", bytes.size()),
            "export or copy the mesh again");
    if (bytes.size() < kHeader + kRecord * faces)
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("truncated: the header announces {} faces, {} bytes, but the file "
                                "has {}",
                                faces, kHeader + kRecord * faces, bytes.size()),
                    "export or copy the mesh again");
    CoordinateCheck coordinates(where);
    for (std::size_t face = 0; face < faces; ++face) {
        std::array<float, 12> values;  // the normal, then three corners
        std::memcpy(values.data(), bytes.data() + kHeader + kRecord * face, sizeof values);
        for (std::size_t c = 3; c < 12; c += 3)
            coordinates.add({values[c], values[c + 1], values[c + 2]});
    }
    coordinates.finish();
    return faces;
}

class AsciiStl {
public:
    AsciiStl(std::string_view bytes, const std::string& where)
        : rest_(bytes), where_(where), coordinates_(where) {}

    /// The same triangles as binary STL, which OpenMesh reads much faster and by its size only.
    SievedStl run() {
        SievedStl out;
        out.bytes.assign(kHeader, ' ');
        while (!rest_.empty()) {
            const std::string_view line = nextLine();
            if (line.find("outer") != line.npos || line.find("OUTER") != line.npos) {
                for (int i = 0; i < 3; ++i) appendBytes(out.bytes, 0.0f);
                for (int corner = 0; corner < 3; ++corner) vertex(nextLine(), out.bytes);
                appendBytes(out.bytes, std::uint16_t{0});
                ++out.faces;
            } else if (isVertex(line)) {
                fail("a vertex outside of \"outer loop\", or the fourth of one");
            }
        }
        coordinates_.finish();
        const auto faces = static_cast<std::uint32_t>(out.faces);
        std::memcpy(out.bytes.data() + 80, &faces, sizeof faces);
        return out;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::BadInput, where_, fmt::format("line {}: {}", line_, what),
                    "export the mesh again, best as binary STL or PLY");
    }
    std::string_view nextLine() {
        ++line_;
        return cutLine(rest_);
    }
    static bool isVertex(std::string_view line) {
        const std::string_view word = cutToken(line);
        return word == "vertex" || word == "VERTEX";
    }
    void vertex(std::string_view line, std::string& bytes) {
        if (!isVertex(line)) fail("a vertex of a face is missing");
        cutToken(line);
        DVec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = cutToken(line);
            const std::optional<double> value = parseNumber(token);
            if (!value) fail(fmt::format("a vertex has \"{}\" where a number belongs", token));
            constexpr double kMax = std::numeric_limits<float>::max();
            p[axis] = std::abs(*value) > kMax ? std::numeric_limits<double>::infinity() : *value;
            appendBytes(bytes, static_cast<float>(p[axis]));
        }
        coordinates_.add(p);
    }

    std::string_view rest_;
    const std::string& where_;
    CoordinateCheck coordinates_;
    std::size_t line_ = 0;
};

}  // namespace

SievedStl sieveStl(std::string bytes, const std::string& where) {
    if (isBinary(bytes)) {
        SievedStl out;
        out.faces = checkBinary(bytes, where);
        out.bytes = std::move(bytes);
        return out;
    }
    // Old Macintosh line ends.
    if (bytes.find('\n') == bytes.npos) std::replace(bytes.begin(), bytes.end(), '\r', '\n');
    return AsciiStl(bytes, where).run();
}

}  // namespace sss
