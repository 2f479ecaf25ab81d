#pragma once
#include "sss/base/bounds.h"
#include "sss/base/vec.h"
#include "sss/geom/ray_scene.h"
#include "sss/scene/scene.h"

#include <array>
#include <optional>

namespace sss {

/// Perspective camera with a thin lens, in the world's space.
class Camera {
public:
    /// The field of view is vertical; `originMm` is subtracted from positions.
    Camera(const CameraSettings& settings, int width, int height, const DVec3& originMm);

    /// Ray through `pixel` (0, 0 = the top left corner of the film), from `lens` in [0, 1)^2.
    Ray ray(const Vec2& pixel, const Vec2& lens) const;
    /// Whether ray() looks at `lens`: a pinhole does not.
    bool hasLens() const { return apertureRadius_ > 0; }
    /// The pixels, as coordinates of ray(), that rays which meet `box` can go through: all, where
    /// that is not easily said (a lens, a box not wholly in front).
    struct Window {
        Vec2 lo, hi;
    };
    Window windowOf(const Bounds& box) const;
    /// The pixel through which the ray to `point` goes, within kPixelError; none where that is not
    /// easily said (through a lens, or if the point is not in front).
    std::optional<Vec2> pixelOf(const Vec3& point) const;
    static constexpr float kPixelError = 0.01f;
    /// mm: no pixel is narrower, across its ray, at anything in `box`. 0 if that is not all in
    /// front.
    double pixelWidthMm(const Bounds& box) const;
    const Vec3& forward() const { return forward_; }
    /// OpenEXR's worldToCamera and worldToNDC, in scene millimetres (not recentred), row vectors.
    std::array<double, 16> worldToCamera() const;
    std::array<double, 16> worldToNdc() const;

private:
    DVec3 positionMm_;  // as in the scene
    Vec3 position_;     // recentred
    Vec3 right_, up_, forward_;
    double tanHalfFov_, tanPerPixel_;
    int width_, height_;
    float apertureRadius_, focusDistance_;
};

}  // namespace sss
