#pragma once
#include "sss/base/bounds.h"
#include "sss/volume/density_grid.h"
#include "sss/volume/volume_region.h"

#include <optional>
#include <span>
#include <vector>

namespace sss {

/// A stretch of a ray within one volume, with the density along it.
struct VolumePiece {
    float begin = 0, end = 0;  ///< mm along the ray
    DensityCubic density;      ///< in s = (t - begin) / (end - begin)

    float length() const { return end - begin; }
    float shareAt(float t) const { return std::clamp((t - begin) / length(), 0.0f, 1.0f); }
};

/// Where a volume is: the unit cube, in which its grid lies, placed in the world's space, and which
/// part of it.
struct VolumePlace {
    enum class Part { Cube, Ball, Mesh };
    DMat4 worldFromUnit{1.0};  ///< invertible
    Part part = Part::Cube;
    TriangleMesh mesh{};  ///< in the world's space, closed; if that is the part
};

/// What fills a volume where the density is 1, mm^-1.
struct VolumeCoefficients {
    Rgb sigmaS{0.0f}, sigmaT{0.0f};
    Rgb glow{0.0f};  ///< sigma_a L_e [Koutajoki Eq. 3], W m^-2 sr^-1 mm^-1
    float g = 0;
};

/// A participating medium in space, homogeneous or from a grid. Const and thread-safe.
class Volume {
public:
    /// Opens the grid's file; throws its errors.
    Volume(const VolumeSettings& settings, const VolumePlace& place);

    const VolumeCoefficients& coefficients() const { return coefficients_; }
    bool scatters() const { return !isZero(coefficients_.sigmaS); }
    bool glows() const { return !isZero(coefficients_.glow); }
    /// Appends its pieces along [0, end] of a ray of unit direction, in order, without overlap;
    /// where it is empty there are none.
    void addPieces(const Vec3& origin, const Vec3& direction, float end,
                   std::vector<VolumePiece>& pieces) const;

    /// The box around it.
    const Bounds& bounds() const { return bounds_; }
    const std::optional<DensityGrid>& grid() const { return grid_; }
    UnitLine unitLine(const Vec3& origin, const Vec3& direction) const;
    Vec3 worldFromUnit(const DVec3& p) const;
    /// Of the unit cube in the world, mm^3.
    double cubeMm3() const { return std::abs(glm::determinant(DMat3(worldFromUnit_))); }

private:
    void addCells(const UnitLine& line, const RayInterval& inside,
                  std::vector<VolumePiece>& pieces) const;

    VolumeCoefficients coefficients_;
    DMat4 worldFromUnit_, unitFromWorld_;
    VolumePlace::Part part_;
    std::optional<MeshInterior> mesh_;
    std::optional<DensityGrid> grid_;
    Bounds bounds_;
};

}  // namespace sss
