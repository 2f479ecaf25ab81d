#pragma once
#include "sss/base/json.h"
#include "sss/base/vec.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// The values of a scene file, checked one by one. Every function here throws Error{BadInput} at
// "file:line:column" with the key, the value that stands there and what may stand there.
namespace sss {

struct NamedMaterial;

/// What reading any value may need to know of the whole file.
struct ReadContext {
    std::string file;              ///< as named in messages
    std::filesystem::path folder;  ///< what relative paths in the file start from
    double mmPerUnit = 1;
    /// The materials read so far, for the objects that name them.
    const std::vector<NamedMaterial>* materials = nullptr;
};

/// A value and the name it goes by in messages: its key, "layers[2]", "material \"wax\"".
struct Node {
    const JsonValue& value;
    std::string name;
    const ReadContext& context;
};

[[noreturn]] void fail(const Node& node, JsonPlace place, const std::string& what,
                       const std::string& hint = {});
/// `what` follows the node's name, at the node's place.
[[noreturn]] void fail(const Node& node, const std::string& what, const std::string& hint = {});

/// What a number may be. The schema (scenes/scene.schema.json) says the same.
struct Range {
    double low, high;
    bool lowOpen = false, highOpen = false;  ///< the bound itself is outside
    std::string_view unit = {};
};

// Scene units. With metersPerUnit in kUnitRange every length in mm, its square too, fits a float.
inline constexpr Range kUnitRange{1e-9, 1e6, false, false, "metres"};
inline constexpr Range kCoordinateRange{-1e9, 1e9, false, false, "scene units"};
inline constexpr Range kSizeRange{1e-9, 1e9, false, false, "scene units"};
inline constexpr Range kSizeOrZeroRange{0, 1e9, false, false, "scene units"};
inline constexpr Range kMmRange{1e-9, 1e9, false, false, "mm"};
inline constexpr Range kFractionRange{0, 1};
inline constexpr Range kLightRange{0, 1e30};
inline constexpr Range kEtaRange{0.1, 10};
inline constexpr Range kAngleRange{-3600, 3600, false, false, "degrees"};

double number(const Node& node, const Range& range);
/// A number in scene units, returned in mm.
double length(const Node& node, const Range& rangeInUnits);
int wholeNumber(const Node& node, int low, int high);
bool yesOrNo(const Node& node);
/// A string that is not empty.
const std::string& text(const Node& node);
/// The index of the string among `names`.
std::size_t choice(const Node& node, std::span<const std::string_view> names);

/// Three numbers, or one that stands for three equal ones.
DRgb channels(const Node& node, const Range& range);
Rgb rgb(const Node& node, const Range& range);
/// Three numbers.
DVec3 vector(const Node& node, const Range& range);
/// Three coordinates in scene units, returned in mm.
DVec3 point(const Node& node);
/// Three numbers, not all zero; as written, not normalised.
DVec3 direction(const Node& node);
/// The string as a path: absolute, or from the scene file's folder.
std::filesystem::path filePath(const Node& node);

/// The entries of an array of `least` to `most` entries, named "key[0]", "key[1]", ...
std::vector<Node> entries(const Node& node, std::size_t least, std::size_t most);

}  // namespace sss
