#include "measure_curve.h"

#include "deviations.h"
#include "stopwatch.h"

namespace sss::bench {
namespace {

struct Entry {
    const SumMethod* method;
    double setting;
    Repeats repeats;
    MethodCounts counts;
    std::vector<Rgb> answers;
};

JsonValue describe(const InteractionCost& cost) {
    JsonValue json = JsonValue::object();
    json.set("localFlops", cost.localFlops)
        .set("nodeFlops", cost.nodeFlops)
        .set("pointFlops", cost.pointFlops)
        .set("exponentials", cost.exponentials)
        .set("squareRoots", cost.squareRoots)
        .set("tableRows", cost.tableRows)
        .set("nodeBytes", cost.nodeBytes)
        .set("pointBytes", cost.pointBytes);
    return json;
}

JsonValue describe(const MethodCounts& counts, double receivers) {
    const auto each = [&](std::uint64_t n) { return static_cast<double>(n) / receivers; };
    JsonValue json = JsonValue::object();
    json.set("interactions", each(counts.interactions()))
        .set("nodes", each(counts.nodeInteractions))
        .set("points", each(counts.pointInteractions))
        .set("locals", each(counts.localInteractions))
        .set("nodesVisited", each(counts.nodesVisited));
    return json;
}

// A method may leave the upper halves of AVX registers in use, and plain SSE code beside it then
// runs up to 13 times slower (seen with expf): the next method shall not pay for that.
void clearVectorState() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx")) asm volatile("vzeroupper");
#endif
}

std::span<const Vec3> timedOf(const CurveInput& input) {
    return input.timed.empty() ? input.receivers : input.timed;
}

void run(const CurveInput& input, Entry& entry) {
    clearVectorState();
    const std::span<const Vec3> timed = timedOf(input);
    entry.answers.resize(timed.size());
    entry.counts = {};
    const double began = threadSeconds();
    entry.method->evaluate(timed, entry.setting, entry.answers, entry.counts);
    entry.repeats.add(threadSeconds() - began);
}

// The answers at the receivers whose truth is known.
void answer(const CurveInput& input, Entry& entry) {
    if (input.timed.empty()) return;
    entry.answers.resize(input.receivers.size());
    MethodCounts uncounted;
    entry.method->evaluate(input.receivers, entry.setting, entry.answers, uncounted);
}

JsonValue describe(const CurveInput& input, const Entry& entry) {
    const auto receivers = static_cast<double>(timedOf(input).size());
    JsonValue json = JsonValue::object();
    json.set("setting", entry.setting)
        .set("seconds", entry.repeats.least() / receivers)
        .set("secondsMedian", entry.repeats.median() / receivers)
        .set("repeats", entry.repeats.count())
        .set("error", describeDeviations(entry.answers, input.truth))
        .set("counts", describe(entry.counts, receivers));
    return json;
}

}  // namespace

JsonValue measureCurves(const CurveInput& input,
                        std::span<const std::unique_ptr<SumMethod>> methods) {
    std::vector<Entry> entries;
    for (const auto& method : methods)
        for (const double setting : method->settings(input.tolerances))
            entries.push_back({method.get(), setting, {}, {}, {}});
    for (int round = 0; round < input.rounds; ++round)
        for (Entry& entry : entries)
            if (entry.repeats.total() < input.secondsPerSetting) run(input, entry);
    for (Entry& entry : entries) answer(input, entry);
    JsonValue all = JsonValue::array();
    for (const auto& method : methods) {
        JsonValue curve = JsonValue::array();
        for (const Entry& entry : entries)
            if (entry.method == method.get()) curve.push(describe(input, entry));
        JsonValue json = JsonValue::object();
        json.set("name", method->name())
            .set("label", method->label())
            .set("setting", method->settingName())
            .set("cost", describe(method->cost()))
            .set("curve", std::move(curve));
        all.push(std::move(json));
    }
    return all;
}

}  // namespace sss::bench
