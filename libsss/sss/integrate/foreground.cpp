#include "sss/integrate/foreground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace sss {
namespace {

constexpr int kMostCells = 512;  // a side: one a pixel of usual pictures, in a MiB
constexpr float kFar = std::numeric_limits<float>::max();
constexpr Camera::Window kEverywhere{Vec2(-kFar), Vec2(kFar)};

// The first and last of `count` pixels whose centres lie in [lo, hi]; first > last if none.
struct PixelSpan {
    PixelSpan(float lo, float hi, int count)
        : first(static_cast<int>(std::ceil(std::clamp(lo - 0.5f, 0.0f, float(count))))),
          last(static_cast<int>(std::floor(std::clamp(hi - 0.5f, -1.0f, float(count - 1))))) {}
    int first, last;
};

}  // namespace

Foreground::Foreground(const World& world, float reachPixels)
    : width_(world.scene().film.width),
      height_(world.scene().film.height),
      reach_(reachPixels),
      cellPixels_((std::max(width_, height_) - 1) / kMostCells + 1),
      // One row and column more than there are cells, for where coverage ends.
      columns_(cell(width_ - 1) + 2),
      covers_(columns_ * (cell(height_ - 1) + 2)) {
    const Camera& camera = world.camera();
    for (std::size_t object = 0; object < world.objectCount(); ++object)
        addTriangles(world.geometry(object), camera);
    for (const auto& volume : world.volumes()) add(camera.windowOf(volume->bounds()));
    for (const auto& light : world.lights()) {
        if (light->isDelta()) continue;
        add(camera.windowOf(light->visibleBounds()));
        if (!light->isInfinite()) continue;
        if (light->isUniform())
            background_ += light->seen({}, camera.forward()).radiance;
        else
            add(kEverywhere);
    }
    sumUp();
}

void Foreground::addTriangles(const RayScene::Geometry& geometry, const Camera& camera) {
    std::vector<Vec2> pixels;
    pixels.reserve(geometry.positions.size());
    for (const Vec3& position : geometry.positions) {
        const std::optional<Vec2> pixel = camera.pixelOf(position);
        if (!pixel) return add(kEverywhere);
        pixels.push_back(*pixel);
    }
    // What is wholly in front is seen between where its corners are seen.
    for (const UVec3& face : geometry.faces) {
        const Vec2 &a = pixels[face.x], &b = pixels[face.y], &c = pixels[face.z];
        add({glm::min(a, glm::min(b, c)) - Camera::kPixelError,
             glm::max(a, glm::max(b, c)) + Camera::kPixelError});
    }
}

// Coverage as its differences along both axes: four numbers for a window of any size.
void Foreground::add(const Camera::Window& window) {
    const PixelSpan x(window.lo.x - reach_, window.hi.x + reach_, width_);
    const PixelSpan y(window.lo.y - reach_, window.hi.y + reach_, height_);
    if (x.first > x.last || y.first > y.last) return;
    const std::size_t left = cell(x.first), right = cell(x.last) + 1;
    const std::size_t top = cell(y.first) * columns_, below = (cell(y.last) + 1) * columns_;
    ++covers_[top + left];
    --covers_[top + right];
    --covers_[below + left];
    ++covers_[below + right];
}

void Foreground::sumUp() {
    for (std::size_t i = 0; i < covers_.size(); ++i)
        if (i % columns_ > 0) covers_[i] += covers_[i - 1];
    for (std::size_t i = columns_; i < covers_.size(); ++i) covers_[i] += covers_[i - columns_];
}

}  // namespace sss
