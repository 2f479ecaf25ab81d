// Light sampling of rectangles, a point a lane. Compiled once for every instruction set that
// Highway knows, chosen when it first runs.
#include "sss/light/rectangle_simd.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sss/light/rectangle_simd.cpp"
// In this order:
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

#ifndef SSS_LIGHT_RECTANGLE_BATCH
#define SSS_LIGHT_RECTANGLE_BATCH
namespace sss {

/// Points and what is sampled from each, as arrays.
struct alignas(64) RectangleBatch {
    static constexpr std::size_t kSize = 16;  // what the widest vectors hold
    float fromX[kSize], fromY[kSize], fromZ[kSize], u[kSize], v[kSize];
    float directionX[kSize], directionY[kSize], directionZ[kSize], distance[kSize], pdf[kSize];
};

}  // namespace sss
#endif

HWY_BEFORE_NAMESPACE();
namespace sss::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using RectangleTag = hn::CappedTag<float, RectangleBatch::kSize>;
using RectangleLanes = hn::Vec<RectangleTag>;

// Where float is good enough: rectangles that fill this much (sr) at least, and that reach no
// further sideways than this many times the distance from their plane.
constexpr float kLeastSolidAngle = 0.25f, kFurthest = 4.0f;

// As in SphericalRectangle: complex numbers whose arguments are angles.
struct RectangleTurn {
    RectangleLanes re, im;
};
HWY_ATTR inline RectangleTurn turnBetween(const RectangleTurn& a, const RectangleTurn& b) {
    return {hn::MulAdd(a.re, b.re, hn::Mul(a.im, b.im)),
            hn::MulSub(a.im, b.re, hn::Mul(a.re, b.im))};
}

HWY_ATTR inline RectangleLanes dot(const Vec3& a, RectangleLanes x, RectangleLanes y,
                                   RectangleLanes z) {
    const RectangleTag d;
    return hn::MulAdd(hn::Set(d, a.x), x,
                      hn::MulAdd(hn::Set(d, a.y), y, hn::Mul(hn::Set(d, a.z), z)));
}

// The steps of SphericalRectangle's constructor and sample(), in units of the distance from the
// rectangle's plane.
HWY_ATTR void sampleLanes(const RectangleFrame& frame, RectangleBatch& batch, std::size_t at) {
    const RectangleTag d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const auto offsetX = hn::Sub(hn::Set(d, frame.centre.x), hn::Load(d, batch.fromX + at));
    const auto offsetY = hn::Sub(hn::Set(d, frame.centre.y), hn::Load(d, batch.fromY + at));
    const auto offsetZ = hn::Sub(hn::Set(d, frame.centre.z), hn::Load(d, batch.fromZ + at));
    const auto height = hn::Neg(dot(frame.normal, offsetX, offsetY, offsetZ));
    const auto unit = hn::Div(one, height);
    const auto cx = hn::Mul(dot(frame.across, offsetX, offsetY, offsetZ), unit);
    const auto cy = hn::Mul(dot(frame.up, offsetX, offsetY, offsetZ), unit);
    const auto halfWidth = hn::Mul(hn::Set(d, frame.halfWidth), unit);
    const auto halfHeight = hn::Mul(hn::Set(d, frame.halfHeight), unit);
    const auto x0 = hn::Sub(cx, halfWidth), x1 = hn::Add(cx, halfWidth);
    const auto y0 = hn::Sub(cy, halfHeight), y1 = hn::Add(cy, halfHeight);

    const auto xx0 = hn::MulAdd(x0, x0, one), xx1 = hn::MulAdd(x1, x1, one);
    const auto yy0 = hn::Mul(y0, y0), yy1 = hn::Mul(y1, y1);
    const RectangleTurn a00{hn::Sqrt(hn::Add(xx0, yy0)), hn::Mul(x0, y0)},
        a01{hn::Sqrt(hn::Add(xx0, yy1)), hn::Mul(x0, y1)},
        a10{hn::Sqrt(hn::Add(xx1, yy0)), hn::Mul(x1, y0)},
        a11{hn::Sqrt(hn::Add(xx1, yy1)), hn::Mul(x1, y1)};
    const RectangleTurn whole = turnBetween(turnBetween(a11, a01), turnBetween(a10, a00));
    // Of less than half a turn; the smaller of its arms over the larger keeps the digits.
    const auto isFlat = hn::Gt(whole.re, whole.im);
    const auto tangent = hn::Div(hn::IfThenElse(isFlat, whole.im, whole.re),
                                 hn::IfThenElse(isFlat, whole.re, whole.im));
    const auto angle = hn::Atan(d, tangent);
    const auto solidAngle = hn::IfThenElse(isFlat, angle, hn::Sub(hn::Set(d, 0.5f * kPiF), angle));

    const auto side0 = hn::Sqrt(hn::Add(yy0, one)), side1 = hn::Sqrt(hn::Add(yy1, one));
    const RectangleTurn corner = turnBetween(a01, a00);
    const auto cornerUnit = hn::Div(one, hn::Mul(xx0, hn::Mul(side0, side1)));
    const auto cosOffset = hn::Mul(corner.re, cornerUnit);
    const auto sinOffset = hn::Mul(corner.im, cornerUnit);
    const auto b0 = hn::Neg(hn::Div(y0, side0)), b1 = hn::Div(y1, side1);

    const auto part = hn::Mul(hn::Load(d, batch.u + at), solidAngle);
    const auto cosPart = hn::Cos(d, part), sinPart = hn::Sin(d, part);
    const auto sinAngle = hn::MulAdd(sinPart, cosOffset, hn::Mul(cosPart, sinOffset));
    const auto cosAngle = hn::MulSub(cosPart, cosOffset, hn::Mul(sinPart, sinOffset));
    const auto f = hn::Div(hn::MulAdd(cosAngle, b0, b1), sinAngle);
    const auto cosine =
        hn::CopySign(hn::Min(one, hn::Div(one, hn::Sqrt(hn::MulAdd(f, f, hn::Mul(b0, b0))))), f);
    const auto sine2 = hn::Max(hn::NegMulAdd(cosine, cosine, one), hn::Set(d, 1e-30f));
    const auto x = hn::Min(hn::Max(hn::Div(cosine, hn::Sqrt(sine2)), x0), x1);

    const auto d2 = hn::MulAdd(x, x, one);
    const auto h0 = hn::Div(y0, hn::Sqrt(hn::Add(d2, yy0)));
    const auto h1 = hn::Div(y1, hn::Sqrt(hn::Add(d2, yy1)));
    const auto hv = hn::MulAdd(hn::Load(d, batch.v + at), hn::Sub(h1, h0), h0);
    const auto free = hn::Sub(one, hn::Mul(hv, hv));
    const auto y = hn::Min(hn::Max(hn::Mul(hv, hn::Sqrt(hn::Div(d2, free))), y0), y1);

    const auto length = hn::Sqrt(hn::MulAdd(y, y, d2));
    const auto scale = hn::Div(one, length);
    const auto along = [&](float across, float up, float normal) HWY_ATTR {
        return hn::Mul(
            hn::MulAdd(hn::Set(d, across), x, hn::MulSub(hn::Set(d, up), y, hn::Set(d, normal))),
            scale);
    };
    hn::Store(along(frame.across.x, frame.up.x, frame.normal.x), d, batch.directionX + at);
    hn::Store(along(frame.across.y, frame.up.y, frame.normal.y), d, batch.directionY + at);
    hn::Store(along(frame.across.z, frame.up.z, frame.normal.z), d, batch.directionZ + at);
    hn::Store(hn::Mul(length, height), d, batch.distance + at);

    const auto furthest = hn::Max(hn::Max(hn::Neg(x0), x1), hn::Max(hn::Neg(y0), y1));
    const auto isGood = hn::And(hn::And(hn::Gt(height, zero), hn::Gt(whole.im, zero)),
                                hn::And(hn::Ge(solidAngle, hn::Set(d, kLeastSolidAngle)),
                                        hn::Le(furthest, hn::Set(d, kFurthest))));
    hn::Store(hn::IfThenElseZero(isGood, hn::Div(one, solidAngle)), d, batch.pdf + at);
}

HWY_ATTR void sampleRectangleAny(const RectangleFrame& frame, RectangleBatch& batch,
                                 std::size_t count) {
    for (std::size_t at = 0; at < count; at += hn::Lanes(RectangleTag()))
        sampleLanes(frame, batch, at);
}

}  // namespace
}  // namespace sss::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sss {

HWY_EXPORT(sampleRectangleAny);

void sampleRectangle(const RectangleFrame& rectangle, std::span<const Vec3> from,
                     std::span<const Vec2> u, std::span<LightSample> samples) {
    RectangleBatch batch;
    for (std::size_t first = 0; first < from.size(); first += RectangleBatch::kSize) {
        const std::size_t count = std::min(RectangleBatch::kSize, from.size() - first);
        for (std::size_t i = 0; i < RectangleBatch::kSize; ++i) {
            const std::size_t k = first + std::min(i, count - 1);
            batch.fromX[i] = from[k].x;
            batch.fromY[i] = from[k].y;
            batch.fromZ[i] = from[k].z;
            batch.u[i] = u[k].x;
            batch.v[i] = u[k].y;
        }
        HWY_DYNAMIC_DISPATCH(sampleRectangleAny)(rectangle, batch, count);
        for (std::size_t i = 0; i < count; ++i) {
            LightSample& sample = samples[first + i];
            sample.direction = {batch.directionX[i], batch.directionY[i], batch.directionZ[i]};
            sample.distance = batch.distance[i];
            sample.pdf = batch.pdf[i];
        }
    }
}

}  // namespace sss
#endif
