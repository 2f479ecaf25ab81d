#pragma once
#include "sss/volume/volume_segment.h"
#include "support/temporary_folder.h"

#include <fstream>
#include <functional>
#include <memory>
#include <vector>

namespace sss::testing {

/// A grey volume of unit density.
inline VolumeSettings greyVolume(float sigmaA, float sigmaS, float emission = 0) {
    VolumeSettings settings;
    settings.sigmaA = Rgb(sigmaA);
    settings.sigmaS = Rgb(sigmaS);
    settings.emission = Rgb(emission);
    return settings;
}

/// The box between two corners, or the ball in it.
inline VolumePlace placeBetween(const DVec3& lo, const DVec3& hi,
                                VolumePlace::Part part = VolumePlace::Part::Cube) {
    VolumePlace place;
    place.part = part;
    place.worldFromUnit = glm::scale(glm::translate(DMat4(1.0), lo), hi - lo);
    return place;
}

/// Writes the values of f(x, y, z), one or four a node, at the nodes over the unit cube.
inline GridFile writeGrid(const std::filesystem::path& path, const std::array<int, 3>& nodes,
                          int channels,
                          const std::function<float(const DVec3& p, int channel)>& f) {
    std::ofstream out(path, std::ios::binary);
    for (int z = 0; z < nodes[2]; ++z)
        for (int y = 0; y < nodes[1]; ++y)
            for (int x = 0; x < nodes[0]; ++x)
                for (int c = 0; c < channels; ++c) {
                    const DVec3 p(x / (nodes[0] - 1.0), y / (nodes[1] - 1.0), z / (nodes[2] - 1.0));
                    const float value = f(p, c);
                    out.write(reinterpret_cast<const char*>(&value), sizeof(value));
                }
    return {path, nodes[0], nodes[1], nodes[2], channels};
}

}  // namespace sss::testing
