#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sss {

enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };
enum class PlyFormat { Ascii, LittleEndian, BigEndian };

/// Bytes of one binary value.
std::size_t plySize(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    bool isList = false;
    PlyType countType = PlyType::UInt8;  ///< of a list's length
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    /// Least bytes that one takes in the file: lists empty, text one digit and a separator.
    std::uint64_t leastSize(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
};

/// Reads and cuts off the header of a PLY file, and checks each element's count against the bytes
/// that follow. Throws Error{BadInput}.
PlyHeader cutPlyHeader(std::string_view& rest, const std::string& where);

}  // namespace sss
