// Replaces operator new of this program, to let a chosen allocation fail.
#include "numbers/passes.h"
#include "numbers/subjects.h"
#include "sss/base/error.h"
#include "sss/integrate/cloud_cache.h"
#include "support/temporary_folder.h"
#include "unit/integrate/cache_maker.h"

#include <fmt/format.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

// Allocations until one fails.
std::atomic<std::int64_t> allocationsLeft{std::numeric_limits<std::int64_t>::max()};

void* allocateOrNull(std::size_t bytes, std::size_t alignment) noexcept {
    if (allocationsLeft.fetch_sub(1, std::memory_order_relaxed) == 0) return nullptr;
    const std::size_t whole =
        (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
    return alignment <= alignof(std::max_align_t) ? std::malloc(whole)
                                                  : std::aligned_alloc(alignment, whole);
}

void* allocate(std::size_t bytes, std::size_t alignment) {
    void* const memory = allocateOrNull(bytes, alignment);
    if (!memory) throw std::bad_alloc();
    return memory;
}

std::size_t toSize(std::align_val_t alignment) { return static_cast<std::size_t>(alignment); }

}  // namespace

// All of them: an allocator of the standard library, or a sanitizer, may pair any two.
void* operator new(std::size_t bytes) { return allocate(bytes, 1); }
void* operator new[](std::size_t bytes) { return allocate(bytes, 1); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocate(bytes, toSize(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
    return allocate(bytes, toSize(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    return allocateOrNull(bytes, 1);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
    return allocateOrNull(bytes, 1);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    return allocateOrNull(bytes, toSize(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment,
                     const std::nothrow_t&) noexcept {
    return allocateOrNull(bytes, toSize(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    std::free(memory);
}

namespace sss::stress {
namespace {

struct Outcome {
    bool isWritten = false, isOutOfMemory = false;
    std::string words;
};

// Pass 1 and its cache, the `nth` allocation of which fails.
Outcome passOne(const Scene& scene, const std::filesystem::path& cache, std::int64_t nth) {
    const auto stop = [] { allocationsLeft = std::numeric_limits<std::int64_t>::max(); };
    try {
        allocationsLeft = nth;
        const Passes passes(scene);
        testing::writeCache(cache, passes.world(), passes.optics(), passes.clouds(),
                            passes.reports());
        stop();
        return {.isWritten = true, .words = "written"};
    } catch (const std::bad_alloc&) {
        stop();
        return {.isOutOfMemory = true, .words = "bad_alloc"};
    } catch (const Error& error) {
        stop();
        return {.isOutOfMemory = error.kind() == ErrorKind::Resource, .words = error.what()};
    }
}

std::int64_t allocationsOfPassOne(const Scene& scene, const std::filesystem::path& cache) {
    constexpr std::int64_t kMany = std::int64_t{1} << 40;
    allocationsLeft = kMany;
    const Passes passes(scene);
    testing::writeCache(cache, passes.world(), passes.optics(), passes.clouds(), passes.reports());
    const std::int64_t used = kMany - allocationsLeft;
    allocationsLeft = std::numeric_limits<std::int64_t>::max();
    return used;
}

}  // namespace

void stressAllocations(Report& report, Scope scope) {
    Row row("memory", "any allocation of pass 1 fails: said so, old cache whole", 0);
    const testing::TemporaryFolder folder;
    testing::SceneMaker maker =
        bodyScene(BoxShape{DVec3(4)}, toMedium(*findMeasuredMedium("Marble")));
    maker.scene.quality.spacingMm = 2;
    const std::int64_t all = allocationsOfPassOne(maker.scene, folder / "made.ssc");
    const std::int64_t tries = scope == Scope::Full ? std::min<std::int64_t>(all, 3000) : 60;
    testing::writeFile(folder / "old.ssc", "old");
    for (std::int64_t i = 0; i < tries; ++i) {
        // Dense at both ends: opening the scene, and writing the file.
        const std::int64_t nth = i % 3 == 0   ? i / 3
                                 : i % 3 == 1 ? all - 1 - i / 3
                                              : all * i / tries;
        const Outcome outcome = passOne(maker.scene, folder / "old.ssc", nth);
        const bool isKept = testing::readFile(folder / "old.ssc") == "old";
        const auto where = [&] {
            return fmt::format("allocation {} of {}: {}", nth, all, outcome.words);
        };
        // Threads share the count, so that the last ones may not come up.
        row.expect(outcome.isWritten ? !isKept : outcome.isOutOfMemory && isKept, where);
        row.expect(folder.fileCount() == 2, where);
        if (outcome.isWritten) testing::writeFile(folder / "old.ssc", "old");
    }
    report.add(row);
}

}  // namespace sss::stress
