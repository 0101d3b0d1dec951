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

/// A Gmsh file from front to back, through a window that moves: its fields are words, or after
/// `begin_bytes` bytes of this machine's order. What is not as it must be is a Failure (65) that
/// names the line, in binary parts the byte, and the section. For one rank alone.
class MshInput
{
 public:
  /// Failure (65) where there is no such file, or none that ends.
  explicit MshInput(const std::string& file);

  /// The next fields of the section are bytes; they begin on the next line.
  void begin_bytes();
  std::int32_t integer();
  std::int64_t size();  ///< counts and tags of nodes and elements
  double real();        ///< finite

  /// The next word as text, whatever the fields are; empty at the end of the file.
  std::string word();
  /// The rest of the line as text; its end is still to come.
  std::string line();

  /// The next word is a section's name, "$Nodes": without the dollar; empty at the end.
  std::string begin_section();
  /// The word that ends it must follow.
  void end_section();
  /// Moves on behind the word that ends it.
  void skip_section();

  /// A count of what takes at least so many bytes each: no larger than what is left can hold.
  std::int64_t count(std::int64_t value, std::size_t bytes_each) const;

  core::Failure failure(const std::string& what) const;
  std::string hash() const { return hash_.hex(); }  ///< FNV-1a of the bytes looked at

 private:
  std::size_t ready() const { return static_cast<std::size_t>(end_ - at_); }
  bool fill(std::size_t bytes);  ///< false: fewer are left
  bool skip_blanks();            ///< false at the end
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
  std::uint64_t bytes_ = 0, taken_ = 0;  ///< bytes of the file, and in earlier windows
  long long line_ = 1;
  bool binary_ = false;
  std::string section_;
};

}  // namespace trocar::io
