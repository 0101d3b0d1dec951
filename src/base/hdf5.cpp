#include "base/hdf5.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/failure.hpp"

namespace trocar::base {
namespace {

/// HDF5 enlarges a file in memory by this much at a time [B].
constexpr std::size_t growth = std::size_t{1} << 16;

H5Id in_memory()
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (access.get() < 0 || H5Pset_fapl_core(access.get(), growth, 0) < 0)
    throw core::Failure(core::ExitCode::internal, "HDF5 cannot keep a file in memory");
  return access;
}

/// A unique name, because HDF5 identifies open files in memory by their names.
std::string name_of_its_own(const std::string& path)
{
  static long long made = 0;
  return path + "#" + std::to_string(++made);
}

}  // namespace

void refuse_nan(const std::vector<double>& values, const std::string& where)
{
  for (double value : values)
    if (!std::isfinite(value))
      throw core::solver_error("a value of " + where + " is not finite; it was not written");
}

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
  if (id < 0) throw core::output_error("cannot read or write " + path_ + " (" + what + ")");
  return {id, close};
}

void H5File::check(int status, const std::string& what) const
{
  if (status < 0) throw core::output_error("cannot read or write " + path_ + " (" + what + ")");
}

H5File H5File::create(const std::string& path)
{
  const H5Id access = in_memory();
  const hid_t id =
      H5Fcreate(name_of_its_own(path).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get());
  if (id < 0) throw core::output_error("cannot make " + path);
  return H5File(path, H5Id(id, H5Fclose));
}

H5File H5File::of_bytes(const std::string& path, std::string bytes)
{
  const H5Id access = in_memory();
  const bool taken = H5Pset_file_image(access.get(), bytes.data(), bytes.size()) >= 0;
  const hid_t id = taken ? H5Fopen(name_of_its_own(path).c_str(), H5F_ACC_RDWR, access.get()) : -1;
  if (id < 0) throw core::output_error("cannot read " + path + " back");
  return H5File(path, H5Id(id, H5Fclose));
}

H5Id H5File::open_object(const std::string& path) const
{
  return checked(H5Oopen(file_.get(), path.c_str(), H5P_DEFAULT), H5Oclose, path);
}

void H5File::link(const std::string& target, const std::string& path)
{
  const H5Id links = checked(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
  check(H5Pset_create_intermediate_group(links.get(), 1), path);
  check(H5Lcreate_soft(target.c_str(), file_.get(), path.c_str(), links.get(), H5P_DEFAULT), path);
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

void H5File::create_series(const std::string& path, std::size_t columns, std::size_t room,
                           const std::string& units)
{
  const int rank = columns ? 2 : 1;
  const hsize_t one[2] = {1, columns};
  const hsize_t unlimited[2] = {H5S_UNLIMITED, columns};
  const hsize_t chunk[2] = {room, columns};
  const H5Id space = checked(H5Screate_simple(rank, one, unlimited), H5Sclose, path);
  const H5Id links = checked(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
  check(H5Pset_create_intermediate_group(links.get(), 1), path);
  const H5Id layout = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
  check(H5Pset_chunk(layout.get(), rank, chunk), path);
  check(H5Pset_alloc_time(layout.get(), H5D_ALLOC_TIME_EARLY), path);
  {
    const H5Id set = checked(H5Dcreate2(file_.get(), path.c_str(), H5T_NATIVE_DOUBLE, space.get(),
                                        links.get(), layout.get(), H5P_DEFAULT),
                             H5Dclose, path);
  }
  attribute(path, "units", units);
}

void H5File::remove(const std::string& path)
{
  check(H5Ldelete(file_.get(), path.c_str(), H5P_DEFAULT), path);
}

void H5File::copy(const H5File& from, const std::string& path)
{
  check(
      H5Ocopy(from.file_.get(), path.c_str(), file_.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      path);
}

std::vector<std::string> H5File::top() const
{
  H5G_info_t group;
  check(H5Gget_info(file_.get(), &group), "/");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < group.nlinks; ++i) {
    const ssize_t length = H5Lget_name_by_idx(file_.get(), "/", H5_INDEX_NAME, H5_ITER_INC, i,
                                              nullptr, 0, H5P_DEFAULT);
    if (length < 0) check(-1, "/");
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    H5Lget_name_by_idx(file_.get(), "/", H5_INDEX_NAME, H5_ITER_INC, i, name.data(), name.size(),
                       H5P_DEFAULT);
    name.pop_back();
    names.push_back(name);
  }
  return names;
}

void H5File::make_group(const std::string& path)
{
  const H5Id links = checked(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
  check(H5Pset_create_intermediate_group(links.get(), 1), path);
  checked(H5Gcreate2(file_.get(), path.c_str(), links.get(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
          path);
}

std::string H5File::bytes() const
{
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "flush");
  const ssize_t size = H5Fget_file_image(file_.get(), nullptr, 0);
  if (size < 0) check(-1, "image");
  std::string all(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file_.get(), all.data(), all.size()) != size) check(-1, "image");
  return all;
}

}  // namespace trocar::base
