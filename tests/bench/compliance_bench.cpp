// Times of the tissue's linear algebra on a gel bar, one line of CSV per figure:
// dofs,figure,value,unit. usage: compliance_bench DOFS [REPEATS] [BASELINE_COLUMNS]
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>

#include "base/blas.hpp"
#include "core/stopwatch.hpp"
#include "mesh/locator.hpp"
#include "mesh/partition.hpp"
#include "solve/step_solver.hpp"
#include "support/body.hpp"

namespace trocar {
namespace {

using core::Vec3;

struct Bench
{
  int dofs = 0;
  int repeats = 5;

  void figure(const std::string& name, double value, const char* unit) const
  {
    std::printf("%d,%s,%.6g,%s\n", dofs, name.c_str(), value, unit);
    std::fflush(stdout);
  }
  /// Median wall time of `work` after `prepare` [s].
  double median(
      const std::function<void()>& work, const std::function<void()>& prepare = [] {}) const
  {
    std::vector<double> seconds;
    for (int k = 0; k < repeats; ++k) {
      prepare();
      const core::Stopwatch watch;
      work();
      seconds.push_back(watch.seconds());
    }
    std::nth_element(seconds.begin(), seconds.begin() + repeats / 2, seconds.end());
    return seconds[static_cast<std::size_t>(repeats / 2)];
  }
};

/// Read rate and triad rate of one core [B/s].
void memory_rates(const Bench& bench)
{
  const auto n = static_cast<Eigen::Index>(2e7);
  core::VecX a = core::VecX::Ones(n), b = core::VecX::Ones(n), c = core::VecX::Ones(n);
  double sum = 0.0;
  const double read = bench.median([&] { sum += b.sum(); });
  const double triad = bench.median([&] { a.noalias() = b + 3.0 * c; });
  bench.figure("read_rate", 8.0 * static_cast<double>(n) / read, "B/s");
  bench.figure("triad_rate", 24.0 * static_cast<double>(n) / triad + 0.0 * (sum + a[0]), "B/s");
}

/// Memory that this process holds ("VmRSS:") or has held at most ("VmHWM:") [B].
double resident_bytes(const std::string& which)
{
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0.0;
  while (status >> word)
    if (word == which) status >> kilobytes;
  return 1024.0 * kilobytes;
}

/// Nodes of all tets along the long axis: what a needle through the bar may probe.
std::vector<int> axis_nodes(const mesh::Mesh& mesh, const Vec3& size)
{
  const mesh::Locator locator(mesh);
  std::vector<int> nodes;
  for (double x = 0.0; x <= size.x(); x += 2e-4) {
    const int tet = locator.tet_at(Vec3(x, 0.4817 * size.y(), 0.5231 * size.z()));
    if (tet < 0) continue;
    const auto& corner = mesh.tets[static_cast<std::size_t>(tet)];
    nodes.insert(nodes.end(), corner.begin(), corner.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

tissue::TissueSettings gel(solve::Provider provider, const std::vector<int>& ordered_last = {})
{
  tissue::TissueSettings settings;
  settings.model = tissue::Model::linear;
  settings.materials = {{5000.0, 0.45, 1000.0, 0.1, 0.001}};
  settings.boundary.fixed = {{"z0", 7}};
  settings.provider = provider;
  settings.ordered_last = ordered_last;
  return settings;
}

/// First operator of a body: analysis, assembly and factor, and the memory they take.
void set_up(const Bench& bench, test::Body& body, double h)
{
  const double before = resident_bytes("VmRSS:");
  const core::Stopwatch watch;
  body.tissue.analyse();
  body.tissue.prepare({h, h, false});
  bench.figure("first_operator", watch.seconds(), "s");
  bench.figure("memory_estimate", body.tissue.factor().solver().memory_bytes(), "B");
  bench.figure("memory_peak", resident_bytes("VmHWM:") - before, "B");
}

/// Median time of twelve new columns beside those there before [s].
double twelve_columns(test::Body& body, const std::vector<int>& nodes)
{
  solve::ComplianceReport report;
  std::vector<double> by_four;
  for (std::size_t at = 0; at + 4 <= nodes.size(); at += 4) {
    const auto begin = nodes.begin() + static_cast<std::ptrdiff_t>(at);
    const core::Stopwatch four;
    body.tissue.factor().compliance().block({{begin, begin + 4}, {}}, report);
    by_four.push_back(four.seconds());
  }
  std::nth_element(by_four.begin(),
                   by_four.begin() + static_cast<std::ptrdiff_t>(by_four.size() / 2),
                   by_four.end());
  return by_four[by_four.size() / 2];
}

void time_supernodal(const Bench& bench, const test::BlockShape& shape)
{
  test::Body body(shape, gel(solve::Provider::supernodal));
  double h = 0.01;
  set_up(bench, body, h);
  bench.figure("factor_bytes", body.tissue.factor().solver().factor_bytes(), "B");
  const auto nodes = axis_nodes(body.mesh, shape.size);
  bench.figure("isolated_dofs", 3.0 * static_cast<double>(nodes.size()), "1");

  const fem::OwnedField load{core::VecX::Ones(body.space.owned_dofs())};
  bench.figure("sweep", bench.median([&] { body.tissue.factor().answer(load); }), "s");
  // A new h is a new operator: its columns start from nothing.
  solve::ComplianceReport report;
  bench.figure("columns_at_once",
               bench.median(
                   [&] {
                     body.tissue.factor().compliance().block({nodes, {}}, report);
                   },
                   [&] {
                     h *= 1.01;
                     body.tissue.prepare({h, h, false});
                   }),
               "s");
  h *= 1.01;
  body.tissue.prepare({h, h, false});
  bench.figure("twelve_columns", twelve_columns(body, nodes), "s");
  const solve::Probes probes{nodes, {}};
  const core::VecX f = core::VecX::Ones(probes.size());
  bench.figure("step_sweep", bench.median([&] {
    solve::LaggedFactor& factor = body.tissue.factor();
    const solve::HalfSolution half = factor.begin(load);
    factor.read(probes, half);
    factor.finish(half, probes, f);
  }),
               "s");
}

/// Filling the operator's values, with and without rotations, and the least that must be moved for
/// it: values zeroed, read and written, and every tet's gradients, volume and slots read. `suffix`:
/// of the figures of quadratic tets, whose factor is timed as well.
void time_assembly(const Bench& bench, const test::BlockShape& shape, const std::string& suffix)
{
  for (const auto model : {tissue::Model::linear, tissue::Model::corotational}) {
    tissue::TissueSettings settings = gel(solve::Provider::supernodal);
    settings.model = model;
    test::Body body(shape, settings);
    const bool turns = model == tissue::Model::corotational;
    fem::OwnedField u = body.space.zero();
    for (int k = 0; k < body.space.owned(); ++k) {
      const Vec3& x = body.mesh.x[static_cast<std::size_t>(body.space.file_node(k))];
      u.node(k) = 0.2 * Vec3(x.z(), 0, -x.x() * x.z() / 0.04);
    }
    const fem::GhostedField u_g = body.space.with_ghosts(u);
    tissue::LinearisationPoint at;
    const double seconds = bench.median([&] {
      if (turns || at.R.empty()) body.tissue.configure(u_g, at);
      body.tissue.assemble(at, {100.0, 100.0});
    });
    bench.figure((turns ? "assembly_corotational" : "assembly_linear") + suffix, seconds, "s");
    if (turns) continue;
    const fem::BlockPattern pattern(body.space);
    // Quadratic tets: ten gradients and a volume at four points, 55 slots.
    const double read = shape.quadratic ? 4.0 * 248.0 + 224.0 : 104.0 + 44.0;
    bench.figure("assembly_bytes" + suffix,
                 3.0 * 72.0 * static_cast<double>(pattern.block_count()) +
                     static_cast<double>(body.space.tets()) * read,
                 "B");
    if (suffix.empty()) continue;
    bench.figure("dofs" + suffix, static_cast<double>(body.space.owned_dofs()), "1");
    body.tissue.analyse();
    double h = 0.01;
    bench.figure("operator" + suffix, bench.median([&] {
      h *= 1.01;
      body.tissue.prepare({h, h, false});
    }),
                 "s");
  }
}

/// All columns of nodes that the factor has put last, and what that costs the factor.
void time_pinned(const Bench& bench, const test::BlockShape& shape)
{
  const mesh::Mesh mesh = test::block(shape);
  const auto nodes = axis_nodes(mesh, shape.size);
  test::Body body(shape, gel(solve::Provider::supernodal, nodes));
  double h = 0.01;
  solve::ComplianceReport report;
  const auto renew = [&] {
    h *= 1.01;
    body.tissue.prepare({h, h, false});
  };
  renew();
  bench.figure("pinned_columns",
               bench.median(
                   [&] {
                     body.tissue.factor().compliance().block({nodes, {}}, report);
                   },
                   renew),
               "s");
}

void time_baseline(const Bench& bench, const test::BlockShape& shape, std::size_t columns)
{
  test::Body body(shape, gel(solve::Provider::ksp));
  const core::Stopwatch watch;
  body.tissue.prepare({0.01, 0.01, false});
  bench.figure("mumps_first_operator", watch.seconds(), "s");
  auto nodes = axis_nodes(body.mesh, shape.size);
  nodes.resize(std::min(nodes.size(), (columns + 2) / 3));
  solve::ComplianceReport report;
  body.tissue.factor().compliance().block({nodes, {}}, report);
  bench.figure("mumps_column", report.seconds / report.built, "s");
}

int run(int argc, char** argv)
{
  Bench bench;
  bench.dofs = argc > 1 ? std::atoi(argv[1]) : 4000;
  if (argc > 2) bench.repeats = std::atoi(argv[2]);
  const Vec3 size(0.15, 0.04, 0.04);
  // Nodes of a bar of cubes: (15/4 n + 1)(n + 1)², three dofs each.
  int n = 2;
  while (3 * (15 * n / 4 + 1) * (n + 1) * (n + 1) < bench.dofs) ++n;
  const test::BlockShape shape{15 * n / 4, n, n, size, 0.15};
  bench.dofs = 3 * (15 * n / 4 + 1) * (n + 1) * (n + 1);
  bench.figure("dgemm_rate", base::blas_rate(), "flop/s");
  time_supernodal(bench, shape);  // first: its memory is what the process takes more
  memory_rates(bench);
  time_pinned(bench, shape);
  time_assembly(bench, shape, "");
  test::BlockShape half{15 * n / 8, n / 2, n / 2, size, 0.15};
  half.quadratic = true;
  time_assembly(bench, half, "_p2");
  time_baseline(bench, shape, argc > 3 ? static_cast<std::size_t>(std::atoi(argv[3])) : 60);
  return 0;
}

}  // namespace
}  // namespace trocar

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  int code = 0;
  {
    const trocar::base::PetscSession petsc({});
    code = trocar::run(argc, argv);
  }
  MPI_Finalize();
  return code;
}
