#pragma once
#include "sss/world/world.h"

#include <cstdint>
#include <vector>

namespace sss {

/// Which pixels can show anything but a background that is the same everywhere: the others need no
/// rays. With a background that varies, or a lens, all can.
class Foreground {
public:
    /// `reachPixels`: how far from a pixel's centre its samples lie.
    Foreground(const World& world, float reachPixels);
    bool mayShow(int x, int y) const { return covers_[cell(y) * columns_ + cell(x)] > 0; }
    /// Radiance of the background where mayShow() is false.
    const Rgb& background() const { return background_; }

private:
    std::size_t cell(int pixel) const { return static_cast<std::size_t>(pixel / cellPixels_); }
    void add(const Camera::Window& window);
    void addTriangles(const RayScene::Geometry& geometry, const Camera& camera);
    void sumUp();

    int width_, height_;
    float reach_;
    int cellPixels_;  // side of a cell
    std::size_t columns_;
    std::vector<std::int32_t> covers_;  // by cell, what may show there; differences until sumUp()
    Rgb background_{0.0f};
};

}  // namespace sss
