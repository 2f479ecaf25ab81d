#pragma once
#include "sss/integrate/preprocess.h"
#include "sss/scene/scene.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace sss::bench {

/// A scene opened for measuring: its world, optics and, on request, a pass 1 at other settings.
class Stage {
public:
    /// Throws Error{BadInput} unless the scene has exactly one translucent body: what is measured
    /// is a body.
    explicit Stage(const Scene& scene);

    const World& world() const { return world_; }
    const Body& body() const { return world_.bodies().front(); }
    const BodyOptics& optics() const { return *optics_.front(); }
    std::span<const std::unique_ptr<BodyOptics>> allOptics() const { return optics_; }

    struct Made {
        BodyCloud cloud;
        BodyReport report;
    };
    /// Pass 1 with the scene's own settings.
    Made makeCloud() const;

private:
    SilentReporter reporter_;
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
};

/// A scene file with the settings that the bench changes; 0 leaves the scene's own.
struct Quality {
    double spacingMm = 0;
    double tolerance = 0;
    int irradianceSamples = 0;
    std::uint64_t seed = 0;
};
Scene readScene(const std::filesystem::path& file, const Quality& quality);

}  // namespace sss::bench
