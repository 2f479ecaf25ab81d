#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace sss {

/// Limits the threads that parallelFor uses while it lives; 0 = all cores.
class ThreadLimit {
public:
    explicit ThreadLimit(unsigned threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;
    /// Threads in force.
    static unsigned current();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Calls body(begin, end) on disjoint ranges that cover [0, count), each at most `grain` long and
/// starting at a multiple of `grain`, whatever the number of threads. For results that do not
/// depend on the threads, write only to places that belong to the range, and reduce per range in
/// order afterwards. A single range runs in the calling thread, which takes up no other work
/// meanwhile: code that holds what others wait for may call this with few enough items. The first
/// exception is rethrown.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace sss
