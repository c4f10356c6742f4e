// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_level_problem_h
#define debond_elasticity_level_problem_h

#include <debond/elasticity/displacement_problem.h>
#include <debond/elasticity/elastic_levels.h>
#include <debond/linear_algebra/dof_vector.h>

namespace Debond
{
  /**
   * J on the unknowns of a level. Majorants are minimised by truncated
   * nonsmooth Newton multigrid (Graeser, Sack, Sander, 2009): one Gauss-Seidel
   * step on the contact normals (on all ranks the same), one truncated V-cycle
   * for all unknowns that are not in contact, projection onto s <= 0 and an
   * exact line search; once the contact set stays as it is, conjugate gradients
   * with that V-cycle.
   *
   * Where ranks share the finest level, each of them has such a problem of it,
   * and all call the same functions.
   */
  template <int dim>
  class LevelProblem : public DisplacementProblem
  {
  public:
    /// Keeps references, also to the cycle of the levels, which it truncates;
    /// @p phi is the function of the finest level's s on the normal
    /// displacements of the level @p l. @p u is the current point, of which
    /// they have to be <= 0. As soon as @p may_go_on returns false, which each
    /// cycle asks, minimise() ends and leaves u as it was before.
    LevelProblem(ElasticLevels<dim>          &levels,
                 const unsigned int           l,
                 const PiecewiseQuadratic    &phi,
                 DofVector                   &u,
                 const std::function<bool()> &may_go_on = {});

    /// A cycle counts as a linear iteration.
    Minimisation
    minimise(const double tolerance) override;

  private:
    void
    multiply(DofVector &dst, const DofVector &src) const override;

    Eigen::VectorXd
    trace(const DofVector &v) const override;

    double
    product(const DofVector &a, const DofVector &b) const override;

    /// Minimises the majorant in one normal displacement after the other.
    void
    smooth_contact(DofVector &force);

    ElasticLevels<dim> &levels;
    const unsigned int  l;

    /// The rows of A of the normal displacements.
    const Eigen::SparseMatrix<double> contact_rows;

    /// What the cycle is truncated for.
    bool                        is_truncated = false;
    Eigen::SparseMatrix<double> cycle_E;
    ActiveSet                   cycle_active;
  };
} // namespace Debond

#endif
