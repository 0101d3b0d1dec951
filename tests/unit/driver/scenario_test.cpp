#include "driver/scenario.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cavity/wall.hpp"
#include "core/failure.hpp"
#include "driver/option_list.hpp"
#include "support/block.hpp"
#include "support/files.hpp"

namespace trocar::driver {
namespace {

using core::Vec3;
using Words = std::map<std::string, std::string>;

/// Options beside a mesh: a block of 4 x 4 x 4 cm, whose cell in the middle of 2 cm is the volume
/// "core" and the rest "beam".
class ScenarioTest : public ::testing::Test
{
 protected:
  ScenarioTest()
  {
    mesh::Mesh mesh = test::block({4, 4, 4, Vec3(0.04, 0.04, 0.04)});
    mesh.volumes.push_back("core");
    for (int t = 0; t < mesh.tet_count(); ++t) {
      Vec3 middle = Vec3::Zero();
      for (const Vec3& x : mesh::corners(mesh, t)) middle += 0.25 * x;
      if ((middle.array() - 0.02).abs().maxCoeff() < 0.01)
        mesh.region[static_cast<std::size_t>(t)] = 1;
    }
    file = test::shared_mesh("scenario.msh", mesh, comm);
  }

  Scenario read(const Words& words)
  {
    std::map<std::string, core::OptionValue> given{{"mesh", {file, "command line"}}};
    for (const auto& [name, value] : words) given[name] = {value, "command line"};
    core::Options options(option_table(), std::move(given));
    return read_scenario(options, comm);
  }
  /// These options are refused on this rank, by code and with these words.
  void expect_refusal(const Words& words, core::ExitCode code, const std::string& why)
  {
    try {
      read(words);
      ADD_FAILURE() << "accepted what " << why;
    } catch (const core::Failure& failure) {
      EXPECT_EQ(failure.code(), code) << failure.what();
      EXPECT_NE(std::string(failure.what()).find(why), std::string::npos) << failure.what();
    }
  }
  void expect_refused_option(const Words& words, const std::string& why)
  {
    expect_refusal(words, core::ExitCode::options, why);
  }

  base::Comm comm{MPI_COMM_WORLD};
  std::string file;
};

TEST_F(ScenarioTest, HasTheDefaultsOfTheTable)
{
  const Scenario scenario = read({});
  EXPECT_EQ(scenario.mesh.volumes, (std::vector<std::string>{"beam", "core"}));
  EXPECT_FALSE(scenario.time.is_static);
  EXPECT_EQ(scenario.time.step, 0.01);
  EXPECT_EQ(scenario.time.end, 0.0);
  EXPECT_FALSE(scenario.time.second_order || scenario.time.start_in_equilibrium);
  EXPECT_EQ(scenario.tissue.model, tissue::Model::corotational);
  ASSERT_EQ(scenario.tissue.materials.size(), 2U);
  EXPECT_EQ(scenario.tissue.materials[1].young, 5000.0);
  EXPECT_EQ(scenario.tissue.materials[1].poisson, 0.45);
  EXPECT_TRUE(scenario.mesh.quadratic());  // p2 by itself
  EXPECT_TRUE(scenario.needles.empty() && scenario.cavities.cavities.empty());
  EXPECT_EQ(scenario.output.folder, "results");
  EXPECT_TRUE(scenario.output.displacement);
  EXPECT_FALSE(scenario.output.velocity || scenario.output.stress.any() || scenario.check_only);
  EXPECT_EQ(scenario.laws.method, law::Method::automatic);
  EXPECT_EQ(scenario.laws.tolerance, 1e-9);
  EXPECT_TRUE(scenario.warnings.empty());
}

TEST_F(ScenarioTest, TakesVectorsAndScalesTheMesh)
{
  const Scenario scenario = read({{"gravity", "0, -1.5,-9.81"}, {"mesh_scale", "0.5"}});
  EXPECT_EQ(scenario.tissue.boundary.gravity, Vec3(0.0, -1.5, -9.81));
  EXPECT_NEAR(mesh::quality(scenario.mesh).volume, 8e-6, 1e-17);
  for (const char* bad : {"1,2", "1,2,3,4", "1,,3", "x,0,0", "free,0,0"})
    expect_refused_option({{"gravity", bad}}, "-gravity");
}

TEST_F(ScenarioTest, GivesEveryVolumeItsOwnMaterial)
{
  const Scenario scenario = read({{"tissue_young", "7000"},
                                  {"tissue_core_young", "9000"},
                                  {"tissue_core_density", "1200"},
                                  {"insertion_core_friction_dynamic", "3"},
                                  {"insertion_friction_dynamic", "2"},
                                  {"insertion_friction_dynamic_withdraw", "1"}});
  const auto& materials = scenario.tissue.materials;
  EXPECT_EQ(materials[0].young, 7000.0);
  EXPECT_EQ(materials[1].young, 9000.0);
  EXPECT_EQ(materials[0].density, 1000.0);
  EXPECT_EQ(materials[1].density, 1200.0);
  const auto& friction = scenario.insertion.friction;
  EXPECT_EQ(friction[0].advance.dynamic_limit, 2.0);
  EXPECT_EQ(friction[1].advance.dynamic_limit, 3.0);
  EXPECT_EQ(friction[1].withdraw.dynamic_limit, 1.0);
  EXPECT_EQ(friction[1].withdraw.static_limit, friction[1].advance.static_limit);
}

TEST_F(ScenarioTest, RefusesWhatNamesNothingInTheScene)
{
  expect_refused_option({{"tissue_coer_young", "9000"}}, "did you mean '-tissue_core_young'");
  expect_refused_option({{"needle_tip_length", "0.1"}}, "-needle_tip_length");
  expect_refused_option({{"output_fields", "displacment"}}, "did you mean 'displacement'");
  expect_refusal({{"fix", "z9"}}, core::ExitCode::data, "did you mean");
  expect_refusal({{"mesh", "no_such.msh"}}, core::ExitCode::data, "no_such.msh");
  expect_refused_option({{"mesh", ""}}, "-mesh is missing");
}

TEST_F(ScenarioTest, ChoosesTheElementByPoissonsRatio)
{
  using tissue::Dilatation;
  struct Case
  {
    const char *element, *poisson;
    bool quadratic;
    Dilatation dilatation;
  };
  for (const Case& one : {Case{"auto", "0.45", true, Dilatation::pointwise},
                          {"auto", "0.495", true, Dilatation::nodal},
                          {"p1", "0.45", false, Dilatation::pointwise},
                          {"p1_anp", "0.3", false, Dilatation::nodal},
                          {"p2_bbar", "0.3", true, Dilatation::element}}) {
    const Scenario scenario =
        read({{"tissue_element", one.element}, {"tissue_core_poisson", one.poisson}});
    EXPECT_EQ(scenario.mesh.quadratic(), one.quadratic) << one.element;
    EXPECT_EQ(scenario.tissue.dilatation, one.dilatation) << one.element << one.poisson;
  }
  const Scenario locks = read({{"tissue_element", "p1"}, {"tissue_core_poisson", "0.48"}});
  ASSERT_EQ(locks.warnings.size(), 1U);
  EXPECT_NE(locks.warnings[0].find("'core'"), std::string::npos);
}

TEST_F(ScenarioTest, ReadsSupportsAndLoads)
{
  const std::string curve = test::shared_text("ramp.csv", "time,factor\n0,0\n1,1\n", comm);
  const Scenario scenario = read({{"fix", "z0,x0:xy"},
                                  {"boundary_z1_displacement", "free,0,-0.002"},
                                  {"boundary_z1_curve", curve},
                                  {"boundary_y1_traction", "0,50,0"}});
  const tissue::BoundaryConditions& boundary = scenario.tissue.boundary;
  ASSERT_EQ(boundary.fixed.size(), 2U);
  EXPECT_EQ(boundary.fixed[0].axes, 7U);
  EXPECT_EQ(boundary.fixed[1].axes, 3U);
  const auto again = read({{"fix", "z0:x,x0,z0:z"}}).tissue.boundary.fixed;
  ASSERT_EQ(again.size(), 2U);  // a group is one support
  EXPECT_EQ(again[0].axes, 5U);
  ASSERT_EQ(boundary.displacements.size(), 1U);
  EXPECT_TRUE(std::isnan(boundary.displacements[0].value.x()));
  EXPECT_EQ(boundary.displacements[0].value.z(), -0.002);
  EXPECT_EQ(tissue::load_factor(boundary.displacements[0].curve, 0.25), 0.25);
  ASSERT_EQ(boundary.tractions.size(), 1U);
  EXPECT_EQ(boundary.tractions[0].value, Vec3(0, 50, 0));
  expect_refused_option({{"fix", "z0:w"}}, "axes are letters of xyz");
  for (const char* option : {"fix", "boundary_core_traction", "boundary_core_displacement"})
    expect_refusal({{option, option == std::string("fix") ? "core" : "0,0,1"}},
                   core::ExitCode::data, "'core' is a volume");
  expect_refusal({{"cavities", "pocket"}, {"cavity_surface", "core"}}, core::ExitCode::data,
                 "'core' is a volume");
  expect_refused_option({{"boundary_z1_curve", curve}}, "neither displacement nor traction");
}

// A node of two groups: what agrees is prescribed once, what does not is refused.
TEST_F(ScenarioTest, RefusesGroupsThatDisagreeOnANode)
{
  const std::string ramp = test::shared_text("ramp.csv", "time,factor\n0,0\n1,1\n", comm);
  const std::string fall = test::shared_text("fall.csv", "time,factor\n0,1\n1,0\n", comm);
  const auto refused = [&](const Words& options, const std::string& words) {
    expect_refusal(options, core::ExitCode::data, words);
  };
  refused({{"fix", "z0"}, {"boundary_x1_displacement", "0.001,free,free"}},
          "disagree along x: 'z0' holds it, 'x1' moves it by 0.001 m");
  refused({{"boundary_z1_displacement", "0.001,0,0"}, {"boundary_x1_displacement", "0.002,0,0"}},
          "'x1' moves it by 0.002 m, 'z1' moves it by 0.001 m");
  refused({{"boundary_z1_displacement", "0.001,0,0"},
           {"boundary_x1_displacement", "0.001,0,0"},
           {"boundary_x1_curve", ramp},
           {"boundary_z1_curve", fall}},
          "times its curve");
  read({{"fix", "z0:z,x0:x"}, {"boundary_x1_displacement", "0.001,free,0"}});
  read({{"boundary_z1_displacement", "0.001,0,0"},
        {"boundary_x1_displacement", "0.001,0,0"},
        {"boundary_x1_curve", ramp},
        {"boundary_z1_curve", ramp}});
}

TEST_F(ScenarioTest, ReadsFieldsByWholeNodeTags)
{
  const auto field = [&](const std::string& rows) {
    return test::shared_text("field.csv", "node,x,y,z\n" + rows, comm);
  };
  const auto refused = [&](const std::string& rows, const std::string& words) {
    expect_refusal({{"boundary_z1_field", field(rows)}}, core::ExitCode::data, words);
  };
  refused("1.7,0,0,1\n", "node 1.7 is no tag of a node");
  refused("1e300,0,0,1\n", "node 1e+300 is no tag");
  refused("5,0,0,1\n5,0,0,2\n", "node 5 is given twice");
}

TEST_F(ScenarioTest, RefusesWhatCouldDoNothing)
{
  expect_refused_option({{"analysis", "static"}, {"time_scheme", "bdf2"}}, "-time_scheme bdf2");
  expect_refused_option({{"tissue_model", "linear"}, {"tissue_tangent", "exact"}},
                        "-tissue_tangent exact");
  expect_refused_option({{"locking_gauge", ""}}, "-locking_gauge");
  expect_refused_option({{"insertion_radius_correction", ""}}, "there is no needle");
  expect_refused_option({{"analysis", "static"}, {"insertion_friction_viscous", "3"}},
                        "takes no time");
  expect_refused_option({{"error_size_field", "next.pos"}}, "give -error_target");
  expect_refused_option({{"pv_low", "0.5"}}, "is for -analysis pv_curve");
  expect_refused_option({{"insertion_friction_static_withdraw", "-0.5"}}, "must be -1");
}

TEST_F(ScenarioTest, ReadsSolversToBeCompared)
{
  const Scenario scenario = read({{"constraint_solver", "hybrid"},
                                  {"constraint_tolerance", "1e-8"},
                                  {"constraint_compare", "pgs:step:1e-7,auto"}});
  EXPECT_EQ(scenario.laws.method, law::Method::hybrid);
  ASSERT_EQ(scenario.compare.size(), 2U);
  EXPECT_EQ(scenario.compare[0].settings.method, law::Method::pgs);
  EXPECT_EQ(scenario.compare[0].settings.norm, law::Norm::step);
  EXPECT_EQ(scenario.compare[0].settings.tolerance, 1e-7);
  EXPECT_EQ(scenario.compare[1].settings.method, law::Method::automatic);
  EXPECT_EQ(scenario.compare[1].settings.tolerance, 1e-8);  // as for that of the run
  for (const char* bad : {"newton", "pgs:max", "pgs:step:0", "pgs:step:1e-7x", "pgs:step:1:2"})
    expect_refused_option({{"constraint_compare", bad}}, bad);
}

TEST_F(ScenarioTest, EmptiesTheVolumeThatACavityTakesOut)
{
  const Scenario scenario = read({{"cavities", "bladder"},
                                  {"cavity_region", "core"},
                                  {"cavity_bladder_initial_pressure", "300"},
                                  {"cavity_density", "1000"},
                                  {"gravity", "0,0,-10"},
                                  {"conduits", "leak:bladder:outside"},
                                  {"conduit_leak_resistance", "1e9"}});
  EXPECT_EQ(scenario.mesh.volumes, (std::vector<std::string>{"beam"}));
  EXPECT_NEAR(mesh::quality(scenario.mesh).volume, 64e-6 - 8e-6, 1e-16);
  ASSERT_EQ(scenario.cavities.cavities.size(), 1U);
  const cavity::CavitySettings& bladder = scenario.cavities.cavities[0];
  EXPECT_EQ(bladder.surface, "core");
  EXPECT_NEAR(cavity::Wall(scenario.mesh, bladder.surface, false).area(), 6 * 4e-4, 1e-15);
  EXPECT_EQ(bladder.initial_pressure, 300.0);
  EXPECT_EQ(bladder.weight, Vec3(0, 0, -10000));
  EXPECT_TRUE(scenario.time.start_in_equilibrium);
  ASSERT_EQ(scenario.cavities.conduits.size(), 1U);
  EXPECT_EQ(scenario.cavities.conduits[0].from, 0);
  EXPECT_EQ(scenario.cavities.conduits[0].to, -1);
  expect_refused_option({{"cavities", "bladder"}}, "either a surface or a volume");
  expect_refused_option({{"cavities", "bladder"}, {"cavity_region", "core"}, {"cavity_law", "gsa"}},
                        "did you mean 'gas'");
}

TEST_F(ScenarioTest, ReadsNeedlesWithTheirOverrides)
{
  const Scenario scenario = read({{"needles", "left,right"},
                                  {"needle_entry", "0,0.011,0.023"},
                                  {"needle_right_entry", "0,0.031,0.023"},
                                  {"needle_direction", "2,0,0"},
                                  {"needle_velocity", "0.01"},
                                  {"needle_depth", "0.02"},
                                  {"needle_right_model", "rigid"},
                                  {"needle_left_bevel", "0.5235987755982988"},
                                  {"time_end", "1"}});
  ASSERT_EQ(scenario.needles.size(), 2U);
  EXPECT_NEAR(scenario.needles[0].bevel, std::sqrt(3.0), 1e-12);  // a face at 30° to the axis
  EXPECT_EQ(scenario.needles[1].bevel, 0.0);
  EXPECT_EQ(scenario.needles[0].name, "left");
  EXPECT_EQ(scenario.needles[0].model, needle::Model::beam);
  EXPECT_EQ(scenario.needles[1].model, needle::Model::rigid);
  EXPECT_EQ(scenario.needles[1].motion.entry, Vec3(0, 0.031, 0.023));
  EXPECT_EQ(scenario.needles[0].motion.direction, Vec3::UnitX());  // made unit
  EXPECT_FALSE(scenario.tissue.ordered_last.empty());              // what the paths go through
}

}  // namespace
}  // namespace trocar::driver
