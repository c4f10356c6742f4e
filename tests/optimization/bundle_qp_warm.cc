// SPDX-License-Identifier: LGPL-2.1-or-later
// The bundle QP as the bundle method uses it: a cut more in each solve, with
// other beta and b, sometimes emptied. Each solution is compared with that of a
// QP that knows nothing of the ones before.

#include <debond/optimization/bundle/bundle_qp.h>

#include <iostream>

#include "../check.h"
#include "bundle_qp_problems.h"

using namespace Debond;
using namespace BundleQPProblems;

namespace
{
  /// Adds cut @p k of the problem as number qp.n_cuts().
  void
  add_cut(const Problem &p, const unsigned int k, BundleQP &qp)
  {
    const unsigned int j = qp.n_cuts(), first = k - j;
    const MatrixXd     unbounded = p.eta.bottomRows(p.eta.rows() - p.b.size());
    qp.add_cut(unbounded.middleCols(first, j + 1).transpose() *
                 unbounded.col(k),
               p.eta.col(k).head(p.b.size()));
  }



  struct Record
  {
    unsigned int solves     = 0;
    unsigned int failed     = 0;
    unsigned int warm_steps = 0, cold_steps = 0;
    double       difference = 0.; // of v and d, relative to their terms
  };



  void
  compare(const Problem            &p,
          const unsigned int        first,
          const VectorXd           &beta,
          const VectorXd           &b,
          const BundleQP::Solution &warm,
          Record                   &record)
  {
    BundleQP cold_qp(beta.size(), b.size());
    for (unsigned int j = 0; j < beta.size(); ++j)
      add_cut(p, first + j, cold_qp);
    const BundleQP::Solution &cold = cold_qp.solve(beta, b, p.u);
    ++record.solves;
    record.failed += warm.status != BundleQP::Status::optimal ||
                     cold.status != BundleQP::Status::optimal;
    record.warm_steps += warm.steps;
    record.cold_steps += cold.steps;

    const double longest =
      p.eta.middleCols(first, beta.size()).colwise().norm().maxCoeff();
    const double d_terms = longest / p.u + b.norm();
    const double v_terms = longest * d_terms + beta.maxCoeff();
    record.difference =
      std::max({record.difference,
                std::abs(warm.v - cold.v) / v_terms,
                (warm.slopes - cold.slopes).norm() / (longest * d_terms),
                (warm.d - cold.d).norm() / d_terms});
  }



  void
  test_sequence(Generator &generator, Record &record)
  {
    Shape shape                    = generator.shape();
    shape.cuts                     = shape.active_cuts + 30;
    const Problem      p           = generator.problem(shape, 1., 1., 1.);
    const unsigned int empty_after = generator.integer(5, 25);

    BundleQP     qp(shape.cuts, shape.n_bounded);
    unsigned int first = 0;
    VectorXd     beta = p.beta, b = p.b;
    for (unsigned int k = 0; k < shape.cuts; ++k)
      {
        if (qp.n_cuts() == empty_after)
          {
            qp.clear();
            first = k;
          }
        add_cut(p, k, qp);
        // A step: the errors change, and with x the distances to the bounds.
        if (k % 3 == 2)
          {
            beta = beta.cwiseProduct(generator.vector(beta.size(), 0., 2.));
            b = b.cwiseAbs().cwiseProduct(generator.vector(b.size(), 0., 2.));
          }
        const VectorXd now = beta.segment(first, qp.n_cuts());

        const BundleQP::Solution &warm = qp.solve(now, b, p.u);
        compare(p, first, now, b, warm, record);
      }
  }
} // namespace



int
main(int argc, char *[])
{
  Generator generator(20261121);
  Record    record;
  for (unsigned int k = 0; k < 200; ++k)
    test_sequence(generator, record);

  std::cout << "all optimal: " << verdict(record.failed == 0)
            << "\nas from a cold start to 1e-10: "
            << verdict(record.difference, 1e-10)
            << "\nat most half of the steps: "
            << verdict(2 * record.warm_steps < record.cold_steps) << '\n';
  if (argc > 1)
    std::cout << record.solves << " solves, " << record.failed << " failed, "
              << record.warm_steps << " steps, " << record.cold_steps
              << " from cold starts, difference " << record.difference << '\n';
}
