#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trocar::base {

/// Owns one HDF5 identifier and closes it with its own close call.
class H5Id
{
 public:
  using Close = int (*)(std::int64_t);
  H5Id() = default;
  H5Id(std::int64_t id, Close close) : id_(id), close_(close) {}
  H5Id(H5Id&& other) noexcept;
  H5Id& operator=(H5Id&& other) noexcept;
  H5Id(const H5Id&) = delete;
  H5Id& operator=(const H5Id&) = delete;
  ~H5Id();
  std::int64_t get() const noexcept { return id_; }

 private:
  std::int64_t id_ = -1;
  Close close_ = nullptr;
};

/// One HDF5 file, used from one rank (serial access). Every failing call is a Failure (74)
/// naming the file. Paths are absolute inside the file; missing groups are made on the way.
class H5File
{
 public:
  static H5File create(const std::string& path);
  ~H5File() = default;
  H5File(H5File&&) noexcept = default;
  H5File& operator=(H5File&&) noexcept = default;

  /// Writes a dataset of shape (rows) when columns is 0, else (rows, columns), row-major.
  void write(const std::string& path, const std::vector<double>& values, std::size_t columns,
             const std::string& units);
  void write(const std::string& path, const std::vector<std::int64_t>& values, std::size_t columns,
             const std::string& units);
  void write_text(const std::string& path, const std::string& text);
  void write_words(const std::string& path, const std::vector<std::string>& words);

  void attribute(const std::string& path, const std::string& name, const std::string& value);
  void attribute(const std::string& path, const std::string& name, std::int64_t value);

  /// Makes an empty dataset of shape (0) or (0, columns) that grows row by row. All of them are
  /// made before the run starts: only then does a killed run leave a readable file (HDF5 1.10).
  void create_series(const std::string& path, std::size_t columns, const std::string& units);
  void append(const std::string& path, const std::vector<double>& row);

  void make_group(const std::string& path);
  void flush();
  /// Flushes, closes and fsyncs.
  void close();

 private:
  explicit H5File(std::string path, H5Id file) : path_(std::move(path)), file_(std::move(file)) {}
  H5Id checked(std::int64_t id, H5Id::Close close, const std::string& what) const;
  void check(int status, const std::string& what) const;
  H5Id open_object(const std::string& path) const;
  void write_block(const std::string& path, const void* values, std::int64_t type,
                   std::size_t count, std::size_t columns, const std::string& units);

  std::string path_;
  H5Id file_;
};

/// fsync of a file or folder by name. Throws Failure (74).
void sync_to_disk(const std::string& path);

}  // namespace trocar::base
