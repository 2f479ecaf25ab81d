#include "sss/base/error.h"
#include "sss/geom/mesh_sieve.h"
#include "sss/geom/text_scan.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace sss {

namespace {

class ObjSieve {
public:
    ObjSieve(std::string& bytes, const std::string& where)
        : bytes_(bytes), where_(where), coordinates_(where) {}

    SievedMesh run() {
        normaliseLineEnds();
        std::string_view rest(bytes_);
        while (!rest.empty()) {
            ++line_;
            std::string_view line = cutLine(rest);
            line = line.substr(0, line.find('#'));
            sieveLine(line);
        }
        coordinates_.finish();
        // Forward references are legal, so the ranges are known only now.
        checkRange(highestVertex_, out_.positions.size(), "vertex");
        checkRange(highestNormal_, normals_.size(), "normal");
        if (highestNormal_.index > 0)
            for (std::uint32_t normal : cornerNormals_)
                out_.cornerNormals.push_back(normal > 0 ? normals_[normal - 1] : Vec3{0});
        return std::move(out_);
    }

private:
    struct Highest {
        long long index = 0;
        std::size_t line = 0;
    };

    [[noreturn]] void fail(std::size_t line, const std::string& what) const {
        throw Error(ErrorKind::BadInput, where_, fmt::format("line {}: {}", line, what),
                    "export the mesh again");
    }

    /// One '\n' ends a line; lines joined by a backslash become one.
    void normaliseLineEnds() {
        for (std::size_t i = 0; i < bytes_.size(); ++i) {
            if (bytes_[i] == '\r')
                bytes_[i] = i + 1 < bytes_.size() && bytes_[i + 1] == '\n' ? ' ' : '\n';
        }
        for (std::size_t i = bytes_.find('\\'); i != bytes_.npos; i = bytes_.find('\\', i + 1)) {
            const std::size_t next = bytes_.find_first_not_of(" \t", i + 1);
            if (next != bytes_.npos && bytes_[next] == '\n') bytes_[i] = bytes_[next] = ' ';
        }
        if (bytes_.starts_with("\xEF\xBB\xBF")) std::fill_n(bytes_.begin(), 3, ' ');
    }

    void sieveLine(std::string_view rest) {
        const std::string_view key = cutToken(rest);
        if (key == "v") {
            out_.positions.push_back(triple(rest, "vertex", out_.positions.size()));
            coordinates_.add(out_.positions.back());
        } else if (key == "vn") {
            normals_.push_back(usableNormal(triple(rest, "normal", normals_.size())));
        } else if (key == "f") {
            face(rest);
        }
    }

    DVec3 triple(std::string_view rest, const char* what, std::size_t index) const {
        DVec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = cutToken(rest);
            const std::optional<double> value = parseNumber(token);
            if (!value)
                fail(line_, fmt::format("{} {} has \"{}\" where a number belongs", what, index + 1,
                                        token));
            p[axis] = *value;
        }
        return p;
    }

    /// Corners of the forms a, a/b, a//c and a/b/c.
    void face(std::string_view rest) {
        std::uint32_t size = 0;
        for (std::string_view token = cutToken(rest); !token.empty(); token = cutToken(rest)) {
            const std::string_view whole = token;
            std::array<std::string_view, 3> parts;
            std::size_t count = 0;
            for (bool more = true; more; ++count) {
                const std::size_t slash = token.find('/');
                more = slash != token.npos;
                if (count == 3) fail(line_, fmt::format("\"{}\" is no corner of a face", whole));
                parts[count] = token.substr(0, slash);
                token.remove_prefix(more ? slash + 1 : token.size());
            }
            out_.corners.push_back(
                absolute(parts[0], whole, out_.positions.size(), highestVertex_) - 1);
            if (!parts[1].empty() && !parseInteger(parts[1]))
                fail(line_, fmt::format("\"{}\" is no corner of a face", whole));
            cornerNormals_.push_back(
                parts[2].empty() ? 0 : absolute(parts[2], whole, normals_.size(), highestNormal_));
            ++size;
        }
        out_.sizes.push_back(size);
    }

    /// The index counted from 1; negative ones count back from the last one read.
    std::uint32_t absolute(std::string_view part, std::string_view corner, std::size_t readSoFar,
                           Highest& highest) const {
        const std::optional<long long> index = parseInteger(part);
        if (!index || *index == 0 || *index > 0xffffffffll)
            fail(line_, fmt::format("\"{}\" is no corner of a face", corner));
        const auto read = static_cast<long long>(readSoFar);
        if (*index < -read)
            fail(line_, fmt::format("index {} lies before the first of {} so far", *index, read));
        const long long value = *index < 0 ? read + *index + 1 : *index;
        if (value > highest.index) highest = {value, line_};
        return static_cast<std::uint32_t>(value);
    }

    void checkRange(const Highest& highest, std::size_t count, const char* what) const {
        if (highest.index > static_cast<long long>(count))
            fail(highest.line,
                 fmt::format("a face uses {} {}, but the file has {}", what, highest.index, count));
    }

    std::string& bytes_;
    const std::string& where_;
    SievedMesh out_;
    CoordinateCheck coordinates_;
    std::vector<Vec3> normals_;
    std::vector<std::uint32_t> cornerNormals_;  ///< counted from 1; 0 = none
    std::size_t line_ = 0;
    Highest highestVertex_, highestNormal_;
};

}  // namespace

SievedMesh sieveObj(std::string bytes, const std::string& where) {
    return ObjSieve(bytes, where).run();
}

}  // namespace sss
