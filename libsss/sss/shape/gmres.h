#pragma once
#include "sss/base/vec.h"

#include <functional>
#include <span>
#include <vector>

namespace sss {

/// Linear systems of the three channels, solved side by side: numbers are DRgb, all arithmetic is
/// by channel.
struct GmresReport {
    int iterations = 0;  ///< products with the operator
    DRgb start{0};       ///< the guess's residual
    DRgb residual{0};    ///< |right - K x| / |right|, by the recurrence
    bool converged = false;
};

/// out = K in. `weight` is by how much of |right| the product enters the residual, at most about:
/// an error of the product is weighed with it, so that later products may be made with less care
/// than the first [van den Eshof and Sleijpen 2004, inexact Krylov methods].
using MatrixProduct =
    std::function<void(std::span<const DRgb> in, const DRgb& weight, std::span<DRgb> out)>;

/// Solves K x = right by GMRES without restarts [Saad & Schultz 1986], from the guess that `x`
/// holds, until every channel's residual is below `tolerance` or `mostIterations` products were
/// made. A channel whose right side is 0 becomes 0.
/// Deterministic.
GmresReport gmres(const MatrixProduct& apply, std::span<const DRgb> right, std::span<DRgb> x,
                  double tolerance, int mostIterations);

}  // namespace sss
