#include "sss/integrate/volume_lobes.h"

#include "sss/integrate/medium_coefficients.h"
#include "sss/optics/phase.h"

namespace sss {

VolumeLobes::VolumeLobes(const VolumeSegment& segment, float t) {
    segment.at(t, [&](std::size_t volume, float density) {
        const VolumeCoefficients& medium = segment.volume(volume).coefficients();
        const Rgb sigmaS = medium.sigmaS * density;
        const float mean = meanComponent(sigmaS);
        if (!(mean > 0)) return;
        lobes_.push_back({Vec4(sigmaS, mean), medium.g});
        total_ += lobes_.back().sigmaS;
    });
}

Rgb VolumeLobes::value(float cosTheta) const {
    Rgb sum(0);
    for (const Lobe& lobe : lobes_) sum += Rgb(lobe.sigmaS) * henyeyGreenstein(cosTheta, lobe.g);
    return sum;
}

float VolumeLobes::pdf(float cosTheta, int chooser) const {
    if (isEmpty(chooser)) return 0;
    float sum = 0;
    for (const Lobe& lobe : lobes_)
        sum += lobe.sigmaS[chooser] * henyeyGreenstein(cosTheta, lobe.g);
    return sum / total_[chooser];
}

Vec3 VolumeLobes::sample(const Vec3& along, float uLobe, const Vec2& u, int chooser) const {
    const Lobe* chosen = &lobes_.back();
    float left = uLobe * total_[chooser];
    for (const Lobe& lobe : lobes_) {
        if (left < lobe.sigmaS[chooser]) {
            chosen = &lobe;
            break;
        }
        left -= lobe.sigmaS[chooser];
    }
    return glm::normalize(sampleScattered(along, chosen->g, u));
}

}  // namespace sss
