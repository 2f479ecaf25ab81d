#include "sss/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <thread>

namespace sss {

struct ThreadLimit::Impl {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(unsigned threads) {
    const unsigned count = threads ? threads : std::max(1u, std::thread::hardware_concurrency());
    impl_ = std::make_unique<Impl>(
        Impl{tbb::global_control(tbb::global_control::max_allowed_parallelism, count)});
}

ThreadLimit::~ThreadLimit() = default;

unsigned ThreadLimit::current() {
    return static_cast<unsigned>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t chunks = (count + grain - 1) / grain;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1), [&](const tbb::blocked_range<std::size_t>& r) {
            for (std::size_t chunk = r.begin(); chunk != r.end(); ++chunk)
                body(chunk * grain, std::min(count, (chunk + 1) * grain));
        });
}

}  // namespace sss
