#include "sss/medium/medium.h"

namespace sss {

DRgb Medium::meanFreePathMm() const {
    return {channel(0).meanFreePathMm(), channel(1).meanFreePathMm(), channel(2).meanFreePathMm()};
}

double Medium::smallestMeanFreePathMm() const { return minComponent(meanFreePathMm()); }

}  // namespace sss
