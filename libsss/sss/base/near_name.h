#pragma once
#include <span>
#include <string>
#include <string_view>

namespace sss {

/// Edits that turn `a` into `b`: insertions, deletions, replacements and swaps of neighbours, each
/// counting 1 (Damerau-Levenshtein, with edits between the swapped letters allowed).
std::size_t editDistance(std::string_view a, std::string_view b);

/// The candidate that `name` was most probably meant to be, or empty if none is near: at most a
/// third of the letters differ, or it is cut short. Upper and lower case, '_', '-' and blanks do
/// not count. Of equally near candidates the first wins.
std::string nearestName(std::string_view name, std::span<const std::string_view> candidates);

/// `did you mean "x"?` if there is a near candidate, otherwise `known: "a", "b", ...`.
std::string nameHint(std::string_view name, std::span<const std::string_view> candidates);

/// `text` in quotation marks for a message: control characters escaped, cut when long.
std::string inQuotes(std::string_view text);

}  // namespace sss
