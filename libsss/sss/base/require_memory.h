#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace sss {

/// For what is large and known before it is allocated: throws Error{Resource} "WHERE: WHAT would
/// need B GB of memory; there are B GB; HINT" if it is more than memoryLimitBytes().
void requireMemory(const std::string& where, std::string_view what, std::uint64_t bytes,
                   const std::string& hint);

/// Whether an error of another library, which comes as words only, is a failed allocation (of a
/// thread's stack, too).
bool saysOutOfMemory(std::string_view words);

}  // namespace sss
