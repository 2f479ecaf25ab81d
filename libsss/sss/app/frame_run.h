#pragma once
#include "sss/app/common_options.h"
#include "sss/app/run_stats.h"

#include <functional>
#include <span>

namespace sss {

/// What a program does with a scene's frames, between its log and its statistics.
using FrameRun = std::function<void(TerminalReporter& log, Reporter& reporter, RunStats& stats)>;

/// Runs `body` with the threads and the log that were asked for; writes the statistics at its end
/// and, if strict, throws where there were warnings. `outputs` are further files that must be
/// writable, empty names aside. Throws Error.
void runFrames(const char* program, const CommonOptions& options,
               std::span<const std::filesystem::path> outputs, const FrameRun& body);

}  // namespace sss
