#include "options.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"
#include "sss/integrate/integrator_table.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

constexpr const char* kHelp = R"(sss-render {} - path-trace a scene with translucent objects

usage: sss-render [options] SCENE -o OUT.exr
       sss-render --list-materials [--json]
       sss-render --profile MATERIAL [--model NAME] [--csv] [--radii R1,R2,...]
       sss-render --compare A.exr [A2.exr ...] REFERENCE.exr [--json]

Input
  SCENE                   scene file (JSON, see scenes/README.md)
  --cache CACHE           made by sss-preprocess from this scene [made in memory]; what the frame
                          computes is kept in CACHE.exitance for the next one
  --cache DIR/            a folder of stages (points, irradiance, exitance), each used as long as
                          what it depends on is the same, and made when it is not there
  --cache-only            ... or an error (3) if pass 1 would have to be made
  --no-keep               do not read or keep exitance
  --meters-per-unit M     length of a scene unit [the scene's metersPerUnit; m]

Frames of an animated scene (scenes/README.md)
  --frames LIST           1-24, 1-100x2, 10-1x-1, 1,5,9-12; OUT and CACHE take the number in place
                          of #### or %04d [one picture, of frame 1]
  --resume                skip frames whose picture is there, whole, and of this scene
  --camera-seed N         of the camera's noise, the same in all frames [each frame's own]
  --explain               print which stages each frame reused, and why others were made

Quality
  --integrator NAME       cached: diffusion by the point cloud; bssrdf: the same sample by sample,
                          no cache, noisy (one shadow ray a sample; other bodies light it in their
                          diffuse limit); brdf: diffusion without spread, no cache; lambertian:
                          diffuse surfaces, no cache; volume: radiative transfer, slow, the ground
                          truth [the scene's, or cached]
  --samples N             per pixel [the scene's, or 64]
  --size WxH              of the picture [the scene's, or 512x512; pixels]
  --tolerance T           relative error of diffusion [the scene's, or 0.01]
  --seed N                of all random numbers [the scene's, or 0]
  --max-points N          without --cache: refuse an object with more [20000000]
  --model NAME            of all translucent materials: a profile (dipole, better_dipole,
                          photon_beam, ...), or shape: diffusion solved on the object itself
                          [the scene's, or dipole]
  --boundary KIND         exact, or polynomial: the papers' Fresnel fits, for all translucent
                          materials [the scene's, or exact]

Materials (these print to standard output and need no scene)
  --list-materials        all measured media, with paper and warnings
  --json                  ... as JSON, coefficients in mm^-1
  --profile MATERIAL      a diffusion profile by radius: a measured medium, or a scene's
                          material as FILE:NAME, or numbers with one value or R/G/B each:
                          sigma_a and sigma_s or sigma_s_prime (mm^-1), or color and mfp or
                          dmfp (mm); g [0], eta [1.3]
  --model NAME            of the profile [the scene material's, or dipole]
  --radii R1,R2,...       [1e-3 to 1e2 mean free paths; mm]
  --thickness MM          of the slab, for the multipole models [the scene's; mm]
  --csv                   commas instead of columns

Pictures compared (this prints to standard output and needs no scene)
  --compare A B           how far the picture A is from the reference B: relative RMSE, bias and
                          maximum, over B's mean; mean FLIP as seen on a screen, 0 to 1; of
                          several A, of other seeds, with standard errors
  --layer NAME            diffusion, single, surface, ... [the beauty]
  --mask NAME             only where this layer of B is above 0; A is its alpha [everywhere]
  --error-image OUT.png   |A - B| over B's mean in false colours, by decades: 0.001 black, 0.01
                          purple, 0.1 orange, 1 pale yellow
  --json                  figures as JSON

Output
  -o, --output OUT.exr    layered OpenEXR; a tone-mapped OUT.png is written beside it
  --no-png                ... or not
  --stats JSON            write what the run cost, and what was left out (see README.md)

Run
  --threads N             0 = all cores [0]
  --quiet                 only warnings
  --progress HOW          plain lines, json lines, none [a bar on a terminal, else plain]
  --strict                exit 6 if there was any warning
  --help, --version

Examples
  sss-render scenes/bunny/demo.json -o bunny.exr
  sss-render scenes/bunny/demo.json --cache bunny.ssc -o bunny.exr --stats bunny.json
  sss-render scenes/turntable/turntable.json --frames 1-24 --cache turn/ -o turn/####.exr --resume
  sss-render scenes/still-life/still-life.json -o small.exr --size 256x256 --samples 16
  sss-render --profile Marble --model better_dipole --csv > marble.csv
  sss-render --compare bunny.exr truth.exr --layer diffusion --mask A --error-image error.png
  sss-render --profile sigma_a=0.002/0.004/0.007,sigma_s_prime=2.6,eta=1.5 --radii 0,0.1,1

Exit codes: 0 done, 1 internal error, 2 usage, 3 bad input, 4 could not read or write,
5 out of memory or over a limit, 6 warnings under --strict, 130 or 143 interrupted
(exit codes are those of both programs)
)";

constexpr int kMostPixelsPerSide = 65536;

constexpr sss::ProgramText kProgram{"sss-render", kHelp};

[[noreturn]] void usage(const std::string& where, const std::string& what) {
    sss::usageError(kProgram, where, what);
}

void readSize(const std::string& text, RenderOptions& o) {
    if (text.empty()) return;
    int width = 0, height = 0, used = 0;
    const bool read = std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &used) == 2 &&
                      static_cast<std::size_t>(used) == text.size();
    if (!read || width < 1 || height < 1 || width > kMostPixelsPerSide ||
        height > kMostPixelsPerSide)
        usage("--size", fmt::format("\"{}\" is not WIDTHxHEIGHT in pixels, 1 to 65536", text));
    o.width = width;
    o.height = height;
}

std::vector<double> readRadii(const std::string& text) {
    std::vector<double> radii;
    const char* at = text.c_str();
    while (true) {
        char* end = nullptr;
        const double r = std::strtod(at, &end);
        if (end == at || (*end != ',' && *end != '\0') || !(r >= 0 && std::isfinite(r)))
            usage("--radii", fmt::format("\"{}\" is not a list R1,R2,... of radii in mm", text));
        radii.push_back(r);
        if (*end == '\0') return radii;
        at = end + 1;
    }
}

// The options that print about materials, which take no scene.
void checkMaterials(const RenderOptions& o, bool radiiGiven) {
    const bool profile = !o.profile.material.empty();
    if (o.compare.json && !o.listMaterials && o.compare.files.empty())
        usage("--json", "belongs to --list-materials and --compare");
    if (!profile) {
        if (o.profile.csv) usage("--csv", "belongs to --profile");
        if (radiiGiven) usage("--radii", "belongs to --profile");
        if (o.profile.thicknessMm) usage("--thickness", "belongs to --profile");
    }
    if (profile && o.listMaterials) usage("--profile", "and --list-materials do not go together");
    if ((profile || o.listMaterials) && !o.scene.empty())
        usage("SCENE", fmt::format("{} is not needed with {}", o.scene.string(),
                                   profile ? "--profile" : "--list-materials"));
    sss::requireLength(kProgram, "--thickness", o.profile.thicknessMm);
}

void checkCompare(const RenderOptions& o) {
    const CompareRequest& compare = o.compare;
    if (compare.files.empty()) {
        if (!compare.layer.empty()) usage("--layer", "belongs to --compare");
        if (!compare.mask.empty()) usage("--mask", "belongs to --compare");
        if (!compare.errorImage.empty()) usage("--error-image", "belongs to --compare");
        return;
    }
    if (compare.files.size() < 2) usage("--compare", "needs a picture and a reference");
    if (o.listMaterials || !o.profile.material.empty())
        usage("--compare", "and what prints about materials do not go together");
    if (!o.scene.empty())
        usage("SCENE", fmt::format("{} is not needed with --compare", o.scene.string()));
    if (!compare.errorImage.empty() && compare.errorImage.extension() != ".png")
        usage("--error-image", fmt::format("{} does not end in .png", compare.errorImage.string()));
}

void checkIntegrator(const std::string& name) {
    if (sss::findIntegrator(name)) return;
    std::vector<std::string_view> names;
    for (const sss::IntegratorKind& kind : sss::integratorTable()) names.push_back(kind.name);
    throw sss::Error(sss::ErrorKind::Usage, "--integrator",
                     fmt::format("there is no integrator called {}", sss::inQuotes(name)),
                     sss::nameHint(name, names));
}

void check(const RenderOptions& o) {
    sss::requireNameForEach(kProgram, o.output, o.frames);
    if (o.cacheOnly && o.cache.empty()) usage("--cache-only", "goes with --cache");
    if (o.integrator) checkIntegrator(*o.integrator);
    if (o.scene.empty()) usage("SCENE", "no scene file given");
    if (o.output.empty()) usage("--output", "no picture given (-o OUT.exr)");
    if (o.output.extension() != ".exr")
        usage("--output", fmt::format("{} does not end in .exr", o.output.string()));
    if (o.samples && (*o.samples < 1 || *o.samples > 1 << 20))
        usage("--samples", fmt::format("{} is not in 1 to 1048576", *o.samples));
}

}  // namespace

std::optional<RenderOptions> readOptions(int argc, const char* const* argv) {
    RenderOptions o;
    CLI::App app;
    std::string size, radii;
    app.add_option("--cache", o.cache);
    app.add_flag("--no-keep", o.noKeep);
    app.add_flag("--cache-only", o.cacheOnly);
    app.add_flag("--resume", o.resume);
    app.add_option("--camera-seed", o.cameraSeed)->check(CLI::NonNegativeNumber);
    app.add_option("-o,--output", o.output);
    app.add_option("--samples", o.samples);
    app.add_option("--size", size);
    app.add_flag("--list-materials", o.listMaterials);
    app.add_flag("--json", o.compare.json);
    app.add_option("--compare", o.compare.files)->expected(1, 1000);
    app.add_option("--layer", o.compare.layer);
    app.add_option("--mask", o.compare.mask);
    app.add_option("--error-image", o.compare.errorImage);
    app.add_option("--integrator", o.integrator);
    app.add_option("--profile", o.profile.material);
    const auto* radiiOption = app.add_option("--radii", radii);
    app.add_option("--thickness", o.profile.thicknessMm);
    app.add_flag("--csv", o.profile.csv);
    app.add_flag("--no-png", o.noPng);
    if (!sss::readCommandLine(app, o, kProgram, argc, argv)) return std::nullopt;
    o.profile.model = o.model;
    o.profile.boundary = o.boundary;
    readSize(size, o);
    if (!radii.empty()) o.profile.radiiMm = readRadii(radii);
    checkMaterials(o, radiiOption->count() > 0);
    checkCompare(o);
    if (o.profile.material.empty() && !o.listMaterials && o.compare.files.empty()) check(o);
    return o;
}
