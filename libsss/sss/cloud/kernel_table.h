#pragma once
#include "sss/base/vec.h"
#include "sss/cloud/regularised_profile.h"
#include "sss/medium/profile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

namespace sss {

/// Three radial profiles (one a channel) as one table of cubics in u = r^2, made for the inner loop
/// of the diffusion sum: any profile, however costly, then costs the same few instructions, for all
/// channels at once.
///
/// u + u0 is cut into 16 segments an octave, so that a segment is found from the bits of the float
/// and no logarithm, root or exponential is left. A row holds c0..c3 for R, G, B and an unused
/// lane: 64 bytes, a cache line; the table is about 20 KB. f(t) = c0 + t (c1 + t (c2 + t c3)), t in
/// [0, 1) within the segment; derivatives by u follow from the same row.
///
/// A profile that is singular at r = 0 is averaged over the disk of a sample there (its total stays
/// the same): see RegularisedProfile.
class KernelTable {
public:
    static constexpr int kSegmentBits = 4;  ///< 2^4 segments an octave
    static constexpr int kShift = 23 - kSegmentBits;
    struct alignas(64) Row {
        float c[4][4];  ///< [power][channel]
    };
    /// Upper bounds over all distances >= the row's lower edge, per channel: of f, |grad f|, the
    /// norm of the second and of the third derivative tensor of f as a function of a 3-D offset.
    struct alignas(64) BoundsRow {
        Rgb derivative[4];
    };

    /// `profiles` may hold the same pointer more than once: channels that share a profile are
    /// evaluated once. Distances up to `reachMm` matter;
    /// beyond, and where a profile falls below 1e-30 of its peak, the table is 0.
    /// `cellRadiusMm` is the radius of a disk as large as a sample's cell.
    KernelTable(const std::array<const Profile*, 3>& profiles, double reachMm, double cellRadiusMm);

    Rgb evaluate(float distanceSquaredMm2) const;
    /// A distance in the table: its row, the place t in it, and dt/du, mm^-2.
    struct Place {
        const Row* row;
        float t, scale;
    };
    Place placeOf(float distanceSquaredMm2) const {
        const auto bits = std::bit_cast<std::uint32_t>(distanceSquaredMm2 + u0_);
        constexpr std::uint32_t kRows = 1u << kShift;
        // Segments an octave over the power of two below u + u0.
        const float scale = std::bit_cast<float>((254u << 23) - (bits & 0x7f800000u)) *
                            static_cast<float>(1 << kSegmentBits);
        return {&rows_[rowOf(distanceSquaredMm2)],
                static_cast<float>(bits & (kRows - 1)) * (1.0f / static_cast<float>(kRows)), scale};
    }
    const BoundsRow& boundsAt(float distanceSquaredMm2) const {
        return bounds_[rowOf(distanceSquaredMm2)];
    }
    /// All rows of bounds, kBoundFloats in a row: [derivative][channel].
    static constexpr std::size_t kBoundFloats = 12;
    static constexpr std::size_t kBoundStride = sizeof(BoundsRow) / sizeof(float);
    const float* boundRows() const { return &bounds_.front().derivative[0].x; }
    const Row* rows() const { return rows_.data(); }
    std::size_t rowCount() const { return rows_.size(); }
    std::int32_t baseRow() const { return base_; }
    float offsetMm2() const { return u0_; }
    /// The distance at which the narrowest of the profiles has fallen to half of its peak, to 20 %.
    float halfWidthMm() const { return halfWidthMm_; }

private:
    std::size_t rowOf(float distanceSquaredMm2) const {
        const auto bits = std::bit_cast<std::uint32_t>(distanceSquaredMm2 + u0_);
        const auto row = static_cast<std::int32_t>(bits >> kShift) - base_;
        return static_cast<std::size_t>(
            std::clamp(row, 0, static_cast<std::int32_t>(rows_.size()) - 1));
    }
    using Regularised = std::array<RegularisedProfile, 3>;
    void fitRows(const Regularised& profiles);
    void boundDerivatives(const Regularised& profiles);

    float halfWidthMm_ = 0;
    float u0_ = 0;           // mm^2
    std::int32_t base_ = 0;  // bits(u0) >> kShift
    std::vector<Row> rows_;  // the last row is all zero
    std::vector<BoundsRow> bounds_;
};

}  // namespace sss
