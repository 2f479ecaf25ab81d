#pragma once
#include "sss/base/vec.h"

#include <filesystem>
#include <span>

namespace sss {

/// Sample points as parallel arrays of one length.
struct PlyPoints {
    std::span<const Vec3> positions;   ///< mm
    std::span<const Vec3> normals;     ///< unit
    std::span<const float> areas;      ///< mm^2
    std::span<const Rgb> irradiances;  ///< W m^-2
};

/// Writes a binary little-endian PLY with a vertex a point: x y z nx ny nz area irradiance_r
/// irradiance_g irradiance_b, all float, as MeshLab and Blender open it. Throws Error{Io}; a file
/// that stands there is replaced only by a whole one.
void exportPly(const std::filesystem::path& path, const PlyPoints& points);

}  // namespace sss
