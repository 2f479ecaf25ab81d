#pragma once
#include "sss/base/json.h"
#include "sss/base/vec.h"

#include <span>

namespace sss::bench {

/// How far answers lie from the truth, as JSON:
///   rms, bias     of the relative deviation, over receivers and channels
///   p999, max     of a receiver's worst channel: 99.9 % of the receivers are within p999
///   rmsOfMean     RMS deviation / mean truth: what an image's relative RMSE is
///   biasOfMean    mean deviation / mean truth
///   channels      [{rms, bias, p999, max} for red, green, blue]
///   receivers     compared
/// Channels whose truth is below 1e-25 (near the end of single precision) are left out of the
/// relative figures.
JsonValue describeDeviations(std::span<const Rgb> answers, std::span<const DRgb> truth);

}  // namespace sss::bench
