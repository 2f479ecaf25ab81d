#include "sss/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace sss {

std::uint64_t memoryLimitBytes() {
    std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
    const long pages = sysconf(_SC_PHYS_PAGES), pageBytes = sysconf(_SC_PAGESIZE);
    if (pages > 0 && pageBytes > 0)
        limit = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(pageBytes);
    rlimit own{};
    if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY)
        limit = std::min<std::uint64_t>(limit, own.rlim_cur);
    // Version 2 of control groups, then version 1; "max" is no number and leaves `group` alone.
    for (const char* file :
         {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        std::uint64_t group = 0;
        if (std::ifstream(file) >> group && group > 0) limit = std::min(limit, group);
    }
    return limit;
}

}  // namespace sss
