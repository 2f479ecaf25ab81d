#include "sss/base/error.h"
#include "sss/geom/mesh_sieve.h"
#include "sss/geom/text_scan.h"

#include <fmt/core.h>

namespace sss {

namespace {

class OffSieve {
public:
    OffSieve(std::string_view bytes, const std::string& where) : rest_(bytes), where_(where) {}

    SievedMesh run() {
        const Header header = readHeader();
        CoordinateCheck coordinates(where_);
        for (std::size_t i = 0; i < header.vertices; ++i) {
            vertex(i, header.normals);
            coordinates.add(out_.positions.back());
        }
        coordinates.finish();
        for (std::size_t i = 0; i < header.faces; ++i) face(i);
        return std::move(out_);
    }

private:
    struct Header {
        bool normals = false;
        std::size_t vertices = 0, faces = 0;
    };

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::BadInput, where_, fmt::format("line {}: {}", line_, what),
                    "export the mesh again, as ASCII OFF");
    }

    /// The next line that is not blank, without its comment.
    std::string_view nextLine() {
        while (!rest_.empty()) {
            ++line_;
            std::string_view line = cutLine(rest_);
            line = line.substr(0, line.find('#'));
            std::string_view probe = line;
            if (!cutToken(probe).empty()) return line;
        }
        fail("the file ends too early");
    }

    /// [ST][C][N]OFF, then the counts on the same or the next line; the word may be missing.
    Header readHeader() {
        Header header;
        std::string_view line = nextLine();
        std::string_view probe = line;
        std::string_view word = cutToken(probe);
        if (!parseInteger(word)) {
            line = probe;
            if (word.starts_with("ST")) word.remove_prefix(2);
            if (word.starts_with("C")) word.remove_prefix(1);
            header.normals = word.starts_with("N");
            if (header.normals) word.remove_prefix(1);
            if (word != "OFF") fail("this is no OFF file of three dimensions");
            if (cutToken(probe).starts_with("BINARY")) fail("binary OFF is not read");
            std::string_view again = line;
            if (cutToken(again).empty()) line = nextLine();
        }
        header.vertices = count(cutToken(line), "vertices");
        header.faces = count(cutToken(line), "faces");
        return header;
    }

    std::size_t count(std::string_view token, const char* what) const {
        const std::optional<long long> value = parseInteger(token);
        if (!value || *value < 0) fail(fmt::format("\"{}\" is no number of {}", token, what));
        // Every vertex and face takes a line of at least two bytes.
        if (static_cast<unsigned long long>(*value) > rest_.size())
            fail(fmt::format("{} {} do not fit into the {} bytes that follow", *value, what,
                             rest_.size()));
        return static_cast<std::size_t>(*value);
    }

    void vertex(std::size_t index, bool normals) {
        std::string_view line = nextLine();
        DVec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = cutToken(line);
            const std::optional<double> value = parseNumber(token);
            if (!value)
                fail(fmt::format("vertex {} has \"{}\" where a number belongs", index, token));
            p[axis] = *value;
        }
        out_.positions.push_back(p);
        if (!normals) return;
        DVec3 n;
        for (int axis = 0; axis < 3; ++axis) {
            const std::optional<double> value = parseNumber(cutToken(line));
            if (!value) fail(fmt::format("vertex {} lacks a normal", index));
            n[axis] = *value;
        }
        out_.normals.push_back(usableNormal(n));
    }

    void face(std::size_t index) {
        std::string_view line = nextLine();
        const std::string_view sizeToken = cutToken(line);
        const std::optional<long long> size = parseInteger(sizeToken);
        if (!size || *size < 0 || static_cast<std::size_t>(*size) > line.size())
            fail(fmt::format("face {} starts with \"{}\", which is not its number of corners",
                             index, sizeToken));
        for (long long corner = 0; corner < *size; ++corner) {
            const std::string_view token = cutToken(line);
            const std::optional<long long> vertex = parseInteger(token);
            if (!vertex) fail(fmt::format("face {} has \"{}\" as a corner", index, token));
            if (*vertex < 0 || static_cast<std::size_t>(*vertex) >= out_.positions.size())
                fail(fmt::format("face {} uses vertex {}, but the file has {} (from 0)", index,
                                 *vertex, out_.positions.size()));
            out_.corners.push_back(static_cast<std::uint32_t>(*vertex));
        }
        out_.sizes.push_back(static_cast<std::uint32_t>(*size));
    }

    std::string_view rest_;
    const std::string& where_;
    SievedMesh out_;
    std::size_t line_ = 0;
};

}  // namespace

SievedMesh sieveOff(std::string_view bytes, const std::string& where) {
    return OffSieve(bytes, where).run();
}

}  // namespace sss
