#include "sss/light/volume_light.h"

#include "sss/base/rng.h"
#include "sss/light/geometry.h"
#include "sss/volume/cell_walk.h"

#include <bit>
#include <vector>

namespace sss {
namespace {

// The unit cube is one cell where there is no grid.
DensityGrid::Cell cellsOf(const Volume& volume) {
    return volume.grid() ? volume.grid()->cells() : DensityGrid::Cell{1, 1, 1};
}

std::size_t indexOf(const Volume& volume, const DensityGrid::Cell& cell) {
    return volume.grid() ? volume.grid()->indexOf(cell) : 0;
}

DVec3 cornerOf(const DensityGrid::Cell& cell) { return {cell[0], cell[1], cell[2]}; }

}  // namespace

VolumeLight::VolumeLight(const Volume& volume, int index) : volume_(volume), index_(index) {
    const DensityGrid::Cell cells = cellsOf(volume);
    const DVec3 perUnit = cornerOf(cells);
    const std::size_t count = volume.grid() ? volume.grid()->cellCount() : 1;
    const double cellMm3 = volume.cubeMm3() / static_cast<double>(count);
    perCellMm3_ = 1 / cellMm3;
    std::vector<double> weights(count);
    DVec3 middle(0);
    double total = 0;
    for (std::size_t i = 0; i < count; ++i) {
        Vec4 mean(1);
        DensityGrid::Cell cell{};
        if (volume.grid()) {
            cell = volume.grid()->cellOf(i);
            mean = volume.grid()->mean(cell);
        }
        weights[i] = static_cast<double>(
            meanComponent(volume.coefficients().glow * Rgb(mean.y, mean.z, mean.w)));
        middle += (cornerOf(cell) + 0.5) / perUnit * weights[i];
        total += weights[i];
    }
    choice_.emplace(weights);
    intensity_ = total * cellMm3;
    centre_ = volume.worldFromUnit(total > 0 ? middle / total : DVec3(0.5));
}

LightSample VolumeLight::sample(const Vec3& from, const Vec2& u) const {
    const PiecewiseConstant1D::Sample chosen = choice_->sample(u.x);
    const DensityGrid::Cell cell =
        volume_.grid() ? volume_.grid()->cellOf(chosen.cell) : DensityGrid::Cell{};
    // A place needs more bits than two numbers have left when one has chosen among many cells.
    Rng more(combineSeeds(std::bit_cast<std::uint32_t>(u.x), std::bit_cast<std::uint32_t>(u.y)));
    const double x = more.uniformDouble(), z = more.uniformDouble();
    const DVec3 inCell(x, static_cast<double>(u.y), z);
    const Vec3 place =
        volume_.worldFromUnit((cornerOf(cell) + inCell) / cornerOf(cellsOf(volume_)));
    const Vec3 offset = place - from;
    const float distance = glm::length(offset);
    if (!(distance > 0)) return {};
    const Vec3 direction = offset / distance;
    return {direction, std::numeric_limits<float>::infinity(), Rgb(1), pdf(from, direction)};
}

// The density by volume is constant in a cell; integrated over t^2 dt along the direction.
float VolumeLight::pdf(const Vec3& from, const Vec3& direction) const {
    const UnitLine line = volume_.unitLine(from, direction);
    const RayInterval inside = clipToUnitCube(line, std::numeric_limits<double>::infinity());
    double sum = 0;
    walkCells(cellsOf(volume_), line, inside,
              [&](const DensityGrid::Cell& cell, double begin, double end) {
                  const auto mass = static_cast<double>(choice_->mass(indexOf(volume_, cell)));
                  sum += mass * (end * end * end - begin * begin * begin);
              });
    return static_cast<float>(sum * perCellMm3_ / 3);
}

bool VolumeLight::isBelow(const Vec3& point, const Vec3& normal) const {
    for (int corner = 0; corner < 8; ++corner) {
        const DVec3 p(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        if (glm::dot(volume_.worldFromUnit(p) - point, normal) > 0) return false;
    }
    return true;
}

float VolumeLight::importance(const Bounds& target) const {
    return static_cast<float>(intensity_ / importanceDistanceSquared(DVec3(centre_), target));
}

}  // namespace sss
