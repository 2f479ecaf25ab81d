#pragma once
#include "sss/volume/volume.h"

#include <limits>
#include <memory>

namespace sss {

using VolumeList = std::span<const std::unique_ptr<Volume>>;

/// A straight stretch of light's way through all volumes that it meets, which may overlap: what
/// they leave of light, and what they emit. Depths are exact: within a cell the trilinear density
/// is a cubic along a line, whose integral is known. So transmittance has no noise and collisions
/// are found by inverting it, at the cost of one step a cell; delta and ratio tracking, which would
/// take fewer steps only in grids much finer than a free path, are not needed. Positions are mm
/// along the ray.
class VolumeSegment {
public:
    /// From the origin of a ray of unit direction to `end`, which may be infinite.
    VolumeSegment(VolumeList volumes, const Vec3& origin, const Vec3& direction, float end);

    bool isEmpty() const { return slices_.empty(); }
    /// Whether anything on it scatters.
    bool scatters() const { return scatters_; }
    /// Where the volumes begin and end on it; not empty.
    float begin() const { return slices_.front().begin; }
    float end() const { return slices_.back().end; }

    /// Optical depth of all of it, or up to `t`.
    const Rgb& depth() const { return depth_; }
    Rgb depthTo(float t) const;
    Rgb transmittance() const { return transmitted(depth_); }
    Rgb transmittanceTo(float t) const { return transmitted(depthTo(t)); }
    /// Radiance that a volume emits along it, back to its origin: the first integral of [Koutajoki
    /// Eq. 4].
    Rgb emission(std::size_t volume) const;

    /// Where light of one channel is scattered or absorbed, by its depth: t has the density
    /// sigma_t(t) e^{-depth(t)}; infinite if it comes through.
    float sampleCollision(int channel, float u) const;
    /// Where one channel's depth, at most that of the whole segment, is reached.
    float distanceAtDepth(int channel, float depth) const;
    Rgb sigmaT(float t) const;
    /// Calls visit(volume, density) for each volume at `t`.
    template <typename Visit>
    void at(float t, const Visit& visit) const {
        const Slice* slice = sliceAt(t);
        if (slice == nullptr) return;
        for (const Part& part : partsOf(*slice))
            visit(part.volume, std::max(0.0f, densityOf(part, t)));
    }
    const Volume& volume(std::size_t index) const { return *volumes_[index]; }

private:
    // One volume's share of a slice.
    struct Part {
        std::uint32_t volume, piece;
    };
    // A stretch on which every volume's density is one cubic.
    struct Slice {
        float begin, end;
        std::uint32_t firstPart, partCount;
        Rgb depthBefore;
    };
    static Rgb transmitted(const Rgb& depth) {
        return {std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z)};
    }
    void merge(const std::vector<std::uint32_t>& firstPiece);
    void addSlice(float begin, float end, std::uint32_t firstPart);
    const Slice* sliceAt(float t) const;
    std::span<const Part> partsOf(const Slice& slice) const {
        return std::span(parts_).subspan(slice.firstPart, slice.partCount);
    }
    float densityOf(const Part& part, float t) const {
        const VolumePiece& piece = pieces_[part.piece];
        return piece.density.densityAt(piece.shareAt(t));
    }
    Rgb depthWithin(const Slice& slice, float t) const;
    Rgb sigmaTIn(const Slice& slice, float t) const;
    Rgb emissionIn(const Slice& slice, const Part& emitter) const;

    VolumeList volumes_;
    std::vector<VolumePiece> pieces_;  // volume after volume
    std::vector<Part> parts_;          // slice after slice
    std::vector<Slice> slices_;        // in order, without overlap
    Rgb depth_{0.0f};
    bool scatters_ = false;
};

}  // namespace sss
