#include "sss/cloud/local_expansion.h"

namespace sss {

DRgb LocalExpansion::at(const Vec3& place) const {
    const DVec3 d = DVec3(place) - DVec3(centre);
    return value + gradient[0] * d.x + gradient[1] * d.y + gradient[2] * d.z +
           0.5 * (hessian[0] * (d.x * d.x) + hessian[1] * (d.y * d.y) + hessian[2] * (d.z * d.z)) +
           hessian[3] * (d.x * d.y) + hessian[4] * (d.x * d.z) + hessian[5] * (d.y * d.z);
}

LocalExpansion LocalExpansion::movedTo(const Vec3& place) const {
    const DVec3 d = DVec3(place) - DVec3(centre);
    LocalExpansion moved = *this;
    moved.centre = place;
    moved.value = at(place);
    moved.gradient[0] += hessian[0] * d.x + hessian[3] * d.y + hessian[4] * d.z;
    moved.gradient[1] += hessian[3] * d.x + hessian[1] * d.y + hessian[5] * d.z;
    moved.gradient[2] += hessian[4] * d.x + hessian[5] * d.y + hessian[2] * d.z;
    return moved;
}

namespace {

// What channels add that lie elsewhere than the centroid. `d`: from there to the expansion's
// centre.
void addLeans(const InteractionList::Block& block, std::size_t i, const Vec3& d,
              const KernelTable::Place& place, LocalExpansion& to) {
    const auto [row, t, s] = place;
    for (int k = 0; k < 3; ++k) {
        const float c1 = row->c[1][k], c2 = row->c[2][k], c3 = row->c[3][k];
        const float slope = block.meanFlux[i] * s * (c1 + t * (2.0f * c2 + 3.0f * t * c3));
        const float bend = block.meanFlux[i] * s * s * (2.0f * c2 + 6.0f * t * c3);
        const Vec3 lean = leanOf(block, i, k);
        const float along = glm::dot(d, lean);
        to.value[k] -= static_cast<double>(2.0f * slope * along);
        for (int axis = 0; axis < 3; ++axis)
            to.gradient[static_cast<std::size_t>(axis)][k] -=
                static_cast<double>(2.0f * slope * lean[axis] + 4.0f * bend * along * d[axis]);
    }
}

void addSource(const KernelTable& table, const InteractionList::Block& block, std::size_t i,
               LocalExpansion& to) {
    const Vec3 d = to.centre - Vec3(block.x[i], block.y[i], block.z[i]);
    const auto [row, t, s] = table.placeOf(glm::dot(d, d));
    const float trace = block.moments[0][i] + block.moments[1][i] + block.moments[2][i];
    const float along = quadraticForm(block, i, d);
    Rgb f, slope, bend;  // flux x kernel, and its derivatives by u
    for (int k = 0; k < 3; ++k) {
        const float c1 = row->c[1][k], c2 = row->c[2][k], c3 = row->c[3][k];
        const float flux = block.flux[i][k];
        f[k] = flux * (row->c[0][k] + t * (c1 + t * (c2 + t * c3)));
        slope[k] = flux * s * (c1 + t * (2.0f * c2 + 3.0f * t * c3));
        bend[k] = flux * s * s * (2.0f * c2 + 6.0f * t * c3);
    }
    if (block.isColoured) addLeans(block, i, d, {row, t, s}, to);
    to.value += DRgb(f + slope * trace + 2.0f * bend * along);
    for (int k = 0; k < 3; ++k) {
        const auto n = static_cast<std::size_t>(k);
        to.gradient[n] += DRgb(2.0f * slope * d[k]);
        to.hessian[n] += DRgb(2.0f * slope + 4.0f * bend * (d[k] * d[k]));
    }
    to.hessian[3] += DRgb(4.0f * bend * (d.x * d.y));
    to.hessian[4] += DRgb(4.0f * bend * (d.x * d.z));
    to.hessian[5] += DRgb(4.0f * bend * (d.y * d.z));
}

}  // namespace

void accumulateScalar(const KernelTable& table, const InteractionList& nodes,
                      LocalExpansion& expansion) {
    for (const InteractionList::Block& block : nodes.blocks())
        for (std::size_t i = 0; i < block.count; ++i) addSource(table, block, i, expansion);
}

}  // namespace sss
