#include "sss/volume/volume.h"

#include "sss/volume/cell_walk.h"

namespace sss {

Volume::Volume(const VolumeSettings& settings, const VolumePlace& place)
    : coefficients_{settings.sigmaS, settings.sigmaA + settings.sigmaS,
                    settings.sigmaA * settings.emission, static_cast<float>(settings.g)},
      worldFromUnit_(place.worldFromUnit),
      unitFromWorld_(glm::inverse(place.worldFromUnit)),
      part_(place.part) {
    if (part_ == VolumePlace::Part::Mesh) mesh_.emplace(place.mesh);
    if (settings.grid) grid_ = DensityGrid::read(*settings.grid);
    for (int corner = 0; corner < 8; ++corner)
        bounds_.add(worldFromUnit(DVec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1)));
}

UnitLine Volume::unitLine(const Vec3& origin, const Vec3& direction) const {
    return {DVec3(unitFromWorld_ * glm::dvec4(DVec3(origin), 1.0)),
            DMat3(unitFromWorld_) * DVec3(direction)};
}

Vec3 Volume::worldFromUnit(const DVec3& p) const {
    return Vec3(DVec3(worldFromUnit_ * glm::dvec4(p, 1.0)));
}

void Volume::addPieces(const Vec3& origin, const Vec3& direction, float end,
                       std::vector<VolumePiece>& pieces) const {
    const UnitLine line = unitLine(origin, direction);
    const RayInterval inCube = clipToUnitCube(line, static_cast<double>(end));
    if (!(inCube.begin < inCube.end)) return;
    switch (part_) {
        case VolumePlace::Part::Cube:
            addCells(line, inCube, pieces);
            return;
        case VolumePlace::Part::Ball:
            addCells(line, clipToUnitBall(line, static_cast<double>(end)), pieces);
            return;
        case VolumePlace::Part::Mesh: {
            std::vector<RayInterval> inside;
            mesh_->clip(origin, direction, static_cast<double>(end), inside);
            for (const RayInterval& interval : inside) addCells(line, interval, pieces);
            return;
        }
    }
}

void Volume::addCells(const UnitLine& line, const RayInterval& inside,
                      std::vector<VolumePiece>& pieces) const {
    const auto add = [&](double begin, double end, const DensityCubic& density) {
        const VolumePiece piece{static_cast<float>(begin), static_cast<float>(end), density};
        if (piece.begin < piece.end) pieces.push_back(piece);
    };
    if (!(inside.begin < inside.end)) return;
    if (!grid_) {
        add(inside.begin, inside.end, DensityCubic::constant(1));
        return;
    }
    const DensityGrid::Cell& cells = grid_->cells();
    const DVec3 perUnit(cells[0], cells[1], cells[2]);
    walkCells(cells, line, inside, [&](const DensityGrid::Cell& cell, double begin, double end) {
        if (grid_->isEmpty(cell)) return;
        add(begin, end,
            grid_->along(cell, Vec3(line.at(begin) * perUnit), Vec3(line.at(end) * perUnit)));
    });
}

}  // namespace sss
