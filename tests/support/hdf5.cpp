#include "support/hdf5.hpp"

#include <hdf5.h>

#include <stdexcept>

#include "base/hdf5.hpp"

namespace trocar::test {
namespace {

using base::H5Id;

H5Id opened(hid_t id, H5Id::Close close, const std::string& what)
{
  if (id < 0) throw std::runtime_error("cannot read " + what);
  return {id, close};
}

H5Id open_attribute(hid_t file, const std::string& path, const std::string& name)
{
  return opened(H5Aopen_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                H5Aclose, path + "@" + name);
}

}  // namespace

H5Reader::H5Reader(const std::string& file)
    : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT))
{
  if (file_ < 0) throw std::runtime_error("cannot read " + file);
}

H5Reader::~H5Reader()
{
  H5Fclose(file_);
}

bool H5Reader::has(const std::string& path) const
{
  return H5Lexists(file_, path.c_str(), H5P_DEFAULT) > 0;
}

Dataset H5Reader::dataset(const std::string& path) const
{
  const H5Id set = opened(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const H5Id space = opened(H5Dget_space(set.get()), H5Sclose, path);
  const H5Id type = opened(H5Dget_type(set.get()), H5Tclose, path);
  hsize_t shape[2] = {0, 0};
  const int rank = H5Sget_simple_extent_dims(space.get(), shape, nullptr);
  Dataset data;
  data.shape.assign(shape, shape + rank);
  data.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  data.integer = H5Tget_class(type.get()) == H5T_INTEGER;
  data.units = text_attribute(path, "units");
  if (!data.values.empty() &&
      H5Dread(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.values.data()) < 0)
    throw std::runtime_error("cannot read " + path);
  return data;
}

std::vector<std::string> H5Reader::words(const std::string& path) const
{
  const H5Id set = opened(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const H5Id space = opened(H5Dget_space(set.get()), H5Sclose, path);
  const H5Id type = opened(H5Dget_type(set.get()), H5Tclose, path);
  std::vector<char*> text(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  if (text.empty()) return {};
  if (H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
    throw std::runtime_error("cannot read " + path);
  std::vector<std::string> words(text.begin(), text.end());
  H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, text.data());
  return words;
}

std::string H5Reader::text_attribute(const std::string& path, const std::string& name) const
{
  const H5Id attribute = open_attribute(file_, path, name);
  const H5Id type = opened(H5Aget_type(attribute.get()), H5Tclose, path);
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0)
    throw std::runtime_error("cannot read " + path + "@" + name);
  return text.c_str();  // up to the end that HDF5 pads with
}

std::int64_t H5Reader::count_attribute(const std::string& path, const std::string& name) const
{
  const H5Id attribute = open_attribute(file_, path, name);
  std::int64_t value = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_INT64, &value) < 0)
    throw std::runtime_error("cannot read " + path + "@" + name);
  return value;
}

}  // namespace trocar::test
