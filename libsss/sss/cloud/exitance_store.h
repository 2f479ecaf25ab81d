#pragma once
#include "sss/cloud/exitance_group.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sss {

/// Groups of exitance in flat arrays, as a cache file keeps them.
struct ExitanceStore {
    struct Entry {
        std::uint32_t group = 0;
        std::uint32_t patches = 0, sites = 0, values = 0;  ///< elements in the arrays below
    };
    struct View {
        std::span<const Entry> entries;
        std::span<const std::uint8_t> segments;
        std::span<const std::uint16_t> siteOf;
        std::span<const Rgb> values;
        std::span<const ExitanceSlope> slopes{};  ///< by value, or none
    };
    std::vector<Entry> entries;
    std::vector<std::uint8_t> segments;
    std::vector<std::uint16_t> siteOf;
    std::vector<Rgb> values;
    std::vector<ExitanceSlope> slopes;

    void add(std::uint32_t group, const ExitanceGroup& exitance);
    View view() const { return {entries, segments, siteOf, values, slopes}; }
};

/// Hands on the groups of a store that are whole in themselves; false if the arrays do not fit
/// their entries or an entry is not whole (then what came before it has been handed on).
bool forEachGroup(const ExitanceStore::View& store,
                  const std::function<bool(std::uint32_t, ExitanceGroup)>& visit);

}  // namespace sss
