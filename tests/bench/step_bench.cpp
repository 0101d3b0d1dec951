// Times of whole corotational steps of an insertion into a gel bar that is being sheared, one line
// of CSV per figure: dofs,figure,value,unit. usage: step_bench DOFS [FRICTION N/m]
// [COLUMN_BASELINE: 0 or 1]
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "base/petsc.hpp"
#include "core/stopwatch.hpp"
#include "driver/needle_options.hpp"
#include "fem/shape.hpp"
#include "mesh/locator.hpp"
#include "support/scene.hpp"

namespace trocar {
namespace {

using core::Vec3;

constexpr int ramp_steps = 20;     ///< from rest to `angle`
constexpr double angle = 5.0;      ///< of the tissue since the factor was made [degrees]
constexpr int measured_steps = 5;  ///< the last ones
const Vec3 size(0.15, 0.04, 0.04);

struct Bench
{
  int dofs = 0;
  void figure(const std::string& name, double value, const char* unit) const
  {
    std::printf("%d,%s,%.6g,%s\n", dofs, name.c_str(), value, unit);
    std::fflush(stdout);
  }
};

/// A needle that slips through the bar; its upper side moves so that the rotation grows evenly.
step::Scene scene(const test::BlockShape& shape, double friction)
{
  step::Scene scenario = test::needle_scenario(shape);
  scenario.insertion.friction = test::same({friction, friction, 0.0});
  scenario.time.step = 0.01;
  scenario.tissue.model = tissue::Model::corotational;
  scenario.tissue.materials = {{5000.0, 0.45, 1000.0, 0.1, 0.001}};
  scenario.tissue.provider = solve::Provider::supernodal;
  const double shear = 2.0 * std::tan(angle * std::numbers::pi / 180.0) * size.z();
  const double end = ramp_steps * scenario.time.step;
  const core::Csv ramp{"shear", {"time", "factor"}, {{0, 0}, {end, 1}, {10, 1}}};
  scenario.tissue.boundary.displacements = {{"z1", Vec3(shear, 0, 0), ramp}};
  needle::NeedleSettings& needle = scenario.needles[0];
  needle.model = needle::Model::beam;
  needle.motion.length = 0.2;
  needle.motion.inserted = 0.08;
  needle.motion.velocity = 0.1;
  needle.motion.depth = 0.14;
  return scenario;
}

struct Course
{
  std::vector<step::State> states;  ///< before each measured step, and at the end
  std::vector<double> seconds;
  int passes = 0, rows = 0, age = 0;
};

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

step::State must(const step::Outcome<step::Accepted>& result)
{
  if (!result) throw core::solver_error("rejected: " + result.why());
  return result->state;
}

core::TimeStep time_of(const step::Scene& scenario, int n)
{
  return {n * scenario.time.step, scenario.time.step, false};
}

/// All steps with an older factor; the last ones are timed.
Course lagged(step::Scene scenario, double tolerance, const base::Comm& comm)
{
  scenario.tissue.lag_tolerance = tolerance;
  step::Model simulation(scenario, comm);
  Course course;
  step::State state = must(step::initial_state(simulation));
  for (int n = 1; n <= ramp_steps; ++n) {
    const bool timed = n > ramp_steps - measured_steps;
    if (timed) course.states.push_back(state);
    const core::Stopwatch watch;
    const step::Outcome<step::Accepted> result =
        step::advance(simulation, state, time_of(scenario, n));
    if (timed) course.seconds.push_back(watch.seconds());
    state = must(result);
    course.passes = result->report.passes;
    course.rows = result->report.rows;
    course.age = simulation.tissue.factor().age().uses;
  }
  course.states.push_back(state);
  return course;
}

/// The last steps of a course again, from the same states, by other means.
Course again(step::Scene scenario, const Course& model, std::size_t steps, const base::Comm& comm)
{
  scenario.tissue.lag_tolerance = 0.0;
  step::Model simulation(scenario, comm);
  step::prepare(simulation);  // analysis and first factor are not part of a step
  Course course;
  const std::size_t first = model.states.size() - 1 - steps;
  for (std::size_t k = first; k + 1 < model.states.size(); ++k) {
    const int n = ramp_steps - static_cast<int>(model.states.size() - 2 - k);
    const core::Stopwatch watch;
    const step::Outcome<step::Accepted> result =
        step::advance(simulation, model.states[k], time_of(scenario, n));
    course.seconds.push_back(watch.seconds());
    course.states.push_back(must(result));
  }
  return course;
}

/// Worst difference of the displacements against the way of the last step.
double error_of_change(const Course& course, const step::State& exact)
{
  const auto& last = course.states.back().tissue.u.value;
  const auto& before = course.states[course.states.size() - 2].tissue.u.value;
  const auto& u = exact.tissue.u.value;
  return (last - u).cwiseAbs().maxCoeff() / (u - before).cwiseAbs().maxCoeff();
}

/// Largest rotation of an element at the end of a course, from rest [degrees].
double largest_turn(const Course& course, const mesh::Mesh& mesh)
{
  double largest = 0.0;
  const auto& u = course.states.back().tissue.u;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Eigen::Matrix<double, 3, 4> nodal;
    for (int a = 0; a < 4; ++a)
      nodal.col(a) = u.node(mesh.tets[static_cast<std::size_t>(t)][static_cast<std::size_t>(a)]);
    const core::Mat3 F = core::Mat3::Identity() +
                         nodal * fem::tet_shape(mesh::corners(mesh, t)).gradient.transpose();
    largest = std::max(largest, core::rotation_log(core::polar_rotation(F)).norm());
  }
  return largest * 180.0 / std::numbers::pi;
}

void run(Bench bench, double friction, bool with_columns)
{
  const base::Comm comm(MPI_COMM_WORLD);
  int n = 2;
  while (3 * (15 * n / 4 + 1) * (n + 1) * (n + 1) < bench.dofs) ++n;
  const test::BlockShape shape{15 * n / 4, n, n, size, 0.15};
  bench.dofs = 3 * (15 * n / 4 + 1) * (n + 1) * (n + 1);
  step::Scene scenario = scene(shape, friction);
  Course course;
  for (const auto& [name, tolerance] :
       {std::pair{"lag_1e-3", 1e-3}, std::pair{"lag_1e-4", 1e-4}, std::pair{"lag_1e-6", 1e-6}}) {
    course = lagged(scenario, tolerance, comm);
    const step::State exact = again(scenario, course, 1, comm).states.back();
    bench.figure(name + std::string("_step"), median(course.seconds), "s");
    bench.figure(name + std::string("_error"), error_of_change(course, exact), "1");
    bench.figure(name + std::string("_passes"), course.passes, "1");
    bench.figure(name + std::string("_age"), course.age, "1");
  }
  bench.figure("largest_turn", largest_turn(course, scenario.mesh), "degrees");
  bench.figure("rows", course.rows, "1");
  bench.figure("refactor_step", median(again(scenario, course, 3, comm).seconds), "s");
  const mesh::Locator locator(scenario.mesh);
  scenario.tissue.ordered_last = driver::planned_nodes(scenario.needles, scenario.mesh, locator, 1);
  bench.figure("refactor_pinned_step", median(again(scenario, course, 3, comm).seconds), "s");
  if (!with_columns) return;
  scenario.tissue.provider = solve::Provider::ksp;
  bench.figure("column_step", median(again(scenario, course, 1, comm).seconds), "s");
}

}  // namespace
}  // namespace trocar

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  {
    const trocar::base::PetscSession petsc({});
    trocar::run({argc > 1 ? std::atoi(argv[1]) : 4000}, argc > 2 ? std::atof(argv[2]) : 2.0,
                argc > 3 && std::atoi(argv[3]) != 0);
  }
  MPI_Finalize();
  return 0;
}
