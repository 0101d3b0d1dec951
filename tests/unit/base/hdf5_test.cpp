#include "base/hdf5.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/comm.hpp"
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
  file.close();
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
  file.close();
  const test::H5Reader reader(path);
  EXPECT_EQ(reader.words("/names"), words);
  EXPECT_TRUE(reader.words("/none").empty());
  EXPECT_EQ(reader.words("/provenance/options"), (std::vector<std::string>{"-quiet\n# note\n"}));
  EXPECT_EQ(reader.text_attribute("/", "schema"), "of a test");
}

TEST(Hdf5, SeriesGrowRowByRow)
{
  const std::string path = own_file("series");
  H5File file = H5File::create(path);
  file.create_series("/history/time", 0, "s");
  file.create_series("/history/tip", 3, "m");
  std::vector<double> times, tips;
  for (int n = 0; n < 300; ++n) {  // more than a chunk
    times.push_back(0.1 * n);
    const std::vector<double> tip{1.0 * n, 2.0 * n, 3.0 * n};
    tips.insert(tips.end(), tip.begin(), tip.end());
    file.append("/history/time", {times.back()});
    file.append("/history/tip", tip);
  }
  file.close();
  const test::H5Reader reader(path);
  EXPECT_EQ(reader.dataset("/history/time").values, times);
  const test::Dataset tip = reader.dataset("/history/tip");
  EXPECT_EQ(tip.shape, (std::vector<std::size_t>{300, 3}));
  EXPECT_EQ(tip.values, tips);
  EXPECT_EQ(tip.units, "m");
}

TEST(Hdf5, CountsMayBeWrittenAnew)
{
  const std::string path = own_file("counts");
  H5File file = H5File::create(path);
  file.make_group("/ledger");
  for (std::int64_t count : {0, 3, 12}) file.attribute("/ledger", "solves", count);
  file.close();
  EXPECT_EQ(test::H5Reader(path).count_attribute("/ledger", "solves"), 12);
}

TEST(Hdf5, FailingCallsAreOutputFailuresThatNameTheFile)
{
  constexpr auto output = core::ExitCode::output;
  expect_failure(output, "no_such_folder/x.h5", [] { H5File::create("no_such_folder/x.h5"); });
  expect_failure(output, "no_such_file", [] { sync_to_disk("no_such_file"); });
  const std::string path = own_file("failing");
  H5File file = H5File::create(path);
  file.write("/x", std::vector<double>{1.0}, 0, "m");
  expect_failure(output, path, [&] { file.write("/x", std::vector<double>{2.0}, 0, "m"); });
  expect_failure(output, path, [&] { file.write("/x/below", std::vector<double>{2.0}, 0, "m"); });
  expect_failure(output, path, [&] { file.append("/missing", {1.0}); });
  expect_failure(output, path, [&] { file.attribute("/missing", "a", std::string("b")); });
  file.close();
  EXPECT_EQ(test::H5Reader(path).dataset("/x").values, (std::vector<double>{1.0}));
}

TEST(Hdf5, NumbersThatAreNotFiniteAreNeverWritten)
{
  const std::string path = own_file("finite");
  H5File file = H5File::create(path);
  file.create_series("/series", 0, "m");
  for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    expect_failure(core::ExitCode::solver, "/x", [&] {
      file.write("/x", std::vector<double>{1.0, bad}, 0, "m");
    });
    expect_failure(core::ExitCode::solver, "/series", [&] { file.append("/series", {bad}); });
  }
  file.close();
  const test::H5Reader reader(path);
  EXPECT_FALSE(reader.has("/x"));
  EXPECT_TRUE(reader.dataset("/series").values.empty());
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
