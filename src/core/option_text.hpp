#pragma once

#include <string>
#include <vector>

namespace trocar::core {

/// An option as somebody wrote it, with the words behind it up to the next one.
struct WrittenOption
{
  std::string name;  ///< without its dash
  std::vector<std::string> words;
  std::string place;  ///< "FILE:LINE", or "" for what was given by hand
};

/// The options in the text of an options file: any number on a line, "#" begins a comment, words
/// with blanks stand in double quotes, a byte-order mark is passed over. Throws Failure (64), with
/// file and line, for words before the first option of a line and quotes that do not end.
std::vector<WrittenOption> parse_option_text(const std::string& text, const std::string& file);

/// The same of words that are told apart already. A dash before a digit begins no option.
std::vector<WrittenOption> parse_option_words(const std::vector<std::string>& words,
                                              const std::string& place);

/// The words as one value, "" when there are none. Several are one where commas join them or, with
/// `spaces`, as the cells of a vector; else the second is a Failure (64).
std::string value_of(const WrittenOption& option, bool spaces);

/// "option -NAME (FILE:LINE)".
std::string label_of(const WrittenOption& option);

}  // namespace trocar::core
