#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace trocar::base {

/// Owns an open file descriptor. Every call that fails throws Failure (74) with the name of the
/// file and the reason. Not collective.
class Descriptor
{
 public:
  Descriptor() = default;
  /// `flags`: those of open(2). A symbolic link at `path` is never followed.
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

/// All bytes of a file; nothing when it cannot be read.
std::optional<std::string> contents_of(const std::string& path);

/// Writes a file completely or not at all: writes a temporary file with a unique name, syncs it and
/// renames it to `path`. An old file or link at `path` is replaced, never written through. Throws
/// Failure (74).
void replace_file(const std::string& path, std::string_view bytes);

/// Prefix of the names of the temporary files of `replace_file`. A killed run may leave one behind.
inline constexpr const char* temporary_prefix = ".trocar-";

/// fsync of a file or folder by name. Throws Failure (74).
void sync_to_disk(const std::string& path);

}  // namespace trocar::base
