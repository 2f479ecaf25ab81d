#pragma once
#include <cstddef>
#include <span>
#include <string_view>

namespace sss::stress {

/// A reader that is fed arbitrary bytes: what it accepts is checked, what it refuses must be
/// refused by an Error that names the file and a fault of it. Anything else ends the process.
struct FuzzTarget {
    std::string_view name;  ///< also the folder of its seeds in tests/stress/corpus
    void (*read)(std::span<const std::byte> input);
};

/// scene, cache, exitance, obj, ply, off, stl, exr.
std::span<const FuzzTarget> fuzzTargets();

/// nullptr if there is none of that name.
const FuzzTarget* findFuzzTarget(std::string_view name);

}  // namespace sss::stress
