#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace trocar::base {

/// An open file descriptor of one's own. Every failing call is a Failure (74) that names the file
/// and says why. For one rank alone.
class Descriptor
{
 public:
  Descriptor() = default;
  /// `flags` as open(2) has them; links are never followed.
  Descriptor(const std::string& path, int flags);
  Descriptor(Descriptor&& other) noexcept
      : path_(std::move(other.path_)), number_(std::exchange(other.number_, -1))
  {
  }
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor();

  int number() const noexcept { return number_; }
  void write_at(std::uint64_t offset, std::string_view bytes) const;
  std::string read_at(std::uint64_t offset, std::size_t bytes) const;
  std::uint64_t size() const;
  void sync() const;
  void close();

 private:
  std::string path_;
  int number_ = -1;
};

/// Puts a file in place whole or not at all: into a temporary file of a name of its own, synced and
/// renamed. What was there is replaced, never written through. Throws Failure (74).
void replace_file(const std::string& path, std::string_view bytes);

/// What the names of these temporary files begin with; a run that is killed may leave one.
inline constexpr const char* temporary_prefix = ".trocar-";

/// fsync of a file or folder by name. Throws Failure (74).
void sync_to_disk(const std::string& path);

}  // namespace trocar::base
