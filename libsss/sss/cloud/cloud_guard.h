#pragma once
#include "sss/cloud/cache_section.h"
#include "sss/cloud/checked_parts.h"
#include "sss/cloud/octree_check.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace sss {

/// A cloud and its octree as sections of a file.
struct CloudSections {
    UncheckedSection<SurfacePoint> points;
    UncheckedSection<Rgb> irradiance;
    UncheckedSection<OctreeNode> nodes;
    std::span<const NodesBefore> nodesBefore;  ///< by part of the nodes; checked against nothing
};

/// Stands before a cloud that lies in a file, so that a sum reads only the parts that it touches:
/// whoever needs points or nodes says so before looking at them, and each part is checked (its
/// checksum, and all that octree_check.h asks) when it is first needed. After that the question
/// costs one load a part. All that is needed of a damaged file throws Error{BadInput} with its
/// name. Thread-safe; valid while the file is open.
class CloudGuard {
public:
    /// Checks how the sections fit together, and the root.
    explicit CloudGuard(const CloudSections& sections);

    void needNodes(std::size_t first, std::size_t count) const {
        nodes_.need(first, count, [this](std::size_t part) { checkNodes(part); });
    }
    /// Points and their irradiance.
    void needPoints(std::size_t first, std::size_t count) const {
        points_.need(first, count, [this](std::size_t part) { checkPoints(part); });
        irradiance_.need(first, count, [this](std::size_t part) { checkIrradiance(part); });
    }
    void needAll() const;
    /// Bytes of the parts that were needed so far.
    std::uint64_t bytesChecked() const;

private:
    void checkPoints(std::size_t part) const;
    void checkIrradiance(std::size_t part) const;
    void checkNodes(std::size_t part) const;
    [[noreturn]] void refuse() const;

    CloudSections sections_;
    OctreeSize size_;
    CheckedParts points_, irradiance_, nodes_;
};

}  // namespace sss
