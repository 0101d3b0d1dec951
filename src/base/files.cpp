#include "base/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/failure.hpp"

namespace trocar::base {
namespace {

core::Failure failure(const std::string& doing, const std::string& path, int reason = errno)
{
  return core::output_error("cannot " + doing + " " + path + ": " + std::strerror(reason));
}

/// Access rights of a new file under the umask of the user.
mode_t usual_mode()
{
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

}  // namespace

Descriptor::Descriptor(const std::string& path, int flags)
    : path_(path), number_(::open(path.c_str(), flags | O_NOFOLLOW | O_CLOEXEC, 0666))
{
  if (number_ < 0) throw failure("open", path_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept
{
  if (this == &other) return *this;
  if (number_ >= 0) ::close(number_);
  path_ = std::move(other.path_);
  number_ = std::exchange(other.number_, -1);
  return *this;
}

Descriptor::~Descriptor()
{
  if (number_ >= 0) ::close(number_);
}

void Descriptor::write_at(std::uint64_t offset, std::string_view bytes) const
{
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(number_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw failure("write", path_, written < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

std::string Descriptor::read_at(std::uint64_t offset, std::size_t bytes) const
{
  std::string text(bytes, '\0');
  for (std::size_t got = 0; got < bytes;) {
    const ssize_t more =
        ::pread(number_, text.data() + got, bytes - got, static_cast<off_t>(offset + got));
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) throw failure("read back", path_, more < 0 ? errno : EIO);
    got += static_cast<std::size_t>(more);
  }
  return text;
}

std::uint64_t Descriptor::size() const
{
  struct stat status
  {
  };
  if (::fstat(number_, &status) != 0) throw failure("look at", path_);
  return static_cast<std::uint64_t>(status.st_size);
}

void Descriptor::sync() const
{
  if (::fsync(number_) != 0) throw failure("sync", path_);
}

void Descriptor::close()
{
  if (::close(std::exchange(number_, -1)) != 0) throw failure("close", path_);
}

std::optional<std::string> contents_of(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  if (!stream || stream.bad()) return std::nullopt;
  return std::move(bytes).str();
}

void sync_to_disk(const std::string& path)
{
  const Descriptor file(path, O_RDONLY);
  file.sync();
}

void replace_file(const std::string& path, std::string_view bytes)
{
  const auto slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  std::string temporary = (slash == std::string::npos ? "" : folder) + temporary_prefix + "XXXXXX";
  const int number = ::mkstemp(temporary.data());  // creates the file, with O_EXCL
  if (number < 0) throw failure("write", path);
  ::close(number);
  try {
    Descriptor file(temporary, O_WRONLY);
    if (::fchmod(file.number(), usual_mode()) != 0) throw failure("write", path);
    file.write_at(0, bytes);
    file.sync();
    file.close();
    if (::rename(temporary.c_str(), path.c_str()) != 0) throw failure("put in place", path);
  } catch (const core::Failure&) {
    ::unlink(temporary.c_str());
    throw;
  }
  sync_to_disk(folder);
}

}  // namespace trocar::base
