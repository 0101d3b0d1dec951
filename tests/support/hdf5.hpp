#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trocar::test {

/// A dataset of numbers as it stands in a file.
struct Dataset
{
  std::vector<std::size_t> shape;
  std::vector<double> values;  ///< row-major, integers included
  std::string units;
  bool integer = false;
};

/// Reads results back, by HDF5's own calls. Throws std::runtime_error for what is not there.
class H5Reader
{
 public:
  explicit H5Reader(const std::string& file);
  ~H5Reader();
  H5Reader(const H5Reader&) = delete;
  H5Reader& operator=(const H5Reader&) = delete;

  bool has(const std::string& path) const;  ///< of an object whose group is there
  Dataset dataset(const std::string& path) const;
  std::vector<std::string> words(const std::string& path) const;
  std::string text_attribute(const std::string& path, const std::string& name) const;
  std::int64_t count_attribute(const std::string& path, const std::string& name) const;

 private:
  std::int64_t file_;
};

}  // namespace trocar::test
