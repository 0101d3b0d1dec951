#include <hdf5.h>

#include "base/hdf5.hpp"
#include "core/failure.hpp"

// Functions that read, for runs that resume an earlier run.
namespace trocar::base {

bool H5File::has(const std::string& path) const
{
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (H5Lexists(file_.get(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

template <class Number>
std::vector<Number> H5File::read_block(const std::string& path, std::int64_t type) const
{
  const H5Id set = checked(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const H5Id space = checked(H5Dget_space(set.get()), H5Sclose, path);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (count < 0) check(-1, path);
  std::vector<Number> values(static_cast<std::size_t>(count));
  if (count > 0)
    check(H5Dread(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  return values;
}

std::vector<double> H5File::read_reals(const std::string& path) const
{
  return read_block<double>(path, H5T_NATIVE_DOUBLE);
}

std::vector<std::int64_t> H5File::read_integers(const std::string& path) const
{
  return read_block<std::int64_t>(path, H5T_NATIVE_INT64);
}

std::vector<std::string> H5File::read_words(const std::string& path) const
{
  const H5Id set = checked(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const H5Id space = checked(H5Dget_space(set.get()), H5Sclose, path);
  const H5Id type = checked(H5Dget_type(set.get()), H5Tclose, path);
  if (H5Tis_variable_str(type.get()) <= 0) check(-1, path);
  const std::vector<char*> pointers = [&] {
    const hssize_t count = H5Sget_simple_extent_npoints(space.get());
    if (count < 0) check(-1, path);
    std::vector<char*> all(static_cast<std::size_t>(count), nullptr);
    if (count > 0)
      check(H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()), path);
    return all;
  }();
  std::vector<std::string> words;
  for (char* pointer : pointers) {
    words.emplace_back(pointer ? pointer : "");
    H5free_memory(pointer);
  }
  return words;
}

}  // namespace trocar::base
