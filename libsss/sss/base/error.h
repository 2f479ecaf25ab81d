#pragma once
#include <stdexcept>
#include <string>

namespace sss {

/// What went wrong, by who can mend it. The value is the exit code of both programs.
enum class ErrorKind : int {
    Internal = 1,  ///< a bug of ours
    Usage = 2,     ///< command line
    BadInput = 3,  ///< scene, mesh, image or cache that cannot be used, or a stale cache
    Io = 4,        ///< a file that cannot be read or written
    Resource = 5,  ///< out of memory, or over a stated limit
    Strict = 6,    ///< finished, but with warnings under --strict
};

/// The one exception of the library, thrown only at its borders (readers, writers, options).
/// The message reads "WHERE: WHAT; HINT".
class Error : public std::runtime_error {
public:
    /// `where`: "file:line:col", "file@byte", "--option" or a module; `what` names the thing and
    /// its value; `hint` says what to do next (may be empty).
    Error(ErrorKind kind, std::string where, std::string what, std::string hint = {});

    ErrorKind kind() const { return kind_; }
    int exitCode() const { return static_cast<int>(kind_); }
    const std::string& where() const { return where_; }

private:
    ErrorKind kind_;
    std::string where_;
};

}  // namespace sss
