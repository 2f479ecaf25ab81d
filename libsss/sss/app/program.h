#pragma once
#include <functional>

namespace sss {

/// What a program does between its start and its exit; returns the exit code.
using ProgramBody = std::function<int(int argc, const char* const* argv)>;

/// Runs `body` and turns every way it can end into an exit code and at most one "ERROR ..." line on
/// stderr. The only catch of each main:
///   Error -> its kind's code · std::bad_alloc -> 5 · other exceptions -> 1 ·
///   standard output that cannot be written -> 4 (a reader that has left, as in "| head", is fine)
///   · SIGHUP, SIGINT, SIGTERM -> 129, 130, 143 at once, with all temporary files removed.
/// Signals that were ignored at the start (nohup) stay ignored. `name` is the program's file name.
int runProgram(const char* name, int argc, const char* const* argv, const ProgramBody& body);

}  // namespace sss
