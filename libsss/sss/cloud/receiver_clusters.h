#pragma once
#include "sss/base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Puts receivers into clusters of at most `most` that lie close together, by halving along the
/// longest axis. `order` becomes the receivers' indices, cluster after cluster; returns where each
/// cluster ends in it. A function of the positions only. O(n log n), for some dozens.
std::vector<std::size_t> clusterReceivers(std::span<const Vec3> receivers, std::size_t most,
                                          std::vector<std::uint32_t>& order);

}  // namespace sss
