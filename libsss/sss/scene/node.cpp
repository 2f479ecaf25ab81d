#include "sss/scene/node.h"

#include "sss/base/error.h"
#include "sss/base/near_name.h"

#include <fmt/format.h>

#include <cmath>

namespace sss {
namespace {

/// As one would type it: 1e9, not 1000000000.
std::string typed(double number) {
    const double exponent = std::round(std::log10(std::abs(number)));
    const bool power =
        number != 0 && std::abs(exponent) >= 6 && std::abs(number) == std::pow(10.0, exponent);
    return power ? fmt::format("{}1e{}", number < 0 ? "-" : "", exponent)
                 : fmt::format("{}", number);
}

std::string described(const Range& range) {
    const std::string low = typed(range.low), high = typed(range.high);
    const bool bothIn = !range.lowOpen && !range.highOpen;
    std::string text = bothIn ? fmt::format("from {} to {}", low, high)
                              : fmt::format("{} {} and {} {}", range.lowOpen ? "above" : "at least",
                                            low, range.highOpen ? "below" : "at most", high);
    if (!range.unit.empty()) text += fmt::format(" {}", range.unit);
    return text;
}

/// The value as a message shows it: numbers and strings themselves, of the rest the kind.
std::string shown(const JsonValue& value) {
    if (value.isNumber()) return typed(value.asNumber());
    if (value.isString()) return inQuotes(value.asString());
    if (value.isArray()) {
        const std::size_t count = value.items().size();
        return count == 0 ? "empty" : fmt::format("an array of {}", count);
    }
    return std::string(value.kindName());
}

/// What stands in the node, and what should.
[[noreturn]] void failValue(const Node& node, const std::string& wanted) {
    fail(node, "is " + shown(node.value), "it must be " + wanted);
}

bool inside(double number, const Range& range) {
    return (range.lowOpen ? number > range.low : number >= range.low) &&
           (range.highOpen ? number < range.high : number <= range.high);
}

}  // namespace

void fail(const Node& node, JsonPlace place, const std::string& what, const std::string& hint) {
    throw Error(ErrorKind::BadInput,
                fmt::format("{}:{}:{}", node.context.file, place.line, place.column), what, hint);
}

void fail(const Node& node, const std::string& what, const std::string& hint) {
    fail(node, node.value.place, node.name + " " + what, hint);
}

double number(const Node& node, const Range& range) {
    if (!node.value.isNumber() || !inside(node.value.asNumber(), range)) {
        failValue(node, "a number " + described(range));
    }
    return node.value.asNumber();
}

double length(const Node& node, const Range& rangeInUnits) {
    return number(node, rangeInUnits) * node.context.mmPerUnit;
}

int wholeNumber(const Node& node, int low, int high) {
    const Range range{static_cast<double>(low), static_cast<double>(high)};
    const double value = node.value.isNumber() ? node.value.asNumber() : 0.5;
    if (value != std::trunc(value) || !inside(value, range)) {
        failValue(node, "a whole number " + described(range));
    }
    return static_cast<int>(value);
}

bool yesOrNo(const Node& node) {
    if (!node.value.isBool()) failValue(node, "true or false");
    return node.value.asBool();
}

const std::string& text(const Node& node) {
    if (!node.value.isString() || node.value.asString().empty()) {
        failValue(node, "a string that is not empty");
    }
    return node.value.asString();
}

std::size_t choice(const Node& node, std::span<const std::string_view> names) {
    const std::string& wanted = text(node);
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == wanted) return i;
    }
    fail(node, "is " + inQuotes(wanted), nameHint(wanted, names));
}

DRgb channels(const Node& node, const Range& range) {
    if (node.value.isNumber()) return DRgb(number(node, range));
    if (!node.value.isArray() || node.value.items().size() != 3) {
        failValue(node, fmt::format("a number or an array of 3 numbers [red, green, blue] {}",
                                    described(range)));
    }
    return vector(node, range);
}

Rgb rgb(const Node& node, const Range& range) { return Rgb(channels(node, range)); }

DVec3 vector(const Node& node, const Range& range) {
    if (!node.value.isArray() || node.value.items().size() != 3) {
        failValue(node, fmt::format("an array of 3 numbers {}", described(range)));
    }
    DVec3 out{0};
    const std::vector<Node> parts = entries(node, 3, 3);
    for (int i = 0; i < 3; ++i) out[i] = number(parts[static_cast<std::size_t>(i)], range);
    return out;
}

DVec3 point(const Node& node) { return vector(node, kCoordinateRange) * node.context.mmPerUnit; }

DVec3 direction(const Node& node) {
    const DVec3 out = vector(node, {-1e9, 1e9});
    if (glm::length(out) < 1e-9) fail(node, "has no length", "give a direction like [0, 1, 0]");
    return out;
}

std::filesystem::path filePath(const Node& node) {
    const std::filesystem::path path = text(node);
    return (path.is_absolute() ? path : node.context.folder / path).lexically_normal();
}

std::vector<Node> entries(const Node& node, std::size_t least, std::size_t most) {
    if (!node.value.isArray()) failValue(node, "an array");
    const JsonValue::Array& items = node.value.items();
    if (items.size() < least || items.size() > most) {
        failValue(node, least == most ? fmt::format("an array of {}", least)
                                      : fmt::format("an array of {} to {} entries", least, most));
    }
    std::vector<Node> out;
    out.reserve(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        out.push_back({items[i], fmt::format("{}[{}]", node.name, i), node.context});
    }
    return out;
}

}  // namespace sss
