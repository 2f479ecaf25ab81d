#pragma once
#include <cstdint>

namespace sss {

/// What this process may take: the least of the machine's memory, the control group's limit
/// (containers) and the process's own (`ulimit -v`). Bytes.
std::uint64_t memoryLimitBytes();

}  // namespace sss
