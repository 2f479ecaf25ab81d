#include "sss/base/error.h"

namespace sss {
namespace {

std::string sentence(const std::string& where, const std::string& what, const std::string& hint) {
    std::string text = where.empty() ? what : where + ": " + what;
    if (!hint.empty()) text += "; " + hint;
    return text;
}

}  // namespace

Error::Error(ErrorKind kind, std::string where, std::string what, std::string hint)
    : std::runtime_error(sentence(where, what, hint)), kind_(kind), where_(std::move(where)) {}

}  // namespace sss
