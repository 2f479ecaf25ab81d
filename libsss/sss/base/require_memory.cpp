#include "sss/base/require_memory.h"

#include "sss/base/error.h"
#include "sss/base/memory.h"

#include <fmt/core.h>

namespace sss {

void requireMemory(const std::string& where, std::string_view what, std::uint64_t bytes,
                   const std::string& hint) {
    const std::uint64_t limit = memoryLimitBytes();
    if (bytes <= limit) return;
    throw Error(ErrorKind::Resource, where,
                fmt::format("{} would need {:.3g} GB of memory; there are {:.3g} GB", what,
                            1e-9 * static_cast<double>(bytes), 1e-9 * static_cast<double>(limit)),
                hint);
}

bool saysOutOfMemory(std::string_view words) {
    // C++ itself and Embree, libpng, zlib; Embree where there is no room for a thread's stack.
    for (const std::string_view sign : {"bad_alloc", "out of memory", "Out of memory",
                                        "insufficient memory", "pthread_create has failed"})
        if (words.find(sign) != words.npos) return true;
    return false;
}

}  // namespace sss
