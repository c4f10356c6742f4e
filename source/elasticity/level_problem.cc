// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/level_problem.h>

namespace Debond
{
  template <int dim>
  LevelProblem<dim>::LevelProblem(LevelCorrection<dim>        &cycle,
                                  const PiecewiseQuadratic    &phi,
                                  DofVector                   &u,
                                  const std::function<bool()> &may_go_on)
    : DisplacementProblem(cycle.levels().load(cycle.level()),
                          phi,
                          cycle.levels().normals(cycle.level()),
                          cycle,
                          u,
                          may_go_on)
    , levels(cycle.levels())
    , l(cycle.level())
  {
    this->contact_rows = levels.contact_rows(l);
    this->diagonal.reinit(levels.n_unknowns(l));
    for (unsigned int i = 0; i < this->diagonal.size(); ++i)
      this->diagonal(i) = levels.diagonal_entry(l, i);
  }



  template <int dim>
  void
  LevelProblem<dim>::add_contact_columns(const Eigen::VectorXd &factors,
                                         DofVector             &v) const
  {
    for (unsigned int i = 0; i < this->normals.size(); ++i)
      if (this->normals[i] != dealii::numbers::invalid_unsigned_int &&
          factors(i) != 0.)
        levels.add_column(l, this->normals[i], factors(i), v);
    levels.update_ghosts(l, v);
  }



  template class LevelProblem<2>;
  template class LevelProblem<3>;
} // namespace Debond
