// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_correction_solver_h
#define debond_elasticity_correction_solver_h

#include <deal.II/lac/lapack_full_matrix.h>

#include <debond/elasticity/elastic_levels.h>
#include <debond/elasticity/multigrid.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/optimization/majorise/bound_qp.h>

#include <Eigen/SparseCore>

#include <vector>

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
    const Condensation              &condensed;
    std::vector<unsigned int>        free; ///< contact nodes
    dealii::LAPACKFullMatrix<double> factor;
  };



  /// By a multigrid cycle of A; the bonds are left out.
  class MultigridCorrection : public CorrectionSolver
  {
  public:
    /// Keeps a reference to the cycle. @p normals are the degrees of freedom of
    /// the contact nodes.
    MultigridCorrection(
      const Multigrid                                    &cycle,
      const std::vector<dealii::types::global_dof_index> &contact_normals)
      : multigrid(cycle)
      , normals(contact_normals)
    {}

    void
    prepare(const Eigen::SparseMatrix<double> &, const ActiveSet &held) override
    {
      active = held;
    }

    DofVector
    solve(const DofVector &r) const override;

  private:
    const Multigrid                             &multigrid;
    std::vector<dealii::types::global_dof_index> normals;
    ActiveSet                                    active;
  };



  /// By the truncated cycle of a level.
  template <int dim>
  class LevelCorrection : public CorrectionSolver
  {
  public:
    /// Keeps a reference, and truncates the cycle.
    explicit LevelCorrection(ElasticLevels<dim> &levels,
                             const unsigned int  level = 0);

    void
    prepare(const Eigen::SparseMatrix<double> &E,
            const ActiveSet                   &held) override;

    DofVector
    solve(const DofVector &r) const override;

    const ElasticLevels<dim> &
    levels() const
    {
      return elastic_levels;
    }

    unsigned int
    level() const
    {
      return l;
    }

  private:
    ElasticLevels<dim> &elastic_levels;
    const unsigned int  l;
  };
} // namespace Debond

#endif
