#pragma once
#include "sss/base/json.h"
#include "sss/base/reporter.h"
#include "sss/scene/scene.h"
#include "sss/world/world.h"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

namespace sss {

/// A scene file by frame, and the worlds of its frames: what two frames have in common is read,
/// built and spoken of once.
class SceneFrames {
public:
    /// `adjust` puts the options of the command line into each scene. Throws as readScene does.
    SceneFrames(std::filesystem::path file, std::optional<double> metersPerUnit,
                std::function<void(Scene&)> adjust, Reporter& reporter);

    Scene at(int frame) const;
    /// The world of a scene that at() gave. The last one is returned again if the camera and its
    /// noise are all that differs: then `sameWorld` is set.
    std::shared_ptr<const World> world(const Scene& scene, bool& sameWorld);
    /// The world of the reference frame if the scene has anything that may deform; else null.
    const World* reference(const Scene& scene);
    /// Of everything that the picture of a scene depends on, the contents of its files among it.
    Fingerprint pictureFingerprint(const Scene& scene);

private:
    std::string withoutView(int frame) const;
    void chooseSpacings();
    const Fingerprint& contentOf(const std::filesystem::path& file);

    std::filesystem::path file_;
    JsonValue root_;
    std::optional<double> metersPerUnit_;
    std::function<void(Scene&)> adjust_;
    Reporter& reporter_;
    std::map<std::string, double> spacingMm_;  // by animated material
    MeshStore meshes_;
    std::shared_ptr<World> last_;
    std::string lastText_;
    bool isReferenceMade_ = false;
    std::unique_ptr<const World> reference_;
    std::map<std::filesystem::path, Fingerprint> contents_;
};

/// Passes on each sentence once, however many frames say it.
class OnceReporter final : public Reporter {
public:
    explicit OnceReporter(Reporter& to) : to_(to) {}
    void info(std::string_view module, std::string_view sentence) override;
    void warn(std::string_view module, std::string_view sentence) override;
    void progress(std::string_view phase, double fraction, double secondsLeft, bool done) override;

private:
    bool isNew(std::string_view module, std::string_view sentence);
    Reporter& to_;
    std::set<std::string> said_;
    std::mutex mutex_;
};

}  // namespace sss
