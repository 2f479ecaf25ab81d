#pragma once
#include <string>
#include <string_view>

namespace sss {

/// One line of the log, ASCII apart from what the sentence quotes, ending with a newline:
/// "INFO     0.02s scene   sentence". Line breaks inside the sentence become blanks, so that one
/// event stays one line.
std::string logLine(std::string_view level, double seconds, std::string_view module,
                    std::string_view sentence);

}  // namespace sss
