#include "io/checkpoint.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "base/comm.hpp"
#include "core/failure.hpp"
#include "core/fnv.hpp"
#include "support/files.hpp"

namespace trocar::io {
namespace {

namespace fs = std::filesystem;

Checkpoint some(int step, std::size_t size = 40)
{
  Checkpoint one;
  one.version = "a test";
  one.options = {{"tissue_young", "5000", ""}, {"mesh", "a mesh.msh", "00ff"}, {"fix", "", ""}};
  one.time = {0.1 * step, 0.1, 3.0, step, step + 2};
  one.run = {1000 + step, step + 3, 64, "an id", "00ab", {1, 2, 3, 4, 5, 6}, {9, 8}};
  one.ledger = {{"steps", step}, {"solves", 1LL << 40}};
  one.frames = {
      {0, 0.0, {{"/displacement", 3, false}, {"/von_mises", 0, true}}, {{"/needle/my needle", 9}}},
      {step, 0.1 * step, {}, {}}};
  one.state.names = {"time [s]", "tissue/displacement [m]", "list"};
  one.state.whole = {-1, 0, 1LL << 50};
  for (std::size_t i = 0; i < size; ++i)
    one.state.real.push_back(std::sin(static_cast<double>(i)) / 3.0);
  one.state.fields = {{"tissue/displacement", "m", one.state.real}, {"tissue/empty", "1", {}}};
  return one;
}

/// On rank 0 alone, with a folder of its own.
void in_folder(const std::string& folder, const std::function<void()>& work)
{
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all(folder);
    fs::create_directories(folder);
    work();
  });
}

/// 65, one line that names the file.
void expect_refused(const std::string& folder, const std::string& file, const std::string& what)
{
  try {
    read_checkpoint(folder);
    ADD_FAILURE() << what << ": was read";
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::data) << what;
    EXPECT_NE(std::string(failure.what()).find(file), std::string::npos) << failure.what();
  }
}

void put(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(Checkpoint, IsReadBackToTheLastBit)
{
  in_folder("checkpoint_back", [] {
    write_checkpoint("checkpoint_back", some(7));
    EXPECT_TRUE(read_checkpoint("checkpoint_back") == some(7));
  });
}

// Two files in turn: the one before stays whole while the next is written, and no more are kept.
TEST(Checkpoint, KeepsTheOneBefore)
{
  in_folder("checkpoint_turns", [] {
    for (int step : {1, 2, 3}) {
      write_checkpoint("checkpoint_turns", some(step));
      EXPECT_EQ(read_checkpoint("checkpoint_turns").time.nominal, step);
      if (step == 1) continue;
      const std::string list = test::file_text("checkpoint_turns/checkpoint.txt");
      const bool a = list.find("checkpoint_a.h5") != std::string::npos;
      EXPECT_EQ(a, step == 3) << list;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator("checkpoint_turns"), fs::directory_iterator()),
              3);
  });
}

// One byte is enough, wherever it is; so is a missing one, and one too many.
TEST(Checkpoint, ThatIsDamagedIsRefused)
{
  in_folder("checkpoint_damage", [] {
    const std::string folder = "checkpoint_damage";
    write_checkpoint(folder, some(7));
    std::mt19937 random(3);
    for (const std::string file : {"checkpoint.txt", "checkpoint_a.h5"}) {
      const std::string path = folder + "/" + file, whole = test::file_text(path);
      const std::size_t step = file == "checkpoint.txt" ? 1 : whole.size() / 300 + 1;
      for (std::size_t at = 0; at < whole.size(); at += step) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ (1 << (random() % 8)));
        put(path, flipped);
        expect_refused(folder, file, "a bit of byte " + std::to_string(at));
        put(path, whole.substr(0, at));
        expect_refused(folder, file, "cut at " + std::to_string(at));
      }
      put(path, whole + "x");
      expect_refused(folder, file, "a byte too many");
      fs::remove(path);
      expect_refused(folder, file, "without it");
      put(path, whole);
    }
    EXPECT_NO_THROW(read_checkpoint(folder));
  });
}

/// A manifest that fits a file whatever is in it.
void list(const std::string& folder, const std::string& format, const std::string& bytes)
{
  const std::string text = "format " + format + "\nfile checkpoint_a.h5\nbytes " +
                           std::to_string(bytes.size()) + "\nfnv1a " + core::fnv1a(bytes) +
                           "\nstep 1\ntime 0.1\n";
  put(folder + "/checkpoint_a.h5", bytes);
  put(folder + "/checkpoint.txt", text + "above " + core::fnv1a(text) + "\n");
}

// Files whose sums are right and that are something else: of another version, text, nothing, HDF5
// without what is wanted.
TEST(Checkpoint, OfAnotherProgramIsRefused)
{
  in_folder("checkpoint_foreign", [] {
    const std::string folder = "checkpoint_foreign", file = "checkpoint_a.h5";
    expect_refused(folder, "checkpoint.txt", "an empty folder");
    write_checkpoint(folder, some(7));
    const std::string good = test::file_text(folder + "/" + file);
    list(folder, "trocar-checkpoint-1", good);
    EXPECT_NO_THROW(read_checkpoint(folder));
    list(folder, "trocar-checkpoint-0", good);
    expect_refused(folder, "trocar-checkpoint-0", "an older format");
    for (const std::string& other : {std::string(), std::string("hello"), good.substr(0, 512)}) {
      list(folder, "trocar-checkpoint-1", other);
      expect_refused(folder, file, "other contents");
    }
    write_checkpoint("checkpoint_foreign", [] {
      Checkpoint one = some(7);
      one.version.clear();
      return one;
    }());
    EXPECT_NO_THROW(read_checkpoint(folder));
  });
}

// A disk that is full, as a limit on files makes it: 74, and the one before stands.
TEST(Checkpoint, ThatDoesNotFitLeavesTheOneBefore)
{
  in_folder("checkpoint_full", [] {
    write_checkpoint("checkpoint_full", some(1));
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{200000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    try {
      write_checkpoint("checkpoint_full", some(2, 100000));
      ADD_FAILURE() << "it was written";
    } catch (const core::Failure& failure) {
      EXPECT_EQ(failure.code(), core::ExitCode::output) << failure.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_TRUE(read_checkpoint("checkpoint_full") == some(1));
  });
}

}  // namespace
}  // namespace trocar::io
