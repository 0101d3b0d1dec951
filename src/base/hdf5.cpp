#include "base/hdf5.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/failure.hpp"

namespace trocar::base {
namespace {

/// A NaN must never reach a result file: it is refused here, at the only door.
void refuse_nan(const std::vector<double>& values, const std::string& where)
{
  for (double value : values)
    if (!std::isfinite(value))
      throw core::solver_error("a value of " + where + " is not finite; it was not written");
}

}  // namespace

H5Id::H5Id(H5Id&& other) noexcept
    : id_(std::exchange(other.id_, -1)), close_(std::exchange(other.close_, nullptr))
{
}

H5Id& H5Id::operator=(H5Id&& other) noexcept
{
  if (this != &other) {
    if (id_ >= 0 && close_) close_(id_);
    id_ = std::exchange(other.id_, -1);
    close_ = std::exchange(other.close_, nullptr);
  }
  return *this;
}

H5Id::~H5Id()
{
  if (id_ >= 0 && close_) close_(id_);
}

H5Id H5File::checked(std::int64_t id, H5Id::Close close, const std::string& what) const
{
  if (id < 0) throw core::output_error("cannot write " + path_ + " (" + what + ")");
  return {id, close};
}

void H5File::check(int status, const std::string& what) const
{
  if (status < 0) throw core::output_error("cannot write " + path_ + " (" + what + ")");
}

H5File H5File::create(const std::string& path)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (id < 0) throw core::output_error("cannot write " + path + ": " + std::strerror(errno));
  return H5File(path, H5Id(id, H5Fclose));
}

H5Id H5File::open_object(const std::string& path) const
{
  return checked(H5Oopen(file_.get(), path.c_str(), H5P_DEFAULT), H5Oclose, path);
}

void H5File::write_block(const std::string& path, const void* values, std::int64_t type,
                         std::size_t count, std::size_t columns, const std::string& units)
{
  const hsize_t shape[2] = {columns ? count / columns : count, columns};
  const H5Id space = checked(H5Screate_simple(columns ? 2 : 1, shape, nullptr), H5Sclose, path);
  const H5Id links = checked(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
  check(H5Pset_create_intermediate_group(links.get(), 1), path);
  const H5Id set = checked(H5Dcreate2(file_.get(), path.c_str(), type, space.get(), links.get(),
                                      H5P_DEFAULT, H5P_DEFAULT),
                           H5Dclose, path);
  if (count > 0) check(H5Dwrite(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path);
  attribute(path, "units", units);
}

void H5File::write(const std::string& path, const std::vector<double>& values, std::size_t columns,
                   const std::string& units)
{
  refuse_nan(values, path);
  write_block(path, values.data(), H5T_NATIVE_DOUBLE, values.size(), columns, units);
}

void H5File::write(const std::string& path, const std::vector<std::int64_t>& values,
                   std::size_t columns, const std::string& units)
{
  write_block(path, values.data(), H5T_NATIVE_INT64, values.size(), columns, units);
}

void H5File::write_text(const std::string& path, const std::string& text)
{
  write_words(path, {text});
}

void H5File::write_words(const std::string& path, const std::vector<std::string>& words)
{
  const H5Id type = checked(H5Tcopy(H5T_C_S1), H5Tclose, path);
  check(H5Tset_size(type.get(), H5T_VARIABLE), path);
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), path);
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  write_block(path, pointers.data(), type.get(), words.size(), 0, "1");
}

void H5File::attribute(const std::string& path, const std::string& name, const std::string& value)
{
  const H5Id object = open_object(path);
  const H5Id type = checked(H5Tcopy(H5T_C_S1), H5Tclose, path);
  check(H5Tset_size(type.get(), std::max<std::size_t>(value.size(), 1)), path);
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), path);
  const H5Id space = checked(H5Screate(H5S_SCALAR), H5Sclose, path);
  const H5Id attribute = checked(
      H5Acreate2(object.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, path + "@" + name);
  check(H5Awrite(attribute.get(), type.get(), value.c_str()), path + "@" + name);
}

void H5File::attribute(const std::string& path, const std::string& name, std::int64_t value)
{
  const H5Id object = open_object(path);
  const bool present = H5Aexists(object.get(), name.c_str()) > 0;
  const H5Id space = checked(H5Screate(H5S_SCALAR), H5Sclose, path);
  const H5Id attribute = checked(present ? H5Aopen(object.get(), name.c_str(), H5P_DEFAULT)
                                         : H5Acreate2(object.get(), name.c_str(), H5T_NATIVE_INT64,
                                                      space.get(), H5P_DEFAULT, H5P_DEFAULT),
                                 H5Aclose, path + "@" + name);
  check(H5Awrite(attribute.get(), H5T_NATIVE_INT64, &value), path + "@" + name);
}

void H5File::create_series(const std::string& path, std::size_t columns, const std::string& units)
{
  const int rank = columns ? 2 : 1;
  const hsize_t none[2] = {0, columns};
  const hsize_t unlimited[2] = {H5S_UNLIMITED, columns};
  const hsize_t chunk[2] = {256, columns};
  const H5Id space = checked(H5Screate_simple(rank, none, unlimited), H5Sclose, path);
  const H5Id links = checked(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
  check(H5Pset_create_intermediate_group(links.get(), 1), path);
  const H5Id layout = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
  check(H5Pset_chunk(layout.get(), rank, chunk), path);
  {
    const H5Id set = checked(H5Dcreate2(file_.get(), path.c_str(), H5T_NATIVE_DOUBLE, space.get(),
                                        links.get(), layout.get(), H5P_DEFAULT),
                             H5Dclose, path);
  }
  attribute(path, "units", units);
}

void H5File::append(const std::string& path, const std::vector<double>& row)
{
  refuse_nan(row, path);
  const H5Id set = checked(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, path);
  H5Id space = checked(H5Dget_space(set.get()), H5Sclose, path);
  hsize_t shape[2] = {0, 0};
  const int rank = H5Sget_simple_extent_dims(space.get(), shape, nullptr);
  const hsize_t start[2] = {shape[0], 0};
  const hsize_t count[2] = {1, row.size()};
  ++shape[0];
  check(H5Dset_extent(set.get(), shape), path);
  space = checked(H5Dget_space(set.get()), H5Sclose, path);
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, count, nullptr), path);
  const H5Id memory = checked(H5Screate_simple(rank, count, nullptr), H5Sclose, path);
  check(H5Dwrite(set.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, row.data()),
        path);
}

void H5File::make_group(const std::string& path)
{
  const H5Id links = checked(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
  check(H5Pset_create_intermediate_group(links.get(), 1), path);
  checked(H5Gcreate2(file_.get(), path.c_str(), links.get(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
          path);
}

void H5File::flush()
{
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "flush");
}

void H5File::close()
{
  flush();
  file_ = H5Id();
  sync_to_disk(path_);
}

void sync_to_disk(const std::string& path)
{
  const int descriptor = ::open(path.c_str(), O_RDONLY);
  const bool failed = descriptor < 0 || ::fsync(descriptor) != 0;
  const std::string why = std::strerror(errno);
  if (descriptor >= 0) ::close(descriptor);
  if (failed) throw core::output_error("cannot sync " + path + ": " + why);
}

}  // namespace trocar::base
