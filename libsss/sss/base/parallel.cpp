#include "sss/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <thread>
#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#endif

namespace sss {

struct ThreadLimit::Impl {
    explicit Impl(std::size_t threads)
        : control(tbb::global_control::max_allowed_parallelism, threads) {}
    tbb::global_control control;  // registers its own address: it must never be moved
};

ThreadLimit::ThreadLimit(unsigned threads)
    : impl_(std::make_unique<Impl>(threads ? threads
                                           : std::max(1u, std::thread::hardware_concurrency()))) {}

ThreadLimit::~ThreadLimit() = default;

unsigned ThreadLimit::current() {
    return static_cast<unsigned>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

#ifdef __SANITIZE_THREAD__
namespace {

// Debian's TBB is not instrumented, so that the sanitizer would see neither how it hands work over
// nor how it waits, and call every result a race. These threads it understands.
void runChunks(std::size_t chunks, const std::function<void(std::size_t)>& body) {
    thread_local bool isNested = false;
    if (isNested) {
        for (std::size_t chunk = 0; chunk < chunks; ++chunk) body(chunk);
        return;
    }
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        isNested = true;
        try {
            for (std::size_t chunk; (chunk = next++) < chunks;) body(chunk);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            next = chunks;
        }
        isNested = false;
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < ThreadLimit::current(); ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace
#else
namespace {

void runChunks(std::size_t chunks, const std::function<void(std::size_t)>& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks, 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk)
                              body(chunk);
                      });
}

}  // namespace
#endif

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t chunks = (count - 1) / grain + 1;
    if (chunks == 1) {
        body(0, count);
        return;
    }
    runChunks(chunks, [&](std::size_t chunk) {
        body(chunk * grain, std::min(count, (chunk + 1) * grain));
    });
}

}  // namespace sss
