#include "sss/base/reporter.h"

#include <algorithm>

namespace sss {
namespace {

constexpr std::int64_t kReportEveryNs = 100'000'000;

}  // namespace

Progress::Progress(Reporter& reporter, std::string phase, std::uint64_t total)
    : reporter_(reporter),
      phase_(std::move(phase)),
      total_(std::max<std::uint64_t>(total, 1)),
      start_(Clock::now()),
      nextReportNs_(kReportEveryNs) {}

Progress::~Progress() { reporter_.progress(phase_, 1.0, 0.0, true); }

void Progress::advance(std::uint64_t amount) {
    const std::uint64_t done = done_.fetch_add(amount, std::memory_order_relaxed) + amount;
    const auto elapsed =
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
    if (elapsed < nextReportNs_.load(std::memory_order_relaxed)) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    nextReportNs_.store(elapsed + kReportEveryNs, std::memory_order_relaxed);
    const double fraction = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    const double seconds = static_cast<double>(elapsed) * 1e-9;
    reporter_.progress(phase_, fraction, fraction > 0 ? seconds * (1 - fraction) / fraction : -1.0,
                       false);
}

}  // namespace sss
