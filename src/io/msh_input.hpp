#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/failure.hpp"
#include "core/fnv.hpp"

namespace trocar::io {

/// Reads a Gmsh file from front to back through a moving window. Fields are words, or, after
/// `begin_bytes`, binary numbers in the byte order of this machine. Anything malformed is a Failure
/// (65) that names the section and the line, or the byte in binary parts. Use on one rank only.
class MshInput
{
 public:
  /// Throws Failure (65) when the file does not exist, is not a regular file or is empty.
  explicit MshInput(const std::string& file);

  /// The next fields of the section are binary. They begin on the next line.
  void begin_bytes();
  std::int32_t integer();
  std::int64_t size();  ///< reads 64 bits: a count, or the tag of a node or element
  double real();        ///< Failure (65) when the number is not finite

  /// The next word as text, in binary parts too; empty at the end of the file.
  std::string word();
  /// The rest of the line as text. Stops before the newline.
  std::string line();

  /// Reads the head of a section, such as "$Nodes". Returns the name without the dollar; empty at
  /// the end of the file.
  std::string begin_section();
  /// Reads the word that ends the section, such as "$EndNodes". Failure (65) for another word.
  void end_section();
  /// Skips everything up to the word that ends the section, and this word.
  void skip_section();

  /// Returns `value`, the announced number of items of at least `bytes_each` bytes each. Failure
  /// (65) when the rest of the file is too small for them.
  std::int64_t count(std::int64_t value, std::size_t bytes_each) const;

  core::Failure failure(const std::string& what) const;
  std::string hash() const { return hash_.hex(); }  ///< FNV-1a of the bytes read so far

 private:
  std::size_t ready() const { return static_cast<std::size_t>(end_ - at_); }
  bool fill(std::size_t bytes);  ///< tries to have so many bytes ready; false when fewer are left
  bool skip_blanks();            ///< false at the end of the file
  std::string_view field();
  template <class Number>
  Number parsed(std::string_view text);
  template <class Number>
  Number raw();

  struct Close
  {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  std::string file_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::vector<char> window_;
  const char* at_ = nullptr;
  const char* end_ = nullptr;
  core::Fnv1a hash_{};
  std::uint64_t bytes_ = 0, taken_ = 0;  ///< size of the file; bytes before the window
  long long line_ = 1;
  bool binary_ = false;
  std::string section_;
};

}  // namespace trocar::io
