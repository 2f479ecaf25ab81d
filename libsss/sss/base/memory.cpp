#include "sss/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace sss {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

// Version 2 of control groups, then version 1; "max" is no number and leaves `group` alone.
std::uint64_t readGroupLimit() {
    std::uint64_t limit = kNoLimit;
    for (const char* file :
         {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        std::uint64_t group = 0;
        if (std::ifstream(file) >> group && group > 0) limit = std::min(limit, group);
    }
    return limit;
}

}  // namespace

std::uint64_t memoryLimitBytes() {
    // Once: to open these files takes longer than to read a small mesh.
    static const std::uint64_t group = readGroupLimit();
    std::uint64_t limit = group;
    const long pages = sysconf(_SC_PHYS_PAGES), pageBytes = sysconf(_SC_PAGESIZE);
    if (pages > 0 && pageBytes > 0)
        limit = std::min(limit,
                         static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(pageBytes));
    rlimit own{};
    if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY)
        limit = std::min<std::uint64_t>(limit, own.rlim_cur);
    return limit;
}

}  // namespace sss
