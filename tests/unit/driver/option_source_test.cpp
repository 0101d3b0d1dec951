#include "driver/option_source.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>

#include "base/petsc.hpp"
#include "core/failure.hpp"
#include "driver/option_list.hpp"
#include "driver/petsc_options.hpp"
#include "support/files.hpp"

namespace trocar::driver {
namespace {

/// Starts of the program, with files and an environment that only the test has.
class OptionSource : public ::testing::Test
{
 protected:
  void TearDown() override { unsetenv("PETSC_OPTIONS"); }

  Invocation start(std::vector<std::string> words) const
  {
    words.insert(words.begin(), "trocar");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return read_invocation(static_cast<int>(argv.size()), argv.data(), comm);
  }
  std::string file(const std::string& name, const std::string& text) const
  {
    return test::shared_text(name, text, comm);
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
  std::string refused(const std::vector<std::string>& words) const
  {
    return refusal(core::ExitCode::options, [&] { start(words); });
  }

  base::Comm comm{MPI_COMM_WORLD};
};

TEST_F(OptionSource, KnowsWhereEveryValueCameFrom)
{
  setenv("PETSC_OPTIONS", "-time_step 0.5 -tissue_mass lumped", 1);
  const std::string opts =
      file("some.opts", "-tissue_young 7000 # of liver\n-time_step 3 -tissue_mass consistent\n");
  const auto given = start({"-tissue_mass", "lumped", "-options_file", opts}).given;
  ASSERT_EQ(given.size(), 3U);
  EXPECT_EQ(given.at("tissue_young").source, "options file");
  EXPECT_EQ(given.at("tissue_young").place, opts + ":1");
  EXPECT_EQ(given.at("tissue_young").value, "7000");
  EXPECT_EQ(given.at("time_step").source, "PETSC_OPTIONS");
  EXPECT_EQ(given.at("time_step").value, "0.5");
  EXPECT_EQ(given.at("tissue_mass").source, "command line");
  EXPECT_EQ(given.at("tissue_mass").value, "lumped");
}

TEST_F(OptionSource, OfOneSourceTheLastValueIsTaken)
{
  const std::string first = file("first.opts", "-tissue_young 1\n-tissue_young 2 -time_end 5\n");
  const std::string second = file("second.opts", "-tissue_young 3\n");
  const auto given =
      start({"-options_file", first, "-options_file", second, "-quiet", "-quiet", "no"}).given;
  EXPECT_EQ(given.at("tissue_young").value, "3");
  EXPECT_EQ(given.at("time_end").value, "5");
  EXPECT_EQ(given.at("quiet").value, "no");
}

// A dash before a digit begins no option, and a flag needs no value.
// For one version, and it is told of; the present name given as well is the same option.
TEST_F(OptionSource, OldNamesMeanThePresentOnes)
{
  const Invocation old = start({"-edges", "leak:a:outside", "-edge_leak_resistance", "1e9",
                                "-conduit_leak_resistance", "2e9"});
  EXPECT_EQ(old.given.at("conduits").value, "leak:a:outside");
  EXPECT_EQ(old.given.at("conduit_leak_resistance").value, "2e9");
  EXPECT_EQ(old.given.count("edges"), 0U);
  EXPECT_EQ(old.outdated, (std::vector<std::string>{"edges", "edge_leak_resistance"}));
  EXPECT_TRUE(start({"-conduits", "leak:a:outside"}).outdated.empty());
}

TEST_F(OptionSource, TellsNegativeNumbersFromNames)
{
  const auto given =
      start({"-gravity", "-1,0,-9.81", "-quiet", "-cavity_bladder_pressure", "-5", "-check"}).given;
  ASSERT_EQ(given.size(), 4U);
  EXPECT_EQ(given.at("gravity").value, "-1,0,-9.81");
  EXPECT_EQ(given.at("cavity_bladder_pressure").value, "-5");
  EXPECT_EQ(given.at("quiet").value, "");
  EXPECT_EQ(given.at("check").value, "");
}

TEST_F(OptionSource, WhatIsUnknownIsRefusedWithTheNearestName)
{
  EXPECT_EQ(refused({"-tisue_young", "7000"}),
            "option -tisue_young is unknown (did you mean '-tissue_young'?)");
  EXPECT_EQ(refused({"-options_file", file("some.opts", "-quiet\n-tisue_young 7\n")}),
            "option -tisue_young (some.opts:2) is unknown (did you mean '-tissue_young'?)");
  EXPECT_NE(refused({"stray"}).find("'stray' belongs to no option"), std::string::npos);
  EXPECT_NE(refused({"-fix", "z0", "z1"}).find("'z1' behind 'z0'"), std::string::npos);
  setenv("PETSC_OPTIONS", "-tisue_young 7", 1);
  EXPECT_NE(refused({}).find("-tisue_young (PETSC_OPTIONS) is unknown"), std::string::npos);
}

TEST_F(OptionSource, FilesNameOthersButNotThemselves)
{
  file("inner.opts", "-time_end 2\n");
  const auto given =
      start({"-options_file", file("outer.opts", "-options_file inner.opts\n-quiet\n")});
  EXPECT_EQ(given.given.at("time_end").place, "inner.opts:1");
  EXPECT_EQ(given.options_file, "outer.opts,inner.opts");
  EXPECT_EQ(given.options_file_text, "-options_file inner.opts\n-quiet\n-time_end 2\n");
  file("b.opts", "\n-options_file a.opts\n");
  EXPECT_EQ(refused({"-options_file", file("a.opts", "-options_file b.opts")}),
            "option -options_file (b.opts:2): 'a.opts' includes itself");
  EXPECT_EQ(refused({"-options_file", file("c.opts", "-options_file no.opts")}),
            "option -options_file (c.opts:1): no such file 'no.opts'");
  EXPECT_EQ(refused({"-options_file", "no.opts"}), "option -options_file: no such file 'no.opts'");
  EXPECT_EQ(refused({"-options_file"}), "option -options_file: a file name must follow");
  EXPECT_EQ(refused({"-options_file", "."}),
            "option -options_file: this is no file that can be read: '.'");
}

// The working folder first, then beside the options file; the record has the path that was found.
TEST_F(OptionSource, FilesAreLookedForInTwoPlaces)
{
  base::on_root(comm, [] { std::filesystem::create_directories("scene"); });
  file("scene/only_there.msh", "");
  file("both.msh", "");
  file("scene/both.msh", "");
  const auto mesh = [&](const std::string& name) {
    const std::string opts = file("scene/some.opts", "-mesh " + name + "\n");
    return start({"-options_file", opts}).given.at("mesh").value;
  };
  EXPECT_EQ(mesh("only_there.msh"), "scene/only_there.msh");
  EXPECT_EQ(mesh("both.msh"), "both.msh");
  EXPECT_EQ(mesh("nowhere.msh"), "nowhere.msh");
  file("scene/nested.opts", "-quiet\n");
  EXPECT_EQ(start({"-options_file", file("scene/outer.opts", "-options_file nested.opts\n")})
                .given.count("quiet"),
            1U);
}

// Nothing but the solver's options and a few reports reaches PETSc, and none that writes or runs.
TEST_F(OptionSource, PetscGetsWhatCanDoNoHarm)
{
  const auto taken = start({"-tissue_ksp_type", "cg", "-tissue_ksp_view", "-tissue_ksp_monitor",
                            "ascii", "-tissue_mg_levels_pc_type", "sor", "-log_view", "-fp_trap",
                            "-tissue_mat_mumps_icntl_14", "80", "-tissue_ksp_rtol", "1e-9"})
                         .petsc;
  EXPECT_EQ(taken, (std::vector<std::string>{
                       "-tissue_ksp_type", "cg", "-tissue_ksp_view", "-tissue_ksp_monitor", "ascii",
                       "-tissue_mg_levels_pc_type", "sor", "-log_view", "-fp_trap",
                       "-tissue_mat_mumps_icntl_14", "80", "-tissue_ksp_rtol", "1e-9"}));
  const std::vector<std::vector<std::string>> harmful{
      {"-dll_append", "x.so"},
      {"-info", "x"},
      {"-history", "x"},
      {"-start_in_debugger"},
      {"-on_error_attach_debugger", "x"},
      {"-options_view"},
      {"-options_left"},
      {"-options_monitor"},
      {"-log_trace", "x"},
      {"-log_view", ":x"},
      {"-log_view", "ascii"},
      {"-malloc_dump", "x"},
      {"-malloc_debug", "x"},
      {"-fp_trap", "./x"},
      {"-ksp_type", "cg"},
      {"-viewer_binary_filename", "x"},
      {"-tissue_ksp_view", "ascii:x"},
      {"-tissue_ksp_view", "binary"},
      {"-tissue_ksp_view_mat", "draw"},
      {"-tissue_ksp_monitor", "x"},
      {"-tissue_ksp_converged_reason", ":x"},
      {"-tissue_ksp_type", "python"},
      {"-tissue_pc_python_type", "x.y"},
      {"-tissue_pc_type", "Python"},
      {"-tissue_pc_type", "a/b"},
      {"-tissue_mat_mumps_ooc_tmpdir", "x"},
      {"-tissue_mat_mumps_icntl_22", "1"},
      {"-tissue_mat_mumps_icntl_2", "8"},
      {"-tissue_pc_factor_mat_solver_type", "superlu_dist"}};
  for (const auto& words : harmful) {
    const std::string line = refused(words);
    EXPECT_NE(line.find(words[0]), std::string::npos) << words[0] << ": " << line;
  }
}

TEST_F(OptionSource, UnusedSolverOptionsAreToldFromMisspeltOnes)
{
  const auto left = [&](const std::string& name) {
    TROCAR_PETSC(PetscOptionsSetValue(nullptr, ("-" + name).c_str(), "1"));
    EXPECT_TRUE(tissue_solver_given());
    const std::string line = refusal(core::ExitCode::options, [] { refuse_unused("a factor"); });
    TROCAR_PETSC(PetscOptionsClearValue(nullptr, ("-" + name).c_str()));
    return line;
  };
  EXPECT_EQ(left("tissue_ksp_rtoll"),
            "option -tissue_ksp_rtoll is unknown (did you mean '-tissue_ksp_rtol'?)");
  EXPECT_EQ(left("tissue_ksp_rtol"),
            "option -tissue_ksp_rtol means nothing to the tissue's solver, a factor");
  EXPECT_FALSE(tissue_solver_given());
  TROCAR_PETSC(PetscOptionsSetValue(nullptr, "-tissue_ksp_view", nullptr));
  EXPECT_NO_THROW(refuse_unused("a factor"));  // asked for only when it solves
  TROCAR_PETSC(PetscOptionsClearValue(nullptr, "-tissue_ksp_view"));
}

TEST_F(OptionSource, EveryRankReadsTheSameTable)
{
  const core::Csv table = read_csv(file("table.csv", "time,factor\n0,0\n2,1\n"), comm);
  EXPECT_EQ(table.columns, (std::vector<std::string>{"time", "factor"}));
  EXPECT_EQ(table.rows, (std::vector<std::vector<double>>{{0, 0}, {2, 1}}));
  EXPECT_NE(refusal(core::ExitCode::data, [&] { read_csv("no.csv", comm); }).find("no.csv"),
            std::string::npos);
  EXPECT_NE(refusal(core::ExitCode::data, [&] { read_csv(".", comm); }).find("no file"),
            std::string::npos);
}

}  // namespace
}  // namespace trocar::driver
