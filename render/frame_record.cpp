#include "frame_record.h"

#include "sss/cloud/interactions.h"

#include <fmt/core.h>

using namespace sss;

namespace {

// Share of the paths that may meet a surface where none should be, by rounding.
constexpr double kUsualLeaks = 0.01;

void recordPaths(RunStats& stats, const Scene& scene, const RenderResult& result) {
    stats.count("cameraSamples", result.counts.cameraSamples);
    stats.count("rays", result.counts.rays);
    stats.count("diffusionEvaluations", result.counts.diffusionLookups);
    stats.count("singleScatteringSamples", result.counts.singleSamples);
    stats.count("scatterings", result.counts.scatterings);
    stats.count("volumeStretches", result.counts.volumeStretches);
    stats.count("leaks", result.counts.leaks);
    stats.count("lostPaths", result.counts.lost);
    stats.value("integrator", scene.quality.integrator);
    stats.count("nan", result.dropped.samples);
}

// What was left out because it brings nothing, or is known already.
void recordSkips(RunStats& stats, const PathCounts& counts, bool needsFields,
                 std::span<const std::unique_ptr<BodyOptics>> optics) {
    int equalChannels = 0;
    std::uint64_t limits = 0;
    for (const auto& body : optics) {
        equalChannels += body->equalChannels();
        limits += body->inDiffuseLimit ? 1 : 0;
    }
    stats.count("equalChannels", static_cast<std::uint64_t>(equalChannels));
    stats.count("diffuseLimitBodies", limits);
    stats.count("passOneSkipped", needsFields && limits < optics.size() ? 0 : 1);
    stats.count("singleScatteringSkipped", counts.singleSkipped);
}

}  // namespace

void addMetadata(LayeredImage& image, const World& world, const Fingerprint& made,
                 std::span<const std::unique_ptr<BodyOptics>> optics) {
    const Scene& scene = world.scene();
    auto& meta = image.metadata;
    meta["Software"] = std::string("sss-render " SSS_VERSION);
    meta["sss/version"] = std::string(SSS_VERSION);
    meta["sss/scene"] = scene.file.filename().string();
    meta["sss/spp"] = scene.film.samples;
    meta["samplesPerPixel"] = scene.film.samples;
    meta["sss/seed"] = static_cast<double>(scene.quality.seed);
    meta["sss/metersPerUnit"] = scene.metersPerUnit;
    meta["sss/tolerance"] = scene.quality.tolerance;
    meta["sss/cacheHash"] = made == Fingerprint{} ? std::string("none") : made.hex();
    meta["imageCounter"] = scene.frame;
    meta["sss/integrator"] = scene.quality.integrator;
    meta["colorInteropID"] = std::string("lin_rec709_scene");
    std::string paths;
    for (std::size_t b = 0; b < optics.size(); ++b) {
        const DRgb mfp = optics[b]->material.medium.meanFreePathMm();
        paths += fmt::format("{}{} {:.4g} {:.4g} {:.4g}", b ? "; " : "", world.bodies()[b].name,
                             mfp.x, mfp.y, mfp.z);
    }
    meta["sss/mfp_mm"] = paths;
    meta["worldToCamera"] = world.camera().worldToCamera();
    meta["worldToNDC"] = world.camera().worldToNdc();
}

void recordRender(RunStats& stats, const Scene& scene, const RenderResult& result, bool needsFields,
                  std::span<const std::unique_ptr<BodyOptics>> optics) {
    recordPaths(stats, scene, result);
    recordSkips(stats, result.counts, needsFields, optics);
}

void recordExitance(RunStats& stats, const ExitanceCounts& total) {
    stats.count("exitanceSites", total.sites);
    stats.count("exitanceGroups", total.groups);
    stats.count("exitanceRefinements", total.refinements);
    stats.count("exitanceUnsettled", total.unsettled);
    stats.count("sumReceivers", total.sums.receivers);
    stats.count("localInteractions", total.sums.localInteractions);
    stats.count("nodeInteractions", total.sums.nodeInteractions);
    stats.count("pointInteractions", total.sums.pointInteractions);
    stats.count("skippedNodes", total.sums.nodesSkipped);
    stats.count("skippedPoints", total.sums.pointsSkipped);
    stats.value("instructionSet", accumulateTarget());
}

void warnOfFlaws(const RenderResult& result, Reporter& reporter) {
    if (result.dropped.samples > 0)
        reporter.warn(
            "render",
            fmt::format("{} camera samples were not finite and were left out, the first "
                        "in pixel {}, {}",
                        result.dropped.samples, result.dropped.firstX, result.dropped.firstY));
    const PathCounts& counts = result.counts;
    if (static_cast<double>(counts.leaks) > kUsualLeaks * static_cast<double>(counts.cameraSamples))
        reporter.warn("render",
                      fmt::format("{} times in {} paths, light inside a body met a face from "
                                  "outside, or found no way out: the body's meshes cut each other "
                                  "or have holes, and light goes astray there",
                                  counts.leaks, counts.cameraSamples));
    if (counts.lost > 0)
        reporter.warn("render", fmt::format("{} paths did not end and were cut", counts.lost));
}
