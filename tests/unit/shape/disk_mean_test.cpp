// Integrals over disks by the sum over their points.
#include "sss/shape/disk_mean.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sss {
namespace {

// By rings and sectors of equal area.
double meanOverDisk(double k, double radius, double aside, double depth) {
    constexpr int kRings = 200, kSectors = 200;
    double sum = 0;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const double at = radius * std::sqrt((i + 0.5) / kRings);
            const double angle = 2 * kPi * (j + 0.5) / kSectors;
            const double r = std::hypot(at * std::cos(angle) - aside, at * std::sin(angle), depth);
            sum += std::exp(-k * r) / (4 * kPi * r);
        }
    return sum / (kRings * kSectors);
}

TEST(DiskMean, IsThatOfTheFieldAtItsPoints) {
    const double radius = 0.7;
    const DRgb screening{0, 0.5, 3};
    for (const double aside : {0.0, 0.3, 0.7, 1.2})
        for (const double depth : {0.01, 0.1, 0.35, 1.5}) {
            const DRgb mean = diskMeanOfGreen(screening, radius, aside, depth);
            const bool isDeep = depth >= 0.5 * radius;
            const bool isNearRim = std::hypot(aside - radius, depth) < 0.5 * radius;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(mean[c] / meanOverDisk(screening[c], radius, aside, depth), 1,
                            isDeep      ? 0.002
                            : isNearRim ? 0.08
                                        : 0.03)
                    << screening[c] << ' ' << aside << ' ' << depth;
        }
}

}  // namespace
}  // namespace sss
