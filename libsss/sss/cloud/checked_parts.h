#pragma once
#include <atomic>
#include <cstddef>
#include <memory>

namespace sss {

/// Which parts of an array have been checked. A part is 2^shift elements and is checked when
/// somebody first needs one of them; after that it costs one load. Thread-safe: a part may be
/// checked by several at once, who come to the same.
class CheckedParts {
public:
    CheckedParts(std::size_t partCount, unsigned shift)
        : count_(partCount),
          shift_(shift),
          checked_(std::make_unique<std::atomic<bool>[]>(partCount)) {}

    /// Calls check(part), which throws at what is wrong, for parts that nobody has checked.
    template <typename Check>
    void need(std::size_t first, std::size_t count, const Check& check) const {
        if (count == 0) return;
        const std::size_t last = (first + count - 1) >> shift_;
        for (std::size_t part = first >> shift_; part <= last; ++part) {
            if (checked_[part].load(std::memory_order_acquire)) continue;
            check(part);
            checked_[part].store(true, std::memory_order_release);
        }
    }
    std::size_t partCount() const { return count_; }
    bool isChecked(std::size_t part) const {
        return checked_[part].load(std::memory_order_acquire);
    }

private:
    std::size_t count_;
    unsigned shift_;
    std::unique_ptr<std::atomic<bool>[]> checked_;
};

}  // namespace sss
