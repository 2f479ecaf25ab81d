#include "sss/app/frame_run.h"

#include "sss/app/scene_frames.h"
#include "sss/base/atomic_file.h"
#include "sss/base/parallel.h"

namespace sss {

void runFrames(const char* program, const CommonOptions& options,
               std::span<const std::filesystem::path> outputs, const FrameRun& body) {
    RunStats stats(program);
    TerminalOptions terminal;
    terminal.quiet = options.quiet;
    terminal.progress = options.progress;
    TerminalReporter log(terminal);
    OnceReporter reporter(log);
    const ThreadLimit threads(options.threads);
    if (!options.stats.empty()) requireWritable(options.stats);
    for (const std::filesystem::path& output : outputs)
        if (!output.empty()) requireWritable(output);
    body(log, reporter, stats);
    stats.value("threads", ThreadLimit::current());
    if (!options.stats.empty()) stats.writeStats(options.stats);
    if (options.strict) log.requireNoWarnings();
}

}  // namespace sss
