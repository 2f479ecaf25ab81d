#include "sss/geom/rigid.h"

#include "sss/base/error.h"
#include "sss/base/rng.h"

#include <gtest/gtest.h>

#include <array>

namespace sss {
namespace {

double largest(const DMat3& m) {
    double most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, maxComponent(glm::abs(m[c])));
    return most;
}

DMat3 randomRotation(Rng& rng) {
    // A random unit quaternion.
    std::array<double, 4> q{};
    double square = 0;
    for (double& x : q) {
        x = rng.uniformDouble() - 0.5;
        square += x * x;
    }
    for (double& x : q) x /= std::sqrt(square);
    const auto [w, x, y, z] = q;
    return {DVec3{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            DVec3{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            DVec3{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

void expectParts(const DMat3& matrix, const PolarParts& parts) {
    const double scale = largest(matrix);
    EXPECT_LT(largest(glm::transpose(parts.rotation) * parts.rotation - DMat3(1.0)), 1e-14);
    EXPECT_NEAR(glm::determinant(parts.rotation), 1, 1e-14);
    EXPECT_EQ(parts.stretch, glm::transpose(parts.stretch));
    EXPECT_LT(largest(parts.rotation * parts.stretch - matrix) / scale, 1e-14);
}

TEST(PolarDecompose, RecoversRotationAndSymmetricStretch) {
    Rng rng(1);
    for (int i = 0; i < 1000; ++i) {
        const DMat3 rotation = randomRotation(rng), axes = randomRotation(rng);
        DMat3 diagonal(1.0);
        for (int c = 0; c < 3; ++c) diagonal[c][c] = 0.2 + 2 * rng.uniformDouble();
        const DMat3 stretch = axes * diagonal * glm::transpose(axes);
        const PolarParts parts = polarDecompose(rotation * stretch);
        expectParts(rotation * stretch, parts);
        EXPECT_LT(largest(parts.rotation - rotation), 1e-14);
        EXPECT_LT(largest(parts.stretch - stretch), 2e-14);
    }
}

TEST(PolarDecompose, HoldsForStronglyScaledAndMirroredMatrices) {
    Rng rng(2);
    for (int i = 0; i < 1000; ++i) {
        DMat3 diagonal(1.0);
        for (int c = 0; c < 3; ++c)
            diagonal[c][c] =
                std::pow(10.0, 9 * rng.uniformDouble() - 4.5) * (rng.uniform() < 0.5f ? -1.0 : 1.0);
        const DMat3 matrix = randomRotation(rng) * diagonal * randomRotation(rng);
        const PolarParts parts = polarDecompose(matrix);
        expectParts(matrix, parts);
        EXPECT_GT(glm::determinant(parts.stretch) * glm::determinant(matrix), 0);
    }
}

TEST(PolarDecompose, KeepsPlainScalesAndMirrorsFree) {
    for (const DVec3 scale :
         {DVec3{1, 1, 1}, DVec3{-1, 1, 1}, DVec3{1, 1, -1}, DVec3{1e-9, 1e-9, 1e-9},
          DVec3{1e200, 1e200, 1e200}, DVec3{25.4, 25.4, -25.4}}) {
        DMat3 matrix(0.0);
        for (int c = 0; c < 3; ++c) matrix[c][c] = scale[c];
        const PolarParts parts = polarDecompose(matrix);
        EXPECT_EQ(parts.rotation, DMat3(1.0));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(parts.stretch[c][c] / scale[c], 1, 1e-15);
    }
    // A pure inversion cannot be free: one axis is mirrored, the rest is a half turn.
    expectParts(DMat3(-1.0), polarDecompose(DMat3(-1.0)));
}

TEST(PolarDecompose, RefusesSingularAndBrokenMatrices) {
    const auto flat = [](double thin) {
        return DMat3(DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, thin});
    };
    EXPECT_NO_THROW(polarDecompose(flat(2e-12)));
    for (const DMat3& bad :
         {flat(0), flat(5e-13), DMat3(0.0), flat(std::nan("")), flat(INFINITY)}) {
        try {
            polarDecompose(bad);
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        }
    }
}

TEST(RigidTransform, ComposesAndInverts) {
    Rng rng(3);
    const RigidTransform a{randomRotation(rng), {1, 2, 3}}, b{randomRotation(rng), {-4, 0.5, 9}};
    const DVec3 p{0.3, -7, 2};
    EXPECT_LT(glm::distance(a.compose(b).transformPoint(p), a.transformPoint(b.transformPoint(p))),
              1e-14);
    EXPECT_LT(glm::distance(a.inverse().transformPoint(a.transformPoint(p)), p), 1e-14);
    EXPECT_LT(glm::distance(a.transformDirection(p), a.transformPoint(p) - a.translation), 1e-14);
    EXPECT_NEAR(glm::length(a.transformDirection(p)), glm::length(p), 1e-14);
}

}  // namespace
}  // namespace sss
