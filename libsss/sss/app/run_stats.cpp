#include "sss/app/run_stats.h"

#include "sss/base/atomic_file.h"

#include <sys/resource.h>

#include <algorithm>
#include <ctime>

namespace sss {
namespace {

double processCpuSeconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Few names, and their order is the order of the report: a list searched from its front.
template <typename Items>
typename Items::value_type& named(Items& items, std::string_view name) {
    using Item = typename Items::value_type;
    const auto found = std::find_if(items.begin(), items.end(),
                                    [&](const Item& item) { return item.name == name; });
    if (found != items.end()) return *found;
    Item added;
    added.name = name;
    return items.emplace_back(std::move(added));
}

template <typename Items>
typename Items::value_type valueOf(const Items& items, std::string_view name) {
    using Item = typename Items::value_type;
    const auto found = std::find_if(items.begin(), items.end(),
                                    [&](const Item& item) { return item.name == name; });
    return found == items.end() ? Item{} : *found;
}

}  // namespace

RunStats::Timer::Timer(RunStats& stats, std::string_view phase)
    : stats_(stats), phase_(stats.startedPhase(phase)), cpuBegan_(processCpuSeconds()) {}

RunStats::Timer::~Timer() {
    const std::lock_guard lock(stats_.mutex_);
    phase_.wallSeconds += wall_.seconds();
    phase_.cpuSeconds += processCpuSeconds() - cpuBegan_;
}

RunStats::RunStats(std::string program) : program_(std::move(program)) {}

void RunStats::count(std::string_view name, std::uint64_t amount) {
    const std::lock_guard lock(mutex_);
    named(counters_, name).amount += amount;
}

void RunStats::value(std::string_view name, JsonValue value) {
    const std::lock_guard lock(mutex_);
    values_.set(std::string(name), std::move(value));
}

RunStats::Phase& RunStats::startedPhase(std::string_view name) {
    const std::lock_guard lock(mutex_);
    return named(phases_, name);
}

double RunStats::wallSeconds(std::string_view phase) const {
    const std::lock_guard lock(mutex_);
    return valueOf(phases_, phase).wallSeconds;
}

double RunStats::wallSeconds() const { return sinceStart_.seconds(); }

double RunStats::cpuSeconds() const { return processCpuSeconds(); }

std::uint64_t RunStats::counter(std::string_view name) const {
    const std::lock_guard lock(mutex_);
    return valueOf(counters_, name).amount;
}

JsonValue RunStats::toJson() const {
    const std::lock_guard lock(mutex_);
    JsonValue wall = JsonValue::object(), cpu = JsonValue::object(), counts = JsonValue::object();
    for (const Phase& phase : phases_) {
        wall.set(phase.name, phase.wallSeconds);
        cpu.set(phase.name, phase.cpuSeconds);
    }
    wall.set("total", sinceStart_.seconds());
    cpu.set("total", processCpuSeconds());
    for (const Counter& counter : counters_) counts.set(counter.name, counter.amount);
    JsonValue all = JsonValue::object();
    all.set("program", program_)
        .set("seconds", std::move(wall))
        .set("cpuSeconds", std::move(cpu))
        .set("counts", std::move(counts))
        .set("values", values_)
        .set("peakMemoryBytes", peakMemoryBytes());
    return all;
}

void RunStats::writeStats(const std::filesystem::path& path) const {
    AtomicFile file(path);
    file.append(dump(toJson()) + "\n");
    file.commit();
}

std::uint64_t peakMemoryBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // ru_maxrss is in KiB on Linux
}

}  // namespace sss
