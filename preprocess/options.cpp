#include "options.h"

#include "sss/app/stage_chain.h"
#include "sss/base/error.h"
#include "sss/base/frame_list.h"
#include "sss/scene/material_override.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cmath>

namespace {

constexpr const char* kHelp =
    R"(sss-preprocess {} - sample translucent objects and cache what light enters them

usage: sss-preprocess [options] SCENE -o CACHE
       sss-preprocess --info CACHE [--json]

Input
  SCENE                   scene file (JSON, see scenes/README.md)
  --meters-per-unit M     length of a scene unit [the scene's metersPerUnit; m]
  --info CACHE            describe a cache on standard output, and do nothing else
  --print-estimate        how many points, memory and time it will take, and do nothing else
  --json                  ... either as JSON

Quality
  --tolerance T           relative error of diffusion [the scene's, or 0.01]
  --spacing MM            distance between points [from tolerance and mean free path; mm]
  --seed N                of points and light samples [the scene's, or 0]
  --model NAME            of all translucent materials: a profile (dipole, better_dipole,
                          photon_beam, ...), or shape: diffusion solved on the object itself
                          [the scene's, or dipole]
  --boundary KIND         exact, or polynomial: the papers' Fresnel fits, for all translucent
                          materials [the scene's, or exact]
  --max-points N          refuse, before allocating, an object with more [20000000]

Frames of an animated scene (scenes/README.md)
  --frames LIST           1-24, 1-100x2, 10-1x-1, 1,5,9-12; CACHE and PLY take the number in place
                          of #### or %04d [frame 1]
  --explain               print which stages each frame reused, and why others were made

Output
  -o, --output CACHE      cache file; replaced only when the new one is whole
  -o, --output DIR/       a folder of stages (points, irradiance), which scenes, frames and
                          processes may share: what is there already is not made again
  --export-ply PLY        also write the points for MeshLab or Blender
  --stats JSON            write what the run cost

Run
  --threads N             0 = all cores [0]
  --quiet                 only warnings
  --progress HOW          plain lines, json lines, none [a bar on a terminal, else plain]
  --strict                exit 6 if there was any warning
  --help, --version

Examples
  sss-preprocess scenes/bunny/demo.json -o bunny.ssc
  sss-preprocess scenes/bunny/demo.json -o fine.ssc --tolerance 0.003 --stats fine.json
  sss-preprocess scenes/moving-light/moving-light.json --frames 1-24 -o light/ --explain
  sss-preprocess --info bunny.ssc --json

Exit codes: 0 done, 1 internal error, 2 usage, 3 bad input, 4 could not read or write,
5 out of memory or over a limit, 6 warnings under --strict, 130 or 143 interrupted
(exit codes are those of both programs)
)";

[[noreturn]] void usage(const std::string& where, const std::string& what) {
    throw sss::Error(sss::ErrorKind::Usage, where, what, "see sss-preprocess --help");
}

void check(const PreprocessOptions& o) {
    if (!o.info.empty()) return;
    if (o.json && !o.printEstimate) usage("--json", "goes with --info and --print-estimate");
    if (o.scene.empty()) usage("SCENE", "no scene file given");
    if (o.frames.size() > 1 && !o.printEstimate && !sss::isFolderName(o.cache) &&
        !sss::hasFrameField(o.cache.string()))
        usage("--output", fmt::format("{} would hold the last of {} frames only: give the number a "
                                      "place (####), or name a folder (DIR/)",
                                      o.cache.string(), o.frames.size()));
    if (o.cache.empty() && !o.printEstimate) usage("--output", "no cache file given (-o CACHE)");
    if (o.tolerance && !(*o.tolerance > 0 && *o.tolerance <= 0.5))
        usage("--tolerance", fmt::format("{} is not in (0, 0.5]", *o.tolerance));
    if (o.spacingMm && !(*o.spacingMm > 0 && std::isfinite(*o.spacingMm)))
        usage("--spacing", fmt::format("{} mm is not a positive length", *o.spacingMm));
    if (o.metersPerUnit && !(*o.metersPerUnit > 0 && std::isfinite(*o.metersPerUnit)))
        usage("--meters-per-unit", fmt::format("{} is not a positive length", *o.metersPerUnit));
    if (o.maxPoints == 0) usage("--max-points", "must be at least 1");
    if (o.threads > 1024) usage("--threads", fmt::format("{} is more than 1024", o.threads));
}

}  // namespace

std::optional<PreprocessOptions> readOptions(int argc, const char* const* argv) {
    PreprocessOptions o;
    CLI::App app;
    app.set_help_flag();
    bool help = false, version = false;
    std::string boundary, frames, progress;
    app.add_flag("-h,--help", help);
    app.add_flag("--version", version);
    app.add_option("scene", o.scene);
    app.add_option("-o,--output", o.cache);
    auto* framesOption = app.add_option("--frames", frames);
    app.add_flag("--explain", o.explain);
    app.add_flag("--print-estimate", o.printEstimate);
    app.add_option("--progress", progress);
    app.add_option("--info", o.info);
    app.add_flag("--json", o.json);
    app.add_option("--export-ply", o.exportPly);
    app.add_option("--stats", o.stats);
    app.add_option("--spacing", o.spacingMm);
    app.add_option("--tolerance", o.tolerance);
    app.add_option("--meters-per-unit", o.metersPerUnit);
    app.add_option("--model", o.model);
    app.add_option("--boundary", boundary);
    app.add_option("--seed", o.seed)->check(CLI::NonNegativeNumber);
    app.add_option("--max-points", o.maxPoints)->check(CLI::NonNegativeNumber);
    app.add_option("--threads", o.threads)->check(CLI::NonNegativeNumber);
    app.add_flag("--quiet", o.quiet);
    app.add_flag("--strict", o.strict);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        usage("command line", e.what());
    }
    if (help || version) {
        if (help)
            fmt::print(fmt::runtime(kHelp), SSS_VERSION);
        else
            fmt::print("sss-preprocess {}\n", SSS_VERSION);
        return std::nullopt;
    }
    if (framesOption->count() > 0) o.frames = sss::parseFrames(frames, "--frames");
    if (!progress.empty()) o.progress = sss::progressStyle(progress, "--progress");
    if (!boundary.empty()) o.boundary = sss::boundaryModel(boundary, "--boundary");
    check(o);
    return o;
}
