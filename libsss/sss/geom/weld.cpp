#include "sss/geom/weld.h"

#include "sss/base/rng.h"

#include <bit>

namespace sss {

namespace {

std::uint64_t hashPosition(const DVec3& p) {
    // Adding +0 turns -0 into +0.
    std::uint64_t seed = std::bit_cast<std::uint64_t>(p.x + 0.0);
    seed = combineSeeds(seed, std::bit_cast<std::uint64_t>(p.y + 0.0));
    return combineSeeds(seed, std::bit_cast<std::uint64_t>(p.z + 0.0));
}

}  // namespace

std::vector<std::uint32_t> weldPositions(std::span<const DVec3> positions) {
    constexpr std::uint32_t kFree = 0xffffffffu;
    const std::size_t slots = std::bit_ceil(positions.size() * 2 + 1);
    std::vector<std::uint32_t> table(slots, kFree);
    std::vector<std::uint32_t> first(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        std::size_t slot = hashPosition(positions[i]) & (slots - 1);
        while (table[slot] != kFree && positions[table[slot]] != positions[i])
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == kFree) table[slot] = index;
        first[i] = table[slot];
    }
    return first;
}

}  // namespace sss
