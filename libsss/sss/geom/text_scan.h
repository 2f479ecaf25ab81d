#pragma once
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>

// Cutting text into lines, tokens and numbers without copying or allocating.
namespace sss {

inline bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Cuts the next token off `rest`; empty at its end.
inline std::string_view cutToken(std::string_view& rest) {
    while (!rest.empty() && isBlank(rest.front())) rest.remove_prefix(1);
    std::size_t length = 0;
    while (length < rest.size() && !isBlank(rest[length])) ++length;
    const std::string_view token = rest.substr(0, length);
    rest.remove_prefix(length);
    return token;
}

/// Cuts the next line off `rest`, without its end.
inline std::string_view cutLine(std::string_view& rest) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return line;
}

/// The whole token as a number ("nan" and "inf" included; infinite if out of a double's range), or
/// nothing.
inline std::optional<double> parseNumber(std::string_view token) {
    if (!token.empty() && token.front() == '+') token.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (end != token.data() + token.size() || token.empty()) return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        // Too large or too small: only the latter has a negative exponent.
        const bool tiny = token.find("e-") != token.npos || token.find("E-") != token.npos;
        return tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return error == std::errc{} ? std::optional(value) : std::nullopt;
}

/// The whole token as an integer that fits, or nothing.
inline std::optional<long long> parseInteger(std::string_view token) {
    if (!token.empty() && token.front() == '+') token.remove_prefix(1);
    long long value = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc{} || end != token.data() + token.size()) return std::nullopt;
    return value;
}

}  // namespace sss
