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

}  // namespace

BodyField::BodyField(const Body& body, const BodyOptics& optics, const BodyCloud::View& cloud,
                     double tolerance)
    : table_(optics.profilePointers(), body.mesh.bounds().diagonal() * 1.01,
             cloud.spacingMm / std::sqrt(kPi)),
      sum_(cloud.cloud, cloud.nodes, table_),
      correction_(cloud.correction.empty()
                      ? nullptr
                      : std::make_unique<PointInterpolator>(cloud.cloud.points, cloud.correction)),
      field_(body.mesh, sum_, segmentLength(body, optics), tolerance, correction_.get()) {}

}  // namespace sss
