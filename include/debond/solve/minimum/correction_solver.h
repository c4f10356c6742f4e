// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_correction_solver_h
#define debond_solve_minimum_correction_solver_h

#include <debond/linear_algebra/cholesky.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/solve/minimum/contact_unknowns.h>

namespace Debond
{
  /**
   * An approximation of (A + E)^{-1} on the unknowns that are neither
   * constrained nor held, where E is a curvature of bonds. It may be wrong in
   * a few directions, such as the bending of a slender body.
   */
  class CorrectionSolver
  {
  public:
    virtual ~CorrectionSolver() = default;

    /// @p held says which contact nodes keep u_nu = 0.
    virtual void
    prepare(const Eigen::SparseMatrix<double> &E, const ActiveSet &held) = 0;

    /// The correction for the forces @p r, zero where held.
    virtual DofVector
    solve(const DofVector &r) const = 0;
  };



  /// By the factors of A in double precision, and of S + E.
  class CondensedCorrection : public CorrectionSolver
  {
  public:
    /// Keeps a reference.
    explicit CondensedCorrection(const Condensation &condensed);

    void
    prepare(const Eigen::SparseMatrix<double> &E,
            const ActiveSet                   &held) override;

    DofVector
    solve(const DofVector &r) const override;

  private:
    const Condensation          &condensed;
    std::vector<int>             free; ///< contact nodes
    std::optional<DenseCholesky> factor;
  };



  /// By the truncated cycle.
  class MultigridCorrection : public CorrectionSolver
  {
  public:
    /// Keeps a reference to the cycle, and truncates it.
    template <int dim>
    MultigridCorrection(const ElasticProblem<dim> &problem,
                        TruncatedMultigrid        &cycle)
      : contact(problem)
      , cycle(cycle)
      , own(problem.unknowns().dof_handler().locally_owned_dofs())
      , ranks(problem.unknowns().communicator())
    {}

    void
    prepare(const Eigen::SparseMatrix<double> &E,
            const ActiveSet                   &held) override
    {
      contact.truncate(E, held, cycle);
    }

    DofVector
    solve(const DofVector &r) const override
    {
      DistributedVector correction(own, ranks);
      cycle.vmult(correction, distribute(r, own, ranks));
      return gather(correction);
    }

  private:
    const ContactUnknowns  contact;
    TruncatedMultigrid    &cycle;
    const dealii::IndexSet own;
    const MPI_Comm         ranks;
  };
} // namespace Debond

#endif
