#pragma once
#include "sss/volume/volume_segment.h"

#include <vector>

namespace sss {

/// Scattering at one place in space: that of all volumes there, each with its Henyey-Greenstein
/// phase function.
class VolumeLobes {
public:
    VolumeLobes(const VolumeSegment& segment, float t);

    bool isEmpty() const { return lobes_.empty(); }
    /// Sum of sigma_s p between propagation directions of this cosine, mm^-1 sr^-1.
    Rgb value(float cosTheta) const;
    /// Density (sr^-1) with which sample() makes a direction.
    float pdf(float cosTheta) const;
    /// A propagation direction after scattering from `along`; not empty.
    Vec3 sample(const Vec3& along, float uLobe, const Vec2& u) const;

private:
    struct Lobe {
        Rgb sigmaS;
        float g;
        float share;  // of the mean sigma_s
    };
    std::vector<Lobe> lobes_;
};

}  // namespace sss
