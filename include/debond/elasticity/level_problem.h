// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_level_problem_h
#define debond_elasticity_level_problem_h

#include <debond/elasticity/displacement_problem.h>
#include <debond/elasticity/elastic_levels.h>
#include <debond/linear_algebra/dof_vector.h>

namespace Debond
{
  /**
   * J on the unknowns of a level. Where ranks share the finest level, each of
   * them has such a problem of it, and all call the same functions.
   */
  template <int dim>
  class LevelProblem : public DisplacementProblem
  {
  public:
    /// Keeps references; @p phi is the function of the finest level's s on the
    /// normal displacements of the level of the @p cycle. @p u is the current
    /// point, of which they have to be <= 0.
    LevelProblem(LevelCorrection<dim>        &cycle,
                 const PiecewiseQuadratic    &phi,
                 DofVector                   &u,
                 const std::function<bool()> &may_go_on = {});

  private:
    void
    multiply(DofVector &dst, const DofVector &src) const override
    {
      levels.vmult(l, dst, src);
    }

    void
    add_contact_columns(const Eigen::VectorXd &factors,
                        DofVector             &v) const override;

    Eigen::VectorXd
    trace(const DofVector &v) const override
    {
      return levels.trace(l, v);
    }

    double
    product(const DofVector &a, const DofVector &b) const override
    {
      return levels.product(l, a, b);
    }

    const ElasticLevels<dim> &levels;
    const unsigned int        l;
  };
} // namespace Debond

#endif
