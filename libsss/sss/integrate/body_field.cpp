#include "sss/integrate/body_field.h"

#include <cmath>

namespace sss {
namespace {

// Sites start this many mean free paths apart; the field refines where that is too coarse.
constexpr double kSegmentPerMfp = 1.5;

double segmentLength(const Body& body, const BodyOptics& optics) {
    const double size = body.mesh.bounds().diagonal();
    const double mfp = optics.material.medium.smallestMeanFreePathMm();
    return std::isfinite(mfp) ? std::min(kSegmentPerMfp * mfp, size) : size;
}

// How far behind its place on the surface the light comes from that is seen there, along the
// surface, over the sine of the angle outside.
Rgb leanLength(const Medium& medium) {
    Rgb length(0);
    for (int c = 0; c < 3; ++c) {
        const ChannelMedium channel = medium.channel(c);
        if (channel.sigmaSPrime() > 0)
            length[c] = static_cast<float>(channel.meanFreePathMm() / medium.eta);
    }
    return length;
}

}  // namespace

BodyField::BodyField(const Body& body, const BodyOptics& optics, const BodyCloud::View& cloud,
                     double tolerance)
    : table_(optics.profilePointers(), body.mesh.bounds().diagonal() * 1.01,
             cloud.spacingMm / std::sqrt(kPi)),
      sum_(cloud.cloud, cloud.nodes, table_),
      correction_(cloud.solved.empty()
                      ? nullptr
                      : std::make_unique<PointInterpolator>(cloud.cloud.points, cloud.solved,
                                                            leanLength(optics.material.medium))),
      field_(body.mesh, sum_, segmentLength(body, optics), tolerance, correction_.get()) {}

}  // namespace sss
