#include "sss/world/camera.h"

#include <gtest/gtest.h>

namespace sss {
namespace {

CameraSettings settings() {
    CameraSettings s;
    s.position = {3, 4, 5};
    s.lookAt = {-7, 1, -20};
    s.up = {0.2, 1, 0.1};
    s.fovDegrees = 34;
    return s;
}

DVec3 viewDirection() { return glm::normalize(settings().lookAt - settings().position); }

void expectClose(const DVec3& a, const DVec3& b, double tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

TEST(Camera, TheMiddleLooksAtTheTarget) {
    const Camera camera(settings(), 300, 200, DVec3(0));
    const Ray ray = camera.ray({150, 100}, {0.5f, 0.5f});
    expectClose(DVec3(ray.direction), viewDirection(), 1e-6);
    expectClose(DVec3(ray.origin), settings().position, 1e-6);
    expectClose(DVec3(camera.forward()), viewDirection(), 1e-6);
}

TEST(Camera, TheFieldOfViewIsVertical) {
    const Camera camera(settings(), 300, 200, DVec3(0));
    const auto angle = [&](const Vec2& a, const Vec2& b) {
        const DVec3 u(camera.ray(a, Vec2(0.5f)).direction), v(camera.ray(b, Vec2(0.5f)).direction);
        return std::acos(glm::dot(u, v)) * 180 / kPi;
    };
    EXPECT_NEAR(angle({150, 0}, {150, 200}), 34, 1e-3);
    const double wide = 2 * std::atan(1.5 * std::tan(17 * kPi / 180)) * 180 / kPi;
    EXPECT_NEAR(angle({0, 100}, {300, 100}), wide, 1e-3);
}

TEST(Camera, UpIsUpAndRightIsRight) {
    CameraSettings s;
    s.position = {0, 0, 10};
    const Camera camera(s, 100, 100, DVec3(0));
    EXPECT_GT(camera.ray({50, 10}, Vec2(0.5f)).direction.y, 0.1f);
    EXPECT_GT(camera.ray({90, 50}, Vec2(0.5f)).direction.x, 0.1f);
}

TEST(Camera, UpAlongTheViewIsReplaced) {
    CameraSettings s;
    s.position = {0, 10, 0};
    const Camera camera(s, 100, 100, DVec3(0));
    const Ray ray = camera.ray({20, 30}, Vec2(0.5f));
    EXPECT_TRUE(isFinite(ray.direction));
    EXPECT_NEAR(glm::length(ray.direction), 1, 1e-6);
}

// All rays of a pixel meet on the plane in focus, and start on a disk of the lens's radius.
TEST(Camera, TheLensIsSharpAtItsFocus) {
    CameraSettings s = settings();
    s.apertureRadiusMm = 0.8;
    s.focusDistanceMm = 12;
    const Camera lens(s, 300, 200, DVec3(0));
    s.apertureRadiusMm = 0;
    const Camera pinhole(s, 300, 200, DVec3(0));
    const DVec3 forward = viewDirection();
    const Vec2 pixel(40, 170);
    const auto inFocus = [&](const Ray& ray) {
        const DVec3 o(ray.origin), d(ray.direction);
        const double t = (12 - glm::dot(o - s.position, forward)) / glm::dot(d, forward);
        return o + d * t;
    };
    const DVec3 expected = inFocus(pinhole.ray(pixel, Vec2(0.5f)));
    double widest = 0;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j) {
            const Vec2 u(static_cast<float>(i) / 8.0f, static_cast<float>(j) / 8.0f);
            const Ray ray = lens.ray(pixel, u);
            expectClose(inFocus(ray), expected, 2e-5);
            const DVec3 offset = DVec3(ray.origin) - s.position;
            EXPECT_NEAR(glm::dot(offset, forward), 0, 1e-5);
            EXPECT_LE(glm::length(offset), 0.8 + 1e-5);
            widest = std::max(widest, glm::length(offset));
        }
    EXPECT_NEAR(widest, 0.8, 1e-5);
}

TEST(Camera, FocusIsTheTargetByDefault) {
    CameraSettings s = settings();
    s.apertureRadiusMm = 1;
    const Camera camera(s, 300, 200, DVec3(0));
    const Ray ray = camera.ray({150, 100}, {0.9f, 0.2f});
    const double distance = glm::length(s.lookAt - s.position);
    EXPECT_LT(glm::length(glm::cross(s.lookAt - DVec3(ray.origin), DVec3(ray.direction))),
              1e-5 * distance);
}

DVec3 projected(const std::array<double, 16>& m, const DVec3& p) {
    double out[4];
    for (std::size_t c = 0; c < 4; ++c)
        out[c] = p.x * m[c] + p.y * m[4 + c] + p.z * m[8 + c] + m[12 + c];
    return DVec3(out[0], out[1], out[2]) / out[3];
}

// A point on the ray through a pixel is mapped to that pixel, wherever the world was recentred to.
TEST(Camera, WorldToNdcFindsThePixel) {
    const DVec3 origin(100, -50, 25);
    const Camera camera(settings(), 300, 200, origin);
    for (const Vec2& pixel : {Vec2(150, 100), Vec2(10, 20), Vec2(290, 190), Vec2(0, 200)}) {
        const Ray ray = camera.ray(pixel, Vec2(0.5f));
        const DVec3 p = DVec3(ray.at(17)) + origin;
        const DVec3 ndc = projected(camera.worldToNdc(), p);
        EXPECT_NEAR((ndc.x + 1) / 2 * 300, pixel.x, 2e-3);
        EXPECT_NEAR((1 - ndc.y) / 2 * 200, pixel.y, 2e-3);
    }
}

TEST(Camera, WorldToCameraLooksAlongMinusZ) {
    const Camera camera(settings(), 300, 200, DVec3(5));
    const auto m = camera.worldToCamera();
    const DVec3 target = projected(m, settings().lookAt);
    expectClose(target, {0, 0, -glm::length(settings().lookAt - settings().position)}, 1e-5);
    expectClose(projected(m, settings().position), DVec3(0), 1e-12);
}

// A ray that meets the box goes through the window, and the window's sides touch the box.
TEST(Camera, TheWindowOfABoxHoldsItsRays) {
    const Camera camera(settings(), 300, 200, DVec3(0));
    Bounds box;
    box.add(Vec3(-5, -1, -14));
    box.add(Vec3(-2, 3, -9));
    const Camera::Window window = camera.windowOf(box);
    Vec2 lo(1e9f), hi(-1e9f);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 300; ++x) {
            const Vec2 pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const Ray ray = camera.ray(pixel, Vec2(0.5f));
            const Vec3 a = (box.lo - ray.origin) / ray.direction;
            const Vec3 b = (box.hi - ray.origin) / ray.direction;
            const Vec3 in = glm::min(a, b), out = glm::max(a, b);
            if (maxComponent(in) > std::min(out.x, std::min(out.y, out.z))) continue;
            lo = glm::min(lo, pixel);
            hi = glm::max(hi, pixel);
        }
    for (int c = 0; c < 2; ++c) {
        EXPECT_LE(window.lo[c], lo[c]);
        EXPECT_GE(window.hi[c], hi[c]);
        EXPECT_NEAR(window.lo[c], lo[c], 2.0f);
        EXPECT_NEAR(window.hi[c], hi[c], 2.0f);
    }
}

TEST(Camera, TheWindowIsEverythingWhereItCannotBeSaid) {
    Bounds around;
    around.add(Vec3(0));
    around.add(Vec3(10));
    EXPECT_LT(Camera(settings(), 300, 200, DVec3(0)).windowOf(around).lo.x, -1e30f);
    CameraSettings withLens = settings();
    withLens.apertureRadiusMm = 1;
    Bounds ahead;
    ahead.add(Vec3(-7, 1, -20));
    EXPECT_GT(Camera(withLens, 300, 200, DVec3(0)).windowOf(ahead).hi.y, 1e30f);
    EXPECT_LT(Camera(settings(), 300, 200, DVec3(0)).windowOf(ahead).hi.y, 102);
    EXPECT_GT(Camera(settings(), 300, 200, DVec3(0)).windowOf({}).lo.x, 1e30f);
}

// Two rays a pixel apart, where they are nearest to the camera in a box.
TEST(Camera, NoPixelIsNarrowerThanItSays) {
    const Camera camera(settings(), 300, 200, DVec3(0));
    const Vec3 middle = Vec3(settings().position + 40.0 * viewDirection());
    const Bounds box{middle - Vec3(30, 20, 10), middle + Vec3(5, 6, 7)};
    const double width = camera.pixelWidthMm(box);
    const double depth = [&] {
        double nearest = 1e9;
        for (const float x : {box.lo.x, box.hi.x})
            for (const float y : {box.lo.y, box.hi.y})
                for (const float z : {box.lo.z, box.hi.z})
                    nearest = std::min(
                        nearest, glm::dot(DVec3(x, y, z) - settings().position, viewDirection()));
        return nearest;
    }();
    double narrowest = 1e9;
    for (const Vec2 pixel : {Vec2(0, 0), Vec2(150, 100), Vec2(299, 0), Vec2(299, 199)})
        for (const Vec2 step : {Vec2(1, 0), Vec2(0, 1)}) {
            const DVec3 u(camera.ray(pixel, Vec2(0.5f)).direction),
                v(camera.ray(pixel + step, Vec2(0.5f)).direction);
            const double distance = depth / glm::dot(u, viewDirection());
            // Across the ray, whichever way the pixel is cut: its shorter side at a corner lies
            // between the two.
            narrowest = std::min(narrowest, distance * glm::length(glm::cross(u, v)));
        }
    EXPECT_GT(narrowest, 0.999 * width);
    EXPECT_LT(narrowest, 1.2 * width);
    EXPECT_EQ(camera.pixelWidthMm({middle - Vec3(60), middle + Vec3(60)}), 0);
    EXPECT_EQ(camera.pixelWidthMm(Bounds{}), 0);
}

}  // namespace
}  // namespace sss
