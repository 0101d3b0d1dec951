#include "io/output_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/date.hpp"
#include "core/failure.hpp"
#include "io/checkpoint.hpp"

namespace trocar::io {
namespace {

namespace fs = std::filesystem;

std::string host()
{
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// Type of the file at a path. Links are not followed.
fs::file_type type_of(const std::string& path)
{
  std::error_code ignored;
  return fs::symlink_status(path, ignored).type();
}

/// The step number in a name step_NNNNNN.h5 of six digits or more; -1 for other names.
long long step_of(const std::string& name)
{
  const std::string begin = "step_", end = ".h5";
  if (name.size() < begin.size() + 6 + end.size() || name.rfind(begin, 0) != 0) return -1;
  if (name.compare(name.size() - end.size(), end.size(), end) != 0) return -1;
  const std::string digits = name.substr(begin.size(), name.size() - begin.size() - end.size());
  constexpr std::size_t most_digits = 18;
  if (digits.size() > most_digits) return -1;
  if (digits.find_first_not_of("0123456789") != std::string::npos) return -1;
  return std::stoll(digits);
}

bool names_temporary(const std::string& name)
{
  return name.rfind(base::temporary_prefix, 0) == 0 &&
         name.size() == std::strlen(base::temporary_prefix) + 6;
}

/// Removes the regular files of a folder whose names pass the test `ours`. Failure (74).
template <class Ours>
void remove_ours(const std::string& folder, const Ours& ours)
{
  std::error_code trouble;
  for (fs::directory_iterator at(folder, trouble), end; !trouble && at != end;
       at.increment(trouble))
    if (ours(at->path().filename().string()) && type_of(at->path()) == fs::file_type::regular)
      fs::remove(at->path(), trouble);
  if (trouble) throw core::output_error("cannot clear " + folder + ": " + trouble.message());
}

base::Descriptor opened(const std::string& lock)
{
  return {lock, O_RDWR | O_CREAT};
}

/// True while the path still leads to this open file.
bool is_at(const base::Descriptor& file, const std::string& path)
{
  using Status = struct stat;
  Status there{}, here{};
  return ::fstat(file.number(), &here) == 0 && ::lstat(path.c_str(), &there) == 0 &&
         there.st_ino == here.st_ino && there.st_dev == here.st_dev;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path) : path_(path)
{
  if (path.empty()) throw core::option_error("option -output_dir: the name of a folder is missing");
  std::error_code trouble;
  fs::create_directories(path_, trouble);
  if (trouble || !fs::is_directory(path_))
    throw core::output_error("cannot make folder " + path_ +
                             (trouble ? ": " + trouble.message() : ": a file has that name"));
  lock();
  refuse_strangers();
  if (type_of(path_ + "/fields") == fs::file_type::not_found) {
    fs::create_directory(path_ + "/fields", trouble);
    if (trouble) throw core::output_error("cannot make " + path_ + "/fields: " + trouble.message());
  }
}

OutputFolder::Lock::~Lock()
{
  if (file.number() >= 0 && is_at(file, path)) ::unlink(path.c_str());
}

/// Locks run.lock with flock(2). The kernel releases this lock when the process ends. The text in
/// the file is for people. Its host name also reveals a run on another host, whose kernel lock may
/// be invisible here.
void OutputFolder::lock()
{
  const std::string file = path_ + "/run.lock";
  if (type_of(file) != fs::file_type::not_found && type_of(file) != fs::file_type::regular)
    throw core::output_error(file + " is no file of ours");
  base::Descriptor mine = opened(file);
  bool have = ::flock(mine.number(), LOCK_EX | LOCK_NB) == 0;
  while (have && !is_at(mine, file)) {  // the last owner removed the file after it was opened here
    mine = opened(file);
    have = ::flock(mine.number(), LOCK_EX | LOCK_NB) == 0;
  }
  constexpr std::uint64_t longest = 1000;
  const std::string said =
      mine.read_at(0, static_cast<std::size_t>(std::min(mine.size(), longest)));
  const bool elsewhere = !said.empty() && said.rfind("host " + host() + "\n", 0) != 0;
  std::string words = said;
  for (char& c : words)
    if (c == '\n') c = ' ';
  if (!have || elsewhere)
    throw core::output_error("folder " + path_ + " belongs to a run (" + words +
                             (elsewhere ? "); if that is over, remove " + file : ")"));
  if (!said.empty()) remark_ = "the lock of a run that died was taken over (" + words + ")";
  const std::string text = "host " + host() + "\nprocess " + std::to_string(::getpid()) +
                           "\nsince " + core::utc_now() + "\n";
  if (::ftruncate(mine.number(), 0) != 0)
    throw core::output_error("cannot lock " + file + ": " + std::strerror(errno));
  mine.write_at(0, text);
  lock_.path = file;
  lock_.file = std::move(mine);
}

/// Throws Failure (74) when something else than a result of this program has the name of a result.
void OutputFolder::refuse_strangers() const
{
  const auto must_be = [&](const std::string& name, fs::file_type type) {
    const fs::file_type found = type_of(path_ + "/" + name);
    if (found != type && found != fs::file_type::not_found)
      throw core::output_error(path_ + "/" + name + " is a link or no result of this program: " +
                               "choose another -output_dir");
  };
  must_be("fields", fs::file_type::directory);
  must_be("run.h5", fs::file_type::regular);
  for (const char* name : {"run.xdmf", "checkpoint.txt", "checkpoint_a.h5", "checkpoint_b.h5"})
    must_be(name, fs::file_type::regular);
  const auto begins = [&](const std::string& name, const std::string& bytes) {
    if (type_of(path_ + "/" + name) == fs::file_type::not_found) return;
    std::ifstream stream(path_ + "/" + name, std::ios::binary);
    std::string found(bytes.size(), '\0');
    stream.read(found.data(), static_cast<std::streamsize>(found.size()));
    if (found != bytes)
      throw core::output_error(path_ + "/" + name +
                               " is no result of this program: choose another -output_dir");
  };
  begins("run.h5", "\x89HDF\r\n\x1a\n");
  begins("run.xdmf", "<?xml");
  begins("checkpoint.txt", "format trocar-checkpoint-");
  begins("checkpoint_a.h5", "\x89HDF\r\n\x1a\n");
  begins("checkpoint_b.h5", "\x89HDF\r\n\x1a\n");
}

void OutputFolder::clear() const
{
  // checkpoint.txt goes first: the run.h5 that its checkpoint needs has been replaced already.
  remove_ours(path_, [](const std::string& name) { return name == "checkpoint.txt"; });
  clear_after(-1);
  remove_ours(path_, [](const std::string& name) {
    return names_checkpoint(name) || name == "run.xdmf";  // the field files that it shows are gone
  });
}

void OutputFolder::clear_after(long long step) const
{
  remove_ours(path_, names_temporary);
  remove_ours(path_ + "/fields", names_temporary);
  remove_ours(path_ + "/fields", [step](const std::string& name) { return step_of(name) > step; });
}

}  // namespace trocar::io
