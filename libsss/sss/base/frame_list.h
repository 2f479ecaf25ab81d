#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace sss {

/// The frames that a specification names, in its order, each once; as render farms write them:
/// "5", "1-10", "1-100x2" (every second), "1-10y3" (those that x3 leaves out), "1-10:4" (coarse to
/// fine: x4, then x2, then the rest), "10-1x-1" (backwards), and several with commas between.
/// Frames are whole numbers from -999999 to 999999, at most 1000000 of them. Throws
/// Error{Usage} at `where` for anything else.
std::vector<int> parseFrames(std::string_view text, const std::string& where);

/// Whether a file's name has a place for the frame's number: "####" (two # or more) or "%04d".
bool hasFrameField(std::string_view name);

/// The name with the number in every such place, as wide as the # or as the width after %0 at
/// least; other names as they are.
std::string frameName(std::string_view name, int frame);

}  // namespace sss
