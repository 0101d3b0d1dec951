#include "base/hdf5.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>

#include "base/comm.hpp"
#include "base/files.hpp"
#include "support/hdf5.hpp"

namespace trocar::base {
namespace {

/// A file of this rank's own: the door is used from one rank.
std::string own_file(const std::string& name)
{
  return name + "_" + std::to_string(Comm(MPI_COMM_WORLD).rank()) + ".h5";
}

/// The failure of `work` has this code and names the file.
void expect_failure(core::ExitCode code, const std::string& names,
                    const std::function<void()>& work)
{
  try {
    work();
    ADD_FAILURE() << "no failure names " << names;
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), code) << failure.what();
    EXPECT_NE(std::string(failure.what()).find(names), std::string::npos) << failure.what();
  }
}

void save(const H5File& file, const std::string& path)
{
  replace_file(path, file.bytes());
}

TEST(Hdf5, GivesBackWhatWasWrittenWithShapeAndUnit)
{
  const std::string path = own_file("written");
  const std::vector<double> rows{1.0, -0.1, 1e-300, 4.0, 5.0, 6.0};
  const std::vector<std::int64_t> counts{0, -7, 1LL << 40};
  H5File file = H5File::create(path);
  file.write("/deep/er/rows", rows, 3, "m");  // groups are made on the way
  file.write("/column", rows, 0, "N m");
  file.write("/counts", counts, 0, "1");
  file.write("/nothing", std::vector<double>{}, 3, "Pa");
  save(file, path);
  const test::H5Reader reader(path);
  const test::Dataset two = reader.dataset("/deep/er/rows"), one = reader.dataset("/column");
  EXPECT_EQ(two.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(two.values, rows);
  EXPECT_EQ(two.units, "m");
  EXPECT_FALSE(two.integer);
  EXPECT_EQ(one.shape, (std::vector<std::size_t>{6}));
  EXPECT_EQ(one.units, "N m");
  const test::Dataset integers = reader.dataset("/counts");
  EXPECT_TRUE(integers.integer);
  EXPECT_EQ(integers.values, (std::vector<double>{0.0, -7.0, std::pow(2.0, 40)}));
  EXPECT_EQ(reader.dataset("/nothing").shape, (std::vector<std::size_t>{0, 3}));
}

TEST(Hdf5, KeepsWordsAndTextsAsTheyAre)
{
  const std::string path = own_file("words");
  const std::vector<std::string> words{"liver", "", "two words", "µm\nand a second line"};
  H5File file = H5File::create(path);
  file.write_words("/names", words);
  file.write_words("/none", {});
  file.write_text("/provenance/options", "-quiet\n# note\n");
  file.attribute("/", "schema", std::string("of a test"));
  save(file, path);
  const test::H5Reader reader(path);
  EXPECT_EQ(reader.words("/names"), words);
  EXPECT_TRUE(reader.words("/none").empty());
  EXPECT_EQ(reader.words("/provenance/options"), (std::vector<std::string>{"-quiet\n# note\n"}));
  EXPECT_EQ(reader.text_attribute("/", "schema"), "of a test");
}

/// Rows are put into the bytes of the file, not by the library; it reads them back.
TEST(Hdf5, SeriesGrowByTheirBytes)
{
  const std::string path = own_file("series");
  H5File file = H5File::create(path);
  file.create_series("/history/time", 0, 300, "s");
  file.create_series("/history/tip", 3, 300, "m");
  file.make_group("/ledger");
  for (int k = 0; k < 20; ++k)  // more than the first block of a header holds
    file.attribute("/ledger", "count_" + std::to_string(k), std::int64_t{k});
  std::string bytes = file.bytes();
  const SeriesPlace times_at = file.series_place("/history/time", 0, bytes);
  const SeriesPlace tips_at = file.series_place("/history/tip", 3, bytes);
  EXPECT_EQ(times_at.columns, 1U);
  EXPECT_EQ(tips_at.columns, 3U);
  std::vector<double> times, tips;
  for (std::uint64_t n = 0; n < 300; ++n) {
    times.push_back(0.1 * static_cast<double>(n));
    for (double x : {1.0, 2.0, 3.0}) tips.push_back(x * static_cast<double>(n));
    const std::uint64_t rows = n + 1;
    std::memcpy(bytes.data() + times_at.data + 8 * n, &times.back(), 8);
    std::memcpy(bytes.data() + tips_at.data + 24 * n, &tips[3 * n], 24);
    std::memcpy(bytes.data() + times_at.rows, &rows, 8);
    std::memcpy(bytes.data() + tips_at.rows, &rows, 8);
  }
  const std::int64_t count = 1LL << 50;
  std::memcpy(bytes.data() + file.attribute_place("/ledger", "count_17", bytes), &count, 8);
  std::ofstream(path, std::ios::binary) << bytes;
  {
    const test::H5Reader reader(path);
    EXPECT_EQ(reader.dataset("/history/time").values, times);
    const test::Dataset tip = reader.dataset("/history/tip");
    EXPECT_EQ(tip.shape, (std::vector<std::size_t>{300, 3}));
    EXPECT_EQ(tip.values, tips);
    EXPECT_EQ(tip.units, "m");
    EXPECT_EQ(reader.count_attribute("/ledger", "count_17"), count);
    EXPECT_EQ(reader.count_attribute("/ledger", "count_16"), 16);
  }
  // And so does this class, which may add to it.
  H5File again = H5File::of_bytes(path, bytes);
  again.write("/later", std::vector<double>{5.0}, 0, "m");
  EXPECT_EQ(again.top(), (std::vector<std::string>{"history", "later", "ledger"}));
  H5File copy = H5File::create(path);
  copy.copy(again, "/history");
  save(copy, path);
  EXPECT_EQ(test::H5Reader(path).dataset("/history/tip").values, tips);
}

TEST(Hdf5, CountsMayBeWrittenAnew)
{
  const std::string path = own_file("counts");
  H5File file = H5File::create(path);
  file.make_group("/ledger");
  for (std::int64_t count : {0, 3, 12}) file.attribute("/ledger", "solves", count);
  save(file, path);
  EXPECT_EQ(test::H5Reader(path).count_attribute("/ledger", "solves"), 12);
}

TEST(Hdf5, FailingCallsAreOutputFailuresThatNameTheFile)
{
  constexpr auto output = core::ExitCode::output;
  expect_failure(output, "no_such_folder/x.h5", [] { replace_file("no_such_folder/x.h5", "x"); });
  expect_failure(output, "no_such_file", [] { sync_to_disk("no_such_file"); });
  expect_failure(output, "damaged", [] { H5File::of_bytes("damaged", "no HDF5"); });
  const std::string path = own_file("failing");
  H5File file = H5File::create(path);
  file.write("/x", std::vector<double>{1.0}, 0, "m");
  expect_failure(output, path, [&] { file.write("/x", std::vector<double>{2.0}, 0, "m"); });
  expect_failure(output, path, [&] { file.write("/x/below", std::vector<double>{2.0}, 0, "m"); });
  expect_failure(output, path, [&] { file.attribute("/missing", "a", std::string("b")); });
  save(file, path);
  EXPECT_EQ(test::H5Reader(path).dataset("/x").values, (std::vector<double>{1.0}));
}

TEST(Hdf5, NumbersThatAreNotFiniteAreNeverWritten)
{
  const std::string path = own_file("finite");
  H5File file = H5File::create(path);
  for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    expect_failure(core::ExitCode::solver, "/x", [&] {
      file.write("/x", std::vector<double>{1.0, bad}, 0, "m");
    });
    expect_failure(core::ExitCode::solver, "/series", [&] { refuse_nan({0.0, bad}, "/series"); });
  }
  save(file, path);
  const test::H5Reader reader(path);
  EXPECT_FALSE(reader.has("/x"));
}

TEST(Hdf5, IdentifiersAreClosedOnceByTheirLastOwner)
{
  static std::vector<std::int64_t> closed;
  closed.clear();
  const auto close = [](std::int64_t id) {
    closed.push_back(id);
    return 0;
  };
  {
    H5Id a(7, close), b(8, close);
    H5Id c(std::move(a));
    EXPECT_LT(a.get(), 0);
    EXPECT_EQ(c.get(), 7);
    b = std::move(c);  // 8 is closed here
    EXPECT_EQ(closed, (std::vector<std::int64_t>{8}));
    H5Id& same = b;
    b = std::move(same);
    EXPECT_EQ(b.get(), 7);
  }
  EXPECT_EQ(closed, (std::vector<std::int64_t>{8, 7}));
}

}  // namespace
}  // namespace trocar::base
