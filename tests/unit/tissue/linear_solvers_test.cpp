#include <gtest/gtest.h>

#include <optional>

#include "base/petsc.hpp"
#include "core/failure.hpp"
#include "solve/linear_system.hpp"
#include "support/body.hpp"

namespace trocar::tissue {
namespace {

/// Options of the tissue's solver, as long as the object lives.
class SolverOptions
{
 public:
  explicit SolverOptions(std::vector<std::array<std::string, 2>> options)
      : options_(std::move(options))
  {
    for (const auto& [name, value] : options_)
      TROCAR_PETSC(PetscOptionsSetValue(nullptr, ("-tissue_" + name).c_str(), value.c_str()));
  }
  ~SolverOptions()
  {
    for (const auto& [name, value] : options_)
      static_cast<void>(PetscOptionsClearValue(nullptr, ("-tissue_" + name).c_str()));
  }
  SolverOptions(const SolverOptions&) = delete;
  SolverOptions& operator=(const SolverOptions&) = delete;

 private:
  std::vector<std::array<std::string, 2>> options_;
};

struct SolverCase
{
  std::vector<std::array<std::string, 2>> options;
  bool one_rank_only = false;  ///< PETSc has no parallel form
};

std::vector<SolverCase> solver_cases()
{
  const std::array<std::string, 2> lu{"pc_type", "lu"}, cholesky{"pc_type", "cholesky"},
      cg{"ksp_type", "cg"};
  const auto package = [](const std::string& name) {
    return std::array<std::string, 2>{"pc_factor_mat_solver_type", name};
  };
  std::vector<SolverCase> cases{{{}, false},
                                {{cholesky, package("mumps")}, false},
                                {{lu, package("mumps")}, false},
                                {{lu, package("petsc")}, true},
                                {{cholesky, package("petsc")}, true},
                                {{cholesky, package("cholmod")}, true},
                                {{{"pc_type", "bjacobi"}, {"sub_pc_type", "icc"}}, false},
                                {{{"ksp_type", "gmres"}, {"pc_type", "asm"}}, false},
                                {{{"ksp_type", "minres"}, {"pc_type", "jacobi"}}, false}};
  for (const char* pc : {"none", "jacobi", "bjacobi", "sor", "gamg", "hypre"})
    cases.push_back({{cg, {"pc_type", pc}}, false});
  for (const char* pc : {"icc", "ilu"}) cases.push_back({{cg, {"pc_type", pc}}, true});
  return cases;
}

struct ModelCase
{
  Model model;
  Tangent tangent;
};

/// Displacements after two steps, each with an operator of its own, under gravity; why there are
/// none.
struct Outcome
{
  std::optional<fem::OwnedField> u;
  std::string why;
};

Outcome two_steps(const ModelCase& one, solve::Provider provider)
{
  TissueSettings settings;
  settings.model = one.model;
  settings.tangent = one.tangent;
  settings.provider = provider;
  settings.materials = {{}};
  settings.boundary.fixed = {{"x0", 7}};
  settings.boundary.gravity = core::Vec3(0, 0, -9.81);
  try {
    test::Body body({4, 2, 2, core::Vec3(0.04, 0.02, 0.02), 0.1}, settings);
    TissueState state = tissue::at_rest(body.space);
    for (int n = 1; n <= 2; ++n) {
      const double h = 0.02 / n;  // other rates: linear tissue has a second operator as well
      auto motion = body.tissue.linearise(state, state.u, {h * n, h, false});
      if (!motion) return {{}, motion.why()};
      const fem::OwnedField u = motion->alone();
      state.v.value = (u.value - state.u.value) / h;
      state.u = u;
    }
    return {state.u, ""};
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::options) << failure.what();
    return {{}, failure.what()};
  }
}

// Every documented solver and preconditioner, filled twice, against a factor of our own.
TEST(LinearSolvers, GiveTheSameMotionWhenFilledAgain)
{
  const base::Comm comm(MPI_COMM_WORLD);
  for (const ModelCase& model : {ModelCase{Model::linear, Tangent::rotated},
                                 {Model::corotational, Tangent::rotated},
                                 {Model::corotational, Tangent::exact},
                                 {Model::neo_hookean, Tangent::rotated}}) {
    const Outcome right = two_steps(model, solve::Provider::supernodal);
    ASSERT_TRUE(right.u) << right.why;
    const double scale = comm.max(right.u->value.cwiseAbs().maxCoeff());
    EXPECT_GT(scale, 1e-4);
    for (const SolverCase& one : solver_cases()) {
      std::string name = "model " + std::to_string(static_cast<int>(model.model));
      for (const auto& [option, value] : one.options) name += " -" + option + " " + value;
      SCOPED_TRACE(name);
      const SolverOptions options(one.options);
      const Outcome found = two_steps(model, solve::Provider::ksp);
      if (one.one_rank_only && comm.size() > 1) {
        EXPECT_FALSE(found.u);
        EXPECT_NE(found.why.find("ranks"), std::string::npos) << found.why;
        continue;
      }
      ASSERT_TRUE(found.u) << found.why;
      EXPECT_LT(comm.max((found.u->value - right.u->value).cwiseAbs().maxCoeff()), 1e-7 * scale);
    }
  }
}

/// c times a diagonal matrix.
fem::BlockMatrix diagonal(const fem::BlockPattern& pattern, int local_tets, double c)
{
  fem::ElementBlocks<4> blocks;
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const bool own = fem::block_pairs<4>[p][0] == fem::block_pairs<4>[p][1];
    core::Mat3 block = core::Mat3::Zero();
    if (own) block.diagonal().setConstant(c);
    blocks[p].head = block.reshaped().head<8>().array();
    blocks[p].last = block(2, 2);
  }
  fem::BlockMatrix values(pattern);
  for (int e = 0; e < local_tets; ++e)
    values.add(pattern.slots(static_cast<std::size_t>(e)), blocks);
  return values;
}

// A tangent without factor is rejected; what is solved with next must not be what is left of it.
TEST(LinearSolvers, SolveAgainAfterAFactorThatFailed)
{
  for (const SolverCase& one : solver_cases()) {
    std::string name = "-";
    for (const auto& [option, value] : one.options) name += option + " " + value + " ";
    if (name.find("lu") == std::string::npos && name.find("cholesky") == std::string::npos)
      continue;
    const test::Body body({2, 2, 2});
    if (one.one_rank_only && body.comm.size() > 1) continue;
    SCOPED_TRACE(name);
    const SolverOptions options(one.options);
    const fem::BlockPattern pattern(body.space);
    core::Ledger ledger;
    solve::LinearSystem system(body.space, pattern, body.mesh.x, {}, ledger);
    const int tets = static_cast<int>(body.space.tets());
    EXPECT_THROW(system.set_operator(diagonal(pattern, tets, 0.0)), core::Failure);
    for (double c : {1.0, 4.0}) {
      const fem::BlockMatrix values = diagonal(pattern, tets, c);
      system.set_operator(values);
      const fem::OwnedField b = test::nodal(body, [](const core::Vec3& x) { return x; });
      const fem::OwnedField u = system.solve(b);
      EXPECT_LT((values.times(body.space, u).value - b.value).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace trocar::tissue
