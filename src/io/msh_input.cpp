#include "io/msh_input.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/words.hpp"

namespace trocar::io {
namespace {

constexpr std::size_t window_bytes = std::size_t{1} << 20;
constexpr std::size_t longest_word = 256;  ///< limit for a number or the name of a section [B]

bool blank(char c)
{
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

std::uint64_t size_of(const std::string& file)
{
  namespace fs = std::filesystem;
  std::error_code trouble;
  const fs::file_status status = fs::status(file, trouble);
  if (!fs::exists(status))
    throw core::data_error(core::printable(file) +
                           ": no such mesh file (scripts/build makes those of meshes/)");
  if (!fs::is_regular_file(status))
    throw core::data_error(core::printable(file) + ": is no file that can be read as a mesh");
  const std::uint64_t bytes = fs::file_size(file, trouble);
  if (trouble) throw core::data_error(core::printable(file) + ": " + trouble.message());
  if (bytes == 0) throw core::data_error(core::printable(file) + ": the mesh file is empty");
  return bytes;
}

}  // namespace

MshInput::MshInput(const std::string& file) : file_(file), bytes_(size_of(file))
{
  stream_.reset(std::fopen(file.c_str(), "rb"));
  if (!stream_) throw core::data_error(core::printable(file) + ": " + std::strerror(errno));
  window_.resize(window_bytes);
  at_ = end_ = window_.data();
}

bool MshInput::fill(std::size_t bytes)
{
  if (ready() >= bytes) return true;
  const std::size_t kept = ready();
  taken_ += static_cast<std::uint64_t>(at_ - window_.data());
  std::memmove(window_.data(), at_, kept);
  char* const free = window_.data() + kept;
  const std::size_t got = std::fread(free, 1, window_.size() - kept, stream_.get());
  if (std::ferror(stream_.get())) throw failure(std::string("cannot be read: ") + strerror(errno));
  hash_.add({free, got});
  at_ = window_.data();
  end_ = free + got;
  return ready() >= bytes;
}

core::Failure MshInput::failure(const std::string& what) const
{
  const std::uint64_t byte = taken_ + static_cast<std::uint64_t>(at_ - window_.data());
  std::string place = core::printable(file_);
  place += binary_ ? ": byte " : ":";
  place += binary_ ? std::to_string(byte) : std::to_string(line_);
  if (!section_.empty()) place += ", in $" + core::printable(section_);
  return core::data_error(place + ": " + what);
}

bool MshInput::skip_blanks()
{
  for (;;) {
    for (; at_ != end_ && blank(*at_); ++at_) line_ += *at_ == '\n';
    if (at_ != end_) return true;
    if (!fill(1)) return false;
  }
}

/// The next word, without moving behind it. The view is valid until the next read.
std::string_view MshInput::field()
{
  if (!skip_blanks()) throw failure("the file ends here");
  if (ready() < longest_word) fill(longest_word);
  const char* word_end = at_;
  while (word_end != end_ && !blank(*word_end)) ++word_end;
  const std::string_view text(at_, static_cast<std::size_t>(word_end - at_));
  if (text.size() >= longest_word)
    throw failure("'" + core::printable(text.substr(0, 20)) + "...' is too long for a word");
  return text;
}

template <class Number>
Number MshInput::parsed(std::string_view text)
{
  const char* const begin = text.data() + (text.size() > 1 && text.front() == '+' ? 1 : 0);
  const char* const end = text.data() + text.size();
  Number value{};
  const auto [rest, trouble] = std::from_chars(begin, end, value);
  const bool large = trouble == std::errc::result_out_of_range;
  if (rest != end || (trouble != std::errc() && !large))
    throw failure("'" + core::printable(text) + "' is no " +
                  (std::is_integral_v<Number> ? "integer" : "number"));
  if constexpr (!std::is_integral_v<Number>)
    // Out of range: strtod gives about 0 for underflow and inf for overflow.
    if (large) value = std::strtod(std::string(text).c_str(), nullptr);
  if (large && (std::is_integral_v<Number> || std::isinf(static_cast<double>(value))))
    throw failure("'" + core::printable(text) + "' is too large");
  at_ += text.size();
  return value;
}

template <class Number>
Number MshInput::raw()
{
  if (ready() < sizeof(Number) && !fill(sizeof(Number))) throw failure("the file ends here");
  Number value;
  std::memcpy(&value, at_, sizeof value);
  at_ += sizeof value;
  return value;
}

std::int32_t MshInput::integer()
{
  return binary_ ? raw<std::int32_t>() : parsed<std::int32_t>(field());
}

std::int64_t MshInput::size()
{
  return binary_ ? raw<std::int64_t>() : parsed<std::int64_t>(field());
}

double MshInput::real()
{
  const double value = binary_ ? raw<double>() : parsed<double>(field());
  if (!std::isfinite(value)) throw failure("a coordinate is not finite");
  return value;
}

std::string MshInput::word()
{
  if (!skip_blanks()) return {};
  const std::string_view text = field();
  at_ += text.size();
  return std::string(text);
}

std::string MshInput::line()
{
  std::string text;
  while (fill(1) && *at_ != '\n') {
    text += *at_++;
    if (text.size() > window_bytes) throw failure("a line is too long");
  }
  if (!text.empty() && text.back() == '\r') text.pop_back();
  return text;
}

void MshInput::begin_bytes()
{
  if (line().find_first_not_of(" \t") != std::string::npos || !fill(1))
    throw failure("bytes must begin on a new line");
  ++at_;
  ++line_;
  binary_ = true;
}

std::string MshInput::begin_section()
{
  binary_ = false;
  section_.clear();
  const std::string name = word();
  if (name.empty()) return {};
  if (name.size() < 2 || name.front() != '$' || name.rfind("$End", 0) == 0)
    throw failure("'" + core::printable(name, 40) +
                  "' where a section of a Gmsh mesh must begin, such as $MeshFormat");
  const std::string rest = line();
  if (rest.find_first_not_of(" \t\r") != std::string::npos)
    throw failure("'" + core::printable(rest) + "' behind " + core::printable(name));
  section_ = name.substr(1);
  return section_;
}

void MshInput::end_section()
{
  binary_ = false;
  if (!skip_blanks()) throw failure("the file ends without $End" + core::printable(section_));
  const std::string_view found = field();
  if (found != "$End" + section_)
    throw failure("'" + core::printable(found) + "' where $End" + section_ + " is due");
  at_ += found.size();
}

void MshInput::skip_section()
{
  const std::string end = "$End" + section_;
  for (;;) {
    if (!fill(end.size())) throw failure("the file ends without $End" + core::printable(section_));
    const char* const dollar = static_cast<const char*>(std::memchr(at_, '$', ready()));
    const char* const next = dollar ? dollar : end_;
    for (; at_ != next; ++at_) line_ += *at_ == '\n';
    if (!dollar) continue;
    const bool here = fill(end.size() + 1) || fill(end.size());
    if (here && std::string_view(at_, end.size()) == end &&
        (ready() == end.size() || blank(at_[end.size()]))) {
      at_ += end.size();
      return;
    }
    ++at_;
  }
}

std::int64_t MshInput::count(std::int64_t value, std::size_t bytes_each) const
{
  const std::uint64_t used = taken_ + static_cast<std::uint64_t>(at_ - window_.data());
  const std::uint64_t left = bytes_ > used ? bytes_ - used : 0;
  if (value < 0 || static_cast<std::uint64_t>(value) > left / bytes_each)
    throw failure(std::to_string(value) + " of them are announced, and " + std::to_string(left) +
                  " bytes are left");
  return value;
}

}  // namespace trocar::io
