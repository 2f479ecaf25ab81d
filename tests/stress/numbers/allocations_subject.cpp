// Replaces operator new of this program, to let a chosen allocation fail.
#include "numbers/passes.h"
#include "numbers/subjects.h"
#include "sss/app/stage_chain.h"
#include "sss/base/error.h"
#include "sss/image/exr_file.h"
#include "sss/integrate/cloud_cache.h"
#include "sss/scene/scene_reader.h"
#include "support/temporary_folder.h"
#include "unit/integrate/cache_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <functional>
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

// Not inlined into operator delete, where GCC 12 would see a new it does not know to be replaced
// end in std::free.
[[gnu::noinline]] void release(void* memory) noexcept { std::free(memory); }

}  // namespace

// All of them: an allocator of the standard library, or a sanitizer, may pair any two.
#ifdef __SANITIZE_ADDRESS__
// FLANN's search loses its working memory where an allocation of its own fails; Embree's scenes
// stay then (geom/ray_scene.cpp).
extern "C" const char* __lsan_default_suppressions() {
    return "leak:flann::NNIndex\nleak:libembree3\n";
}
#endif

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
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
    release(memory);
}

namespace sss::stress {
namespace {

// Allocations that are counted without any of them failing.
constexpr std::int64_t kMany = std::int64_t{1} << 40;

struct Outcome {
    bool isWritten = false, isOutOfMemory = false;
    std::string words;
};

/// Something that reads files and writes a cache, to be tried with one allocation after the other
/// failing.
struct Work {
    const char* name;
    std::function<void()> run;
    /// What is wrong with what it has left; empty if nothing is. Clears it away for the next try.
    std::function<std::string(bool isWritten)> complaint;
};

// The `nth` allocation of the work fails.
Outcome outcomeOf(const Work& work, std::int64_t nth) {
    const auto stop = [] { allocationsLeft = std::numeric_limits<std::int64_t>::max(); };
    try {
        allocationsLeft = nth;
        work.run();
        stop();
        return {.isWritten = true, .words = "written"};
    } catch (const std::bad_alloc&) {
        stop();
        return {.isOutOfMemory = true, .words = "bad_alloc"};
    } catch (const Error& error) {
        stop();
        return {.isOutOfMemory = error.kind() == ErrorKind::Resource, .words = error.what()};
    } catch (const std::exception& error) {
        stop();
        return {.words = fmt::format("an exception of no kind of ours: {}", error.what())};
    }
}

std::int64_t allocationsOf(const Work& work) {
    work.run();  // tables that are made once
    work.complaint(true);
    allocationsLeft = kMany;
    work.run();
    const std::int64_t used = kMany - allocationsLeft;
    allocationsLeft = std::numeric_limits<std::int64_t>::max();
    work.complaint(true);
    return used;
}

Row tried(const Work& work, std::int64_t mostTries) {
    Row row("memory", fmt::format("any allocation fails, {}", work.name), 0);
    const std::int64_t all = allocationsOf(work);
    const std::int64_t tries = std::min(all, mostTries);
    for (std::int64_t i = 0; i < tries; ++i) {
        // All, or dense at both ends: opening the scene, and writing the file.
        const std::int64_t nth = tries == all ? i
                                 : i % 3 == 0 ? i / 3
                                 : i % 3 == 1 ? all - 1 - i / 3
                                              : all * i / tries;
        const Outcome outcome = outcomeOf(work, nth);
        const std::string complaint = work.complaint(outcome.isWritten);
        // Threads share the count, so that the last ones may not come up; and what can do without
        // is free to.
        row.expect((outcome.isWritten || outcome.isOutOfMemory) && complaint.empty(), [&] {
            return fmt::format("allocation {} of {}: {}; {}", nth, all, outcome.words, complaint);
        });
    }
    return row;
}

// The old cache is there, or a new one, and nothing else.
std::function<std::string(bool)> oldOrNew(const std::filesystem::path& cache) {
    const auto filesBeside = [cache] {
        return std::distance(std::filesystem::directory_iterator(cache.parent_path()), {});
    };
    testing::writeFile(cache, "old");
    return [cache, filesBeside, before = filesBeside()](bool isWritten) -> std::string {
        const bool isOld = testing::readFile(cache) == "old";
        testing::writeFile(cache, "old");
        if (isOld == isWritten) return "the old cache is gone, or the new one is not there";
        return filesBeside() == before ? "" : "a file was left";
    };
}

// Whatever is in the folder is whole.
std::function<std::string(bool)> wholeStages(const std::filesystem::path& folder) {
    return [folder](bool /*isWritten*/) {
        std::string complaint;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().filename() == "lock") continue;
            try {
                CacheFile::open(entry.path()).checkAll();
            } catch (const Error& error) {
                complaint = error.what();
            }
        }
        std::filesystem::remove_all(folder);
        std::filesystem::create_directory(folder);
        return complaint;
    };
}

// A scene with one of each kind of file.
std::filesystem::path writeSceneFiles(const std::filesystem::path& folder) {
    testing::writeFile(folder / "box.obj",
                       "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    const float nodes[8] = {0, 0, 0, 0, 1, 1, 1, 1};
    testing::writeFile(folder / "fog.raw",
                       std::string(reinterpret_cast<const char*>(nodes), sizeof nodes));
    LayeredImage sky{32, 16, {}, {}};
    sky.layers = {{"", {"R", "G", "B"}, std::vector<float>(3 * sky.pixelCount(), 0.5f), false}};
    writeExr(folder / "sky.exr", sky);
    const std::filesystem::path scene = folder / "scene.json";
    testing::writeFile(scene, R"({
      "metersPerUnit": 0.001, "camera": {"position": [0, 0, 30], "lookAt": [0, 0, 0]},
      "quality": {"spacingMm": 2, "tolerance": 0.1, "bounces": 0, "irradianceSamples": 4},
      "materials": {"stone": {"type": "translucent", "medium": "Marble"}},
      "objects": [{"mesh": "box.obj", "material": "stone"}],
      "volumes": [{"shape": "box", "size": [20, 20, 20], "sigmaSPerMm": 0.01,
                   "grid": {"file": "fog.raw", "dimensions": [2, 2, 2]}}],
      "lights": [{"type": "environment", "map": "sky.exr"}]})");
    return scene;
}

void writePasses(const Scene& scene, const std::filesystem::path& cache) {
    const Passes passes(scene);
    testing::writeCache(cache, passes.world(), passes.optics(), passes.clouds(), passes.reports());
}

void makeStages(const Scene& scene, const std::filesystem::path& folder) {
    SilentReporter silent;
    RunStats stats("sss-stress");
    StageChain chain({.folder = folder, .limits = {}}, silent, stats);
    chain.prepare(std::make_shared<const World>(scene, silent), nullptr);
}

}  // namespace

void stressAllocations(Report& report, Scope scope) {
    const testing::TemporaryFolder ofBox, ofFiles, ofStages;
    testing::SceneMaker maker =
        bodyScene(BoxShape{DVec3(4)}, toMedium(*findMeasuredMedium("Marble")));
    maker.scene.quality.spacingMm = 2;
    const std::filesystem::path file = writeSceneFiles(ofFiles.path());
    const std::filesystem::path stages = ofStages / "stages";
    std::filesystem::create_directory(stages);
    const Work works[] = {
        {"pass 1: said so, old cache whole", [&] { writePasses(maker.scene, ofBox / "a.ssc"); },
         oldOrNew(ofBox / "a.ssc")},
        {"scene, mesh, sky, grid and pass 1: said so, old cache whole",
         [&] { writePasses(readScene(file), ofFiles / "a.ssc"); }, oldOrNew(ofFiles / "a.ssc")},
        {"a folder of stages: said so, what is there is whole",
         [&] { makeStages(maker.scene, stages); }, wholeStages(stages)},
    };
    // Nothing comes of these but an error, and they are quick enough for all of their allocations.
    const auto nothing = [](bool) { return std::string(); };
    const std::vector<UVec3> faces(4000, UVec3(0, 1, 2));
    const std::vector<Vec3> corners{Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    const RayScene::Geometry mesh{corners, faces};
    for (const Work& work :
         {Work{"reading a scene: said so", [&] { readScene(file); }, nothing},
          Work{"what rays may meet: said so", [&] { RayScene(std::span(&mesh, 1)); }, nothing}})
        report.add(tried(work, 3000));
    for (const Work& work : works) report.add(tried(work, scope == Scope::Full ? 1500 : 18));
}

}  // namespace sss::stress
