#include "sss/cloud/cloud_guard.h"

#include "sss/base/parallel.h"

#include <fmt/core.h>

namespace sss {
namespace {

constexpr std::size_t kElementsPerTask = 1 << 14;  // some parts

template <typename T>
CheckedParts unchecked(const UncheckedSection<T>& section) {
    return {section.parts.count(), section.parts.shift()};
}

std::uint64_t bytesOf(const CheckedParts& checked, const SectionParts& parts) {
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < parts.count(); ++i)
        if (checked.isChecked(i)) bytes += parts.part(i).size();
    return bytes;
}

}  // namespace

CloudGuard::CloudGuard(const CloudSections& sections)
    : sections_(sections),
      size_{sections.nodes.elements.size(), sections.points.elements.size()},
      points_(unchecked(sections.points)),
      irradiance_(unchecked(sections.irradiance)),
      nodes_(unchecked(sections.nodes)) {
    if (sections.irradiance.elements.size() != size_.points ||
        sections.nodesBefore.size() != sections.nodes.parts.count() ||
        !isSound(sections.nodesBefore, size_))
        refuse();
    if (size_.nodes > 0) needNodes(0, 1);
}

void CloudGuard::refuse() const {
    sections_.nodes.parts.refuse(
        fmt::format("the octree of body {} does not fit its points", sections_.nodes.parts.body()));
}

void CloudGuard::checkPoints(std::size_t part) const {
    sections_.points.parts.check(part);
    if (!areSound(sections_.points.part(part))) refuse();
}

void CloudGuard::checkIrradiance(std::size_t part) const {
    sections_.irradiance.parts.check(part);
    if (!areSound(sections_.irradiance.part(part))) refuse();
}

void CloudGuard::checkNodes(std::size_t part) const {
    sections_.nodes.parts.check(part);
    const auto& before = sections_.nodesBefore;
    const NodesBefore after = part + 1 < before.size()
                                  ? before[part + 1]
                                  : NodesBefore{static_cast<std::uint32_t>(size_.nodes),
                                                static_cast<std::uint32_t>(size_.points)};
    const std::size_t first = part << sections_.nodes.parts.shift();
    if (!isSound(sections_.nodes.part(part), first, before[part], after, size_)) refuse();
}

void CloudGuard::needAll() const {
    parallelFor(size_.points, kElementsPerTask,
                [&](std::size_t begin, std::size_t end) { needPoints(begin, end - begin); });
    parallelFor(size_.nodes, kElementsPerTask,
                [&](std::size_t begin, std::size_t end) { needNodes(begin, end - begin); });
}

std::uint64_t CloudGuard::bytesChecked() const {
    return bytesOf(points_, sections_.points.parts) +
           bytesOf(irradiance_, sections_.irradiance.parts) +
           bytesOf(nodes_, sections_.nodes.parts);
}

}  // namespace sss
