#include "sss/cloud/cell_grid.h"

#include "sss/base/bounds.h"
#include "sss/base/parallel.h"
#include "sss/base/rng.h"

#include <algorithm>
#include <bit>

namespace sss {
namespace {

constexpr std::uint32_t kNoCell = 0xffffffffu;
constexpr double kMostCellsPerAxis = 2e6;  // 21 bits each in a key
constexpr std::size_t kGrain = 2048;

constexpr std::uint64_t pack(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return x | y << 21 | z << 42;
}

constexpr std::array<std::uint64_t, 3> coordinates(std::uint64_t key) {
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return {key & mask, key >> 21 & mask, key >> 42};
}

}  // namespace

CellGrid::CellGrid(std::span<const Vec3> positions, double cellSize) {
    Bounds box;
    for (const Vec3& p : positions) box.add(p);
    origin_ = box.lo;
    const double smallest = std::max<double>(maxComponent(box.size()) / kMostCellsPerAxis, 1e-30);
    inverseSize_ = 1.0 / std::max(cellSize, smallest);
    slots_.assign(std::bit_ceil(positions.size() + 16), kNoCell);
    cellOf_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) cellOf_[i] = insert(keyOf(positions[i]));
    listNeighbours();
}

int CellGrid::phase(std::uint32_t cell) const {
    const auto [x, y, z] = coordinates(keys_[cell]);
    return static_cast<int>(x % 3 + 3 * (y % 3) + 9 * (z % 3));
}

std::uint64_t CellGrid::keyOf(const Vec3& p) const {
    // One empty layer in front, so that neighbours never wrap.
    const auto cell = [&](float x, float lo) {
        return static_cast<std::uint64_t>((static_cast<double>(x) - lo) * inverseSize_) + 1;
    };
    return pack(cell(p.x, origin_.x), cell(p.y, origin_.y), cell(p.z, origin_.z));
}

std::size_t CellGrid::slotOf(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mix64(key) & mask;
    while (slots_[slot] != kNoCell && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
    return slot;
}

std::uint32_t CellGrid::insert(std::uint64_t key) {
    const std::size_t slot = slotOf(key);
    if (slots_[slot] == kNoCell) {
        slots_[slot] = static_cast<std::uint32_t>(keys_.size());
        keys_.push_back(key);
    }
    return slots_[slot];
}

int CellGrid::find27(std::uint32_t cell, std::array<std::uint32_t, 27>& out) const {
    const auto [x, y, z] = coordinates(keys_[cell]);
    int count = 0;
    for (std::uint64_t i = 0; i < 27; ++i) {
        const std::uint64_t key = pack(x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1);
        const std::uint32_t found = slots_[slotOf(key)];
        if (found != kNoCell) out[static_cast<std::size_t>(count++)] = found;
    }
    return count;
}

void CellGrid::listNeighbours() {
    std::vector<std::vector<std::uint32_t>> chunks((cellCount() + kGrain - 1) / kGrain);
    firstNeighbour_.assign(cellCount() + 1, 0);
    parallelFor(cellCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::array<std::uint32_t, 27> near;
        std::vector<std::uint32_t>& found = chunks[begin / kGrain];
        for (std::size_t c = begin; c < end; ++c) {
            const int count = find27(static_cast<std::uint32_t>(c), near);
            firstNeighbour_[c + 1] = static_cast<std::uint32_t>(count);
            found.insert(found.end(), near.begin(), near.begin() + count);
        }
    });
    for (std::size_t c = 0; c < cellCount(); ++c) firstNeighbour_[c + 1] += firstNeighbour_[c];
    neighbours_.reserve(firstNeighbour_.back());
    for (std::vector<std::uint32_t>& chunk : chunks) {
        neighbours_.insert(neighbours_.end(), chunk.begin(), chunk.end());
        std::vector<std::uint32_t>().swap(chunk);
    }
}

}  // namespace sss
