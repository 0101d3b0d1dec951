#include "driver/option_source.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <functional>

#include "base/petsc.hpp"
#include "core/failure.hpp"
#include "support/files.hpp"

namespace trocar::driver {
namespace {

/// Puts options into PETSc's database, from where the program takes them, and takes them out again.
class OptionSource : public ::testing::Test
{
 protected:
  void TearDown() override
  {
    for (const std::string& name : set_)
      TROCAR_PETSC(PetscOptionsClearValue(nullptr, name.c_str()));
    unsetenv("PETSC_OPTIONS");
  }
  /// As PETSc has read it from a file or from the environment.
  void set(const std::string& name, const std::string& value)
  {
    set_.push_back(name);
    TROCAR_PETSC(PetscOptionsSetValue(nullptr, name.c_str(), value.c_str()));
  }
  /// What a start with these arguments gives; they are in the database afterwards.
  Invocation start(const std::vector<std::string>& arguments)
  {
    Invocation invocation;
    invocation.arguments = {"trocar"};
    for (const std::string& word : arguments) {
      invocation.arguments.push_back(word);
      if (word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1]))) set_.push_back(word);
    }
    apply_arguments(invocation);
    return invocation;
  }
  /// The line that `work` is refused with, by code.
  static std::string refusal(core::ExitCode code, const std::function<void()>& work)
  {
    try {
      work();
    } catch (const core::Failure& failure) {
      EXPECT_EQ(failure.code(), code);
      return failure.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }

  base::Comm comm{MPI_COMM_WORLD};

 private:
  std::vector<std::string> set_;
};

TEST_F(OptionSource, KnowsWhereEveryValueCameFrom)
{
  setenv("PETSC_OPTIONS", "-time_step 0.5 -tissue_mass lumped", 1);
  set("-time_step", "0.5");
  set("-tissue_young", "7000");
  set("-time_end", "3");
  Invocation invocation = start({"-tissue_poisson", "0.3"});
  invocation.options_file_text = "# -time_end 1\n  -tissue_young 7000 # of liver\n";
  const auto given = take_options(invocation);
  ASSERT_EQ(given.size(), 4U);
  EXPECT_EQ(given.at("tissue_poisson").source, "command line");
  EXPECT_EQ(given.at("tissue_poisson").value, "0.3");
  EXPECT_EQ(given.at("tissue_young").source, "options file");
  EXPECT_EQ(given.at("time_step").source, "PETSC_OPTIONS");
  EXPECT_EQ(given.at("time_end").source, "petscrc");  // in a comment of the file only
  EXPECT_TRUE(take_options(invocation).empty());      // taken once
}

TEST_F(OptionSource, TheCommandLineWins)
{
  set("-tissue_young", "1");  // by a file that was named after it
  const auto given = take_options(start({"-tissue_young", "2"}));
  EXPECT_EQ(given.at("tissue_young").value, "2");
  EXPECT_EQ(given.at("tissue_young").source, "command line");
}

// A dash before a digit begins no option, and a flag needs no value.
TEST_F(OptionSource, TellsNegativeNumbersFromNames)
{
  const auto given = take_options(
      start({"-gravity", "-1,0,-9.81", "-quiet", "-cavity_bladder_pressure", "-5", "-check"}));
  ASSERT_EQ(given.size(), 4U);
  EXPECT_EQ(given.at("gravity").value, "-1,0,-9.81");
  EXPECT_EQ(given.at("cavity_bladder_pressure").value, "-5");
  EXPECT_EQ(given.at("quiet").value, "");
  EXPECT_EQ(given.at("check").value, "");
}

TEST_F(OptionSource, MisspeltOptionsAreRefusedWithTheNearestName)
{
  const Invocation invocation = start({"-tisue_young", "7000"});
  EXPECT_TRUE(take_options(invocation).empty());
  const std::string line = refusal(core::ExitCode::options, [] { refuse_unused(); });
  EXPECT_NE(line.find("-tisue_young is unknown"), std::string::npos) << line;
  EXPECT_NE(line.find("did you mean '-tissue_young'"), std::string::npos) << line;
}

TEST_F(OptionSource, PetscsOwnOptionsAreLeftToIt)
{
  const Invocation invocation = start({"-tissue_ksp_rtoll", "1e-9"});
  EXPECT_TRUE(take_options(invocation).empty());
  EXPECT_TRUE(tissue_solver_given());
  const std::string line = refusal(core::ExitCode::options, [] { refuse_unused(); });
  EXPECT_NE(line.find("did you mean '-tissue_ksp_rtol'"), std::string::npos) << line;
}

TEST_F(OptionSource, NothingGivenIsNothingTaken)
{
  EXPECT_TRUE(take_options(start({})).empty());
  EXPECT_FALSE(tissue_solver_given());
  EXPECT_NO_THROW(refuse_unused());
}

Invocation invoked_with(std::vector<std::string> words, const base::Comm& comm)
{
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return read_invocation(static_cast<int>(argv.size()), argv.data(), comm);
}

TEST_F(OptionSource, EveryRankKnowsTheOptionsFile)
{
  const std::string text = "-tissue_young 7000\n# the end\n";
  const std::string file = test::shared_text("invocation.opts", text, comm);
  const Invocation invocation =
      invoked_with({"trocar", "-quiet", "-options_file", file, "-check"}, comm);
  EXPECT_EQ(invocation.options_file, file);
  EXPECT_EQ(invocation.options_file_text, text);
  EXPECT_EQ(invocation.arguments.size(), 5U);
  EXPECT_EQ(invoked_with({"trocar", "-quiet"}, comm).options_file, "");
}

TEST_F(OptionSource, OptionsFilesThatAreNotThereAreRefusedOnEveryRank)
{
  const auto options = core::ExitCode::options;
  EXPECT_NE(refusal(options,
                    [&] {
                      invoked_with({"trocar", "-options_file", "no.opts"}, comm);
                    })
                .find("no.opts"),
            std::string::npos);
  EXPECT_NE(refusal(options,
                    [&] {
                      invoked_with({"trocar", "-options_file"}, comm);
                    })
                .find("a file name must follow"),
            std::string::npos);
  setenv("PETSC_OPTIONS", "-quiet -options_file of_environment.opts", 1);
  EXPECT_NE(refusal(options, [&] { invoked_with({"trocar"}, comm); }).find("of_environment.opts"),
            std::string::npos);
}

TEST_F(OptionSource, EveryRankReadsTheSameTable)
{
  const std::string file = test::shared_text("table.csv", "time,factor\n0,0\n2,1\n", comm);
  const core::Csv table = read_csv(file, comm);
  EXPECT_EQ(table.columns, (std::vector<std::string>{"time", "factor"}));
  EXPECT_EQ(table.rows, (std::vector<std::vector<double>>{{0, 0}, {2, 1}}));
  EXPECT_NE(refusal(core::ExitCode::data, [&] { read_csv("no.csv", comm); }).find("no.csv"),
            std::string::npos);
}

}  // namespace
}  // namespace trocar::driver
