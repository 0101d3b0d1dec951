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

/// Where the bytes of a growing dataset are in the file: rows can be added without the library, in
/// an order that leaves the file readable whatever happens in between.
struct SeriesPlace
{
  std::uint64_t data = 0;   ///< first value, rows one behind the other [B]
  std::uint64_t rows = 0;   ///< number of rows, 64 bits, in the dataset's header [B]
  std::size_t columns = 1;  ///< values in a row
};

/// One HDF5 file in memory, used from one rank: nothing is on disk before its bytes are written
/// there, so that no disk can fail the library. Every failing call is a Failure (74) naming the
/// file; who reads makes one of its own of it. Paths are absolute inside the file; missing groups
/// are made on the way.
class H5File
{
 public:
  /// An empty file; `path` is what messages call it.
  static H5File create(const std::string& path);
  /// The file with these bytes.
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

  /// Makes a dataset of shape (1) or (1, columns) with room for so many rows, all in one chunk.
  void create_series(const std::string& path, std::size_t columns, std::size_t room,
                     const std::string& units);
  /// `bytes`: those of this file.
  SeriesPlace series_place(const std::string& path, std::size_t columns,
                           const std::string& bytes) const;
  /// Where the value of a 64-bit attribute is [B].
  std::uint64_t attribute_place(const std::string& path, const std::string& name,
                                const std::string& bytes) const;

  void make_group(const std::string& path);
  /// Makes `path` a soft link to `target`, which need not exist yet.
  void link(const std::string& target, const std::string& path);
  /// Takes an object out of the file.
  void remove(const std::string& path);
  /// Copies an object with all below it from another file, and its attributes.
  void copy(const H5File& from, const std::string& path);
  /// Names of what is at the top.
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

/// The value must be finite: a NaN must never reach a result file. Throws Failure (70).
void refuse_nan(const std::vector<double>& values, const std::string& where);

}  // namespace trocar::base
