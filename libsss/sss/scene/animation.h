#pragma once
#include "sss/base/json.h"
#include "sss/scene/field_set.h"

#include <string>
#include <vector>

// Animation is a matter of the scene file alone: it is resolved to the scene of one frame, in the
// same JSON, before anything is read from it. No reader knows of time.
namespace sss {

/// The scene file's JSON as it stands at `frame`. In the camera, materials, objects, lights and
/// volumes a value may be animated:
///   {"keys": [{"frame": 1, "value": V}, ...], "interpolation": "linear" | "smooth"}
/// becomes the value between its keys, at the place of the object in the file, and the first or
/// last key's before and after them. V is a number, an array of numbers, or a rotation {"axis",
/// "degrees"}, which turns the shorter way (quaternions). "smooth" curves do not overshoot their
/// keys. Names of files (mesh, map, grid) get the frame's number in place of "####" or "%04d".
/// Throws Error{BadInput} at the place in `file` of what cannot be meant.
JsonValue sceneAt(const JsonValue& root, int frame, const std::string& file);

/// Whether anything in it differs from frame to frame: all of it, or below one of its members.
bool isAnimated(const JsonValue& value);

/// The frames of all keys below a value, in order, each once.
std::vector<double> keyFrames(const JsonValue& value);

void listAnimationKeys(std::vector<KeyList>& out);

}  // namespace sss
