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
        for (std::size_t begin = 0; begin < bytes_.size();) {
            const std::size_t end = std::min(bytes_.find('\n', begin), bytes_.size());
            ++line_;
            sieveLine(begin, end);
            begin = end + 1;
        }
        coordinates_.finish();
        // Forward references are legal, so the ranges are known only now.
        checkRange(highestVertex_, out_.positions.size(), "vertex");
        checkRange(highestNormal_, normals_, "normal");
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

    /// One '\n' ends a line; a joined line keeps its length in blanks.
    void normaliseLineEnds() {
        for (std::size_t i = 0; i < bytes_.size(); ++i) {
            if (bytes_[i] == '\r')
                bytes_[i] = i + 1 < bytes_.size() && bytes_[i + 1] == '\n' ? ' ' : '\n';
        }
        for (std::size_t i = 0; i < bytes_.size(); ++i) {
            if (bytes_[i] != '\\') continue;
            const std::size_t next = bytes_.find_first_not_of(" \t", i + 1);
            if (next != bytes_.npos && bytes_[next] == '\n') bytes_[i] = bytes_[next] = ' ';
        }
        if (bytes_.starts_with("\xEF\xBB\xBF")) std::fill_n(bytes_.begin(), 3, ' ');
    }

    void sieveLine(std::size_t begin, std::size_t end) {
        const std::size_t comment = std::min(bytes_.find('#', begin), end);
        std::fill(bytes_.begin() + static_cast<std::ptrdiff_t>(comment),
                  bytes_.begin() + static_cast<std::ptrdiff_t>(end), ' ');
        std::string_view rest = std::string_view(bytes_).substr(begin, end - begin);
        const std::string_view key = cutToken(rest);
        if (key.empty()) return;
        if (key == "v") {
            out_.positions.push_back(vertex(rest));
            coordinates_.add(out_.positions.back());
        } else if (key == "vn") {
            ++normals_;
            if (!isGoodNormal(rest)) blankNormal(begin, end);
        } else if (key == "f") {
            ++out_.faces;
            face(rest);
        } else {
            // Anything else becomes a comment: texture coordinates, groups, and material files,
            // which OpenMesh would open wherever they point to.
            bytes_[static_cast<std::size_t>(key.data() - bytes_.data())] = '#';
        }
    }

    DVec3 vertex(std::string_view rest) const {
        DVec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = cutToken(rest);
            const std::optional<double> value = parseNumber(token);
            if (!value)
                fail(line_, fmt::format("vertex {} has \"{}\" where a number belongs",
                                        out_.positions.size() + 1, token));
            p[axis] = *value;
        }
        return p;
    }

    static bool isGoodNormal(std::string_view rest) {
        for (int axis = 0; axis < 3; ++axis) {
            const std::optional<double> value = parseNumber(cutToken(rest));
            // OpenMesh skips what is no number, and reads it into a float.
            if (!value || !(std::abs(*value) < 1e38)) return false;
        }
        return true;
    }

    /// A zero normal holds the place of an unreadable one; it counts as missing.
    void blankNormal(std::size_t begin, std::size_t end) {
        constexpr std::string_view kZero = "vn 0 0 0";
        if (end - begin < kZero.size()) fail(line_, "a normal has fewer than three numbers");
        std::fill(bytes_.begin() + static_cast<std::ptrdiff_t>(begin),
                  bytes_.begin() + static_cast<std::ptrdiff_t>(end), ' ');
        std::copy(kZero.begin(), kZero.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin));
    }

    /// Checks corners of the forms a, a/b, a//c and a/b/c.
    void face(std::string_view rest) {
        corners_.clear();
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
            corners_.push_back(absolute(parts[0], whole, out_.positions.size(), highestVertex_));
            if (!parts[1].empty() && !parseInteger(parts[1]))
                fail(line_, fmt::format("\"{}\" is no corner of a face", whole));
            if (!parts[2].empty()) absolute(parts[2], whole, normals_, highestNormal_);
        }
        std::sort(corners_.begin(), corners_.end());
        if (corners_.size() > 3 &&
            std::adjacent_find(corners_.begin(), corners_.end()) != corners_.end())
            ++out_.repeating;
    }

    /// The index counted from 1; negative ones count back from the last one read.
    long long absolute(std::string_view part, std::string_view corner, std::size_t readSoFar,
                       Highest& highest) const {
        const std::optional<long long> index = parseInteger(part);
        if (!index || *index == 0)
            fail(line_, fmt::format("\"{}\" is no corner of a face", corner));
        const auto read = static_cast<long long>(readSoFar);
        if (*index < -read)
            fail(line_, fmt::format("index {} lies before the first of {} so far", *index, read));
        const long long value = *index < 0 ? read + *index + 1 : *index;
        if (value > highest.index) highest = {value, line_};
        return value;
    }

    void checkRange(const Highest& highest, std::size_t count, const char* what) const {
        if (highest.index > static_cast<long long>(count))
            fail(highest.line, fmt::format("a face uses {} {}, but the file has {}", what,
                                           highest.index, count));
    }

    std::string& bytes_;
    const std::string& where_;
    SievedMesh out_;
    CoordinateCheck coordinates_;
    std::vector<long long> corners_;
    std::size_t line_ = 0, normals_ = 0;
    Highest highestVertex_, highestNormal_;
};

}  // namespace

SievedMesh sieveObj(std::string bytes, const std::string& where) {
    SievedMesh out = ObjSieve(bytes, where).run();
    out.bytes = std::move(bytes);
    return out;
}

}  // namespace sss
