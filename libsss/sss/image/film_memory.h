#pragma once
#include <string>
#include <vector>

namespace sss {

/// Throws Error{Resource} if there is not the memory for a picture of these layers (see
/// filmLayers()) and for writing it: for whoever has long work to do before the first pixel.
void requireFilmMemory(int width, int height, const std::vector<std::string>& layers);

}  // namespace sss
