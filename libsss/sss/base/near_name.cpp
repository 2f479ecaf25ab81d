#include "sss/base/near_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace sss {
namespace {

/// What is compared of a name.
std::string letters(std::string_view name) {
    std::string out;
    for (const char c : name) {
        if (c == '_' || c == '-' || c == ' ') continue;
        out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return out;
}

}  // namespace

// Lowrance & Wagner 1975, "An extension of the string-to-string correction problem". Row and
// column 0 hold "unreachable", row i + 1 and column j + 1 the prefixes of length i and j.
std::size_t editDistance(std::string_view a, std::string_view b) {
    const std::size_t unreachable = a.size() + b.size();
    const std::size_t width = b.size() + 2;
    std::vector<std::size_t> cost((a.size() + 2) * width, unreachable);
    const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& {
        return cost[i * width + j];
    };
    for (std::size_t i = 0; i <= a.size(); ++i) at(i + 1, 1) = i;
    for (std::size_t j = 0; j <= b.size(); ++j) at(1, j + 1) = j;

    std::array<std::size_t, 256> lastRowWith{};  // of each byte in a, 1-based
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t lastMatch = 0;  // column in this row where the bytes were equal
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t i1 = lastRowWith[static_cast<unsigned char>(b[j - 1])];
            const std::size_t j1 = lastMatch;
            const bool equal = a[i - 1] == b[j - 1];
            if (equal) lastMatch = j;
            const std::size_t replaced = at(i, j) + (equal ? 0 : 1);
            const std::size_t inserted = at(i + 1, j) + 1;
            const std::size_t deleted = at(i, j + 1) + 1;
            const std::size_t swapped = at(i1, j1) + (i - i1 - 1) + 1 + (j - j1 - 1);
            at(i + 1, j + 1) = std::min({replaced, inserted, deleted, swapped});
        }
        lastRowWith[static_cast<unsigned char>(a[i - 1])] = i;
    }
    return at(a.size() + 1, b.size() + 1);
}

std::string nearestName(std::string_view name, std::span<const std::string_view> candidates) {
    const std::string wanted = letters(name);
    std::string best;
    std::size_t bestDistance = 0;
    for (const std::string_view candidate : candidates) {
        const std::string offered = letters(candidate);
        const std::size_t longer = std::max(wanted.size(), offered.size());
        const std::size_t shorter = std::min(wanted.size(), offered.size());
        const std::size_t allowed = longer < 2 ? 0 : std::max<std::size_t>(1, longer / 3);
        // A name cut short is one slip.
        const bool cut = wanted.size() >= 3 && offered.starts_with(wanted);
        if (!cut && longer - shorter > allowed) continue;  // safe against endless names, too
        const std::size_t distance = cut ? longer != shorter : editDistance(wanted, offered);
        if (distance <= allowed && (best.empty() || distance < bestDistance)) {
            best = candidate;
            bestDistance = distance;
        }
    }
    return best;
}

std::string nameHint(std::string_view name, std::span<const std::string_view> candidates) {
    const std::string near = nearestName(name, candidates);
    if (!near.empty()) return fmt::format("did you mean {}?", inQuotes(near));
    std::string list;
    for (const std::string_view candidate : candidates) {
        list += (list.empty() ? "" : ", ") + inQuotes(candidate);
    }
    return "known: " + list;
}

std::string inQuotes(std::string_view text) {
    constexpr std::size_t kLongest = 60;
    std::string out = "\"";
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const bool startsCharacter = (byte & 0xC0u) != 0x80u;
        if (i >= kLongest && startsCharacter) return out + "...\"";
        if (byte < 0x20 || byte == 0x7F) {
            out += fmt::format("\\u{:04x}", byte);
        } else {
            out += text[i];
        }
    }
    return out + "\"";
}

}  // namespace sss
