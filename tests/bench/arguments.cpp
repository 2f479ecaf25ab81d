#include "arguments.h"

#include "sss/base/error.h"

#include <charconv>
#include <cmath>

namespace sss::bench {
namespace {

constexpr const char* kUsage =
    "see tests/bench/README.md; tests/bench/run.py is the way to call it";

[[noreturn]] void usage(const std::string& where, const std::string& what) {
    throw Error(ErrorKind::Usage, where, what, kUsage);
}

double parseNumber(std::string_view name, std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        usage("--" + std::string(name), "\"" + std::string(text) + "\" is not a number");
    return value;
}

}  // namespace

Arguments::Arguments(int argc, const char* const* argv) {
    if (argc < 2) usage("command line", "no subject given");
    subject_ = argv[1];
    int i = 2;
    if (i < argc && !std::string_view(argv[i]).starts_with("--")) scene_ = argv[i++];
    for (; i < argc; i += 2) {
        const std::string_view name = argv[i];
        if (!name.starts_with("--")) usage(std::string(name), "not an option");
        if (i + 1 == argc) usage(std::string(name), "has no value");
        options_[std::string(name.substr(2))] = {argv[i + 1]};
    }
}

const std::string* Arguments::find(std::string_view name) const {
    const auto found = options_.find(name);
    if (found == options_.end()) return nullptr;
    found->second.asked = true;
    return &found->second.value;
}

double Arguments::number(std::string_view name, double otherwise) const {
    const std::string* value = find(name);
    return value == nullptr ? otherwise : parseNumber(name, *value);
}

std::vector<double> Arguments::numbers(std::string_view name,
                                       const std::vector<double>& otherwise) const {
    const std::string* value = find(name);
    if (value == nullptr) return otherwise;
    std::vector<double> list;
    for (std::size_t begin = 0; begin <= value->size();) {
        const std::size_t end = std::min(value->find(',', begin), value->size());
        list.push_back(parseNumber(name, std::string_view(*value).substr(begin, end - begin)));
        begin = end + 1;
    }
    return list;
}

std::string Arguments::text(std::string_view name) const {
    const std::string* value = find(name);
    if (value == nullptr) usage("--" + std::string(name), "is missing");
    return *value;
}

void Arguments::check() const {
    for (const auto& [name, option] : options_)
        if (!option.asked) usage("--" + name, "is not an option of " + subject_);
}

}  // namespace sss::bench
