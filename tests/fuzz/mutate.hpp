#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "core/failure.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

// What the fuzz targets share: changes of the kind that people, programs and disks make to files.
namespace trocar::fuzz {

using Random = std::minstd_rand;

inline std::size_t below(Random& random, std::size_t n)
{
  return n == 0 ? 0 : random() % n;
}

/// Numbers that break things and, as often, small ones that may mean something else.
inline std::string odd_number(Random& random)
{
  if (below(random, 2)) return std::to_string(below(random, 7));
  static const std::vector<std::string> numbers{"0",
                                                "-1",
                                                "1",
                                                "2147483647",
                                                "2147483648",
                                                "-2147483649",
                                                "4294967296",
                                                "1e9",
                                                "9223372036854775807",
                                                "9223372036854775808",
                                                "18446744073709551615",
                                                "1e308",
                                                "1e999",
                                                "-1e999",
                                                "1e-400",
                                                "nan",
                                                "inf",
                                                "0x10",
                                                "1.5",
                                                "",
                                                "1,5",
                                                "99999999999",
                                                "+3",
                                                "--3",
                                                "1e",
                                                "\xc2\xb2"};
  return numbers[below(random, numbers.size())];
}

inline std::vector<std::string> split_lines(const std::string& text)
{
  std::vector<std::string> lines{""};
  for (char c : text) {
    lines.back() += c;
    if (c == '\n') lines.emplace_back();
  }
  return lines;
}

inline std::string joined(const std::vector<std::string>& lines)
{
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

/// A word of the text becomes an odd number.
inline std::string change_word(const std::string& text, Random& random)
{
  std::vector<std::pair<std::size_t, std::size_t>> words;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t begin = text.find_first_not_of(" \n,=", i);
    if (begin == std::string::npos) break;
    const std::size_t end = std::min(text.find_first_of(" \n,=", begin), text.size());
    words.emplace_back(begin, end - begin);
    i = end;
  }
  if (words.empty()) return text;
  const auto [at, size] = words[below(random, words.size())];
  return text.substr(0, at) + odd_number(random) + text.substr(at + size);
}

/// Lines deleted, doubled, swapped; text cut off or with strange bytes inside.
inline std::string change_lines(const std::string& text, Random& random)
{
  std::vector<std::string> lines = split_lines(text);
  const std::size_t i = below(random, lines.size()), j = below(random, lines.size());
  switch (below(random, 5)) {
    case 0:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i));
      return joined(lines);
    case 1:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(i), lines[j]);
      return joined(lines);
    case 2:
      std::swap(lines[i], lines[j]);
      return joined(lines);
    case 3:
      return text.substr(0, below(random, text.size() + 1));
    default: {
      std::string changed = text;
      const std::size_t at = below(random, text.size() + 1);
      changed.insert(at, std::string(1 + below(random, 4), static_cast<char>(random() % 256)));
      return changed;
    }
  }
}

/// Four or eight bytes become a number that breaks things.
inline std::string change_bytes(const std::string& text, Random& random)
{
  static const std::vector<std::int64_t> numbers{0,
                                                 -1,
                                                 1,
                                                 2,
                                                 3,
                                                 1000,
                                                 2147483647,
                                                 -2147483648LL,
                                                 4294967296LL,
                                                 INT64_MAX,
                                                 INT64_MIN,
                                                 0x7ff8000000000000,
                                                 0x7ff0000000000000};
  std::string changed = text;
  const std::size_t width = below(random, 2) ? 8 : 4;
  if (text.size() < width + 1) return text;
  const std::int64_t value = numbers[below(random, numbers.size())];
  const std::size_t at = below(random, text.size() - width);
  for (std::size_t k = 0; k < width; ++k)
    changed[at + k] = static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * k));
  return changed;
}

/// The line must be one, without control characters.
inline void require_one_line(const core::Failure& failure, core::ExitCode code)
{
  const std::string line = failure.what();
  bool good = failure.code() == code && !line.empty() && line.size() < 100000;
  for (char c : line) good = good && static_cast<unsigned char>(c) >= 0x20;
  if (!good) __builtin_trap();
}

/// What became of the inputs; printed at the end.
struct Tally
{
  const char* name;
  std::uint64_t inputs = 0, past_header = 0, read = 0, accepted = 0;

  explicit Tally(const char* target) : name(target) {}
  ~Tally()
  {
    std::fprintf(
        stderr, "%s: %llu inputs, %.0f %% past the header, %.0f %% read, %.0f %% accepted\n", name,
        static_cast<unsigned long long>(inputs), part(past_header), part(read), part(accepted));
  }
  double part(std::uint64_t n) const
  {
    return inputs ? 100.0 * static_cast<double>(n) / static_cast<double>(inputs) : 0.0;
  }
};

/// The body of a custom mutator of texts: changes the input or, now and then, `scene`, or leaves
/// it to libFuzzer.
inline std::size_t mutate_text(const char* scene, std::uint8_t* data, std::size_t size,
                               std::size_t most, unsigned seed)
{
  Random random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (below(random, 4) == 0 || size < 5) text = scene;
  for (std::size_t changes = 1 + below(random, 3); changes > 0; --changes) {
    const std::size_t kind = below(random, 8);
    if (kind == 7) return LLVMFuzzerMutate(data, size, most);
    text = kind < 4 ? change_word(text, random) : change_lines(text, random);
  }
  text.resize(std::min(text.size(), most));
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

/// One input to a reader: it may be refused, with one line and the exit code of bad input. `work`
/// counts in the tally how far the input came.
template <class Work>
int tried(Tally& tally, core::ExitCode refused, const Work& work)
{
  ++tally.inputs;
  try {
    work();
  } catch (const core::Failure& failure) {
    require_one_line(failure, refused);
  }
  return 0;
}

}  // namespace trocar::fuzz
