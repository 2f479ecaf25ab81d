#pragma once
#include "sss/base/json.h"

#include <algorithm>
#include <ctime>
#include <vector>

namespace sss::bench {

/// CPU seconds, which other processes disturb less than the wall clock's.
inline double secondsOf(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
inline double threadSeconds() { return secondsOf(CLOCK_THREAD_CPUTIME_ID); }
inline double processSeconds() { return secondsOf(CLOCK_PROCESS_CPUTIME_ID); }

/// Repeated measurements of one thing. The minimum is what the machine can do undisturbed, the
/// median what it did.
class Repeats {
public:
    void add(double seconds) { seconds_.push_back(seconds); }
    std::size_t count() const { return seconds_.size(); }
    double total() const {
        double sum = 0;
        for (const double s : seconds_) sum += s;
        return sum;
    }
    double least() const { return *std::min_element(seconds_.begin(), seconds_.end()); }
    double median() const {
        std::vector<double> sorted = seconds_;
        std::sort(sorted.begin(), sorted.end());
        return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
    }

private:
    std::vector<double> seconds_;
};

}  // namespace sss::bench
