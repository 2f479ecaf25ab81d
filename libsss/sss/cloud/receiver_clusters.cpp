#include "sss/cloud/receiver_clusters.h"

#include "sss/base/bounds.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sss {
namespace {

class Halver {
public:
    Halver(std::span<const Vec3> receivers, std::size_t most)
        : receivers_(receivers), most_(most) {}

    void halve(std::span<std::uint32_t> order) {
        if (order.size() <= most_) {
            done_ += order.size();
            ends.push_back(done_);
            return;
        }
        Bounds box;
        for (const std::uint32_t i : order) box.add(receivers_[i]);
        const Vec3 size = box.size();
        int axis = size.y > size.x ? 1 : 0;
        if (size.z > size[axis]) axis = 2;
        const std::size_t middle = order.size() / 2;
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle),
                         order.end(), [&](std::uint32_t a, std::uint32_t b) {
                             return std::pair(receivers_[a][axis], a) <
                                    std::pair(receivers_[b][axis], b);
                         });
        halve(order.first(middle));
        halve(order.subspan(middle));
    }

    std::vector<std::size_t> ends;

private:
    std::span<const Vec3> receivers_;
    std::size_t most_, done_ = 0;
};

}  // namespace

std::vector<std::size_t> clusterReceivers(std::span<const Vec3> receivers, std::size_t most,
                                          std::vector<std::uint32_t>& order) {
    order.resize(receivers.size());
    std::iota(order.begin(), order.end(), 0u);
    Halver halver(receivers, most);
    halver.halve(order);
    return std::move(halver.ends);
}

}  // namespace sss
