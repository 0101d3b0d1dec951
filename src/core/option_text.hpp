#pragma once

#include <string>
#include <vector>

namespace trocar::core {

/// An option as the user wrote it, with the words between it and the next option.
struct WrittenOption
{
  std::string name;  ///< without its dash
  std::vector<std::string> words;
  std::string place;  ///< "FILE:LINE", "PETSC_OPTIONS", or "" for the command line
};

/// Reads the text of an options file. A line holds any number of options, "#" begins a comment,
/// words with blanks stand in double quotes, and a byte-order mark is skipped. Throws Failure (64)
/// with file and line for words before the first option of a line, for quotes that do not end and
/// for null bytes.
std::vector<WrittenOption> parse_option_text(const std::string& text, const std::string& file);

/// Groups words into options. A word begins an option if a letter follows its dash, so that
/// negative numbers are values. Throws Failure (64) for words before the first option.
std::vector<WrittenOption> parse_option_words(const std::vector<std::string>& words,
                                              const std::string& place);

/// The words of an option as one value, "" when there are none. A comma at the end of a word or at
/// the start of the next word joins the two. Other words are joined by a comma if `spaces` is true
/// (cells of a vector), and are a Failure (64) if it is false.
std::string value_of(const WrittenOption& option, bool spaces);

/// "option -NAME (FILE:LINE)".
std::string label_of(const WrittenOption& option);

}  // namespace trocar::core
