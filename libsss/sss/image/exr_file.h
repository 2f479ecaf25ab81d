#pragma once
#include "sss/image/image.h"

#include <filesystem>

namespace sss {

struct ExrOptions {
    /// 16-bit floats for every layer that does not ask for full precision.
    bool halfPrecision = true;
};

/// Writes all layers as one scanline part (ZIP, 16 lines a block): channels "R G B A" of the
/// unnamed layer, "layer.C" of the others, a bare "C" for a layer called C. Chromaticities Rec.709
/// with D65. Metadata becomes attributes: text, float, int, M44f; the same input gives the same
/// bytes. Values beyond the range of the file's numbers become the largest finite one, NaN
/// becomes 0. Throws Error{Io}, and then no file is left or changed; Error{Internal} for layers
/// whose sizes disagree or a metadata name that the format keeps for itself.
void writeExr(const std::filesystem::path& path, const LayeredImage& image,
              const ExrOptions& options = {});

/// Reads every layer of the (first part of the) file as float, scanline or tiled, with text,
/// number and matrix attributes as metadata. The picture is the data window. Throws Error{Io} for
/// a missing file and Error{BadInput} for one that is no EXR, is truncated or corrupt, is deep, has
/// subsampled channels, or whose stated size is absurd (checked before allocation).
LayeredImage readExr(const std::filesystem::path& path);

}  // namespace sss
