#include <hdf5.h>

#include <algorithm>
#include <cstring>

#include "base/hdf5.hpp"
#include "core/failure.hpp"

// Finds the byte offsets of values in a file from its object headers.
namespace trocar::base {
namespace {

/// The messages in an object header of version 1, the earliest format, which the HDF5 library
/// writes by default. See "IV.A.1.a Version 1 Data Object Header Prefix" in the HDF5 file format
/// specification.
class HeaderMessages
{
 public:
  HeaderMessages(const std::string& bytes, std::uint64_t header) : bytes_(bytes)
  {
    if (bytes_.at(header) != 1) throw unknown();
    add_block(header + 16, number<std::uint32_t>(header + 8));
  }

  struct Message
  {
    unsigned type;
    std::uint64_t begin;  ///< offset of the message's content in the file [B]
  };
  const std::vector<Message>& all() const { return messages_; }

  template <class Number>
  Number number(std::uint64_t at) const
  {
    Number value;
    if (at + sizeof value > bytes_.size()) throw unknown();
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }

  static core::Failure unknown()
  {
    return {core::ExitCode::internal, "this version of HDF5 writes headers that are not known"};
  }

 private:
  void add_block(std::uint64_t at, std::uint64_t size)
  {
    constexpr unsigned continuation = 0x10;
    constexpr std::size_t most = 10000;  // limit for a damaged file with a cycle of blocks
    for (const std::uint64_t end = at + size; at + 8 <= end;) {
      if (messages_.size() > most) throw unknown();
      const unsigned type = number<std::uint16_t>(at);
      const std::uint64_t content = at + 8;
      messages_.push_back({type, content});
      if (type == continuation)
        add_block(number<std::uint64_t>(content), number<std::uint64_t>(content + 8));
      at = content + number<std::uint16_t>(at + 2);
    }
  }

  const std::string& bytes_;
  std::vector<Message> messages_;
};

std::uint64_t padded(std::uint64_t size)
{
  return (size + 7) / 8 * 8;
}

}  // namespace

SeriesPlace H5File::series_place(const std::string& path, std::size_t columns,
                                 const std::string& bytes) const
{
  constexpr unsigned dataspace = 0x1;
  const H5Id set = checked(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const H5Id space = checked(H5Dget_space(set.get()), H5Sclose, path);
  hsize_t first[2];
  unsigned filters = 0;
  haddr_t data = HADDR_UNDEF;
  hsize_t size = 0;
  check(H5Dget_chunk_info(set.get(), space.get(), 0, first, &filters, &data, &size), path);
  H5O_info_t header;
  check(H5Oget_info2(set.get(), &header, H5O_INFO_BASIC), path);
  const HeaderMessages messages(bytes, header.addr);
  for (const HeaderMessages::Message& one : messages.all())
    // content: version, rank and flags (1 byte each), 5 unused bytes, then the sizes
    if (one.type == dataspace && bytes.at(one.begin) == 1)
      return {data, one.begin + 8, std::max<std::size_t>(columns, 1)};
  throw HeaderMessages::unknown();
}

std::uint64_t H5File::attribute_place(const std::string& path, const std::string& name,
                                      const std::string& bytes) const
{
  constexpr unsigned attribute = 0xC;
  const H5Id object = open_object(path);
  H5O_info_t header;
  check(H5Oget_info2(object.get(), &header, H5O_INFO_BASIC), path);
  const HeaderMessages messages(bytes, header.addr);
  for (const HeaderMessages::Message& one : messages.all()) {
    if (one.type != attribute || bytes.at(one.begin) != 1) continue;
    // Content: version (1 byte), 1 unused byte, the sizes of name, type and space (2 bytes each),
    // then name, type and space, each padded to 8 bytes, then the value.
    const auto size = [&](std::uint64_t at) {
      return messages.number<std::uint16_t>(one.begin + at);
    };
    if (std::string(bytes.c_str() + one.begin + 8) != name) continue;
    return one.begin + 8 + padded(size(2)) + padded(size(4)) + padded(size(6));
  }
  throw HeaderMessages::unknown();
}

}  // namespace trocar::base
