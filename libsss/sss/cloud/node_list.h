#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sss {

/// Indices of octree nodes, added many at a time: room is made once for all of them.
class NodeList {
public:
    void clear() { size_ = 0; }
    bool empty() const { return size_ == 0; }
    std::span<const std::uint32_t> indices() const { return std::span(storage_).first(size_); }

    /// first, first + 1, ...
    void addRun(std::uint32_t first, std::uint32_t count) {
        std::uint32_t* to = room(count);
        for (std::uint32_t k = 0; k < count; ++k) to[k] = first + k;
        size_ += count;
    }
    /// Those whose bit is set.
    void addWhere(std::uint64_t bits, std::span<const std::uint32_t> from) {
        std::uint32_t* to = room(64);
        for (; bits != 0; bits &= bits - 1)
            *to++ = from[static_cast<std::size_t>(std::countr_zero(bits))];
        size_ = static_cast<std::size_t>(to - storage_.data());
    }

private:
    std::uint32_t* room(std::size_t more) {
        if (storage_.size() < size_ + more) storage_.resize(2 * (size_ + more));
        return storage_.data() + size_;
    }
    std::vector<std::uint32_t> storage_;
    std::size_t size_ = 0;
};

}  // namespace sss
