#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/results.hpp"

// What tests of result files share.
namespace trocar::io {

namespace fs = std::filesystem;

/// Runs on rank 0 alone, where results live, with the folder gone before.
inline void with_results(const std::string& folder, const mesh::Mesh& mesh,
                         const std::function<void(Results&)>& work)
{
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all(folder);
    Results results(folder, mesh, {{{"program", "a test"}}, {{"options/name", {"b", "a"}}}},
                    {{"time", 0, "s"}, {"needle/tip", 3, "m"}});
    work(results);
    results.close();
  });
}

inline std::vector<std::string> files_of(const std::string& folder)
{
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

inline std::vector<double> as_numbers(const std::vector<core::Vec3>& points)
{
  std::vector<double> numbers;
  for (const core::Vec3& x : points) numbers.insert(numbers.end(), x.data(), x.data() + 3);
  return numbers;
}

/// How often a text stands in another.
inline int count(const std::string& text, const std::string& piece)
{
  int found = 0;
  for (auto at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) ++found;
  return found;
}

}  // namespace trocar::io
