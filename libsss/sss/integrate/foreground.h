#pragma once
#include "sss/world/world.h"

#include <vector>

namespace sss {

/// Which pixels can show anything but a background that is the same everywhere: the others need no
/// rays. With a background that varies, or a lens, all can.
class Foreground {
public:
    /// `reachPixels`: how far from a pixel's centre its samples lie.
    Foreground(const World& world, float reachPixels);
    bool mayShow(int x, int y) const;
    /// Radiance of the background where mayShow() is false.
    const Rgb& background() const { return background_; }

private:
    std::vector<Camera::Window> windows_;
    float reach_;
    bool isEverywhere_ = false;
    Rgb background_{0.0f};
};

}  // namespace sss
