#include "sss/integrate/foreground.h"

namespace sss {

Foreground::Foreground(const World& world, float reachPixels) : reach_(reachPixels) {
    const Camera& camera = world.camera();
    windows_.push_back(camera.windowOf(world.bounds()));
    for (const auto& light : world.lights()) {
        if (light->isDelta()) continue;
        const Bounds box = light->visibleBounds();
        if (!box.isEmpty()) windows_.push_back(camera.windowOf(box));
        if (!light->isInfinite()) continue;
        if (light->isUniform())
            background_ += light->seen({}, camera.forward()).radiance;
        else
            isEverywhere_ = true;
    }
}

bool Foreground::mayShow(int x, int y) const {
    const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    for (const Camera::Window& window : windows_) {
        const bool isInside = centre.x + reach_ >= window.lo.x &&
                              centre.x - reach_ <= window.hi.x &&
                              centre.y + reach_ >= window.lo.y && centre.y - reach_ <= window.hi.y;
        if (isInside) return true;
    }
    return isEverywhere_;
}

}  // namespace sss
