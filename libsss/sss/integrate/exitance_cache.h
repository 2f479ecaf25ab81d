#pragma once
#include "sss/base/hash.h"
#include "sss/base/reporter.h"
#include "sss/integrate/body_field.h"
#include "sss/integrate/scene_fingerprint.h"
#include "sss/world/world.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace sss {

/// Of all that the exitance of a body depends on; `inputs` of its pass 1.
Fingerprint exitanceFingerprint(const World& world, int body, const BodyInputs& inputs);

/// "CACHE.exitance".
std::filesystem::path exitanceFileOf(const std::filesystem::path& cloudCache);

/// Radiant exitance kept beside a cache of clouds: what one frame has computed
/// serves all later ones, which add what they see for the first time. A body's part is used only if
/// all it depends on is the same: points, light, medium, profile, tolerance. Values are the same
/// bytes whether computed or read. Several processes may share the file: it is replaced as a whole,
/// and what others have added is kept.
class ExitanceCache {
public:
    /// `fingerprints` by body: what its exitance depends on (exitanceFingerprint).
    ExitanceCache(std::filesystem::path file, std::vector<Fingerprint> fingerprints);

    const std::filesystem::path& file() const { return file_; }
    /// Hands the fields what the file has for them; returns how many groups. A missing file is no
    /// fault; a damaged one is named in a warning and made anew by save().
    std::uint64_t load(std::span<const std::unique_ptr<BodyField>> fields, Reporter& reporter);
    /// Writes all that is known, if that is more than was read. Where that cannot be done (a folder
    /// that may not be written to) it says so, and nothing is lost but time.
    void save(std::span<const std::unique_ptr<BodyField>> fields, Reporter& reporter);

private:
    std::uint64_t adopt(std::span<const std::unique_ptr<BodyField>> fields);

    std::filesystem::path file_;
    std::vector<Fingerprint> fingerprints_;
};

}  // namespace sss
