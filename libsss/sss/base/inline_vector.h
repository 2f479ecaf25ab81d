#pragma once
#include "sss/base/assert.h"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace sss {

/// A list of at most `N` elements without memory of its own elsewhere. Unlike a std::array, it does
/// not set elements that are not used, which in inner loops costs more than using some.
template <typename T, std::size_t N>
class InlineVector {
    static_assert(std::is_trivially_destructible_v<T>);

public:
    InlineVector() = default;
    InlineVector(const InlineVector&) = delete;  // elements may point at each other
    InlineVector& operator=(const InlineVector&) = delete;

    template <typename... Arguments>
    T& add(Arguments&&... arguments) {
        SSS_ASSERT_LT(size_, N);
        return *std::construct_at(begin() + size_++, std::forward<Arguments>(arguments)...);
    }
    std::size_t size() const { return size_; }
    T* begin() { return reinterpret_cast<T*>(bytes_.data()); }
    T* end() { return begin() + size_; }
    T& operator[](std::size_t i) {
        SSS_ASSERT_LT(i, size_);
        return begin()[i];
    }
    std::span<T> span() { return {begin(), size_}; }

private:
    alignas(T) std::array<std::byte, sizeof(T[N])> bytes_;
    std::size_t size_ = 0;
};

}  // namespace sss
