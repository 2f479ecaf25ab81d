// sss-render: pass 2. Wiring only; the work is in libsss.
#include "list_materials.h"
#include "options.h"
#include "print_profile.h"
#include "render_frames.h"
#include "sss/app/program.h"

namespace {

int run(int argc, const char* const* argv) {
    const auto options = readOptions(argc, argv);
    if (!options) return 0;
    if (options->listMaterials) {
        listMaterials(options->compare.json);
        return 0;
    }
    if (!options->compare.files.empty()) {
        comparePictures(options->compare);
        return 0;
    }
    if (!options->profile.material.empty()) {
        printProfile(options->profile, options->metersPerUnit);
        return 0;
    }
    renderFrames(*options);
    return 0;
}

}  // namespace

int main(int argc, char** argv) { return sss::runProgram("sss-render", argc, argv, run); }
