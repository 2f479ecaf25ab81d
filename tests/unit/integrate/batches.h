#pragma once
#include "sss/base/sampler.h"

#include <algorithm>
#include <functional>

namespace sss::testing {

struct Estimate {
    DRgb mean{0}, error{0};
};

/// Mean and standard error of `sample` over 32 batches that are stratified in themselves and
/// independent of each other.
inline Estimate batchEstimate(std::uint64_t seed, std::uint32_t perBatch,
                              const std::function<DRgb(Sampler&)>& sample) {
    constexpr std::uint32_t kBatches = 32;
    DRgb sum(0), squares(0);
    for (std::uint32_t b = 0; b < kBatches; ++b) {
        DRgb batch(0);
        for (std::uint32_t i = 0; i < perBatch; ++i) {
            Sampler sampler(combineSeeds(seed, b), i);
            batch += sample(sampler);
        }
        batch /= perBatch;
        sum += batch;
        squares += batch * batch;
    }
    Estimate e;
    e.mean = sum / static_cast<double>(kBatches);
    const DRgb variance = squares / static_cast<double>(kBatches) - e.mean * e.mean;
    e.error = glm::sqrt(glm::max(variance, DRgb(0)) / static_cast<double>(kBatches - 1));
    return e;
}

}  // namespace sss::testing
