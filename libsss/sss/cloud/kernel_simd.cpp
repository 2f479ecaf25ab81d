// The vector code of the diffusion sum. Compiled once for every instruction set that Highway knows
// for this processor family, chosen when it first runs.
#include "sss/cloud/interactions.h"
#include "sss/cloud/local_expansion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sss/cloud/kernel_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sss::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
// Highway's floor on plain x86-64 (SSE2); the reference is as good there.
void accumulateAny(const KernelTable& table, const InteractionList& list, bool withMoments,
                   std::span<const Vec3> receivers, std::span<DRgb> sums) {
    accumulateScalar(table, list, withMoments, receivers, sums);
}
void expandAny(const KernelTable& table, const InteractionList& nodes, LocalExpansion& expansion) {
    accumulateScalar(table, nodes, expansion);
}
#else

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kBlock = InteractionList::kBlock;

// What one receiver needs of each source of a block: the table row, and the weights of c1, c2, c3.
struct alignas(64) Weights {
    std::int32_t row[kBlock];
    float k1[kBlock], k2[kBlock], k3[kBlock];
};

// What an expansion needs besides: the place in the row, dt/du = s, s (centre - source).
struct alignas(64) Steps {
    float t[kBlock], s[kBlock];
    float x[kBlock], y[kBlock], z[kBlock];
};

template <bool kWithMoments>
HWY_ATTR void weigh(const KernelTable& table, const InteractionList::Block& block,
                    const Vec3& receiver, Weights& out, Steps* steps = nullptr) {
    const hn::CappedTag<float, kBlock> d;
    const hn::RebindToSigned<decltype(d)> di;
    const auto px = hn::Set(d, receiver.x), py = hn::Set(d, receiver.y),
               pz = hn::Set(d, receiver.z);
    const auto u0 = hn::Set(d, table.offsetMm2());
    const auto base = hn::Set(di, table.baseRow());
    const auto lastRow = hn::Set(di, static_cast<std::int32_t>(table.rowCount()) - 1);
    const auto fraction = hn::Set(di, (1 << KernelTable::kShift) - 1);
    const auto unit = hn::Set(d, 1.0f / static_cast<float>(1 << KernelTable::kShift));
    for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
        const auto dx = hn::Sub(px, hn::Load(d, block.x + i));
        const auto dy = hn::Sub(py, hn::Load(d, block.y + i));
        const auto dz = hn::Sub(pz, hn::Load(d, block.z + i));
        const auto u = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::MulAdd(dz, dz, u0)));
        const auto bits = hn::BitCast(di, u);
        const auto row = hn::Min(hn::Sub(hn::ShiftRight<KernelTable::kShift>(bits), base), lastRow);
        hn::Store(row, di, out.row + i);
        const auto t = hn::Mul(hn::ConvertTo(d, hn::And(bits, fraction)), unit);
        if constexpr (kWithMoments) {
            const auto exponent = hn::And(bits, hn::Set(di, 0x7f800000));
            const auto s = hn::Mul(hn::BitCast(d, hn::Sub(hn::Set(di, 254 << 23), exponent)),
                                   hn::Set(d, static_cast<float>(1 << KernelTable::kSegmentBits)));
            const auto xx = hn::Load(d, block.moments[0] + i),
                       yy = hn::Load(d, block.moments[1] + i),
                       zz = hn::Load(d, block.moments[2] + i),
                       xy = hn::Load(d, block.moments[3] + i),
                       xz = hn::Load(d, block.moments[4] + i),
                       yz = hn::Load(d, block.moments[5] + i);
            const auto two = hn::Set(d, 2.0f);
            // d^T Q d with Q d row by row, scaled by s on both sides to stay in range.
            const auto sx = hn::Mul(s, dx), sy = hn::Mul(s, dy), sz = hn::Mul(s, dz);
            if (steps != nullptr) {
                hn::Store(t, d, steps->t + i);
                hn::Store(s, d, steps->s + i);
                hn::Store(sx, d, steps->x + i);
                hn::Store(sy, d, steps->y + i);
                hn::Store(sz, d, steps->z + i);
            }
            const auto qx = hn::MulAdd(xx, sx, hn::MulAdd(xy, sy, hn::Mul(xz, sz)));
            const auto qy = hn::MulAdd(xy, sx, hn::MulAdd(yy, sy, hn::Mul(yz, sz)));
            const auto qz = hn::MulAdd(xz, sx, hn::MulAdd(yz, sy, hn::Mul(zz, sz)));
            const auto along = hn::MulAdd(qx, sx, hn::MulAdd(qy, sy, hn::Mul(qz, sz)));
            const auto a = hn::Mul(s, hn::Add(xx, hn::Add(yy, zz)));
            const auto b = hn::Mul(two, along);
            const auto tt = hn::Mul(t, t), ta = hn::Mul(t, a);
            hn::Store(hn::Add(t, a), d, out.k1 + i);
            hn::Store(hn::MulAdd(two, hn::Add(ta, b), tt), d, out.k2 + i);
            hn::Store(
                hn::Mul(t, hn::MulAdd(hn::Set(d, 3.0f), ta, hn::MulAdd(hn::Set(d, 6.0f), b, tt))),
                d, out.k3 + i);
        } else {
            const auto tt = hn::Mul(t, t);
            hn::Store(t, d, out.k1 + i);
            hn::Store(tt, d, out.k2 + i);
            hn::Store(hn::Mul(t, tt), d, out.k3 + i);
        }
    }
}

// Of one source, all channels in one vector: lean along s (centre - source).
HWY_ATTR hn::Vec<hn::FixedTag<float, 4> > leaning(const InteractionList::Block& block,
                                                  const Steps& steps, std::size_t i) {
    const hn::FixedTag<float, 4> d;
    auto along = hn::Mul(hn::Set(d, steps.x[i]), hn::Load(d, block.lean[0][i]));
    along = hn::MulAdd(hn::Set(d, steps.y[i]), hn::Load(d, block.lean[1][i]), along);
    return hn::MulAdd(hn::Set(d, steps.z[i]), hn::Load(d, block.lean[2][i]), along);
}

// What a block's channels add that lie elsewhere than the centroids: - 2 f' d lean x mean flux.
HWY_ATTR void reduceLeans(const KernelTable& table, const InteractionList::Block& block,
                          const Weights& w, const Steps& steps, DRgb& sum) {
    const hn::FixedTag<float, 4> d;
    const auto two = hn::Set(d, 2.0f), three = hn::Set(d, 3.0f);
    auto half = hn::Zero(d);
    for (std::size_t i = 0; i < block.count; ++i) {
        const auto& c = table.rows()[w.row[i]].c;
        const auto t = hn::Set(d, steps.t[i]);
        const auto bent =
            hn::MulAdd(hn::Mul(three, t), hn::Load(d, c[3]), hn::Mul(two, hn::Load(d, c[2])));
        const auto slope = hn::MulAdd(t, bent, hn::Load(d, c[1]));
        half = hn::MulAdd(hn::Mul(slope, hn::Set(d, block.meanFlux[i])), leaning(block, steps, i),
                          half);
    }
    alignas(16) float total[4];
    hn::Store(hn::Mul(two, half), d, total);
    sum -= DRgb(total[0], total[1], total[2]);
}

// Sum of flux x (c0 + k1 c1 + k2 c2 + k3 c3), all channels of a source in one vector.
HWY_ATTR void reduce(const KernelTable& table, const InteractionList::Block& block,
                     const Weights& w, DRgb& sum) {
    const hn::FixedTag<float, 4> d;
    const KernelTable::Row* rows = table.rows();
    auto even = hn::Zero(d), odd = hn::Zero(d);
    const std::size_t count = (block.count + 1) & ~std::size_t{1};
    for (std::size_t i = 0; i < count; i += 2) {
        const auto& p = rows[w.row[i]].c;
        const auto& q = rows[w.row[i + 1]].c;
        auto f = hn::MulAdd(hn::Set(d, w.k1[i]), hn::Load(d, p[1]), hn::Load(d, p[0]));
        auto g = hn::MulAdd(hn::Set(d, w.k1[i + 1]), hn::Load(d, q[1]), hn::Load(d, q[0]));
        f = hn::MulAdd(hn::Set(d, w.k2[i]), hn::Load(d, p[2]), f);
        g = hn::MulAdd(hn::Set(d, w.k2[i + 1]), hn::Load(d, q[2]), g);
        f = hn::MulAdd(hn::Set(d, w.k3[i]), hn::Load(d, p[3]), f);
        g = hn::MulAdd(hn::Set(d, w.k3[i + 1]), hn::Load(d, q[3]), g);
        even = hn::MulAdd(f, hn::Load(d, block.flux[i]), even);
        odd = hn::MulAdd(g, hn::Load(d, block.flux[i + 1]), odd);
    }
    alignas(16) float total[4];
    hn::Store(hn::Add(even, odd), d, total);
    sum += DRgb(total[0], total[1], total[2]);
}

template <bool kWithMoments>
HWY_ATTR void accumulateList(const KernelTable& table, const InteractionList& list,
                             std::span<const Vec3> receivers, std::span<DRgb> sums) {
    Weights weights;
    Steps steps;
    for (const InteractionList::Block& block : list.blocks())
        for (std::size_t r = 0; r < receivers.size(); ++r) {
            const bool isColoured = kWithMoments && block.isColoured;
            weigh<kWithMoments>(table, block, receivers[r], weights, isColoured ? &steps : nullptr);
            reduce(table, block, weights, sums[r]);
            if (isColoured) reduceLeans(table, block, weights, steps, sums[r]);
        }
}

// One block's part of an expansion, all channels of a source in one vector.
HWY_ATTR void expandBlock(const KernelTable& table, const InteractionList::Block& block,
                          const Weights& w, const Steps& steps, LocalExpansion& to) {
    const hn::FixedTag<float, 4> d;
    const KernelTable::Row* rows = table.rows();
    auto value = hn::Zero(d), trace = hn::Zero(d), gx = hn::Zero(d), gy = hn::Zero(d),
         gz = hn::Zero(d), xx = hn::Zero(d), yy = hn::Zero(d), zz = hn::Zero(d), xy = hn::Zero(d),
         xz = hn::Zero(d), yz = hn::Zero(d);
    for (std::size_t i = 0; i < block.count; ++i) {
        const auto& row = rows[w.row[i]].c;
        const auto flux = hn::Load(d, block.flux[i]);
        const auto c1 = hn::Load(d, row[1]), c2 = hn::Load(d, row[2]), c3 = hn::Load(d, row[3]);
        auto f = hn::MulAdd(hn::Set(d, w.k1[i]), c1, hn::Load(d, row[0]));
        f = hn::MulAdd(hn::Set(d, w.k2[i]), c2, f);
        f = hn::MulAdd(hn::Set(d, w.k3[i]), c3, f);
        value = hn::MulAdd(f, flux, value);
        const auto t = hn::Set(d, steps.t[i]), two = hn::Set(d, 2.0f);
        const auto tc3 = hn::Mul(hn::Mul(t, c3), hn::Set(d, 3.0f)), c2c2 = hn::Mul(two, c2);
        const auto flux2 = hn::Mul(two, flux);
        const auto slope = hn::Mul(flux2, hn::MulAdd(t, hn::Add(c2c2, tc3), c1));  // 2 df/dt
        trace = hn::MulAdd(hn::Set(d, steps.s[i]), slope, trace);
        const auto sx = hn::Set(d, steps.x[i]), sy = hn::Set(d, steps.y[i]),
                   sz = hn::Set(d, steps.z[i]);
        gx = hn::MulAdd(slope, sx, gx);
        gy = hn::MulAdd(slope, sy, gy);
        gz = hn::MulAdd(slope, sz, gz);
        const auto bend = hn::Mul(hn::Mul(two, flux2), hn::MulAdd(two, tc3, c2c2));  // 4 d2f/dt2
        const auto bx = hn::Mul(bend, sx), by = hn::Mul(bend, sy), bz = hn::Mul(bend, sz);
        xx = hn::MulAdd(bx, sx, xx);
        xy = hn::MulAdd(bx, sy, xy);
        xz = hn::MulAdd(bx, sz, xz);
        yy = hn::MulAdd(by, sy, yy);
        yz = hn::MulAdd(by, sz, yz);
        zz = hn::MulAdd(bz, sz, zz);
    }
    const auto add = [&](auto v, DRgb& sum) {
        alignas(16) float lanes[4];
        hn::Store(v, d, lanes);
        sum += DRgb(lanes[0], lanes[1], lanes[2]);
    };
    add(value, to.value);
    add(gx, to.gradient[0]);
    add(gy, to.gradient[1]);
    add(gz, to.gradient[2]);
    add(hn::Add(xx, trace), to.hessian[0]);
    add(hn::Add(yy, trace), to.hessian[1]);
    add(hn::Add(zz, trace), to.hessian[2]);
    add(xy, to.hessian[3]);
    add(xz, to.hessian[4]);
    add(yz, to.hessian[5]);
}

// What leaning channels add to an expansion: their value, and its slope.
HWY_ATTR void expandLeans(const KernelTable& table, const InteractionList::Block& block,
                          const Weights& w, const Steps& steps, LocalExpansion& to) {
    reduceLeans(table, block, w, steps, to.value);
    const hn::FixedTag<float, 4> d;
    const auto two = hn::Set(d, 2.0f), six = hn::Set(d, 6.0f), three = hn::Set(d, 3.0f);
    auto gx = hn::Zero(d), gy = hn::Zero(d), gz = hn::Zero(d);
    for (std::size_t i = 0; i < block.count; ++i) {
        const auto& c = table.rows()[w.row[i]].c;
        const auto t = hn::Set(d, steps.t[i]), c3 = hn::Load(d, c[3]);
        const auto c2 = hn::Mul(two, hn::Load(d, c[2]));
        const auto flux = hn::Set(d, block.meanFlux[i]);
        const auto byT =
            hn::Mul(flux, hn::MulAdd(t, hn::MulAdd(hn::Mul(three, t), c3, c2), hn::Load(d, c[1])));
        const auto byTT = hn::Mul(flux, hn::MulAdd(hn::Mul(six, t), c3, c2));
        const auto straight = hn::Mul(byT, hn::Set(d, 2.0f * steps.s[i]));
        const auto bent = hn::Mul(hn::Mul(hn::Set(d, 4.0f), byTT), leaning(block, steps, i));
        gx = hn::MulAdd(bent, hn::Set(d, steps.x[i]),
                        hn::MulAdd(straight, hn::Load(d, block.lean[0][i]), gx));
        gy = hn::MulAdd(bent, hn::Set(d, steps.y[i]),
                        hn::MulAdd(straight, hn::Load(d, block.lean[1][i]), gy));
        gz = hn::MulAdd(bent, hn::Set(d, steps.z[i]),
                        hn::MulAdd(straight, hn::Load(d, block.lean[2][i]), gz));
    }
    const auto take = [&](auto v, DRgb& from) {
        alignas(16) float lanes[4];
        hn::Store(v, d, lanes);
        from -= DRgb(lanes[0], lanes[1], lanes[2]);
    };
    take(gx, to.gradient[0]);
    take(gy, to.gradient[1]);
    take(gz, to.gradient[2]);
}

HWY_ATTR void expandAny(const KernelTable& table, const InteractionList& nodes,
                        LocalExpansion& expansion) {
    Weights weights;
    Steps steps;
    for (const InteractionList::Block& block : nodes.blocks()) {
        weigh<true>(table, block, expansion.centre, weights, &steps);
        expandBlock(table, block, weights, steps, expansion);
        if (block.isColoured) expandLeans(table, block, weights, steps, expansion);
    }
}

HWY_ATTR void accumulateAny(const KernelTable& table, const InteractionList& list, bool withMoments,
                            std::span<const Vec3> receivers, std::span<DRgb> sums) {
    if (withMoments)
        accumulateList<true>(table, list, receivers, sums);
    else
        accumulateList<false>(table, list, receivers, sums);
}

#endif

const char* targetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace sss::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sss {

HWY_EXPORT(accumulateAny);
HWY_EXPORT(expandAny);
HWY_EXPORT(targetName);

void accumulate(const KernelTable& table, const InteractionList& list, bool withMoments,
                std::span<const Vec3> receivers, std::span<DRgb> sums) {
    HWY_DYNAMIC_DISPATCH(accumulateAny)(table, list, withMoments, receivers, sums);
}

void accumulate(const KernelTable& table, const InteractionList& nodes, LocalExpansion& expansion) {
    HWY_DYNAMIC_DISPATCH(expandAny)(table, nodes, expansion);
}

const char* accumulateTarget() { return HWY_DYNAMIC_DISPATCH(targetName)(); }

}  // namespace sss
#endif
