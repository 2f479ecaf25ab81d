#include "sss/cloud/exitance_store.h"

#include <algorithm>

namespace sss {

void ExitanceStore::add(std::uint32_t group, const ExitanceGroup& exitance) {
    entries.push_back({group, static_cast<std::uint32_t>(exitance.segments.size()),
                       static_cast<std::uint32_t>(exitance.siteOf.size()),
                       static_cast<std::uint32_t>(exitance.values.size())});
    segments.insert(segments.end(), exitance.segments.begin(), exitance.segments.end());
    siteOf.insert(siteOf.end(), exitance.siteOf.begin(), exitance.siteOf.end());
    values.insert(values.end(), exitance.values.begin(), exitance.values.end());
    slopes.insert(slopes.end(), exitance.slopes.begin(), exitance.slopes.end());
}

namespace {

// Takes the next `count` elements off an array; empty and `ok` false if there are not as many.
template <typename T>
std::vector<T> take(std::span<const T>& from, std::size_t count, bool& ok) {
    if (count > from.size()) {
        ok = false;
        return {};
    }
    std::vector<T> taken(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
    from = from.subspan(count);
    return taken;
}

bool isFiniteSlope(const ExitanceSlope& slope) {
    return isFinite(slope.x) && isFinite(slope.y) && isFinite(slope.z);
}

}  // namespace

bool forEachGroup(const ExitanceStore::View& store,
                  const std::function<bool(std::uint32_t, ExitanceGroup)>& visit) {
    ExitanceStore::View rest = store;
    for (const ExitanceStore::Entry& entry : store.entries) {
        bool ok = true;
        ExitanceGroup group;
        group.segments = take(rest.segments, entry.patches, ok);
        group.siteOf = take(rest.siteOf, entry.sites, ok);
        group.values = take(rest.values, entry.values, ok);
        if (!store.slopes.empty()) group.slopes = take(rest.slopes, entry.values, ok);
        std::uint32_t sites = 0;
        for (const std::uint32_t n : group.segments) {
            group.firstSite.push_back(sites);
            sites += (n + 1) * (n + 2) / 2;
        }
        const auto isKnown = [&](std::uint16_t site) { return site < group.values.size(); };
        if (!ok || sites != group.siteOf.size() || !std::ranges::all_of(group.siteOf, isKnown) ||
            !std::ranges::all_of(group.values, [](const Rgb& v) { return isFinite(v); }) ||
            !std::ranges::all_of(group.slopes, isFiniteSlope) ||
            !visit(entry.group, std::move(group)))
            return false;
    }
    return rest.segments.empty() && rest.siteOf.empty() && rest.values.empty() &&
           rest.slopes.empty();
}

}  // namespace sss
