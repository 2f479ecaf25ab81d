#include "sss/cloud/receiver_tree.h"

#include "sss/base/bounds.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sss {

void buildReceiverTree(std::span<const Vec3> receivers, std::uint32_t most, float mostRadius,
                       std::vector<ReceiverCell>& cells, std::vector<std::uint32_t>& order) {
    order.resize(receivers.size());
    std::iota(order.begin(), order.end(), 0u);
    cells.clear();
    if (receivers.empty()) return;
    cells.push_back({.begin = 0, .end = static_cast<std::uint32_t>(receivers.size())});
    for (std::size_t k = 0; k < cells.size(); ++k) {
        ReceiverCell cell = cells[k];
        const auto first = order.begin() + cell.begin, last = order.begin() + cell.end;
        Bounds box;
        for (auto i = first; i != last; ++i) box.add(receivers[*i]);
        cell.centre = box.centre();
        for (auto i = first; i != last; ++i)
            cell.radius = std::max(cell.radius, glm::length(receivers[*i] - cell.centre));
        if (cell.size() > 1 && (cell.size() > most || cell.radius > mostRadius)) {
            const Vec3 size = box.size();
            int axis = size.y > size.x ? 1 : 0;
            if (size.z > size[axis]) axis = 2;
            const std::uint32_t middle = cell.begin + cell.size() / 2;
            // Equal places are told apart by their index.
            std::nth_element(
                first, order.begin() + middle, last, [&](std::uint32_t a, std::uint32_t b) {
                    return std::pair(receivers[a][axis], a) < std::pair(receivers[b][axis], b);
                });
            cell.child = static_cast<std::uint32_t>(cells.size());
            cells.push_back({.begin = cell.begin, .end = middle});
            cells.push_back({.begin = middle, .end = cell.end});
        }
        cells[k] = cell;
    }
}

}  // namespace sss
