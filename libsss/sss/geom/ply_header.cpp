#include "sss/geom/ply_header.h"

#include "sss/base/error.h"
#include "sss/geom/text_scan.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

namespace sss {

namespace {

[[noreturn]] void fail(const std::string& where, const std::string& what) {
    throw Error(ErrorKind::BadInput, where, what, "export the mesh again");
}

PlyType typeNamed(std::string_view name, const std::string& where) {
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{
        {{"char", PlyType::Int8},
         {"int8", PlyType::Int8},
         {"uchar", PlyType::UInt8},
         {"uint8", PlyType::UInt8},
         {"short", PlyType::Int16},
         {"int16", PlyType::Int16},
         {"ushort", PlyType::UInt16},
         {"uint16", PlyType::UInt16},
         {"int", PlyType::Int32},
         {"int32", PlyType::Int32},
         {"uint", PlyType::UInt32},
         {"uint32", PlyType::UInt32},
         {"float", PlyType::Float32},
         {"float32", PlyType::Float32},
         {"double", PlyType::Float64},
         {"float64", PlyType::Float64}}};
    const auto* const found = std::find_if(kNames.begin(), kNames.end(),
                                           [&](const auto& entry) { return entry.first == name; });
    if (found == kNames.end()) fail(where, fmt::format("unknown PLY type \"{}\"", name));
    return found->second;
}

PlyFormat formatNamed(std::string_view name, const std::string& where) {
    if (name == "ascii") return PlyFormat::Ascii;
    if (name == "binary_little_endian") return PlyFormat::LittleEndian;
    if (name == "binary_big_endian") return PlyFormat::BigEndian;
    fail(where, fmt::format("unknown PLY format \"{}\"", name));
}

PlyElement element(std::string_view line, const std::string& where) {
    PlyElement result;
    result.name = cutToken(line);
    const std::string_view token = cutToken(line);
    const std::optional<long long> count = parseInteger(token);
    if (!count || *count < 0)
        fail(where, fmt::format("\"{}\" is no count of element \"{}\"", token, result.name));
    result.count = static_cast<std::uint64_t>(*count);
    return result;
}

PlyProperty property(std::string_view line, const std::string& where) {
    PlyProperty result;
    std::string_view type = cutToken(line);
    result.isList = type == "list";
    if (result.isList) {
        result.countType = typeNamed(cutToken(line), where);
        type = cutToken(line);
    }
    result.type = typeNamed(type, where);
    result.name = cutToken(line);
    return result;
}

void checkCounts(const PlyHeader& header, std::size_t bytesLeft, const std::string& where) {
    for (const PlyElement& e : header.elements) {
        if (e.count > 0 && e.properties.empty())
            fail(where, fmt::format("element \"{}\" has no properties", e.name));
        // Text may lack the very last separator. Divided, so that it cannot overflow.
        if (e.count > 0 && e.count > (bytesLeft + 1) / e.leastSize(header.format))
            fail(where, fmt::format("truncated: {} of element \"{}\" do not fit into the {} bytes "
                                    "after the header",
                                    e.count, e.name, bytesLeft));
    }
}

}  // namespace

std::size_t plySize(PlyType type) {
    switch (type) {
        case PlyType::Int8:
        case PlyType::UInt8:
            return 1;
        case PlyType::Int16:
        case PlyType::UInt16:
            return 2;
        case PlyType::Float64:
            return 8;
        case PlyType::Int32:
        case PlyType::UInt32:
        case PlyType::Float32:
            break;
    }
    return 4;
}

std::uint64_t PlyElement::leastSize(PlyFormat format) const {
    std::uint64_t size = 0;
    for (const PlyProperty& p : properties)
        size += format == PlyFormat::Ascii ? 2 : plySize(p.isList ? p.countType : p.type);
    return size;
}

PlyHeader cutPlyHeader(std::string_view& rest, const std::string& where) {
    std::string_view first = cutLine(rest);
    if (cutToken(first) != "ply")
        fail(where, "this is no PLY file: it does not start with \"ply\"");
    PlyHeader header;
    bool hasFormat = false;
    while (true) {
        if (rest.empty()) fail(where, "truncated: the header has no \"end_header\"");
        std::string_view line = cutLine(rest);
        const std::string_view key = cutToken(line);
        if (key == "end_header") break;
        if (key == "format") {
            header.format = formatNamed(cutToken(line), where);
            hasFormat = true;
        } else if (key == "element") {
            header.elements.push_back(element(line, where));
        } else if (key == "property") {
            if (header.elements.empty()) fail(where, "a property stands before any element");
            header.elements.back().properties.push_back(property(line, where));
        } else if (!key.empty() && key != "comment" && key != "obj_info") {
            fail(where, fmt::format("unknown word \"{}\" in the header", key));
        }
    }
    if (!hasFormat) fail(where, "the header names no format");
    checkCounts(header, rest.size(), where);
    return header;
}

}  // namespace sss
