#include "sss/base/error.h"
#include "sss/geom/mesh_sieve.h"
#include "sss/geom/ply_header.h"
#include "sss/geom/text_scan.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace sss {

namespace {

/// The values after the header, one by one.
class PlyValues {
public:
    PlyValues(std::string_view rest, PlyFormat format, const std::string& where)
        : rest_(rest), format_(format), where_(where) {}

    double next(PlyType type, const PlyElement& element, std::uint64_t index) {
        return format_ == PlyFormat::Ascii ? nextText(element, index)
                                           : nextBinary(type, element, index);
    }
    std::size_t bytesLeft() const { return rest_.size(); }
    [[noreturn]] void fail(const PlyElement& element, std::uint64_t index,
                           const std::string& what) const {
        throw Error(ErrorKind::BadInput, where_,
                    fmt::format("{} {} (from 0): {}", element.name, index, what),
                    "export the mesh again");
    }

private:
    double nextText(const PlyElement& element, std::uint64_t index) {
        const auto isSpace = [](char c) { return isBlank(c) || c == '\n'; };
        const auto* begin = std::find_if_not(rest_.begin(), rest_.end(), isSpace);
        const auto* end = std::find_if(begin, rest_.end(), isSpace);
        const std::string_view token(begin, static_cast<std::size_t>(end - begin));
        if (token.empty()) fail(element, index, "truncated: the file ends here");
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.begin()));
        const std::optional<double> value = parseNumber(token);
        if (!value) fail(element, index, fmt::format("\"{}\" is no number", token));
        return *value;
    }

    double nextBinary(PlyType type, const PlyElement& element, std::uint64_t index) {
        const std::size_t size = plySize(type);
        if (rest_.size() < size) fail(element, index, "truncated: the file ends here");
        std::array<char, 8> raw{};
        std::memcpy(raw.data(), rest_.data(), size);
        rest_.remove_prefix(size);
        if (format_ == PlyFormat::BigEndian)
            std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
        switch (type) {
            case PlyType::Int8:
                return as<std::int8_t>(raw);
            case PlyType::UInt8:
                return as<std::uint8_t>(raw);
            case PlyType::Int16:
                return as<std::int16_t>(raw);
            case PlyType::UInt16:
                return as<std::uint16_t>(raw);
            case PlyType::Int32:
                return as<std::int32_t>(raw);
            case PlyType::UInt32:
                return as<std::uint32_t>(raw);
            case PlyType::Float32:
                return static_cast<double>(as<float>(raw));
            case PlyType::Float64:
                break;
        }
        return as<double>(raw);
    }

    template <typename T>
    static T as(const std::array<char, 8>& raw) {
        T value;
        std::memcpy(&value, raw.data(), sizeof value);
        return value;
    }

    std::string_view rest_;
    PlyFormat format_;
    const std::string& where_;
};

class PlySieve {
public:
    PlySieve(std::string_view bytes, const std::string& where)
        : where_(where),
          header_(cutPlyHeader(bytes, where)),
          values_(bytes, header_.format, where) {
        checkElements();
    }

    SievedMesh run() {
        for (const PlyElement& element : header_.elements)
            for (std::uint64_t i = 0; i < element.count; ++i) {
                if (element.name == "vertex")
                    vertex(element, i);
                else
                    other(element, i);
            }
        checkResults();
        return std::move(out_);
    }

private:
    static bool isFaceList(const PlyElement& element, const PlyProperty& p) {
        return element.name == "face" && p.isList &&
               (p.name == "vertex_indices" || p.name == "vertex_index");
    }

    void checkElements() {
        for (const PlyElement& e : header_.elements) {
            if (e.name == "tristrips" && e.count > 0)
                throw Error(ErrorKind::BadInput, where_, "triangle strips are not read",
                            "export the mesh with an element \"face\"");
            if (e.name != "vertex") continue;
            for (const char* axis : {"x", "y", "z"})
                if (!has(e, axis))
                    throw Error(ErrorKind::BadInput, where_,
                                fmt::format("the vertices have no property \"{}\"", axis),
                                "export the mesh again");
            hasNormals_ = has(e, "nx") && has(e, "ny") && has(e, "nz");
        }
    }
    static bool has(const PlyElement& element, std::string_view name) {
        return std::any_of(element.properties.begin(), element.properties.end(),
                           [&](const PlyProperty& p) { return !p.isList && p.name == name; });
    }

    void vertex(const PlyElement& element, std::uint64_t index) {
        constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
        std::array<double, 6> kept{};
        for (const PlyProperty& p : element.properties) {
            if (p.isList) {
                skipList(element, p, index);
                continue;
            }
            const double value = values_.next(p.type, element, index);
            const auto* const slot = std::find(kNames.begin(), kNames.end(), p.name);
            if (slot != kNames.end()) kept[static_cast<std::size_t>(slot - kNames.begin())] = value;
        }
        out_.positions.emplace_back(kept[0], kept[1], kept[2]);
        if (hasNormals_) out_.normals.push_back(usableNormal({kept[3], kept[4], kept[5]}));
    }

    void other(const PlyElement& element, std::uint64_t index) {
        for (const PlyProperty& p : element.properties) {
            if (isFaceList(element, p))
                face(element, p, index);
            else if (p.isList)
                skipList(element, p, index);
            else
                values_.next(p.type, element, index);
        }
    }

    std::uint32_t listSize(const PlyElement& element, const PlyProperty& p, std::uint64_t index) {
        const double size = values_.next(p.countType, element, index);
        if (!(size >= 0) || size != std::floor(size))
            values_.fail(element, index, fmt::format("{} is no length of a list", size));
        if (size > static_cast<double>(values_.bytesLeft()))
            values_.fail(element, index,
                         fmt::format("a list of {} does not fit into the {} bytes that follow",
                                     size, values_.bytesLeft()));
        return static_cast<std::uint32_t>(size);
    }
    void skipList(const PlyElement& element, const PlyProperty& p, std::uint64_t index) {
        const std::uint32_t size = listSize(element, p, index);
        for (std::uint32_t i = 0; i < size; ++i) values_.next(p.type, element, index);
    }

    void face(const PlyElement& element, const PlyProperty& p, std::uint64_t index) {
        const std::uint32_t size = listSize(element, p, index);
        for (std::uint32_t i = 0; i < size; ++i) {
            const double corner = values_.next(p.type, element, index);
            // Faces may stand before the vertices, so the range is checked at the end.
            if (!(corner >= 0 && corner < 4294967295.0) || corner != std::floor(corner))
                values_.fail(element, index, fmt::format("{} is no vertex", corner));
            const auto vertex = static_cast<std::uint32_t>(corner);
            if (vertex > highest_) {
                highest_ = vertex;
                highestFace_ = index;
            }
            out_.corners.push_back(vertex);
        }
        out_.sizes.push_back(size);
    }

    void checkResults() const {
        CoordinateCheck coordinates(where_);
        for (const DVec3& p : out_.positions) coordinates.add(p);
        coordinates.finish();
        if (!out_.corners.empty() && highest_ >= out_.positions.size())
            throw Error(ErrorKind::BadInput, where_,
                        fmt::format("face {} uses vertex {}, but the file has {} (both from 0)",
                                    highestFace_, highest_, out_.positions.size()),
                        "export the mesh again");
    }

    const std::string& where_;
    PlyHeader header_;
    PlyValues values_;
    bool hasNormals_ = false;
    SievedMesh out_;
    std::uint32_t highest_ = 0;
    std::uint64_t highestFace_ = 0;
};

}  // namespace

SievedMesh sievePly(std::string_view bytes, const std::string& where) {
    return PlySieve(bytes, where).run();
}

}  // namespace sss
