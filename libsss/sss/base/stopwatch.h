#pragma once

#include <chrono>

namespace sss {

/// Wall seconds since it was made or restarted; not moved by changes of the system's clock.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
    void restart() { began_ = Clock::now(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point began_ = Clock::now();
};

}  // namespace sss
