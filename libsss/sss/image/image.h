#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace sss {

/// A group of channels of one picture: "R,G,B,A" without a name (beauty), or "diffusion" with
/// R,G,B. A layer whose only channel bears the layer's own name ("Z" with Z) is a bare channel in
/// the file.
struct ImageLayer {
    std::string name;                   ///< empty for the beauty layer
    std::vector<std::string> channels;  ///< e.g. {"R","G","B"}, {"X","Y","Z"}, {"Z"}
    std::vector<float> values;          ///< row by row from the top left, channels interleaved
    bool fullPrecision = false;         ///< float in the file whatever the writer's default
};

/// Sixteen numbers are a 4 x 4 matrix in OpenEXR's order, rows of a matrix that acts on row
/// vectors: the same memory as GLM's columns of a matrix that acts on column vectors.
using MetadataValue = std::variant<std::string, double, int, std::array<double, 16>>;

/// A scene-linear picture with named layers of one size.
struct LayeredImage {
    int width = 0, height = 0;
    std::vector<ImageLayer> layers;
    std::map<std::string, MetadataValue> metadata;

    /// The layer called `name`; nullptr if there is none.
    const ImageLayer* find(const std::string& name) const;
    std::size_t pixelCount() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
};

}  // namespace sss
