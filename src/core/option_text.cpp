#include "core/option_text.hpp"

#include <cctype>
#include <sstream>

#include "core/failure.hpp"
#include "core/words.hpp"

namespace trocar::core {
namespace {

bool names_option(const std::string& word)
{
  return word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1]));
}

Failure stray(const std::string& word, const std::string& place)
{
  const std::string where = place.empty() ? "" : place + ": ";
  return option_error(where + "'" + printable(word, 60) +
                      "' belongs to no option: options begin with one dash");
}

bool blank(char c)
{
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/// Words of a line. Double quotes keep blanks together and are removed. Only "" stays as it is: the
/// empty value of an option of type `names`.
std::vector<std::string> words_of(const std::string& line, const std::string& place)
{
  std::vector<std::string> words;
  for (std::size_t at = 0; at < line.size();) {
    if (blank(line[at])) {
      ++at;
      continue;
    }
    if (line[at] == '#') break;
    std::string word;
    if (line[at] == '"') {
      const std::size_t end = line.find('"', at + 1);
      if (end == std::string::npos) throw option_error(place + ": a quote does not end");
      word = line.substr(at + 1, end - at - 1);
      at = end + 1;
      if (word.empty()) word = "\"\"";
    } else {
      for (; at < line.size() && !blank(line[at]); ++at) word += line[at];
    }
    words.push_back(word);
  }
  return words;
}

}  // namespace

std::vector<WrittenOption> parse_option_words(const std::vector<std::string>& words,
                                              const std::string& place)
{
  std::vector<WrittenOption> options;
  for (const std::string& word : words) {
    if (names_option(word))
      options.push_back({word.substr(1), {}, place});
    else if (options.empty())
      throw stray(word, place);
    else
      options.back().words.push_back(word);
  }
  return options;
}

std::vector<WrittenOption> parse_option_text(const std::string& text, const std::string& file)
{
  const std::string mark = "\xef\xbb\xbf";
  std::istringstream lines(text.rfind(mark, 0) == 0 ? text.substr(mark.size()) : text);
  std::vector<WrittenOption> all;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string place = file + ":" + std::to_string(++number);
    if (line.find('\0') != std::string::npos) throw option_error(place + ": this is no text");
    for (WrittenOption& one : parse_option_words(words_of(line, place), place))
      all.push_back(std::move(one));
  }
  return all;
}

std::string value_of(const WrittenOption& option, bool spaces)
{
  std::string value;
  for (std::size_t i = 0; i < option.words.size(); ++i) {
    const std::string& word = option.words[i];
    const bool joined = value.empty() || value.back() == ',' || word.front() == ',';
    if (!joined && !spaces)
      throw option_error(label_of(option) + ": '" + printable(word, 60) + "' behind '" +
                         printable(value, 60) + "' belongs to nothing");
    value += (joined ? "" : ",") + word;
  }
  return value;
}

std::string label_of(const WrittenOption& option)
{
  return "option -" + printable(option.name, 60) +
         (option.place.empty() ? "" : " (" + option.place + ")");
}

}  // namespace trocar::core
