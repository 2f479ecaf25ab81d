// sss-preprocess: pass 1. Wiring only; the work is in libsss.
#include "options.h"
#include "preprocess_frames.h"
#include "sss/app/program.h"
#include "sss/integrate/cloud_cache.h"

#include <fmt/core.h>

namespace {

using namespace sss;

void printNumber(const JsonValue& body, const char* key, const char* format) {
    const JsonMember* found = body.find(key);
    if (found && found->value.isNumber()) fmt::print(fmt::runtime(format), found->value.asNumber());
}

void printInfo(const PreprocessOptions& options) {
    const JsonValue info = describeCache(options.info);
    if (options.json) {
        fmt::print("{}\n", dump(info));
        return;
    }
    for (const JsonMember& m : info.members())
        if (m.value.isString() || m.value.isNumber())
            fmt::print("{:15} {}\n", m.key, dump(m.value, -1));
    const JsonMember* bodies = info.find("bodies");
    if (!bodies || !bodies->value.isArray()) return;
    for (const JsonValue& body : bodies->value.items()) {
        const JsonMember* name = body.isObject() ? body.find("name") : nullptr;
        if (!name) continue;
        fmt::print("body            {}\n", dump(name->value, -1));
        printNumber(body, "points", "  points        {}\n");
        printNumber(body, "nodes", "  nodes         {}\n");
        printNumber(body, "areaMm2", "  area          {:.6g} mm2\n");
        printNumber(body, "spacingMm", "  spacing       {:.4g} mm\n");
        if (const JsonMember* mfp = body.find("meanFreePathMm"))
            fmt::print("  mean free path {} mm\n", dump(mfp->value, -1));
        printNumber(body, "irradianceSamples", "  light samples {} a point\n");
    }
}

int run(int argc, const char* const* argv) {
    const auto options = readOptions(argc, argv);
    if (!options) return 0;
    if (!options->info.empty()) {
        printInfo(*options);
        return 0;
    }
    preprocessFrames(*options);
    return 0;
}

}  // namespace

int main(int argc, char** argv) { return sss::runProgram("sss-preprocess", argc, argv, run); }
