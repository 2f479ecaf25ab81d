#include "sss/integrate/volume_lobes.h"

#include "sss/integrate/medium_coefficients.h"
#include "sss/optics/phase.h"

namespace sss {

VolumeLobes::VolumeLobes(const VolumeSegment& segment, float t) {
    float total = 0;
    segment.at(t, [&](std::size_t volume, float density) {
        const VolumeCoefficients& medium = segment.volume(volume).coefficients();
        const Rgb sigmaS = medium.sigmaS * density;
        const float mean = meanComponent(sigmaS);
        if (!(mean > 0)) return;
        lobes_.push_back({sigmaS, medium.g, mean});
        total += mean;
    });
    for (Lobe& lobe : lobes_) lobe.share /= total;
}

Rgb VolumeLobes::value(float cosTheta) const {
    Rgb sum(0);
    for (const Lobe& lobe : lobes_) sum += lobe.sigmaS * henyeyGreenstein(cosTheta, lobe.g);
    return sum;
}

float VolumeLobes::pdf(float cosTheta) const {
    float sum = 0;
    for (const Lobe& lobe : lobes_) sum += lobe.share * henyeyGreenstein(cosTheta, lobe.g);
    return sum;
}

Vec3 VolumeLobes::sample(const Vec3& along, float uLobe, const Vec2& u) const {
    const Lobe* chosen = &lobes_.back();
    for (const Lobe& lobe : lobes_) {
        if (uLobe < lobe.share) {
            chosen = &lobe;
            break;
        }
        uLobe -= lobe.share;
    }
    return glm::normalize(sampleScattered(along, chosen->g, u));
}

}  // namespace sss
