#include "fuzz/targets.h"
#include "numbers/subjects.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>

#include <algorithm>

namespace sss::stress {

// A target ends the process on what it must not accept, so that getting here is passing.
void stressCorpus(Report& report, Scope /*scope*/) {
    for (const FuzzTarget& target : fuzzTargets()) {
        Row row("corpus", fmt::format("{}: seeds and former findings", target.name), 0);
        std::vector<std::filesystem::path> inputs;
        for (const auto& entry : std::filesystem::directory_iterator(
                 std::filesystem::path(SSS_STRESS_CORPUS) / target.name))
            inputs.push_back(entry.path());
        std::ranges::sort(inputs);
        for (const std::filesystem::path& input : inputs) {
            const std::string bytes = testing::readFile(input);
            target.read(std::as_bytes(std::span(bytes)));
            row.expect(true, [] { return std::string(); });
        }
        report.add(row);
    }
}

}  // namespace sss::stress
