#pragma once
#include "sss/base/warp.h"
#include "sss/integrate/integrator_table.h"
#include "sss/integrate/preprocess.h"
#include "unit/integrate/batches.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

namespace sss::testing {

inline Estimate estimate(std::uint32_t perBatch, const std::function<DRgb(Sampler&)>& sample) {
    return batchEstimate(4711, perBatch, sample);
}

/// Within 3 standard errors, which must be small enough to say something; `slack` is the error of
/// the expectation itself.
inline void expectWithin(const Estimate& e, const DRgb& expected, double largestError,
                         double slack = 1e-5) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(e.mean[c], expected[c], 3 * e.error[c] + slack) << "channel " << c;
        EXPECT_LT(e.error[c], largestError) << "channel " << c;
    }
}

/// A scene and the integrator "volume" upon it.
class Experiment {
public:
    explicit Experiment(const SceneMaker& maker)
        : world_(maker.world()),
          optics_(makeBodyOptics(world_)),
          integrator_(findIntegrator("volume")->make({world_, optics_, {}})) {}

    FilmSample trace(const Ray& ray, Sampler& sampler) const {
        return integrator_->trace(ray, sampler, counts_);
    }
    const World& world() const { return world_; }
    const BodyOptics& optics() const { return *optics_[0]; }
    const PathCounts& counts() const { return counts_; }

private:
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
    std::unique_ptr<Integrator> integrator_;
    mutable PathCounts counts_;
};

inline DRgb scattered(const FilmSample& s) { return DRgb(s.diffusion) + DRgb(s.single); }
inline DRgb all(const FilmSample& s) { return scattered(s) + DRgb(s.surface); }

inline Ray downTo(float height, const Vec3& towardsCamera = {0, 1, 0}) {
    Ray ray;
    ray.origin = Vec3(0.31f, height, -0.23f) + towardsCamera * 2.0f;
    ray.direction = -towardsCamera;
    return ray;
}
/// So that what is seen is flux per pi.
inline Ray cosineDownTo(float height, Sampler& sampler) {
    const Vec3 local = cosineDirection(sampler.next2D());
    return downTo(height, glm::normalize(Vec3(local.x, std::max(local.z, 1e-4f), local.y)));
}

inline constexpr float kHalfSize = 25;  // mm; hundreds of free paths
inline SceneMaker halfSpace(const TranslucentMaterial& material) {
    SceneMaker maker;
    maker.object(BoxShape{DVec3(2 * kHalfSize)}, maker.material(material));
    return maker;
}
inline SceneMaker slab(const TranslucentMaterial& material, double thickness) {
    SceneMaker maker;
    maker.object(BoxShape{{100, thickness, 100}}, maker.material(material));
    return maker;
}
inline LightSettings sky(float radiance = 1) { return EnvironmentLight{Rgb(radiance), {}, 0}; }
/// Nothing comes from below.
inline void blackFloor(SceneMaker& maker, double height) {
    maker.object(RectangleShape{1e5, 1e5}, maker.material(LambertianMaterial{Rgb(0)}),
                 moved({0, height, 0}) * turned(-90, {1, 0, 0}));
}
inline void blackCeiling(SceneMaker& maker, double height) {
    maker.object(RectangleShape{1e5, 1e5}, maker.material(LambertianMaterial{Rgb(0)}),
                 moved({0, height, 0}) * turned(90, {1, 0, 0}));
}

/// Whatever a camera above sees of a scene that absorbs nothing, under a sky of radiance 1, is 1,
/// path by path.
inline void expectWhiteFurnace(const SceneMaker& maker) {
    const Experiment experiment(maker);
    const Estimate e = estimate(16, [&](Sampler& sampler) {
        Ray ray;
        ray.origin = Vec3(Vec2(1.8f) * (sampler.next2D() - 0.5f), 3.0f);
        ray.direction = {0, 0, -1};
        return all(experiment.trace(ray, sampler));
    });
    expectWithin(e, DRgb(1), 1e-4, 1e-4);
    EXPECT_EQ(experiment.counts().lost, 0u);
}

}  // namespace sss::testing
