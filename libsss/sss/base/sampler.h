#pragma once
#include "sss/base/rng.h"
#include "sss/base/vec.h"

#include <cstdint>
#include <span>

namespace sss {

/// Low-discrepancy numbers for one sample of one pixel (or surface point): Owen-scrambled, shuffled
/// (0,2)-sequences, padded pair by pair [Burley 2020, "Practical Hash-based Owen Scrambling"].
/// The first 2^k samples of every pair are stratified; pairs are independent of each other.
/// Numbers are in [0, 1). Deterministic in (seed, index), a few nanoseconds each.
class Sampler {
public:
    Sampler() = default;
    /// `seed` names the pixel or point, `index` its sample.
    Sampler(std::uint64_t seed, std::uint32_t index);
    float next1D();
    Vec2 next2D();
    /// next2D() of each of several samplers of one seed that stand at the same dimension, as those
    /// of a pixel do: cheaper together.
    static void next2D(std::span<Sampler> samplers, std::span<Vec2> values);
    /// Passes over a number, or a pair, that is not needed: what comes after stays the same, and a
    /// dimension means the same in all samples of a pixel, as stratification needs.
    void skip(std::uint32_t calls = 1) { dimension_ += calls; }
    /// Numbers of their own for a side path that takes nobody knows how many: costs the path one.
    Sampler branch() { return {combineSeeds(seed_, ~std::uint64_t{dimension_++}), index_}; }
    std::uint32_t index() const { return index_; }

private:
    std::uint64_t seed_ = 0;
    std::uint32_t index_ = 0, reversedIndex_ = 0;
    std::uint32_t dimension_ = 0;
};

}  // namespace sss
