# sss_options: the only place for compiler flags. Every target of ours links it privately.
add_library(sss_options INTERFACE)
target_compile_options(sss_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align
  -Woverloaded-virtual -Werror
  # sqrt inlines to one instruction; values are the same.
  -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 sees overlaps and overflows in std::string and std::vector that are not there (its bugs
  # 105329 and 105651).
  target_compile_options(sss_options INTERFACE
    -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds -Wno-stringop-overread)
endif()
if(CMAKE_UNITY_BUILD)
  # Files that are compiled together are all headers to this warning.
  target_compile_options(sss_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
# SSS_ASSERT is on in every build but Release.
target_compile_definitions(sss_options INTERFACE $<$<NOT:$<CONFIG:Release>>:SSS_ASSERTIONS=1>)

# Empty, or the option for files that are optimised across their borders when a program is linked:
# only where it is known to help, and never under a sanitizer.
set(SSS_LINK_TIME_OPTIMISATION "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT SSS_SANITIZE)
  set(SSS_LINK_TIME_OPTIMISATION -flto=auto)
endif()

if(SSS_SANITIZE)
  target_compile_options(sss_options INTERFACE
    -fsanitize=${SSS_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    # The sanitizers' own instrumentation confuses this warning in GCC 12.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(sss_options INTERFACE -fsanitize=${SSS_SANITIZE})
  target_compile_definitions(sss_options INTERFACE SSS_SANITIZED=1)
endif()

find_program(SSS_CCACHE ccache)
if(SSS_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${SSS_CCACHE})
endif()

# sss_precompile(TARGET header...): the headers that most files of a target spend their time on. Tests
# always; the library only where SSS_PRECOMPILE says so, so that a missing include is seen.
function(sss_precompile target)
  sss_cache_precompiled(${target})
  target_precompile_headers(${target} PRIVATE
    <algorithm> <filesystem> <functional> <memory> <optional> <span> <string> <vector>
    <glm/glm.hpp> <fmt/format.h> ${ARGN})
endfunction()

# sss_precompile_as(OTHER TARGET): with the headers of another target, whose options are the same.
function(sss_precompile_as other target)
  sss_cache_precompiled(${target})
  target_precompile_headers(${target} REUSE_FROM ${other})
endfunction()

# ccache wants to know of precompiled headers.
function(sss_cache_precompiled target)
  if(SSS_CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess)
  endif()
endfunction()
