#pragma once
#include "sss/base/vec.h"

#include <string>

namespace sss {

/// Motion without scaling: p -> rotation * p + translation. The rotation is proper (det +1).
struct RigidTransform {
    DMat3 rotation{1.0};
    DVec3 translation{0};

    DVec3 transformPoint(const DVec3& p) const { return rotation * p + translation; }
    DVec3 transformDirection(const DVec3& d) const { return rotation * d; }
    RigidTransform inverse() const {
        const DMat3 back = glm::transpose(rotation);
        return {back, -(back * translation)};
    }
    /// First `inner`, then this.
    RigidTransform compose(const RigidTransform& inner) const {
        return {rotation * inner.rotation, transformPoint(inner.translation)};
    }
};

/// matrix = rotation * stretch.
struct PolarParts {
    DMat3 rotation{1.0};  ///< orthogonal to rounding, det +1
    DMat3 stretch{1.0};   ///< symmetric; its determinant has the sign of the matrix's
};

/// Splits off the rotation nearest to `matrix`. A mirrored matrix gets a stretch with one negative
/// eigenvalue, of the smallest magnitude; among equals, the choice that turns least.
/// Throws Error{BadInput} if `matrix` is not finite, or if its smallest singular value is below
/// 1e-12 of its largest. Source: singular values by one-sided Jacobi rotations [Hestenes 1958],
/// which keep the relative accuracy of strongly scaled columns. `where`: where the matrix comes
/// from, for the error.
PolarParts polarDecompose(const DMat3& matrix, const std::string& where = "transform");

}  // namespace sss
