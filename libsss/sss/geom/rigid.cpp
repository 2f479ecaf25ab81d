#include "sss/geom/rigid.h"

#include "sss/base/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace sss {

namespace {

/// matrix = columns * transpose(right): the columns are orthogonal, their lengths the singular
/// values.
struct OrthogonalColumns {
    DMat3 columns;
    DMat3 right{1.0};
};

/// Rotates columns i and j of both matrices so that those of `s.columns` become orthogonal; false
/// if they already are, to rounding.
bool orthogonalise(OrthogonalColumns& s, int i, int j) {
    const double ii = glm::dot(s.columns[i], s.columns[i]);
    const double jj = glm::dot(s.columns[j], s.columns[j]);
    const double ij = glm::dot(s.columns[i], s.columns[j]);
    if (std::abs(ij) <= 1e-16 * std::sqrt(ii) * std::sqrt(jj)) return false;
    const double zeta = (jj - ii) / (2.0 * ij);
    const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
    const double c = 1.0 / std::hypot(1.0, t), sine = c * t;
    for (DMat3* m : {&s.columns, &s.right}) {
        const DVec3 a = (*m)[i], b = (*m)[j];
        (*m)[i] = c * a - sine * b;
        (*m)[j] = sine * a + c * b;
    }
    return true;
}

OrthogonalColumns decompose(const DMat3& matrix) {
    OrthogonalColumns s{matrix};
    // Quadratic convergence: five sweeps in practice; the bound ends a last-bit oscillation.
    for (int sweep = 0; sweep < 30; ++sweep) {
        const bool a = orthogonalise(s, 0, 1), b = orthogonalise(s, 0, 2);
        const bool c = orthogonalise(s, 1, 2);
        if (!a && !b && !c) break;
    }
    return s;
}

double trace(const DMat3& m) { return m[0][0] + m[1][1] + m[2][2]; }

/// One Newton step of the orthogonal polar factor [Higham 1986]: removes the accumulated rounding.
DMat3 reorthogonalised(const DMat3& q) { return 0.5 * (q + glm::transpose(glm::inverse(q))); }

}  // namespace

PolarParts polarDecompose(const DMat3& matrix, const std::string& where) {
    double largest = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            largest = std::isfinite(matrix[c][r]) ? std::max(largest, std::abs(matrix[c][r]))
                                                  : std::numeric_limits<double>::infinity();
    if (!std::isfinite(largest))
        throw Error(ErrorKind::BadInput, where, "the matrix holds NaN or infinite numbers");
    const OrthogonalColumns s = decompose(largest > 0 ? matrix / largest : matrix);
    const std::array<double, 3> sigma{glm::length(s.columns[0]), glm::length(s.columns[1]),
                                      glm::length(s.columns[2])};
    const auto [smallest, greatest] = std::minmax_element(sigma.begin(), sigma.end());
    if (!(*smallest > 1e-12 * *greatest))
        throw Error(ErrorKind::BadInput, where,
                    fmt::format("the matrix is singular: it shrinks one direction to {:.3g} of "
                                "another",
                                *greatest > 0 ? *smallest / *greatest : 0.0),
                    "no scale factor may be zero");

    DMat3 left;
    for (int i = 0; i < 3; ++i) left[i] = s.columns[i] / sigma[static_cast<std::size_t>(i)];
    DVec3 stretches{sigma[0], sigma[1], sigma[2]};
    if (glm::determinant(left) * glm::determinant(s.right) < 0) {
        int flip = -1;
        double bestTrace = 0;
        for (int i = 0; i < 3; ++i) {
            if (stretches[i] > *smallest * (1 + 1e-12)) continue;
            DMat3 candidate = left;
            candidate[i] = -candidate[i];
            const double turned = trace(candidate * glm::transpose(s.right));
            if (flip < 0 || turned > bestTrace) flip = i, bestTrace = turned;
        }
        left[flip] = -left[flip];
        stretches[flip] = -stretches[flip];
    }
    PolarParts parts;
    parts.rotation = reorthogonalised(left * glm::transpose(s.right));
    const DMat3 scaled(s.right[0] * (stretches.x * largest), s.right[1] * (stretches.y * largest),
                       s.right[2] * (stretches.z * largest));
    const DMat3 stretch = scaled * glm::transpose(s.right);
    parts.stretch = 0.5 * (stretch + glm::transpose(stretch));
    return parts;
}

}  // namespace sss
