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
               std::span<const Vec3> receivers, std::span<DRgb> sums) {
    accumulateLayersScalar(tree, green, list, receivers, sums);
}
void expandAny(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
               LocalExpansion& expansion) {
    expandLayersScalar(tree, green, list, expansion);
}
#else

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::FixedTag<float, 4>;
using Lanes = hn::Vec<Tag>;

// The sums of the receivers, in single precision: a list has some thousand entries.
struct alignas(16) Totals {
    float lanes[kMostLayerReceivers][4] = {};
};

// A row's function of u at a place t: itself, dt/du times its slope once and twice.
struct Radial {
    Lanes f, first, second;
};

HWY_ATTR Radial radialAt(const KernelTable::Place& place) {
    const Tag d;
    const auto& row = place.row->c;
    const auto c2 = hn::Load(d, row[2]), c3 = hn::Load(d, row[3]), c1 = hn::Load(d, row[1]);
    const auto t = hn::Set(d, place.t), two = hn::Set(d, 2.0f);
    const auto twice = hn::Mul(two, c2), tc3 = hn::Mul(hn::Mul(hn::Set(d, 3.0f), c3), t);
    return {hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, t, c2), t, c1), t, hn::Load(d, row[0])),
            hn::MulAdd(hn::Add(twice, tc3), t, c1), hn::MulAdd(two, tc3, twice)};
}

HWY_ATTR void addNode(const ChargeNode& node, const Vec3& centre, const KernelTable& green,
                      std::span<const Vec3> receivers, Totals& totals) {
    const Tag d;
    const auto two = hn::Set(d, 2.0f);
    const auto xx = hn::Load(d, node.quadrupole[0]), yy = hn::Load(d, node.quadrupole[1]),
               zz = hn::Load(d, node.quadrupole[2]);
    const auto xy = hn::Mul(two, hn::Load(d, node.quadrupole[3])),
               xz = hn::Mul(two, hn::Load(d, node.quadrupole[4])),
               yz = hn::Mul(two, hn::Load(d, node.quadrupole[5]));
    const auto trace = hn::Add(xx, hn::Add(yy, zz));
    const auto px = hn::Load(d, node.dipole[0]), py = hn::Load(d, node.dipole[1]),
               pz = hn::Load(d, node.dipole[2]);
    const auto charge = hn::Load(d, node.charge);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const Vec3 v = centre - receivers[r];
        const KernelTable::Place place = green.placeOf(glm::dot(v, v));
        const Radial g = radialAt(place);
        const auto x = hn::Set(d, v.x), y = hn::Set(d, v.y), z = hn::Set(d, v.z);
        const auto s = hn::Set(d, 2.0f * place.scale);
        const auto slope = hn::MulAdd(px, x, hn::MulAdd(py, y, hn::MulAdd(pz, z, trace)));
        // Row by row: d^T T d = x (xx x + 2 xy y + 2 xz z) + y (yy y + 2 yz z) + zz z z.
        const auto inX = hn::MulAdd(xx, x, hn::MulAdd(xy, y, hn::Mul(xz, z)));
        const auto inY = hn::MulAdd(yy, y, hn::Mul(yz, z));
        const auto bend = hn::MulAdd(inX, x, hn::MulAdd(inY, y, hn::Mul(zz, hn::Mul(z, z))));
        const auto rest = hn::MulAdd(slope, g.first, hn::Mul(hn::Mul(s, bend), g.second));
        const auto sum = hn::MulAdd(charge, g.f, hn::Load(d, totals.lanes[r]));
        hn::Store(hn::MulAdd(s, rest, sum), d, totals.lanes[r]);
    }
}

HWY_ATTR void layersAny(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                        std::span<const Vec3> receivers, std::span<DRgb> sums) {
    const Tag d;
    Totals totals;
    for (const std::uint32_t n : list.nodes)
        addNode(tree.charges()[n], tree.shapes()[n].centre, green, receivers, totals);
    for (const std::uint32_t i : list.points) {
        const Vec3& from = tree.cloud().points[i].position;
        const Vec3& normal = tree.normal(i);
        const Rgb &flux = tree.areaFluence(i), &charge = tree.charge(i);
        alignas(16) const float fluxes[4] = {flux.x, flux.y, flux.z, 0.0f};
        alignas(16) const float charges[4] = {charge.x, charge.y, charge.z, 0.0f};
        const auto weight = hn::Load(d, fluxes), own = hn::Load(d, charges);
        for (std::size_t r = 0; r < receivers.size(); ++r) {
            const Vec3 v = from - receivers[r];
            const KernelTable::Place place = green.placeOf(glm::dot(v, v));
            const Radial g = radialAt(place);
            const auto across = hn::Set(d, 2.0f * place.scale * glm::dot(normal, v));
            const auto sum = hn::MulAdd(own, g.f, hn::Load(d, totals.lanes[r]));
            hn::Store(hn::MulAdd(hn::Mul(weight, across), g.first, sum), d, totals.lanes[r]);
        }
    }
    for (std::size_t r = 0; r < receivers.size(); ++r)
        sums[r] += DRgb(totals.lanes[r][0], totals.lanes[r][1], totals.lanes[r][2]);
}

// An expansion in single precision, as Totals.
struct Expansion {
    Lanes value, trace, gradient[3], hessian[6];
};

HWY_ATTR void expandNode(const ChargeNode& node, const Vec3& v, const KernelTable& green,
                         Expansion& to) {
    const Tag d;
    const KernelTable::Place place = green.placeOf(glm::dot(v, v));
    const Radial g = radialAt(place);
    const auto s = hn::Set(d, 2.0f * place.scale);
    const auto x = hn::Set(d, v.x), y = hn::Set(d, v.y), z = hn::Set(d, v.z);
    const auto charge = hn::Load(d, node.charge);
    const auto px = hn::Load(d, node.dipole[0]), py = hn::Load(d, node.dipole[1]),
               pz = hn::Load(d, node.dipole[2]);
    const auto xx = hn::Load(d, node.quadrupole[0]), yy = hn::Load(d, node.quadrupole[1]),
               zz = hn::Load(d, node.quadrupole[2]);
    // T d row by row.
    const auto xy = hn::Load(d, node.quadrupole[3]), xz = hn::Load(d, node.quadrupole[4]),
               yz = hn::Load(d, node.quadrupole[5]);
    const auto tx = hn::MulAdd(xx, x, hn::MulAdd(xy, y, hn::Mul(xz, z)));
    const auto ty = hn::MulAdd(xy, x, hn::MulAdd(yy, y, hn::Mul(yz, z)));
    const auto tz = hn::MulAdd(xz, x, hn::MulAdd(yz, y, hn::Mul(zz, z)));
    const auto inside = hn::MulAdd(tx, x, hn::MulAdd(ty, y, hn::Mul(tz, z)));
    const auto along = hn::MulAdd(px, x, hn::MulAdd(py, y, hn::Mul(pz, z)));
    const auto traces = hn::Add(xx, hn::Add(yy, zz));
    const auto slope = hn::Mul(s, g.first), bend = hn::Mul(hn::Mul(s, s), g.second);
    const auto first = hn::MulAdd(slope, hn::Add(along, traces), hn::Mul(bend, inside));
    to.value = hn::Add(to.value, hn::MulAdd(charge, g.f, first));
    // Along an axis e: slope (q d + p) + bend (p.d) d, less since d shrinks.
    const auto common = hn::MulAdd(slope, charge, hn::Mul(bend, along));
    to.gradient[0] = hn::Sub(to.gradient[0], hn::MulAdd(common, x, hn::Mul(slope, px)));
    to.gradient[1] = hn::Sub(to.gradient[1], hn::MulAdd(common, y, hn::Mul(slope, py)));
    to.gradient[2] = hn::Sub(to.gradient[2], hn::MulAdd(common, z, hn::Mul(slope, pz)));
    to.trace = hn::MulAdd(charge, slope, to.trace);
    const auto b = hn::Mul(charge, bend), bx = hn::Mul(b, x), by = hn::Mul(b, y);
    to.hessian[0] = hn::MulAdd(bx, x, to.hessian[0]);
    to.hessian[1] = hn::MulAdd(by, y, to.hessian[1]);
    to.hessian[2] = hn::MulAdd(hn::Mul(b, z), z, to.hessian[2]);
    to.hessian[3] = hn::MulAdd(bx, y, to.hessian[3]);
    to.hessian[4] = hn::MulAdd(bx, z, to.hessian[4]);
    to.hessian[5] = hn::MulAdd(by, z, to.hessian[5]);
}

HWY_ATTR void addLanes(Lanes v, DRgb& sum) {
    const Tag d;
    alignas(16) float lanes[4];
    hn::Store(v, d, lanes);
    sum += DRgb(lanes[0], lanes[1], lanes[2]);
}

HWY_ATTR void expandAny(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                        LocalExpansion& expansion) {
    const auto zero = hn::Zero(Tag());
    Expansion sum{zero, zero, {zero, zero, zero}, {zero, zero, zero, zero, zero, zero}};
    for (const std::uint32_t n : list.locals)
        expandNode(tree.charges()[n], tree.shapes()[n].centre - expansion.centre, green, sum);
    addLanes(sum.value, expansion.value);
    for (std::size_t k = 0; k < 3; ++k) {
        addLanes(sum.gradient[k], expansion.gradient[k]);
        addLanes(sum.trace, expansion.hessian[k]);
    }
    for (std::size_t k = 0; k < 6; ++k) addLanes(sum.hessian[k], expansion.hessian[k]);
}
#endif

}  // namespace
}  // namespace sss::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sss {

HWY_EXPORT(layersAny);
HWY_EXPORT(expandAny);

void accumulateLayers(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                      std::span<const Vec3> receivers, std::span<DRgb> sums) {
    HWY_DYNAMIC_DISPATCH(layersAny)(tree, green, list, receivers, sums);
}

void expandLayers(const ChargeTree& tree, const KernelTable& green, const LayerList& list,
                  LocalExpansion& expansion) {
    HWY_DYNAMIC_DISPATCH(expandAny)(tree, green, list, expansion);
}

}  // namespace sss
#endif
