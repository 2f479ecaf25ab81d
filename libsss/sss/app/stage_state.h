#pragma once
// What stage_chain.cpp and stage_maker.cpp share.
#include "sss/app/stage_chain.h"

namespace sss {

struct StageChain::Generation {
    std::shared_ptr<const World> world;
    std::vector<std::unique_ptr<BodyOptics>> optics;
};

struct StageChain::BodyStage {
    BodyInputs inputs;
    Fingerprint points, light, shape, exitance;
    const TriangleMesh* placedOn = nullptr;         // of the reference frame, if points are carried
    std::shared_ptr<const SurfaceSamples> samples;  // as placed, where there is no folder
    std::shared_ptr<const SurfaceSamples> lit;      // as they are, until the body is done
    std::shared_ptr<const EnteredBeams> beams;      // in the cloud's order

    // What the view looks into: a stage's file, a cache file, or what was made.
    std::shared_ptr<const CacheFile> file, shapeFile;
    std::shared_ptr<const CloudCache> cache;
    std::shared_ptr<const BodyCloud> made;
    std::shared_ptr<const std::vector<SolvedExitance>> solved;
    BodyCloud::View view;
    bool hasLight = false, hasShape = false;  // in the view
    BodyReport report;

    // Why a stage was made for this frame; empty if it was not.
    std::string whyPoints, whyLight, whyOctree, whyShape;

    /// What a stage's file is called by.
    const Fingerprint& madeFrom(Stage kind) const {
        return kind == Stage::Points ? points : kind == Stage::Correction ? shape : light;
    }
};

}  // namespace sss
