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
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("truncated: {} bytes, less than the header of an STL file",
                                bytes.size()),
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

    std::size_t check() {
        std::size_t faces = 0;
        while (!rest_.empty()) {
            const std::string_view line = nextLine();
            if (line.find("outer") != line.npos || line.find("OUTER") != line.npos) {
                for (int corner = 0; corner < 3; ++corner) vertex(nextLine());
                ++faces;
            } else if (isVertex(line)) {
                fail("a vertex outside of \"outer loop\", or the fourth of one");
            }
        }
        coordinates_.finish();
        return faces;
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
    void vertex(std::string_view line) {
        if (!isVertex(line)) fail("a vertex of a face is missing");
        cutToken(line);
        DVec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = cutToken(line);
            const std::optional<double> value = parseNumber(token);
            if (!value) fail(fmt::format("a vertex has \"{}\" where a number belongs", token));
            // What a float cannot hold is infinite to OpenMesh.
            constexpr double kMax = std::numeric_limits<float>::max();
            p[axis] = std::abs(*value) > kMax ? std::numeric_limits<double>::infinity() : *value;
        }
        coordinates_.add(p);
    }

    std::string_view rest_;
    const std::string& where_;
    CoordinateCheck coordinates_;
    std::size_t line_ = 0;
};

}  // namespace

SievedMesh sieveStl(std::string bytes, const std::string& where) {
    SievedMesh out;
    out.binary = isBinary(bytes);
    // Old Macintosh line ends.
    if (!out.binary && bytes.find('\n') == bytes.npos)
        std::replace(bytes.begin(), bytes.end(), '\r', '\n');
    out.faces = out.binary ? checkBinary(bytes, where) : AsciiStl(bytes, where).check();
    out.bytes = std::move(bytes);
    return out;
}

}  // namespace sss
