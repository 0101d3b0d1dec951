#pragma once

#include <cstdint>
#include <string>
#include <utility>
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

/// Byte offsets of a growing dataset in its file, for appending rows without the HDF5 library. The
/// values are written first and the number of rows last, so that an interruption leaves a readable
/// file.
struct SeriesPlace
{
  std::uint64_t data = 0;   ///< offset of the first value; rows are contiguous [B]
  std::uint64_t rows = 0;   ///< offset of the number of rows (64 bits) in the dataset's header [B]
  std::size_t columns = 1;  ///< values in a row
};

/// An HDF5 file in memory, used on one rank. Only the caller writes its bytes to the disk, so a
/// failing disk never interrupts the HDF5 library. Every call that fails throws Failure (74) with
/// the name of the file. Callers that read an input file catch it and throw Failure (65).
/// Paths are absolute inside the file, and missing groups on a path are created.
class H5File
{
 public:
  /// Makes an empty file in memory. `path` is only its name in messages.
  static H5File create(const std::string& path);
  /// Opens a file in memory with these bytes. `path` is only its name in messages.
  static H5File of_bytes(const std::string& path, std::string bytes);
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

  /// Makes a growing dataset of shape (1) when columns is 0, else (1, columns). Its first chunk has
  /// room for `room` rows.
  void create_series(const std::string& path, std::size_t columns, std::size_t room,
                     const std::string& units);
  /// Byte offsets of a dataset from `create_series`. `bytes`: the result of `bytes()`. Throws
  /// Failure (1) when the file has object headers of another format than expected.
  SeriesPlace series_place(const std::string& path, std::size_t columns,
                           const std::string& bytes) const;
  /// Offset of the value of a 64-bit attribute [B]. Arguments and Failure as in `series_place`.
  std::uint64_t attribute_place(const std::string& path, const std::string& name,
                                const std::string& bytes) const;

  void make_group(const std::string& path);
  /// Makes `path` a soft link to `target`, which need not exist yet.
  void link(const std::string& target, const std::string& path);
  /// Removes an object from the file.
  void remove(const std::string& path);
  /// Copies an object from another file, with its attributes and everything below it.
  void copy(const H5File& from, const std::string& path);
  /// Names of the objects in the root group.
  std::vector<std::string> top() const;

  bool has(const std::string& path) const;
  /// A dataset's values, row-major.
  std::vector<double> read_reals(const std::string& path) const;
  std::vector<std::int64_t> read_integers(const std::string& path) const;
  std::vector<std::string> read_words(const std::string& path) const;

  /// The file as it would be on disk.
  std::string bytes() const;

 private:
  explicit H5File(std::string path, H5Id file) : path_(std::move(path)), file_(std::move(file)) {}
  H5Id checked(std::int64_t id, H5Id::Close close, const std::string& what) const;
  void check(int status, const std::string& what) const;
  H5Id open_object(const std::string& path) const;
  template <class Number>
  std::vector<Number> read_block(const std::string& path, std::int64_t type) const;
  void write_block(const std::string& path, const void* values, std::int64_t type,
                   std::size_t count, std::size_t columns, const std::string& units);

  std::string path_;
  H5Id file_;
};

/// Throws Failure (70) when a value is not finite: no NaN may reach a result file. `where`: name of
/// the values in the message.
void refuse_nan(const std::vector<double>& values, const std::string& where);

}  // namespace trocar::base
