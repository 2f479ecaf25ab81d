#pragma once
#include "sss/base/parallel.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace sss {

/// Sorts by `less`, a strict total order: the result is then the same however the work is divided.
/// Runs of a fixed length are sorted by themselves and merged, two by two. O(n log n) and as much
/// memory again.
template <typename T, typename Less>
void parallelSort(std::span<T> items, const Less& less) {
    constexpr std::size_t kRun = 1 << 15;
    parallelFor(items.size(), kRun, [&](std::size_t begin, std::size_t end) {
        std::sort(items.data() + begin, items.data() + end, less);
    });
    std::vector<T> other(items.size() > kRun ? items.size() : 0);
    T *from = items.data(), *to = other.data();
    for (std::size_t run = kRun; run < items.size(); run *= 2, std::swap(from, to))
        parallelFor(items.size(), 2 * run, [&](std::size_t begin, std::size_t end) {
            const std::size_t middle = std::min(begin + run, end);
            std::merge(from + begin, from + middle, from + middle, from + end, to + begin, less);
        });
    if (from != items.data()) std::copy(other.begin(), other.end(), items.begin());
}

}  // namespace sss
