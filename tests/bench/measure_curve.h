#pragma once
#include "sss/base/json.h"
#include "sum_methods.h"

#include <memory>
#include <vector>

namespace sss::bench {

/// What a curve is measured with.
struct CurveInput {
    std::span<const Vec3> receivers;
    std::span<const DRgb> truth;  ///< at the receivers
    /// What time and counts are of, where the truth at so many would take too long; none: the
    /// receivers.
    std::span<const Vec3> timed;
    std::vector<double> tolerances;
    int rounds = 3;                ///< every method and setting once a round, in turn
    double secondsPerSetting = 2;  ///< further rounds are left out beyond it
};

/// [{name, label, setting, cost, curve: [{setting, seconds, secondsMedian, repeats, error,
/// counts}]}], seconds and counts per receiver.
JsonValue measureCurves(const CurveInput& input,
                        std::span<const std::unique_ptr<SumMethod>> methods);

}  // namespace sss::bench
