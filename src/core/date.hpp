#pragma once

#include <ctime>
#include <string>

namespace trocar::core {

/// The time now as "2026-11-28T12:00:00Z".
inline std::string utc_now()
{
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

}  // namespace trocar::core
