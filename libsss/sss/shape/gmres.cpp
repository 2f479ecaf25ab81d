#include "sss/shape/gmres.h"

#include <algorithm>

namespace sss {
namespace {

DRgb inner(std::span<const DRgb> a, std::span<const DRgb> b) {
    DRgb sum{0};
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

DRgb lengthOf(std::span<const DRgb> a) { return glm::sqrt(inner(a, a)); }

// 0 where there is nothing to divide by.
DRgb quotient(const DRgb& a, const DRgb& b) {
    DRgb q{0};
    for (int c = 0; c < 3; ++c)
        if (b[c] != 0) q[c] = a[c] / b[c];
    return q;
}

double worst(const DRgb& v) { return std::max({v.x, v.y, v.z}); }

// A rotation by channel that turns (a, b) into (r, 0).
struct Rotation {
    DRgb cosine{1}, sine{0};
    Rotation(const DRgb& a, const DRgb& b) {
        const DRgb r = glm::sqrt(a * a + b * b);
        for (int c = 0; c < 3; ++c)
            if (r[c] > 0) {
                cosine[c] = a[c] / r[c];
                sine[c] = b[c] / r[c];
            }
    }
    void turn(DRgb& a, DRgb& b) const {
        const DRgb x = cosine * a + sine * b;
        b = cosine * b - sine * a;
        a = x;
    }
};

}  // namespace

GmresReport gmres(const MatrixProduct& apply, std::span<const DRgb> right, std::span<DRgb> x,
                  double tolerance, int mostIterations) {
    GmresReport report;
    const std::size_t n = right.size();
    const DRgb size = lengthOf(right);
    for (DRgb& v : x)
        for (int c = 0; c < 3; ++c)
            if (size[c] == 0) v[c] = 0;
    std::vector<std::vector<DRgb>> basis{std::vector<DRgb>(n)};
    apply(x, quotient(lengthOf(x), size), basis[0]);
    ++report.iterations;
    for (std::size_t i = 0; i < n; ++i) basis[0][i] = right[i] - basis[0][i];
    std::vector<DRgb> rest{lengthOf(basis[0])};
    for (DRgb& v : basis[0]) v = quotient(v, rest[0]);

    std::vector<std::vector<DRgb>> columns;  // of the triangular factor
    std::vector<Rotation> rotations;
    report.residual = report.start = quotient(glm::abs(rest[0]), size);
    while (worst(report.residual) > tolerance && report.iterations < mostIterations) {
        const std::size_t k = columns.size();
        std::vector<DRgb> next(n), column;
        apply(basis[k], report.residual, next);
        ++report.iterations;
        for (const std::vector<DRgb>& v : basis) {  // modified Gram-Schmidt
            column.push_back(inner(next, v));
            for (std::size_t i = 0; i < n; ++i) next[i] -= column.back() * v[i];
        }
        DRgb below = lengthOf(next);
        for (DRgb& v : next) v = quotient(v, below);
        for (std::size_t j = 0; j < rotations.size(); ++j)
            rotations[j].turn(column[j], column[j + 1]);
        rotations.emplace_back(column[k], below);
        rotations[k].turn(column[k], below);
        rest.emplace_back(0.0);
        rotations[k].turn(rest[k], rest[k + 1]);
        columns.push_back(std::move(column));
        basis.push_back(std::move(next));
        report.residual = quotient(glm::abs(rest[k + 1]), size);
    }
    // Back substitution.
    std::vector<DRgb> y(columns.size());
    for (std::size_t i = columns.size(); i-- > 0;) {
        DRgb value = rest[i];
        for (std::size_t j = i + 1; j < columns.size(); ++j) value -= columns[j][i] * y[j];
        y[i] = quotient(value, columns[i][i]);
    }
    for (std::size_t k = 0; k < y.size(); ++k)
        for (std::size_t i = 0; i < n; ++i) x[i] += y[k] * basis[k][i];
    report.converged = worst(report.residual) <= tolerance;
    return report;
}

}  // namespace sss
