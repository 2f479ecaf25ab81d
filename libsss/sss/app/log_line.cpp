#include "sss/app/log_line.h"

#include <fmt/core.h>

#include <algorithm>

namespace sss {

std::string logLine(std::string_view level, double seconds, std::string_view module,
                    std::string_view sentence) {
    // Level and time share 13 columns; long ones may run over.
    constexpr int kHeadWidth = 12;
    const bool isWide = level.size() > 7;
    const std::string time = fmt::format("{:.{}f}", seconds, isWide ? 1 : 2);
    std::string line = fmt::format("{} {:>{}}s {:<7} {}", level, time,
                                   kHeadWidth - static_cast<int>(level.size()), module, sentence);
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return line + '\n';
}

}  // namespace sss
