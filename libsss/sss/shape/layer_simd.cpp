// The vector code of the layer sums: all channels of a source in one vector. Compiled once for
// every instruction set that Highway knows, chosen when it first runs.
#include "sss/shape/layer_sum.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sss/shape/layer_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sss::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
void layersAny(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
               const Rgb& perLength, const Vec3& receiver, DRgb& sum) {
    accumulateLayersScalar(tree, green, list, perLength, receiver, sum);
}
#else

namespace hn = hwy::HWY_NAMESPACE;

HWY_ATTR void layersAny(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                        const Rgb& perLength, const Vec3& receiver, DRgb& sum) {
    const hn::FixedTag<float, 4> d;
    const auto two = hn::Set(d, 2.0f), three = hn::Set(d, 3.0f), six = hn::Set(d, 6.0f);
    auto total = hn::Zero(d);
    const std::span<const NodeShape> shapes = tree.shapes();
    const std::span<const ChargeNode> charges = tree.charges();
    for (const std::uint32_t n : list.nodes) {
        const Vec3 v = shapes[n].centre - receiver;
        const ChargeNode& node = charges[n];
        const KernelTable::Place place = green.placeOf(glm::dot(v, v));
        const auto& row = place.row->c;
        const auto c1 = hn::Load(d, row[1]), c2 = hn::Load(d, row[2]), c3 = hn::Load(d, row[3]);
        const auto t = hn::Set(d, place.t), s = hn::Set(d, 2.0f * place.scale);
        const auto x = hn::Set(d, v.x), y = hn::Set(d, v.y), z = hn::Set(d, v.z);
        const auto xx = hn::Load(d, node.quadrupole[0]), yy = hn::Load(d, node.quadrupole[1]),
                   zz = hn::Load(d, node.quadrupole[2]), xy = hn::Load(d, node.quadrupole[3]),
                   xz = hn::Load(d, node.quadrupole[4]), yz = hn::Load(d, node.quadrupole[5]);
        const auto f = hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, t, c2), t, c1), t, hn::Load(d, row[0]));
        const auto first = hn::MulAdd(hn::MulAdd(hn::Mul(three, c3), t, hn::Mul(two, c2)), t, c1);
        const auto second = hn::MulAdd(hn::Mul(six, c3), t, hn::Mul(two, c2));
        auto slope = hn::Add(xx, hn::Add(yy, zz));
        slope = hn::MulAdd(hn::Load(d, node.dipole[0]), x, slope);
        slope = hn::MulAdd(hn::Load(d, node.dipole[1]), y, slope);
        slope = hn::MulAdd(hn::Load(d, node.dipole[2]), z, slope);
        // Row by row: d^T T d = x (xx x + 2 xy y + 2 xz z) + y (yy y + 2 yz z) + zz z z.
        const auto inX = hn::MulAdd(xx, x, hn::Mul(two, hn::MulAdd(xy, y, hn::Mul(xz, z))));
        const auto inY = hn::MulAdd(yy, y, hn::Mul(two, hn::Mul(yz, z)));
        const auto bend = hn::MulAdd(inX, x, hn::MulAdd(inY, y, hn::Mul(zz, hn::Mul(z, z))));
        total = hn::MulAdd(hn::Load(d, node.charge), f, total);
        total = hn::MulAdd(slope, hn::Mul(s, first), total);
        total = hn::MulAdd(hn::Mul(s, bend), hn::Mul(s, second), total);
    }
    alignas(16) const float perB[4] = {perLength.x, perLength.y, perLength.z, 0.0f};
    const auto b = hn::Load(d, perB);
    const std::span<const SurfacePoint> points = tree.cloud().points;
    for (const std::uint32_t i : list.points) {
        const Vec3 v = points[i].position - receiver;
        const KernelTable::Place place = green.placeOf(glm::dot(v, v));
        const auto& row = place.row->c;
        const auto c1 = hn::Load(d, row[1]), c2 = hn::Load(d, row[2]), c3 = hn::Load(d, row[3]);
        const auto t = hn::Set(d, place.t);
        const auto f = hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, t, c2), t, c1), t, hn::Load(d, row[0]));
        const auto first = hn::MulAdd(hn::MulAdd(hn::Mul(three, c3), t, hn::Mul(two, c2)), t, c1);
        const float across = 2.0f * place.scale * glm::dot(tree.normal(i), v);
        const Rgb& flux = tree.areaFluence(i);
        alignas(16) const float lanes[4] = {flux.x, flux.y, flux.z, 0.0f};
        total = hn::MulAdd(hn::Load(d, lanes), hn::MulAdd(f, b, hn::Mul(hn::Set(d, across), first)),
                           total);
    }
    alignas(16) float lanes[4];
    hn::Store(total, d, lanes);
    sum += DRgb(lanes[0], lanes[1], lanes[2]);
}
#endif

}  // namespace
}  // namespace sss::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sss {

HWY_EXPORT(layersAny);

void accumulateLayers(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                      const Rgb& perLength, const Vec3& receiver, DRgb& sum) {
    HWY_DYNAMIC_DISPATCH(layersAny)(tree, green, list, perLength, receiver, sum);
}

}  // namespace sss
#endif
