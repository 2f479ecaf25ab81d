#pragma once
#include "sss/scene/field_set.h"
#include "sss/scene/scene.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace sss {

/// Reads and checks a scene file (scenes/README.md documents it, scenes/scene.schema.json describes
/// it) and converts it to mm and mm^-1; opens no other file. `metersPerUnit`, if given, replaces
/// the file's. An animated scene is that of `frame` (animation.h). Throws Error{Io} if the file
/// cannot be read and Error{BadInput} at "file:line:column" for anything in it that cannot be
/// meant.
Scene readScene(const std::filesystem::path& file, std::optional<double> metersPerUnit = {},
                int frame = 1);

/// readScene of JSON that was read from `file`.
Scene readSceneJson(const JsonValue& root, const std::filesystem::path& file,
                    std::optional<double> metersPerUnit, int frame);

/// readScene of a text; relative paths start from `file`'s folder.
Scene readSceneText(std::string_view text, const std::filesystem::path& file,
                    std::optional<double> metersPerUnit = {}, int frame = 1);

/// All keys that the reader knows, by the kind of object that they may stand in.
std::vector<KeyList> sceneKeys();

}  // namespace sss
