// sss-stress: tries what people should not feed a renderer and says what survived, one line a row;
// with --json FILE also for tests/stress/run.py. Exit code 0 only if all did. --list names the
// subjects and tries nothing.
#include "numbers/subjects.h"
#include "sss/app/program.h"
#include "sss/base/atomic_file.h"
#include "sss/base/error.h"

#include <fmt/core.h>

#include <cstdio>
#include <string_view>

namespace {

using namespace sss;
using namespace sss::stress;

struct Subject {
    std::string_view name;
    void (*run)(Report&, Scope);
};
constexpr Subject kSubjects[] = {
    {"optics", stressOptics},    {"media", stressMedia},        {"surfaces", stressSurfaces},
    {"sums", stressSums},        {"scenes", stressScenes},      {"caches", stressCaches},
    {"stages", stressStages},    {"memory", stressAllocations}, {"corpus", stressCorpus},
    {"damage", stressMutations},
};

struct Options {
    Scope scope = Scope::Quick;
    std::string json;
    std::string_view only;
    bool isList = false;
};

Options readOptions(int argc, const char* const* argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--quick")
            options.scope = Scope::Quick;
        else if (word == "--full")
            options.scope = Scope::Full;
        else if (word == "--list")
            options.isList = true;
        else if (word == "--json" && i + 1 < argc)
            options.json = argv[++i];
        else if (word == "--only" && i + 1 < argc)
            options.only = argv[++i];
        else
            throw Error(ErrorKind::Usage, "command line",
                        fmt::format("\"{}\" is not understood", word),
                        "sss-stress [--list | --quick | --full] [--only SUBJECT] [--json FILE]");
    }
    return options;
}

int run(int argc, const char* const* argv) {
    const Options options = readOptions(argc, argv);
    if (options.isList) {
        for (const Subject& subject : kSubjects) fmt::print("{}\n", subject.name);
        return 0;
    }
    Report report;
    std::size_t told = 0;
    bool isPassed = true;
    for (const Subject& subject : kSubjects) {
        if (!options.only.empty() && options.only != subject.name) continue;
        subject.run(report, options.scope);
        for (; told < report.rows().size(); ++told) {
            fmt::print("{}\n", report.rows()[told].line());
            isPassed &= report.rows()[told].isPassed();
        }
        std::fflush(stdout);
    }
    if (told == 0)
        throw Error(ErrorKind::Usage, "--only", fmt::format("no subject \"{}\"", options.only));
    if (!options.json.empty()) {
        JsonValue rows = JsonValue::array();
        for (const Row& row : report.rows()) rows.push(row.json());
        AtomicFile file(options.json);
        file.append(dump(rows));
        file.commit();
    }
    return isPassed ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return sss::runProgram("sss-stress", argc, argv, run); }
