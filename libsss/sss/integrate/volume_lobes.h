#pragma once
#include "sss/volume/volume_segment.h"

#include <vector>

namespace sss {

/// Scattering at one place in space: that of all volumes there, each with its Henyey-Greenstein
/// phase function.
class VolumeLobes {
public:
    VolumeLobes(const VolumeSegment& segment, float t);

    /// Who chooses among lobes, by their sigma_s: a channel, 0 to 2, or the mean of them.
    static constexpr int kMean = 3;

    /// Whether a chooser finds nothing that scatters.
    bool isEmpty(int chooser = kMean) const { return !(total_[chooser] > 0); }
    /// Sum of sigma_s p between propagation directions of this cosine, mm^-1 sr^-1.
    Rgb value(float cosTheta) const;
    /// Density (sr^-1) with which sample() makes a direction of this cosine.
    float pdf(float cosTheta, int chooser = kMean) const;
    /// A propagation direction after scattering from `along`; not empty for the chooser.
    Vec3 sample(const Vec3& along, float uLobe, const Vec2& u, int chooser = kMean) const;

private:
    struct Lobe {
        Vec4 sigmaS;  // by chooser
        float g;
    };
    std::vector<Lobe> lobes_;
    Vec4 total_{0};
};

}  // namespace sss
