#pragma once
#include "sss/base/reporter.h"

#include <functional>
#include <string>

namespace sss::stress {

/// Counts warnings, and says nothing.
class CountingReporter final : public Reporter {
public:
    void info(std::string_view, std::string_view) override {}
    void warn(std::string_view, std::string_view) override { ++warnings; }
    void progress(std::string_view, double, double, bool) override {}
    int warnings = 0;
};

/// Calls `visit` with every damaged form of a file and words for it: cut at every 64 bytes, and
/// with a bit flipped in every 97th byte.
void forEachDamage(const std::string& whole,
                   const std::function<void(const std::string&, const std::string&)>& visit);

}  // namespace sss::stress
