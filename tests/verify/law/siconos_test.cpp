#ifdef TROCAR_SICONOS

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

extern "C" {
#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>
#include <fc3d_compute_error.h>
}

#include "law/solve.hpp"
#include "support/cones.hpp"

// Siconos (Acary and others), an independent code for friction cones, judges our forces by its
// residual, and we judge its forces by ours.
namespace trocar {
namespace {

using test::Cones;

/// A problem in the form of Siconos. It owns all its memory.
class Judge
{
 public:
  Judge(const law::Problem& problem, double friction)
      : rows_(static_cast<int>(problem.rows())),
        options_(solver_options_create(SICONOS_FRICTION_3D_NSGS))
  {
    const int groups = rows_ / 3;
    auto* q = static_cast<double*>(std::malloc(sizeof(double) * static_cast<std::size_t>(rows_)));
    auto* mu = static_cast<double*>(std::malloc(sizeof(double) * static_cast<std::size_t>(groups)));
    NumericsMatrix* M = NM_create(NM_DENSE, rows_, rows_);
    for (int i = 0; i < rows_; ++i) {
      q[i] = problem.g[i];
      for (int j = 0; j < rows_; ++j) M->matrix0[i + rows_ * j] = problem.W(i, j);
    }
    std::fill(mu, mu + groups, friction);
    problem_ = frictionContactProblem_new_with_data(3, groups, M, q, mu);
    options_->dparam[SICONOS_DPARAM_TOL] = 1e-13;
    options_->iparam[SICONOS_IPARAM_MAX_ITER] = 20000;
  }
  ~Judge()
  {
    solver_options_delete(options_);
    frictionContactProblem_free(problem_);
  }
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  /// Its residual of the natural map, absolute.
  double error(law::VecX lambda)
  {
    law::VecX w = law::VecX::Zero(rows_);
    double error = 0.0;
    fc3d_compute_error(problem_, lambda.data(), w.data(), 1e-9, options_, 1.0, &error);
    return error;
  }
  law::VecX solve()
  {
    law::VecX lambda = law::VecX::Zero(rows_), w = lambda;
    fc3d_driver(problem_, lambda.data(), w.data(), options_);
    return lambda;
  }

 private:
  int rows_;
  SolverOptions* options_;
  FrictionContactProblem* problem_;
};

TEST(Siconos, AcceptsOurForcesAndWeItsOwn)
{
  int problems = 0;
  for (const Cones kind : {Cones::half_space, Cones::stiff, Cones::rigid, Cones::half_rank})
    for (const double friction : {0.3, 1.0})
      for (unsigned seed = 11; seed < 14; ++seed) {
        if (kind == Cones::half_rank && friction > 0.3) continue;
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(kind) << ' ' << friction << ' ' << seed);
        const test::KnownCones made = test::known_cones(kind, 20, friction, seed);
        Judge judge(made.problem, friction);
        law::Settings settings;
        settings.tolerance = 1e-12;
        const law::Multipliers ours = law::solve(made.problem, settings);
        ASSERT_TRUE(ours.converged);
        EXPECT_LT(judge.error(ours.lambda), 1e-8);  // of forces about 1 N
        // Its sweeps come to rest slowly where a stiff body rests on many points.
        const double most = kind == Cones::stiff ? 1e-6 : 1e-12;
        EXPECT_LT(law::kkt_residual(made.problem, judge.solve()), most);
        ++problems;
      }
  EXPECT_EQ(problems, 21);
}

}  // namespace
}  // namespace trocar

#endif
