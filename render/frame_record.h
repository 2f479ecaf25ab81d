#pragma once
#include "sss/app/run_stats.h"
#include "sss/integrate/body_field.h"
#include "sss/integrate/renderer.h"

#include <memory>
#include <span>

// What a frame says of itself: in its picture, in the statistics, and to the user.

/// Names the program, scene, options and media in the picture. `made` is of what the lighting comes
/// from, zero for integrators that keep none.
void addMetadata(sss::LayeredImage& image, const sss::World& world, const sss::Fingerprint& made,
                 std::span<const std::unique_ptr<sss::BodyOptics>> optics);

/// Counts the frame's rays, samples and evaluations, and what was left out because it brings
/// nothing or is known already.
void recordRender(sss::RunStats& stats, const sss::Scene& scene, const sss::RenderResult& result,
                  bool needsFields, std::span<const std::unique_ptr<sss::BodyOptics>> optics);

/// Counts what the exitance of all frames took.
void recordExitance(sss::RunStats& stats, const sss::ExitanceCounts& total);

/// Warns of samples that were dropped and of light that went astray.
void warnOfFlaws(const sss::RenderResult& result, sss::Reporter& reporter);
