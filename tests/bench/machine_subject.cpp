// What the machine could do at most: the yardstick for everything else.
#include "sss/cloud/interactions.h"
#include "stopwatch.h"
#include "subjects.h"

#include <algorithm>
#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace sss::bench {
namespace {

constexpr int kRepeats = 15;

// Best of several runs of `work`, which does `amount` of something: amount per second.
template <typename Work>
double bestRate(double amount, const Work& work) {
    Repeats repeats;
    for (int i = 0; i < kRepeats; ++i) {
        const double began = threadSeconds();
        work();
        repeats.add(threadSeconds() - began);
    }
    return amount / repeats.least();
}

// A chain of additions, each waiting for the one before: one a cycle on every current processor.
double clockHertz() {
    constexpr std::uint64_t kSteps = 20'000'000;
    return bestRate(static_cast<double>(kSteps), [] {
        std::uint64_t x = 0;
        for (std::uint64_t i = 0; i < kSteps / 8; ++i) {
#if defined(__x86_64__)
            asm volatile(
                "add $1, %0\n\tadd $1, %0\n\tadd $1, %0\n\tadd $1, %0\n\t"
                "add $1, %0\n\tadd $1, %0\n\tadd $1, %0\n\tadd $1, %0"
                : "+r"(x));
#else
            for (int k = 0; k < 8; ++k) {
                x += 1;
                asm volatile("" : "+r"(x));
            }
#endif
        }
    });
}

constexpr int kChains =
    12;  // enough to hide a multiply-add's latency of 4 to 5 cycles, two a cycle
constexpr int kRounds = 1'000'000;

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) float multiplyAdd() {
    __m256 sums[kChains];
    for (__m256& s : sums) s = _mm256_set1_ps(1.0f);
    const __m256 a = _mm256_set1_ps(0.999f), b = _mm256_set1_ps(0.001f);
    for (int i = 0; i < kRounds; ++i)
#pragma GCC unroll 12
        for (int k = 0; k < kChains; ++k) sums[k] = _mm256_fmadd_ps(sums[k], a, b);
    float total = 0;
    for (const __m256& s : sums) total += _mm256_cvtss_f32(s);
    return total;
}

double multiplyAddFlops() {
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return 0;
    volatile float kept = 0;  // or there would be nothing to compute
    return bestRate(2.0 * 8 * kChains * kRounds, [&] { kept = multiplyAdd(); });
}
#else
double multiplyAddFlops() { return 0; }
#endif

}  // namespace

JsonValue measureMachine(const Arguments& arguments) {
    arguments.check();
    JsonValue json = JsonValue::object();
    json.set("clockHertz", clockHertz())
        .set("peakFlops", multiplyAddFlops())
        .set("peakOf", "AVX2 single-precision fused multiply-add, one thread; 0 = not measured")
        .set("instructionSet", accumulateTarget());
    return json;
}

}  // namespace sss::bench
