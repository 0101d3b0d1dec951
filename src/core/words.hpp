#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trocar::core {

/// The candidate with the smallest edit distance to `word`; empty when there is no candidate.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)" for the nearest candidate, or "" when there is none.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// The text as a message may show it. Control characters, line separators, changes of the writing
/// direction and bytes that are not UTF-8 are escaped ("\n", "\x1b"). A text of more than `most`
/// characters is cut in its middle.
std::string printable(std::string_view text, std::size_t most = 200);

/// Whether `name` can name a thing in paths and in XML: it is not empty, "." or "..", and has no
/// control characters, quotes or any of / \ < > &.
bool is_plain_name(std::string_view name);

/// A number with at most six significant digits: 1.5e-09, 0.08.
std::string shown(double value);

/// The words joined by `separator`.
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

/// The first `most` tags, and "..." if there are more: "3, 7, 12, ...".
std::string listed(const std::vector<long long>& tags, std::size_t most = 5);

/// The pieces of `text` between separators, blanks trimmed; an empty text has no pieces.
std::vector<std::string> split(std::string_view text, char separator);

}  // namespace trocar::core
