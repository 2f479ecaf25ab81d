#pragma once
#include "sss/base/json.h"
#include "sss/integrate/preprocess.h"

#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>

namespace sss {

/// What pass 1 of a world, or of the frames of an animation, will cost, before it is done. A stage
/// that frames share is counted once.
class PassOneEstimate {
public:
    /// `reference`: as in StageChain::prepare().
    void add(const World& world, const World* reference);

    /// {"points", "memoryBytes", "seconds", "bodies": [{"name", "points", "spacingMm"}]}. Points
    /// are those that have to be placed; memory is that of the points and their cells in the frame
    /// with most of them, beside the meshes'; seconds are measured on a few points of each body,
    /// with the threads there are.
    JsonValue total() const;

private:
    struct Trial {
        double secondsToPlace = 0, secondsToLight = 0;  ///< all its points
    };
    Trial tryOut(const World& light, int body, std::span<const std::unique_ptr<BodyOptics>> optics,
                 double wanted, double spacingMm) const;

    std::map<std::string, Trial> trials_;  // by the fingerprint of the points
    std::set<std::string> lit_;            // fingerprints of what comes of light
    double points_ = 0, mostPoints_ = 0, seconds_ = 0;
    JsonValue bodies_ = JsonValue::array();
};

}  // namespace sss
