#pragma once

#include <cstdint>
#include <iomanip>
#include <sstream>
#include <string>
#include <string_view>

namespace trocar::core {

/// FNV-1a hash of 64 bits (Fowler, Noll, Vo). It distinguishes files and detects accidental damage,
/// but not a deliberate change. A single wrong byte always changes the hash.
struct Fnv1a
{
  std::uint64_t value = 14695981039346656037ULL;

  void add(std::string_view bytes)
  {
    for (const char c : bytes)
      value = (value ^ static_cast<unsigned char>(c)) * std::uint64_t{1099511628211ULL};
  }
  std::string hex() const
  {
    std::ostringstream text;
    text << std::hex << std::setw(16) << std::setfill('0') << value;
    return text.str();
  }
};

inline std::string fnv1a(std::string_view bytes)
{
  Fnv1a hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace trocar::core
