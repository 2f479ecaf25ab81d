#include "sss/scene/animation.h"

#include "sss/scene/interpolation.h"
#include "unit/scene/scene_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sss {
namespace {

const std::vector<double> kTimes{1, 3, 7, 8};

TEST(Interpolation, LinearIsStraightAndHoldsItsEnds) {
    const std::vector<double> values{2, 6, -2, -2};
    const auto at = [&](double t) { return interpolate(kTimes, values, t, Interpolation::Linear); };
    EXPECT_EQ(at(-100), 2);
    EXPECT_EQ(at(1), 2);
    EXPECT_DOUBLE_EQ(at(2), 4);
    EXPECT_EQ(at(3), 6);
    EXPECT_DOUBLE_EQ(at(4), 4);
    EXPECT_EQ(at(7.5), -2);
    EXPECT_EQ(at(100), -2);
    EXPECT_EQ(interpolate(std::vector{4.0}, std::vector{9.0}, 5, Interpolation::Smooth), 9);
}

// Through the keys, once differentiable, never beyond the two keys around.
TEST(Interpolation, SmoothNeitherBreaksNorOvershoots) {
    const std::vector<double> values{0, 1, 1.5, 9};
    const auto at = [&](double t) { return interpolate(kTimes, values, t, Interpolation::Smooth); };
    for (std::size_t k = 0; k < kTimes.size(); ++k) EXPECT_EQ(at(kTimes[k]), values[k]);
    for (double t = 1; t < 8; t += 0.01) EXPECT_LE(at(t), at(t + 0.01)) << t;
    for (const double key : {3.0, 7.0}) {
        const double h = 1e-6;
        EXPECT_NEAR((at(key) - at(key - h)) / h, (at(key + h) - at(key)) / h, 1e-4);
    }
    // Where the keys turn, the curve is flat; a parabola's worth above neither.
    const std::vector<double> peak{0, 1, 0, 0};
    for (double t = 1; t < 8; t += 0.01) {
        const double v = interpolate(kTimes, peak, t, Interpolation::Smooth);
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 1);
    }
}

// On one axis both kinds of rotation are numbers' own: even speed for even keys.
TEST(Interpolation, RotationsGoTheShorterWay) {
    const DVec3 axis = glm::normalize(DVec3(1, 2, 3));
    const auto turn = [&](double degrees) { return quaternionOf(axis, glm::radians(degrees)); };
    const auto degrees = [&](const Quaternion& q) {
        EXPECT_NEAR(glm::length(glm::cross(q.v, axis)), 0, 1e-12);
        return glm::degrees(2 * std::atan2(glm::dot(q.v, axis), q.w));
    };
    const std::vector<double> times{0, 1, 2};
    const std::vector<Quaternion> even{turn(0), turn(60), turn(120)};
    const std::vector<Quaternion> wide{turn(0), turn(350), turn(340)};
    for (const Interpolation how : {Interpolation::Linear, Interpolation::Smooth}) {
        EXPECT_NEAR(degrees(interpolate(times, even, 0.5, how)), 30, 1e-9);
        EXPECT_NEAR(degrees(interpolate(times, even, 1.25, how)), 75, 1e-9);
        EXPECT_NEAR(degrees(interpolate(times, wide, 0.5, how)), -5, 1e-9);
    }
    // Squad keeps its speed at a key where slerp breaks.
    const std::vector<Quaternion> corner{turn(0), turn(30), quaternionOf({0, 0, 1}, 1.0)};
    const auto speedJump = [&](Interpolation how) {
        const double h = 1e-5;
        const auto v = [&](double t) { return interpolate(times, corner, t, how).v; };
        return glm::length((v(1 + h) - v(1)) - (v(1) - v(1 - h))) / h;
    };
    EXPECT_GT(speedJump(Interpolation::Linear), 0.1);
    EXPECT_LT(speedJump(Interpolation::Smooth), 1e-3);
}

constexpr const char* kCurve =
    R"({"keys": [{"frame": 1, "value": %s}, {"frame": 5, "value": %s}]})";
std::string curve(const char* first, const char* last) {
    std::string text(512, '\0');
    text.resize(
        static_cast<std::size_t>(std::snprintf(text.data(), text.size(), kCurve, first, last)));
    return text;
}

Scene frame(const Parts& parts, int number) {
    return readSceneText(
        fmt::format(
            R"({{"metersPerUnit": {}, "camera": {}, "materials": {{{}}}, "objects": [{}]{}}})",
            parts.units, parts.camera, parts.materials, parts.objects, parts.rest),
        "/scenes/here/test.json", {}, number);
}

TEST(Animation, MovesCameraLightsObjectsAndMaterials) {
    Parts parts;
    parts.camera = R"({"position": )" + curve("[0, 0, 10]", "[0, 4, 30]") + R"(, "transform":
        [{"rotate": {"axis": [0, 1, 0], "degrees": )" +
                   curve("0", "360") + "}}]}";
    parts.materials = R"("milk": {"type": "translucent", "sigmaAPerMm": )" +
                      curve("[0, 1, 2]", "[1, 1, 4]") + R"(, "sigmaSPerMm": 3})";
    parts.objects =
        R"({"mesh": "wave.####.obj", "material": "milk", "transform": [{"rotate": )" +
        curve(R"({"axis": [0, 0, 1], "degrees": 0})", R"({"axis": [0, 0, 1], "degrees": 90})") +
        "}]}";
    parts.rest = R"(, "lights": [{"type": "sphere", "centre": [1, 0, 0], "radius": 1,
        "transform": [{"translate": [0, 1, 0]}], "radiance": )" +
                 curve("1", "3") + "}]";
    const Scene middle = frame(parts, 3);
    EXPECT_EQ(middle.frame, 3);
    EXPECT_NEAR(glm::length(middle.camera.position - DVec3(0, 2, -20)), 0, 1e-12);
    EXPECT_EQ(translucent(middle).medium.sigmaA, DRgb(0.5, 1, 3));
    EXPECT_EQ(std::get<MeshFileShape>(middle.objects[0].shape).path, "/scenes/here/wave.0003.obj");
    const auto& lamp = std::get<SphereLight>(middle.lights[0]);
    EXPECT_EQ(lamp.radiance, Rgb(2));
    EXPECT_EQ(lamp.centre, DVec3(1, 1, 0));
    const DVec3 turned(std::get<DMat4>(middle.objects[0].transform[0]) * glm::dvec4(1, 0, 0, 0));
    EXPECT_NEAR(glm::length(turned - DVec3(1, 1, 0) / std::sqrt(2.0)), 0, 1e-12);
    EXPECT_EQ(frame(parts, 99).camera.position.y, 4);
}

TEST(Animation, KnowsWhatMoves) {
    const auto parsed = [](const std::string& text) { return parseJson(text, "t"); };
    EXPECT_TRUE(isAnimated(parsed(curve("1", "2"))));
    EXPECT_TRUE(isAnimated(parsed(R"([{"mesh": "a.%04d.ply"}])")));
    EXPECT_FALSE(isAnimated(parsed(R"({"mesh": "a.ply", "keys": {"type": "metal"}})")));
    EXPECT_EQ(keyFrames(parsed("[" + curve("1", "2") + "," + curve("3", "4") + "]")),
              std::vector<double>({1, 5}));
}

TEST(Animation, SaysWhereItCannotBeMeant) {
    const auto expectRefused = [](const std::string& intensity, const char* words) {
        Parts parts;
        parts.rest = R"(, "lights": [{"type": "point", "position": [9, 9, 9], "intensity": )" +
                     intensity + "}]";
        const std::string message = complaint(parts);
        EXPECT_NE(message.find("test.json:1:"), std::string::npos) << message;
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    expectRefused(R"({"keys": []})", "array");
    expectRefused(R"({"keys": [{"frame": 1}]})", "lacks \"value\"");
    expectRefused(R"({"keys": [{"frame": 1, "value": 1}, {"frame": 1, "value": 2}]})",
                  "not after the one before");
    expectRefused(R"({"keys": [{"frame": 1, "value": [1, 2]}, {"frame": 2, "value": [1]}]})",
                  "array of 2");
    expectRefused(R"({"keys": [{"frame": 1, "value": "red"}]})", "number");
    expectRefused(R"({"keys": [{"frame": 1, "value": -1}]})", "\"intensity\" is -1");
    expectRefused(R"({"keys": [{"frame": 1, "value": 1}], "interpolation": "cubic"})", "cubic");
    expectRefused(R"({"keys": [{"frame": 1, "value": {"axis": [0, 1, 0]}}]})", "lacks");
    expectRefused(
        R"({"keys": [{"frame": 1, "value": {"axis": [0, 1, 0], "degrees": 9, "radians": 1}}]})",
        "has 3 members; a rotation has \"axis\" and \"degrees\"");
    Parts parts;
    parts.rest = R"(, "film": {"samples": {"keys": [{"frame": 1, "value": 4}]}})";
    EXPECT_NE(complaint(parts).find("samples"), std::string::npos);
    parts.rest = R"(, "lights": [{"type": "point", "position": [9, 9, 9], "intensity": 1,
                      "transform": [{"scale": 2}]}])";
    EXPECT_NE(complaint(parts).find("scales"), std::string::npos);
}

}  // namespace
}  // namespace sss
