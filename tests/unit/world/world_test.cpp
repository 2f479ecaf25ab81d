#include "sss/world/world.h"

#include "sss/base/error.h"
#include "sss/geom/shapes.h"
#include "support/temporary_folder.h"
#include "unit/integrate/scene_maker.h"

#include <fmt/ostream.h>
#include <gtest/gtest.h>

#include <fstream>

namespace sss {
namespace {

using testing::grey;
using testing::measured;
using testing::moved;
using testing::SceneMaker;
using testing::turned;

Body bodyOf(const Shape& shape, const DMat4& placed) {
    SceneMaker maker;
    maker.object(shape, maker.material(measured("Marble")), placed);
    return maker.world().bodies().at(0);
}

// No world comes of the scene: bad input, at that place of its file, in these words among others.
void expectRefused(const SceneMaker& maker, const std::string& where, const std::string& words) {
    try {
        maker.world();
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        EXPECT_EQ(error.where(), where);
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}

// What is warned of, all in one.
struct Listener final : Reporter {
    void info(std::string_view, std::string_view) override {}
    void warn(std::string_view, std::string_view sentence) override { all += sentence; }
    void progress(std::string_view, double, double, bool) override {}
    std::string all;
};

// Volume by the divergence theorem: positive if the faces are wound outward.
double volume(const TriangleMesh& mesh) {
    double six = 0;
    for (const UVec3& f : mesh.faces)
        six += glm::dot(mesh.positions[f.x], glm::cross(mesh.positions[f.y], mesh.positions[f.z]));
    return six / 6;
}

void expectSmoothNormalsAgree(const Body& body) {
    for (FaceIndex f = 0; f < body.mesh.faceCount(); ++f)
        ASSERT_GT(glm::dot(DVec3(body.normalAt(f, {1 / 3.0f, 1 / 3.0f})),
                           glm::normalize(body.mesh.faceCross(f))),
                  0.8);
}

TEST(Bodies, ObjectsOfAGroupAreOneBody) {
    SceneMaker maker;
    const int stone = maker.material(measured("Marble"));
    maker.object(BoxShape{DVec3(2)}, stone).group = "pair";
    maker.object(SphereShape{3}, stone, moved({20, 0, 0}));
    maker.object(BoxShape{DVec3(4)}, stone, moved({10, 0, 0})).group = "pair";
    const World world = maker.world();
    ASSERT_EQ(world.bodies().size(), 2u);
    const Body& pair = world.bodies()[0];
    EXPECT_EQ(pair.name, "pair");
    EXPECT_EQ(pair.objects, (std::vector<int>{0, 2}));
    EXPECT_EQ(pair.firstFace, (std::vector<FaceIndex>{0, 12}));
    EXPECT_NEAR(volume(pair.mesh), 8 + 64, 1e-9);
    EXPECT_NEAR(pair.mesh.area(), 24 + 96, 1e-9);
    EXPECT_NEAR(pair.mesh.bounds().size().x, 13, 1e-9);
    EXPECT_TRUE(pair.closed);
    EXPECT_EQ(world.bodies()[1].name, "o1");
}

// A ball with a hollow that holds a ball, as three objects: walls inward, the rest outward, in the
// body's mesh and for rays, whichever way the objects are mirrored.
TEST(Bodies, ShellsOfAGroupAreNested) {
    for (const double mirror : {1.0, -1.0}) {
        SceneMaker maker;
        const int stone = maker.material(measured("Marble"));
        const DMat4 placed = moved({4, 0, 1}) * glm::scale(DMat4(1.0), DVec3(1, mirror, 1));
        maker.object(SphereShape{2}, stone, placed).group = "hollow";
        maker.object(SphereShape{5}, stone, placed).group = "hollow";
        maker.object(SphereShape{1}, stone, placed).group = "hollow";
        maker.object(SphereShape{2}, stone, moved({20, 0, 0})).group = "hollow";
        const World world = maker.world();
        const Body& body = world.bodies().at(0);
        ASSERT_TRUE(body.closed);
        EXPECT_NEAR(volume(body.mesh) / (4 * kPi / 3 * (125 - 8 + 1 + 8)), 1, 0.01);
        for (const FaceIndex f : body.firstFace) {
            const SurfaceHit hit = world.surfaceOf(0, f, {0.3f, 0.3f});
            const DVec3 out =
                body.worldFromBody.transformDirection(glm::normalize(body.mesh.faceCross(f)));
            EXPECT_GT(glm::dot(DVec3(hit.geometricNormal), out), 0.99);
            EXPECT_GT(glm::dot(DVec3(hit.shadingNormal), out), 0.9);
        }
        // From the middle of the wall towards the hollow the surface is seen from inside.
        const Vec3 wall(DVec3(7.5, 0, 1) - world.originMm());
        Hit hit;
        ASSERT_TRUE(world.rays().intersect(Ray{wall, Vec3(-1, 0, 0)}, hit));
        EXPECT_LT(world.surfaceAt(hit).geometricNormal.x, -0.9f);
    }
}

// A mesh wound inward is right as the wall of a hollow; anywhere else it is told of and turned.
TEST(Bodies, OnlyInwardMeshesThatAreNoWallsAreToldOf) {
    const testing::TemporaryFolder folder;
    const TriangleMesh box = makeBox(DVec3(2));
    {
        std::ofstream file(folder / "inward.obj");
        for (const DVec3& p : box.positions) fmt::print(file, "v {} {} {}\n", p.x, p.y, p.z);
        for (const UVec3& f : box.faces)
            fmt::print(file, "f {} {} {}\n", f.x + 1, f.z + 1, f.y + 1);
    }
    for (const double at : {0.0, 20.0}) {
        SceneMaker maker;
        const int stone = maker.material(measured("Marble"));
        maker.object(SphereShape{5}, stone).group = "g";
        maker.object(MeshFileShape{folder / "inward.obj"}, stone, moved({at, 0, 0})).group = "g";
        Listener listener;
        const World world(maker.scene, listener);
        EXPECT_EQ(listener.all.find("wound the wrong way") != std::string::npos, at > 0)
            << listener.all;
        const double expected = volume(makeSphere(5)) + (at > 0 ? 8 : -8);
        EXPECT_NEAR(volume(world.bodies().at(0).mesh), expected, 1e-6);
    }
}

TEST(Bodies, MaterialsOfAGroupMustAgree) {
    SceneMaker maker;
    const int stone = maker.material(measured("Marble")),
              milk = maker.material(measured("Skimmilk"));
    maker.object(BoxShape{DVec3(2)}, stone).group = "pair";
    maker.object(BoxShape{DVec3(2)}, milk, moved({9, 0, 0})).group = "pair";
    expectRefused(maker, "test.json:2:7", "\"pair\"");
}

TEST(Bodies, AFlatPartAmongSmoothOnesStaysFlat) {
    SceneMaker maker;
    const int stone = maker.material(measured("Marble"));
    maker.object(SphereShape{2}, stone).group = "pair";
    ObjectSettings& box = maker.object(BoxShape{DVec3(4)}, stone, moved({10, 0, 0}));
    box.group = "pair";
    box.normals = NormalsMode::Flat;
    const World world = maker.world();
    const Body& body = world.bodies().at(0);
    for (FaceIndex f = body.firstFace[1]; f < body.mesh.faceCount(); ++f) {
        const DVec3 n = glm::normalize(body.mesh.faceCross(f));
        ASSERT_LT(glm::length(DVec3(body.normalAt(f, {0.1f, 0.7f})) - n), 1e-6);
    }
}

TEST(Bodies, TheirSpaceDoesNotKnowWhereTheyStand) {
    const Shape shape = CylinderShape{3, 8};
    const DMat4 stretch = glm::scale(DMat4(1.0), DVec3(1.7, 0.3, 1.1));
    const Body still = bodyOf(shape, stretch);
    for (const DMat4& place :
         {moved({1000.25, -3, 7.1}), turned(33, {1, 2, 3}),
          moved({-12, 0.1, 1e5}) * turned(171, {0.3, 1, -2}) * turned(5, {0, 0, 1})}) {
        const Body body = bodyOf(shape, place * stretch);
        ASSERT_EQ(body.mesh.faces, still.mesh.faces);
        ASSERT_EQ(body.mesh.positions, still.mesh.positions);
        ASSERT_EQ(body.mesh.normals, still.mesh.normals);
    }
}

TEST(Bodies, AreWhereTheirObjectsAre) {
    const DMat4 place = moved({5, -20, 3}) * turned(40, {1, 1, 0}) *
                        glm::scale(DMat4(1.0), DVec3(2, 0.5, 1)) * turned(10, {0, 0, 1});
    SceneMaker maker;
    maker.object(BoxShape{DVec3(2, 4, 6)}, maker.material(measured("Marble")), place);
    const World world = maker.world();
    const Body& body = world.bodies().at(0);
    EXPECT_NEAR(volume(body.mesh), 48, 1e-8);
    for (FaceIndex f = 0; f < body.mesh.faceCount(); ++f) {
        const SurfaceHit hit = world.surfaceOf(0, f, {0.2f, 0.3f});
        const UVec3 v = body.mesh.faces[f];
        const DVec3 inBody = body.mesh.positions[v.x] * 0.5 + body.mesh.positions[v.y] * 0.2 +
                             body.mesh.positions[v.z] * 0.3;
        EXPECT_LT(glm::length(body.worldFromBody.transformPoint(inBody) - DVec3(hit.position)),
                  1e-5);
        // Back in the object's own space it lies on the box.
        const DVec3 own =
            DVec3(glm::inverse(place) * glm::dvec4(DVec3(hit.position) + world.originMm(), 1.0));
        const DVec3 share = glm::abs(own) / DVec3(1, 2, 3);
        EXPECT_NEAR(maxComponent(share), 1, 1e-5);
        // ... and the normal points away from its middle.
        const DVec3 out = DVec3(hit.position) - body.worldFromBody.transformPoint(DVec3(0));
        EXPECT_GT(glm::dot(DVec3(hit.geometricNormal), out), 0);
        EXPECT_GT(glm::dot(DVec3(hit.shadingNormal), out), 0);
    }
}

TEST(Bodies, MirrorsKeepNormalsOutward) {
    for (const DVec3& mirror : {DVec3(-1, 1, 1), DVec3(1, 1, -2), DVec3(-1, -1, -1)}) {
        const Body body =
            bodyOf(SphereShape{3}, turned(25, {1, 0, 2}) * glm::scale(DMat4(1.0), mirror));
        EXPECT_GT(volume(body.mesh), 0);
        EXPECT_TRUE(body.closed);
        expectSmoothNormalsAgree(body);
    }
}

TEST(Objects, FitSetsHeightAndCentre) {
    SceneMaker maker;
    ObjectSettings& object =
        maker.object(BoxShape{DVec3(1, 2, 4)}, maker.material(measured("Marble")));
    object.transform = {turned(90, {1, 0, 0}), FitStep{50, {10, 20, 30}}};
    const World world = maker.world();
    EXPECT_NEAR(world.bounds().size().y, 50, 1e-4);  // the 4 stands up
    EXPECT_NEAR(world.bounds().size().x, 12.5, 1e-4);
    const DVec3 centre = DVec3(world.bounds().centre()) + world.originMm();
    EXPECT_LT(glm::length(centre - DVec3(10, 20, 30)), 1e-4);
}

TEST(Objects, FlatOnesCannotBeFitted) {
    SceneMaker maker;
    ObjectSettings& object = maker.object(RectangleShape{4, 2}, maker.material(measured("Marble")));
    object.transform = {turned(90, {1, 0, 0}), FitStep{50, DVec3(0)}};
    object.line = 7;
    object.column = 3;
    expectRefused(maker, "test.json:7:3", "flat in y");
}

// Two squeezes that the scene reader lets through one by one leave nothing of the object.
TEST(Objects, TransformsThatAreSingularTogetherAreRefusedWhereTheyStand) {
    SceneMaker maker;
    ObjectSettings& object = maker.object(BoxShape{DVec3(2)}, maker.material(measured("Marble")));
    const DMat4 squeeze = glm::scale(DMat4(1), DVec3(1, 1e-8, 1));
    object.transform = {squeeze};
    EXPECT_NO_THROW(maker.world());
    object.transform = {squeeze, squeeze};
    object.line = 7;
    object.column = 3;
    expectRefused(maker, "test.json:7:3", "singular");
}

TEST(Objects, MeshFilesAreInSceneUnits) {
    const testing::TemporaryFolder folder;
    testing::writeFile(
        folder / "t.obj",
        "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    SceneMaker maker;
    maker.scene.metersPerUnit = 0.01;
    maker.object(MeshFileShape{folder / "t.obj"}, maker.material(measured("Marble")));
    EXPECT_NEAR(volume(maker.world().bodies().at(0).mesh), 1e6 / 6, 1e-4);
}

TEST(Objects, WithoutAnyAreaAreRefusedByFile) {
    const testing::TemporaryFolder folder;
    testing::writeFile(folder / "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    SceneMaker maker;
    maker.object(MeshFileShape{folder / "flat.obj"}, maker.material(measured("Marble")));
    try {
        maker.world();
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_NE(error.where().find("flat.obj"), std::string::npos) << error.what();
    }
}

// What rays see of a scene far away is what they see of it at home.
TEST(World, IsRecentred) {
    const auto make = [](const DVec3& away) {
        SceneMaker maker;
        maker.object(SphereShape{5}, maker.material(measured("Marble")), moved(away));
        maker.object(RectangleShape{50, 50}, maker.material(LambertianMaterial{}),
                     moved(away + DVec3(0, 0, -9)));
        maker.scene.camera.fovDegrees = 15;
        maker.scene.camera.position += away;
        maker.scene.camera.lookAt += away;
        return maker.world();
    };
    const World home = make(DVec3(0)), far = make({1e6, -2e6, 5e5});
    EXPECT_LT(glm::length(far.originMm() - home.originMm() - DVec3(1e6, -2e6, 5e5)), 1e-8);
    for (int i = 0; i < 16; ++i) {
        const Vec2 pixel(static_cast<float>(i), static_cast<float>(i * 7 % 16) + 0.3f);
        Hit a, b;
        ASSERT_TRUE(home.rays().intersect(home.camera().ray(pixel, Vec2(0.5f)), a));
        ASSERT_TRUE(far.rays().intersect(far.camera().ray(pixel, Vec2(0.5f)), b));
        const SurfaceHit p = home.surfaceAt(a), q = far.surfaceAt(b);
        EXPECT_EQ(p.object, q.object);
        EXPECT_LT(glm::length(p.position - q.position), 1e-4f);
        EXPECT_LT(glm::length(p.shadingNormal - q.shadingNormal), 1e-4f);
    }
}

TEST(World, KnowsWhatARayHits) {
    SceneMaker maker;
    const int stone = maker.material(measured("Marble"));
    maker.object(RectangleShape{100, 100}, maker.material(LambertianMaterial{}), moved({0, 0, -8}));
    maker.object(SphereShape{2}, stone);
    const World world = maker.world();
    Ray ray;
    ray.origin = {0.5f, 0.3f, 20};
    ray.direction = {0, 0, -1};
    Hit found;
    ASSERT_TRUE(world.rays().intersect(ray, found));
    const SurfaceHit ball = world.surfaceAt(found);
    EXPECT_EQ(ball.object, 1);
    EXPECT_EQ(ball.body, 0);
    EXPECT_EQ(ball.material, stone);
    EXPECT_NEAR(glm::length(ball.position), 2, 1e-3);
    EXPECT_LT(glm::length(ball.shadingNormal - ball.position / 2.0f), 1e-3f);
    const SurfaceHit again = world.surfaceOf(0, ball.bodyFace, ball.barycentrics);
    EXPECT_EQ(again.position, ball.position);
    EXPECT_EQ(again.object, 1);
    // Leaving, on either side.
    EXPECT_GT(glm::length(world.leave(ball, ball.geometricNormal)), glm::length(ball.position));
    EXPECT_LT(glm::length(world.leave(ball, -ball.geometricNormal)), glm::length(ball.position));
    // The mask of the body sees it, that of opaque things the wall behind.
    Hit wall;
    ASSERT_TRUE(world.rays().intersect(ray, wall, 1u));
    EXPECT_EQ(world.surfaceAt(wall).object, 0);
    EXPECT_EQ(world.surfaceAt(wall).body, -1);
    ASSERT_TRUE(world.rays().intersect(ray, wall, bodyMask(0)));
    EXPECT_EQ(wall.geometry, 1u);
}

TEST(World, ParticipatesEmittersAsLights) {
    SceneMaker maker;
    maker.object(SphereShape{1}, maker.material(measured("Marble")));
    maker.light(PointLight{});
    maker.object(RectangleShape{4, 5}, maker.material(EmitterMaterial{Rgb(3), false}),
                 moved({0, 0, 9}) * glm::scale(DMat4(1.0), DVec3(2, 1, 1)));
    const World world = maker.world();
    ASSERT_EQ(world.lights().size(), 2u);
    EXPECT_EQ(world.emitter(0), nullptr);
    ASSERT_NE(world.emitter(1), nullptr);
    EXPECT_EQ(world.emitterIndex(1), 1u);
    EXPECT_EQ(world.emitter(1), world.lights()[1].get());
    EXPECT_NEAR(world.emitter(1)->areaMm2(), 40, 1e-4);
}

// An open surface is reported, a closed one is not.
TEST(World, ReportsWhatIsWrong) {
    for (const bool open : {false, true}) {
        SceneMaker maker;
        const int stone = maker.material(measured("Marble"));
        if (open)
            maker.object(RectangleShape{20, 20}, stone);
        else
            maker.object(BoxShape{DVec3(20)}, stone);
        Listener listener;
        const World world(maker.scene, listener);
        EXPECT_EQ(world.bodies()[0].closed, !open);
        EXPECT_EQ(listener.all.find("not closed") != std::string::npos, open) << listener.all;
    }
}

}  // namespace
}  // namespace sss
