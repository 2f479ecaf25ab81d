#include "sss/base/frame_list.h"

#include "sss/base/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <unordered_set>

namespace sss {
namespace {

constexpr int kLargestFrame = 999999;
constexpr std::size_t kMostFrames = 1000000;

/// A whole number at the start of `text`, taken off it.
std::optional<int> takeNumber(std::string_view& text) {
    int value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || std::abs(value) > kLargestFrame) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// "FIRST", or "FIRST-LAST" with a step of the kinds x, y or : behind it.
struct Range {
    int first = 0, last = 0, step = 1;
    char kind = 'x';
};

std::optional<Range> readRange(std::string_view text) {
    Range range;
    const auto first = takeNumber(text);
    if (!first) return {};
    range.first = range.last = *first;
    if (text.empty()) return range;
    if (text.front() != '-') return {};
    text.remove_prefix(1);
    const auto last = takeNumber(text);
    if (!last) return {};
    range.last = *last;
    if (text.empty()) return range.first <= range.last ? std::optional(range) : std::nullopt;
    range.kind = text.front();
    text.remove_prefix(1);
    const auto step = takeNumber(text);
    const bool isBackward = range.last < range.first;
    if (!step || !text.empty() || (range.kind != 'x' && range.kind != 'y' && range.kind != ':') ||
        *step == 0 || (*step < 0) != isBackward || (isBackward && range.kind != 'x'))
        return {};
    range.step = *step;
    return range;
}

std::vector<int> framesOf(const Range& range) {
    std::vector<int> frames;
    const auto count = static_cast<long>(range.last - range.first) / range.step;
    if (range.kind == 'x') {
        for (long i = 0; i <= count; ++i)
            frames.push_back(range.first + static_cast<int>(i) * range.step);
    } else if (range.kind == 'y') {
        for (int f = range.first; f <= range.last; ++f)
            if ((f - range.first) % range.step != 0) frames.push_back(f);
    } else {
        for (int step = range.step; step >= 1; step /= 2)  // repeated frames are dropped later
            for (int f = range.first; f <= range.last; f += step) frames.push_back(f);
    }
    return frames;
}

/// A place for the number in a name: where it begins, its length and its digits.
struct FrameField {
    std::size_t begin = 0, length = 0;
    int digits = 0;
};

std::optional<FrameField> nextField(std::string_view name, std::size_t from) {
    for (std::size_t i = from; i < name.size(); ++i) {
        if (name[i] == '#') {
            const std::size_t end = std::min(name.find_first_not_of('#', i), name.size());
            if (end - i >= 2) return FrameField{i, end - i, static_cast<int>(end - i)};
            continue;
        }
        if (name[i] != '%') continue;
        const std::size_t d = name.find_first_not_of("0123456789", i + 1);
        if (d == std::string_view::npos || name[d] != 'd' || d - i > 3) continue;
        int digits = 1;
        if (d > i + 1) std::from_chars(name.data() + i + 1, name.data() + d, digits);
        return FrameField{i, d + 1 - i, digits};
    }
    return {};
}

}  // namespace

std::vector<int> parseFrames(std::string_view text, const std::string& where) {
    std::vector<int> frames;
    std::unordered_set<int> seen;
    std::string_view rest = text;
    while (true) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const auto range = readRange(rest.substr(0, comma));
        if (!range)
            throw Error(ErrorKind::Usage, where,
                        fmt::format("\"{}\" does not name frames", rest.substr(0, comma)),
                        "write 7, 1-24, 1-100x2 or 10-1x-1, several with commas between");
        for (const int frame : framesOf(*range))
            if (seen.insert(frame).second) frames.push_back(frame);
        if (frames.size() > kMostFrames)
            throw Error(ErrorKind::Usage, where,
                        fmt::format("names more than {} frames", kMostFrames));
        if (comma == rest.size()) break;
        rest.remove_prefix(comma + 1);
    }
    if (frames.empty())
        throw Error(ErrorKind::Usage, where, fmt::format("\"{}\" names no frame", text));
    return frames;
}

bool hasFrameField(std::string_view name) { return nextField(name, 0).has_value(); }

std::string frameName(std::string_view name, int frame) {
    std::string out;
    std::size_t from = 0;
    while (const auto field = nextField(name, from)) {
        out += name.substr(from, field->begin - from);
        // As wide as the field whatever the sign, as printf does.
        out += fmt::format("{:0{}d}", frame, field->digits);
        from = field->begin + field->length;
    }
    return out += name.substr(from);
}

}  // namespace sss
