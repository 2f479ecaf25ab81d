#include "sss/integrate/entry_sampler.h"

#include "sss/integrate/preprocess.h"
#include "unit/integrate/batches.h"
#include "unit/integrate/scene_maker.h"

#include <gtest/gtest.h>

#include <vector>

namespace sss {
namespace {

using testing::Estimate;
using testing::grey;
using testing::SceneMaker;

constexpr const char* kProfiles[] = {"dipole", "better_dipole", "normalized_diffusion"};

TranslucentMaterial unevenlyColoured(const char* profile) {
    TranslucentMaterial material = grey(0, 0, 1.4);
    material.medium.sigmaA = {0.01, 0.3, 2};
    material.medium.sigmaS = {1, 3, 5};
    material.profile = profile;
    material.singleScattering = false;  // whose share takes a while to compute
    return material;
}

/// Samples around the top of body 0.
class EntryExperiment {
public:
    explicit EntryExperiment(const SceneMaker& maker)
        : world_(maker.world()), optics_(makeBodyOptics(world_)), sampler_(world_, 0, *optics_[0]) {
        Ray down;
        down.origin = {0.02f, 1000, -0.03f};
        down.direction = {0, -1, 0};
        Hit hit;
        EXPECT_TRUE(world_.rays().intersect(down, hit));
        exit_ = world_.surfaceAt(hit);
    }
    EntryPlace sample(Sampler& sampler) const { return sampler_.sample(exit_, sampler); }
    /// What an even irradiance of 1 sends out.
    Estimate evenly(std::uint32_t perBatch) const {
        return testing::batchEstimate(
            5, perBatch, [&](Sampler& sampler) { return DRgb(sample(sampler).weight); });
    }
    const Profile& profile(int channel) const {
        return *optics_[0]->profiles[static_cast<std::size_t>(channel)];
    }
    const SurfaceHit& exit() const { return exit_; }

private:
    World world_;
    std::vector<std::unique_ptr<BodyOptics>> optics_;
    EntrySampler sampler_;
    SurfaceHit exit_;
};

void expectEstimate(const Estimate& e, const DRgb& expected, double largestRelativeError,
                    double relativeSlack) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(e.mean[c], expected[c], 3.5 * e.error[c] + relativeSlack * expected[c])
            << "channel " << c;
        EXPECT_LT(e.error[c], largestRelativeError * expected[c]) << "channel " << c;
    }
}

// On a sphere of radius R as much area lies within a distance r <= 2R as on the plane.
TEST(EntrySampler, Sphere) {
    for (const char* profile : kProfiles)
        for (const double radius :
             profile == kProfiles[0] ? std::vector{0.3, 3.0} : std::vector{3.0}) {
            SCOPED_TRACE(::testing::Message() << profile << ' ' << radius);
            SceneMaker maker;
            maker.object(SphereShape{radius}, maker.material(unevenlyColoured(profile)));
            const EntryExperiment experiment(maker);
            DRgb expected;
            for (int c = 0; c < 3; ++c)
                expected[c] =
                    experiment.profile(c).total() - experiment.profile(c).tail(2 * radius);
            expectEstimate(experiment.evenly(256), expected, 0.02, 3e-4);
        }
}

// The far face of a slab of thickness d, whose places are sqrt(r^2 + d^2) away, adds tail(d).
TEST(EntrySampler, ThinSlab) {
    for (const char* profile : kProfiles) {
        SCOPED_TRACE(profile);
        const double thickness = 0.4;
        SceneMaker maker;
        maker.object(BoxShape{{400, thickness, 400}}, maker.material(unevenlyColoured(profile)));
        const EntryExperiment experiment(maker);
        DRgb expected;
        for (int c = 0; c < 3; ++c)
            expected[c] = experiment.profile(c).total() + experiment.profile(c).tail(thickness);
        expectEstimate(experiment.evenly(512), expected, 0.02, 1e-4);
    }
}

// No noise where there is nothing to choose from: on a plane, for a grey medium.
TEST(EntrySampler, EverySampleOfAPlaneSaysTheTotal) {
    for (const char* profile : kProfiles) {
        SCOPED_TRACE(profile);
        TranslucentMaterial material = grey(0.3, 3, 1.4);
        material.profile = profile;
        SceneMaker maker;
        maker.object(RectangleShape{100, 100}, maker.material(material),
                     testing::turned(-90, {1, 0, 0}));
        const EntryExperiment experiment(maker);
        const double total = experiment.profile(0).total();
        int outside = 0;
        for (std::uint32_t i = 0; i < 1024; ++i) {
            Sampler sampler(8, i);
            const EntryPlace place = experiment.sample(sampler);
            ASSERT_EQ(place.hit.body, 0);
            const double ratio = static_cast<double>(place.weight.x) / total;
            outside += std::abs(ratio - 1) > 0.04 ? 1 : 0;
        }
        // Far out a cell of the table spans more than that of an exponential.
        EXPECT_LT(outside, 20);
    }
}

// Places come with their profile's density, corners and all: a moment of theirs against the sum
// over the faces of a box.
TEST(EntrySampler, BoxByQuadrature) {
    const double size = 1.5;
    SceneMaker maker;
    maker.object(BoxShape{DVec3(size)}, maker.material(unevenlyColoured("better_dipole")));
    const EntryExperiment experiment(maker);
    const DVec3 exit(experiment.exit().position);
    const auto received = [](const DVec3& p) { return 1 + p.x + 2 * p.y * p.z; };
    constexpr int kSteps = 120;
    DRgb expected(0);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-0.5, 0.5})
            for (int i = 0; i < kSteps; ++i)
                for (int j = 0; j < kSteps; ++j) {
                    DVec3 p;
                    p[axis] = side * size;
                    p[(axis + 1) % 3] = ((i + 0.5) / kSteps - 0.5) * size;
                    p[(axis + 2) % 3] = ((j + 0.5) / kSteps - 0.5) * size;
                    const double area = size * size / kSteps / kSteps;
                    for (int c = 0; c < 3; ++c)
                        expected[c] += experiment.profile(c).reflectance(glm::distance(p, exit)) *
                                       received(p) * area;
                }
    const Estimate e = testing::batchEstimate(6, 1024, [&](Sampler& sampler) {
        const EntryPlace place = experiment.sample(sampler);
        return DRgb(place.weight) * received(DVec3(place.hit.position));
    });
    expectEstimate(e, expected, 0.015, 2e-3);
}

}  // namespace
}  // namespace sss
