#include "sss/base/error.h"

namespace sss {
namespace {

std::string sentence(const std::string& where, std::string what, std::string hint) {
    std::string text = where.empty() ? std::move(what) : where + ": " + std::move(what);
    if (!hint.empty()) text += "; " + std::move(hint);
    return text;
}

}  // namespace

Error::Error(ErrorKind kind, std::string where, std::string what, std::string hint)
    : std::runtime_error(sentence(where, std::move(what), std::move(hint))),
      kind_(kind),
      where_(std::move(where)) {}

}  // namespace sss
