#include "sss/volume/volume_segment.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sss {
namespace {

// Gauss-Legendre with three points on [0, 1].
struct GaussPoint {
    float s, weight;
};
constexpr std::array<GaussPoint, 3> kGauss3{
    {{0.11270166537925831f, 5.0f / 18}, {0.5f, 8.0f / 18}, {0.88729833462074169f, 5.0f / 18}}};
// Emission is integrated in steps of at most this depth, where three points are right to 1e-6.
constexpr float kDepthPerStep = 0.5f;
constexpr int kMostDepthSteps = 64;

// (1 - e^-x) / x.
float meanTransmittance(float x) { return x > 1e-6f ? -std::expm1(-x) / x : 1.0f - 0.5f * x; }

}  // namespace

VolumeSegment::VolumeSegment(VolumeList volumes, const Vec3& origin, const Vec3& direction,
                             float end)
    : volumes_(volumes) {
    std::vector<std::uint32_t> firstPiece;
    for (const std::unique_ptr<Volume>& volume : volumes) {
        firstPiece.push_back(static_cast<std::uint32_t>(pieces_.size()));
        volume->addPieces(origin, direction, end, pieces_);
        scatters_ = scatters_ || (pieces_.size() > firstPiece.back() && volume->scatters());
    }
    firstPiece.push_back(static_cast<std::uint32_t>(pieces_.size()));
    if (!pieces_.empty()) merge(firstPiece);
}

// Cuts the pieces of all volumes at each other's ends.
void VolumeSegment::merge(const std::vector<std::uint32_t>& firstPiece) {
    std::vector<float> cuts;
    for (const VolumePiece& piece : pieces_) {
        cuts.push_back(piece.begin);
        cuts.push_back(piece.end);
    }
    std::ranges::sort(cuts);
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    std::vector<std::uint32_t> current(firstPiece.begin(), firstPiece.end() - 1);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        const auto firstPart = static_cast<std::uint32_t>(parts_.size());
        for (std::uint32_t v = 0; v < current.size(); ++v) {
            std::uint32_t& piece = current[v];
            while (piece < firstPiece[v + 1] && pieces_[piece].end <= cuts[k]) ++piece;
            if (piece < firstPiece[v + 1] && pieces_[piece].begin <= cuts[k])
                parts_.push_back({v, piece});
        }
        if (parts_.size() > firstPart) addSlice(cuts[k], cuts[k + 1], firstPart);
    }
}

void VolumeSegment::addSlice(float begin, float end, std::uint32_t firstPart) {
    slices_.push_back(
        {begin, end, firstPart, static_cast<std::uint32_t>(parts_.size()) - firstPart, depth_});
    depth_ += depthWithin(slices_.back(), end);
}

const VolumeSegment::Slice* VolumeSegment::sliceAt(float t) const {
    const auto after = std::ranges::upper_bound(slices_, t, {}, &Slice::begin);
    if (after == slices_.begin()) return nullptr;
    const Slice& slice = *(after - 1);
    return t <= slice.end ? &slice : nullptr;
}

// Optical depth from the slice's begin to t.
Rgb VolumeSegment::depthWithin(const Slice& slice, float t) const {
    Rgb depth(0);
    for (const Part& part : partsOf(slice)) {
        const VolumePiece& piece = pieces_[part.piece];
        const float from = piece.shareAt(slice.begin), to = piece.shareAt(t);
        const float before = from > 0 ? piece.density.integralTo(from) : 0.0f;
        const float column = (piece.density.integralTo(to) - before) * piece.length();
        depth += volume(part.volume).coefficients().sigmaT * std::max(0.0f, column);
    }
    return depth;
}

Rgb VolumeSegment::depthTo(float t) const {
    const auto after = std::ranges::upper_bound(slices_, t, {}, &Slice::begin);
    if (after == slices_.begin()) return Rgb(0);
    const Slice& slice = *(after - 1);
    if (t < slice.end) return slice.depthBefore + depthWithin(slice, t);
    return after == slices_.end() ? depth_ : after->depthBefore;
}

Rgb VolumeSegment::sigmaTIn(const Slice& slice, float t) const {
    Rgb sum(0);
    for (const Part& part : partsOf(slice))
        sum += volume(part.volume).coefficients().sigmaT * std::max(0.0f, densityOf(part, t));
    return sum;
}

Rgb VolumeSegment::sigmaT(float t) const {
    const Slice* slice = sliceAt(t);
    return slice != nullptr ? sigmaTIn(*slice, t) : Rgb(0);
}

Rgb VolumeSegment::emission(std::size_t index) const {
    if (!volume(index).glows()) return Rgb(0);
    Rgb sum(0);
    for (const Slice& slice : slices_)
        for (const Part& part : partsOf(slice))
            if (part.volume == index) sum += emissionIn(slice, part);
    return sum;
}

Rgb VolumeSegment::emissionIn(const Slice& slice, const Part& emitter) const {
    const Rgb& glow = volume(emitter.volume).coefficients().glow;
    const DensityCubic& density = pieces_[emitter.piece].density;
    const Rgb before = transmitted(slice.depthBefore), within = depthWithin(slice, slice.end);
    const float length = slice.end - slice.begin;
    const auto isConstant = [&](const Part& p) { return pieces_[p.piece].density.isConstant(); };
    if (std::ranges::all_of(partsOf(slice), isConstant)) {
        Rgb share;
        for (int c = 0; c < 3; ++c) share[c] = meanTransmittance(within[c]);
        return before * glow * share * Rgb(density.c[0].y, density.c[0].z, density.c[0].w) * length;
    }
    const int steps = std::clamp(static_cast<int>(std::ceil(maxComponent(within) / kDepthPerStep)),
                                 1, kMostDepthSteps);
    const float step = length / static_cast<float>(steps);
    Rgb sum(0);
    for (int k = 0; k < steps; ++k) {
        for (const GaussPoint& point : kGauss3) {
            const float t = slice.begin + (static_cast<float>(k) + point.s) * step;
            const Vec4 value = density.at(pieces_[emitter.piece].shareAt(t));
            sum += Rgb(value.y, value.z, value.w) * transmitted(depthWithin(slice, t)) *
                   (point.weight * step);
        }
    }
    return before * glow * glm::max(sum, Rgb(0));
}

float VolumeSegment::sampleCollision(int channel, float u) const {
    const float depth = -std::log1p(-u);
    if (!(depth < depth_[channel])) return std::numeric_limits<float>::infinity();
    return distanceAtDepth(channel, depth);
}

float VolumeSegment::distanceAtDepth(int channel, float depth) const {
    const auto after = std::ranges::upper_bound(
        slices_, depth, {}, [&](const Slice& s) { return s.depthBefore[channel]; });
    const Slice& slice = *(after == slices_.begin() ? after : after - 1);
    const float wanted = depth - slice.depthBefore[channel];
    const float whole = depthWithin(slice, slice.end)[channel];
    if (!(whole > 0)) return slice.begin;
    // Newton's method, within brackets: depth rises.
    float lo = slice.begin, hi = slice.end;
    float t = lo + (hi - lo) * std::min(1.0f, wanted / whole);
    for (int k = 0; k < 24 && lo < hi; ++k) {
        const float excess = depthWithin(slice, t)[channel] - wanted;
        if (std::abs(excess) <= 1e-6f * whole) break;
        (excess > 0 ? hi : lo) = t;
        const float newton = t - excess / sigmaTIn(slice, t)[channel];
        t = newton > lo && newton < hi ? newton : 0.5f * (lo + hi);
    }
    return t;
}

}  // namespace sss
