#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trocar::core {

/// The candidate with the smallest edit distance to `word`; empty when there is no candidate.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)" for the nearest candidate, or "" when there is none.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// A number with six significant digits: 1.5e-09, 0.08.
std::string shown(double value);

/// The words joined by `separator`.
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

/// The pieces of `text` between separators, blanks trimmed; an empty text has no pieces.
std::vector<std::string> split(std::string_view text, char separator);

}  // namespace trocar::core
