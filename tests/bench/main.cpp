// sss-bench: measures inside the library what the two programs cannot show; JSON on stdout.
// tests/bench/run.py drives it.
#include "sss/app/program.h"
#include "sss/base/error.h"
#include "subjects.h"

#include <fmt/core.h>

namespace {

using namespace sss;

struct Subject {
    const char* name;
    JsonValue (*measure)(const bench::Arguments&);
};
constexpr Subject kSubjects[] = {
    {"machine", bench::measureMachine},     {"reference", bench::makeReference},
    {"frame", bench::measureFrame},         {"scaling", bench::measureScaling},
    {"hierarchy", bench::measureHierarchy}, {"picture", bench::measurePicture},
    {"exitance", bench::measureExitance},
};

int run(int argc, const char* const* argv) {
    const bench::Arguments arguments(argc, argv);
    for (const Subject& subject : kSubjects)
        if (arguments.subject() == subject.name) {
            fmt::print("{}\n", dump(subject.measure(arguments)));
            return 0;
        }
    throw Error(ErrorKind::Usage, "command line", "no subject \"" + arguments.subject() + "\"",
                "machine, reference, frame, exitance, scaling, hierarchy or picture");
}

}  // namespace

int main(int argc, char** argv) { return sss::runProgram("sss-bench", argc, argv, run); }
