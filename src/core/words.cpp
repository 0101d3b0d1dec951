#include "core/words.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

namespace trocar::core {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

std::string_view trimmed(std::string_view text)
{
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Length of the UTF-8 character at the front of a text [bytes]. 0 if the front is no UTF-8, or a
/// control character, line separator or change of the writing direction.
std::size_t character(std::string_view text)
{
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  if (first == 0xc2 && byte(1) < 0xa0) return 0;  // control characters U+0080 to U+009F
  // U+2028 to U+202E and U+2066 to U+2069: line separators, changes of the writing direction.
  const bool turns = first == 0xe2 && ((byte(1) == 0x80 && byte(2) >= 0xa8 && byte(2) <= 0xae) ||
                                       (byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9));
  return turns ? 0 : length;
}

std::string escaped(char c)
{
  constexpr std::string_view digits = "0123456789abcdef";
  if (c == '\n') return "\\n";
  if (c == '\r') return "\\r";
  if (c == '\t') return "\\t";
  const auto byte = static_cast<unsigned char>(c);
  return {'\\', 'x', digits[byte >> 4], digits[byte & 15U]};
}

}  // namespace

std::string printable(std::string_view text, std::size_t most)
{
  std::vector<std::string> shown;
  while (!text.empty()) {
    const std::size_t length = character(text);
    shown.push_back(length > 0 ? std::string(text.substr(0, length)) : escaped(text.front()));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  std::string all;
  const std::size_t half = most / 2;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const bool cut = shown.size() > most && i >= half && i + half < shown.size();
    if (!cut) all += shown[i];
    if (cut && i == half) all += "...";
  }
  return all;
}

bool is_plain_name(std::string_view name)
{
  return !name.empty() && name != "." && name != ".." &&
         name.find_first_of("/<>&\"'\\") == std::string_view::npos &&
         printable(name, name.size()) == name;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates)
{
  std::string best;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates)
{
  const std::string best = nearest(word, candidates);
  return best.empty() ? std::string() : " (did you mean '" + best + "'?)";
}

std::string shown(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string join(const std::vector<std::string>& words, std::string_view separator)
{
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

std::string listed(const std::vector<long long>& tags, std::size_t most)
{
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(tags.size(), most); ++i)
    words.push_back(std::to_string(tags[i]));
  if (tags.size() > most) words.push_back("...");
  return join(words);
}

std::vector<std::string> split(std::string_view text, char separator)
{
  std::vector<std::string> pieces;
  if (trimmed(text).empty()) return pieces;
  while (true) {
    const auto end = text.find(separator);
    pieces.emplace_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return pieces;
    text.remove_prefix(end + 1);
  }
}

}  // namespace trocar::core
