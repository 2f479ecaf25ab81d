#include "options.h"

#include "sss/app/stage_chain.h"

#include <CLI/CLI.hpp>

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

constexpr sss::ProgramText kProgram{"sss-preprocess", kHelp};

void check(const PreprocessOptions& o) {
    const auto usage = [](const char* where, const std::string& what) {
        sss::usageError(kProgram, where, what);
    };
    if (!o.info.empty()) return;
    if (o.json && !o.printEstimate) usage("--json", "goes with --info and --print-estimate");
    if (o.scene.empty()) usage("SCENE", "no scene file given");
    if (!o.printEstimate && !sss::isFolderName(o.cache))
        sss::requireNameForEach(kProgram, o.cache, o.frames, "name a folder (DIR/)");
    if (o.cache.empty() && !o.printEstimate) usage("--output", "no cache file given (-o CACHE)");
    sss::requireLength(kProgram, "--spacing", o.spacingMm);
}

}  // namespace

std::optional<PreprocessOptions> readOptions(int argc, const char* const* argv) {
    PreprocessOptions o;
    CLI::App app;
    app.add_option("-o,--output", o.cache);
    app.add_flag("--print-estimate", o.printEstimate);
    app.add_option("--info", o.info);
    app.add_flag("--json", o.json);
    app.add_option("--export-ply", o.exportPly);
    app.add_option("--spacing", o.spacingMm);
    if (!sss::readCommandLine(app, o, kProgram, argc, argv)) return std::nullopt;
    check(o);
    return o;
}
