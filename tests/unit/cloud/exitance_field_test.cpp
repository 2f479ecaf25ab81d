#include "sss/cloud/exitance_field.h"

#include "cloud_tools.h"
#include "sss/base/parallel.h"
#include "sss/base/rng.h"
#include "sss/geom/shapes.h"

#include <gtest/gtest.h>

#include <cstring>

namespace sss {
namespace {

using testing::Deviations;
using testing::fromOneSide;
using testing::halfPlane;
using testing::LitCloud;
using testing::Optics;

struct Place {
    FaceIndex face;
    Vec2 barycentrics;
};

std::vector<Place> randomPlaces(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
    const SurfaceStrata strata = makeStrata(mesh, count, seed);
    std::vector<Place> places;
    for (std::size_t i = 0; i < count; ++i)
        places.push_back({strata.faces[i], strata.barycentrics[i]});
    Rng rng(seed);
    for (std::size_t i = count; i-- > 1;) std::swap(places[i], places[rng.next64() % (i + 1)]);
    return places;
}

// A lit body and what is needed to make fields over it.
struct LitBody {
    Optics optics;
    TriangleMesh mesh;
    LitCloud cloud;
    KernelTable table;
    DiffusionSum sum;

    LitBody(const char* medium, TriangleMesh shape, double spacingPerMfp,
            const testing::Light& light)
        : optics(medium),
          mesh(std::move(shape)),
          cloud(mesh, spacingPerMfp * optics.smallestMfp(), light),
          table(cloud.table(optics, mesh.bounds().diagonal() * 1.01)),
          sum(cloud.view(), cloud.nodes, table) {}
    double segment() const { return 1.5 * optics.smallestMfp(); }
};

void expectWithin(const LitBody& body, double tolerance, const char* name) {
    const ExitanceField field(body.mesh, body.sum, body.segment(), tolerance);
    Deviations deviations(tolerance);
    for (const Place& p : randomPlaces(body.mesh, 2000, 17))
        deviations.add(field.at(p.face, p.barycentrics),
                       body.sum.bruteForce(field.sites().position(p.face, p.barycentrics)));
    EXPECT_LE(deviations.shareOutside(), 0.001) << name << " " << tolerance;
    EXPECT_LE(deviations.largest(), 3 * tolerance) << name << " " << tolerance;
    EXPECT_LE(deviations.bias(), 0.1 * tolerance) << name << " " << tolerance;
}

TEST(ExitanceField, KeepsItsToleranceAcrossATerminator) {
    const LitBody marble("marble", makeSphere(6), 0.75, fromOneSide);
    for (const double tolerance : {0.03, 0.01, 0.003}) expectWithin(marble, tolerance, "marble");
    const LitBody ketchup("ketchup", makeSphere(6), 0.45, fromOneSide);
    expectWithin(ketchup, 0.01, "ketchup");
}

TEST(ExitanceField, KeepsItsToleranceAtALightEdge) {
    const LitBody marble("marble", makeRectangle(20, 10), 0.75, halfPlane);
    expectWithin(marble, 0.01, "marble");
    const LitBody skimmilk("skimmilk", makeRectangle(20, 10, 1), 0.75, halfPlane);
    expectWithin(skimmilk, 0.01, "skimmilk");
}

// Red light on one half, blue on the other, green on both.
TEST(ExitanceField, KeepsItsToleranceUnderColouredLight) {
    const LitBody skin("skin1", makeSphere(8), 0.6,
                       [](const Vec3& p) { return p.x > 0 ? Rgb(1, 0.5f, 0) : Rgb(0, 0.5f, 1); });
    expectWithin(skin, 0.01, "skin1");
}

// Light from above comes out below: there everything is dimmer, and of another colour.
TEST(ExitanceField, KeepsItsToleranceOnAThinPart) {
    const LitBody plate("marble", makeBox({10, 6, 0.5}), 0.75, [](const Vec3& p) {
        return p.z > 0 ? Rgb(1, 0.9f, 0.7f) * (p.x > 0 ? 1.0f : 0.2f) : Rgb(0.0f);
    });
    expectWithin(plate, 0.01, "marble");
}

// What three refinements cannot do is counted: here a light edge within the first segment.
TEST(ExitanceField, CountsWhatItLeavesTooCoarse) {
    const LitBody body("marble", makeRectangle(20, 10), 0.75, halfPlane);
    const auto unsettled = [&](double segment) {
        const ExitanceField field(body.mesh, body.sum, segment, 0.01);
        for (const Place& p : randomPlaces(body.mesh, 500, 17)) field.at(p.face, p.barycentrics);
        return field.counts().unsettled;
    };
    EXPECT_EQ(unsettled(body.segment()), 0u);
    EXPECT_GT(unsettled(20 * body.segment()), 0u);
}

TEST(ExitanceField, KeepsItsToleranceOnFacesFarLargerThanTheMeanFreePath) {
    const LitBody box("skimmilk", makeBox(DVec3(24)), 0.9, fromOneSide);
    ASSERT_EQ(box.mesh.faceCount(), 12u);
    expectWithin(box, 0.01, "box");
}

TEST(ExitanceField, ValuesAreTheSumAtSitesToTheHierarchysError) {
    const LitBody body("marble", makeSphere(3), 0.75, fromOneSide);
    const ExitanceField field(body.mesh, body.sum, body.segment(), 0);
    for (FaceIndex f = 0; f < body.mesh.faceCount(); f += 97)
        for (const Vec2 corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}) {
            const DRgb truth = body.sum.bruteForce(field.sites().position(f, corner));
            const Rgb value = field.at(f, corner);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(value[c]), truth[c], 3e-6 * truth[c]);
        }
}

TEST(ExitanceField, SameBytesWhoeverAsksFirst) {
    const LitBody body("marble", makeSphere(4), 0.9, fromOneSide);
    const std::vector<Place> places = randomPlaces(body.mesh, 3000, 5);
    const auto ask = [&](bool backwards, unsigned threads) {
        const ThreadLimit limit(threads);
        const ExitanceField field(body.mesh, body.sum, body.segment(), 0.01);
        std::vector<Rgb> values(places.size());
        parallelFor(places.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const std::size_t i = backwards ? places.size() - 1 - k : k;
                values[i] = field.at(places[i].face, places[i].barycentrics);
            }
        });
        EXPECT_GT(field.counts().groups, field.sites().groupCount() / 2);
        return values;
    };
    const auto expected = ask(false, 1);
    for (const auto& values : {ask(true, 1), ask(false, 2), ask(true, 2)})
        EXPECT_EQ(std::memcmp(values.data(), expected.data(), values.size() * sizeof(Rgb)), 0);
}

TEST(ExitanceField, ComputesOnlyWhatIsAskedFor) {
    const LitBody body("marble", makeBox(DVec3(12)), 0.9, fromOneSide);
    const ExitanceField field(body.mesh, body.sum, body.segment(), 0.01);
    EXPECT_EQ(field.counts().groups, 0u);
    EXPECT_GT(field.sites().groupCount(), 40u);
    for (int i = 0; i < 50; ++i) field.at(3, {0.2f + 1e-4f * static_cast<float>(i), 0.3f});
    const ExitanceCounts counts = field.counts();
    EXPECT_GE(counts.groups, 1u);
    EXPECT_LE(counts.groups, 2u);
    EXPECT_GE(counts.sums.receivers, counts.sites);
}

TEST(ExitanceField, NoJumpAcrossPatchBorders) {
    constexpr double kTolerance = 0.01;
    const LitBody body("skimmilk", makeBox(DVec3(12)), 0.9, fromOneSide);
    const ExitanceField field(body.mesh, body.sum, body.segment(), kTolerance);
    int borders = 0;
    for (FaceIndex face = 0; face < 12; face += 2)
        for (const float y : {0.1f, 0.37f})
            for (int k = 1; k < 1000; ++k) {
                const float x = (1 - y) * static_cast<float>(k) / 1000.0f;
                const float step = (1 - y) / 1000.0f;
                const auto a = field.sites().locate(face, {x, y});
                const auto b = field.sites().locate(face, {x + step, y});
                if (a.group == b.group) continue;
                ++borders;
                // By halving, to either side of the border.
                float lo = x, hi = x + step;
                for (int i = 0; i < 12; ++i) {
                    const float mid = 0.5f * (lo + hi);
                    (field.sites().locate(face, {mid, y}).group == a.group ? lo : hi) = mid;
                }
                const DRgb left(field.at(face, {lo, y})), right(field.at(face, {hi, y}));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(left[c] / right[c], 1.0, 2 * kTolerance) << face << " " << x;
            }
    EXPECT_GT(borders, 30);
}

TEST(ExitanceField, BarycentricsOfCornersAndBeyondAreClamped) {
    const LitBody body("marble", makeBox(DVec3(6)), 0.9, fromOneSide);
    const ExitanceField field(body.mesh, body.sum, body.segment(), 0.01);
    for (FaceIndex face = 0; face < 12; ++face)
        for (const Vec2 b :
             {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(0.5f, 0.5f), Vec2(0.3333334f, 0.6666667f),
              Vec2(-1e-7f, 0.4f), Vec2(1.0000001f, 0)}) {
            EXPECT_TRUE(isFinite(field.at(face, b)));
            EXPECT_GE(minComponent(DRgb(field.at(face, b))), 0.0);
        }
}

TEST(ExitanceField, DarkBodyIsDark) {
    const LitBody body("marble", makeSphere(2), 0.9, [](const Vec3&) { return Rgb(0.0f); });
    const ExitanceField field(body.mesh, body.sum, body.segment(), 0.01);
    for (FaceIndex f = 0; f < body.mesh.faceCount(); f += 50)
        EXPECT_EQ(field.at(f, {0.3f, 0.3f}), Rgb(0.0f));
}

// Every place of a face lies in the patch that locate names, at the place it names.
TEST(ExitanceSites, LocateAgreesWithPatches) {
    for (const double segment : {20.0, 1.7, 0.31, 0.05}) {
        const TriangleMesh mesh = makeBox({3, 7, 5});
        const ExitanceSites sites(mesh, segment);
        for (const Place& p : randomPlaces(mesh, 1500, 3)) {
            const auto at = sites.locate(p.face, p.barycentrics);
            ASSERT_LT(at.group, sites.groupCount());
            const auto patches = sites.patches(at.group);
            ASSERT_LT(at.patch, patches.size());
            const auto& patch = patches[at.patch];
            ASSERT_EQ(patch.face, p.face);
            ASSERT_LT(glm::length(patch.at(at.inPatch) - p.barycentrics), 1e-6f);
            ASSERT_GE(std::min(at.inPatch.x, at.inPatch.y), 0.0f);
            ASSERT_LE(at.inPatch.x + at.inPatch.y, 1.0f + 1e-6f);
            ASSERT_LE(patch.segments, ExitanceSites::kMostSegments);
        }
    }
}

TEST(ExitanceSites, SharedEdgesHaveTheSameBits) {
    const TriangleMesh mesh = makeSphere(3);
    const ExitanceSites sites(mesh, 0.4);
    // The same edge from both sides: corner k to corner k + 1, against the other face's order.
    const auto along = [](int edge, float t) {
        return edge == 0 ? Vec2(t, 0) : edge == 1 ? Vec2(1 - t, t) : Vec2(0, 1 - t);
    };
    int shared = 0;
    for (FaceIndex f = 0; f < 40; ++f)
        for (FaceIndex g = 0; g < mesh.faceCount(); ++g)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const UVec3 a = mesh.faces[f], b = mesh.faces[g];
                    if (a[i] != b[(j + 1) % 3] || a[(i + 1) % 3] != b[j]) continue;
                    ++shared;
                    for (const float t : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
                        ASSERT_EQ(sites.position(f, along(i, t)),
                                  sites.position(g, along(j, 1 - t)));
                }
    EXPECT_EQ(shared, 120);
}

}  // namespace
}  // namespace sss
