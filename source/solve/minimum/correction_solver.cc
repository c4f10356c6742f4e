// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/solve/minimum/correction_solver.h>

namespace Debond
{
  CondensedCorrection::CondensedCorrection(
    const Condensation &condensed_problem)
    : condensed(condensed_problem)
  {}



  void
  CondensedCorrection::prepare(const Eigen::SparseMatrix<double> &E,
                               const ActiveSet                   &held)
  {
    free.clear();
    for (unsigned int i = 0; i < held.size(); ++i)
      if (held[i] == 0)
        free.push_back(static_cast<int>(i));
    if (free.empty())
      return;

    // (A + E)^{-1} by the block factors of A in double precision: A_ii is in
    // the factor of the condensation, and what remains is S + E on the nodes
    // that are not held.
    Eigen::MatrixXd whole = condensed.schur_complement();
    whole += E;
    const Eigen::MatrixXd matrix = whole(free, free);
    // If rounding has made S + E indefinite, a larger diagonal mends it.
    double shift = 0.;
    while (shift < Tolerance::largest_shift)
      {
        Eigen::MatrixXd shifted = matrix;
        shifted.diagonal() *= 1. + shift;
        factor.emplace(shifted);
        if (factor->is_positive_definite())
          return;
        shift = std::max(10. * shift, Tolerance::epsilon);
      }
    // Any positive definite matrix is a preconditioner: a bad one costs
    // iterations, but no accuracy.
    factor.emplace(matrix.diagonal().cwiseAbs().asDiagonal());
  }



  DofVector
  CondensedCorrection::solve(const DofVector &r) const
  {
    // Elimination takes the forces r to the contact normals, and expansion
    // takes s back to all unknowns.
    const Condensation under_r = condensed.with_load(r);
    Eigen::VectorXd    s       = Eigen::VectorXd::Zero(under_r.load().size());
    if (!free.empty())
      {
        Eigen::VectorXd s_free = under_r.load()(free);
        factor->solve_in_place(s_free);
        s(free) = s_free;
      }
    return under_r.expand(s);
  }
} // namespace Debond
