// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/multigrid_problem.h>

#include <unordered_map>

namespace Debond
{
  template <int dim>
  MultigridProblem<dim>::MultigridProblem(
    const ElasticProblem<dim>   &problem,
    const PiecewiseQuadratic    &phi,
    MultigridCorrection         &cycle,
    DofVector                   &u,
    const std::function<bool()> &may_go_on)
    : DisplacementProblem(problem.load(),
                          phi,
                          {problem.unknowns().contact().normals().begin(),
                           problem.unknowns().contact().normals().end()},
                          cycle,
                          u,
                          may_go_on)
    , A(problem.matrix())
  {
    this->diagonal.reinit(A.m());
    for (unsigned int i = 0; i < A.m(); ++i)
      this->diagonal(i) = A.diag_element(i);
    std::unordered_map<unsigned int, unsigned int> place;
    for (unsigned int i = 0; i < this->normals.size(); ++i)
      place[this->normals[i]] = i;
    std::vector<Eigen::Triplet<double>> entries;
    for (unsigned int i = 0; i < this->normals.size(); ++i)
      for (auto entry = A.begin(this->normals[i]);
           entry != A.end(this->normals[i]);
           ++entry)
        if (const auto j = place.find(entry->column()); j != place.end())
          entries.emplace_back(j->second, i, entry->value());
    this->contact_rows.resize(this->normals.size(), this->normals.size());
    this->contact_rows.setFromTriplets(entries.begin(), entries.end());
  }



  template <int dim>
  void
  MultigridProblem<dim>::multiply(DofVector &dst, const DofVector &src) const
  {
    A.vmult(dst, src);
  }



  template <int dim>
  void
  MultigridProblem<dim>::add_contact_columns(const Eigen::VectorXd &factors,
                                             DofVector             &v) const
  {
    for (unsigned int i = 0; i < this->normals.size(); ++i)
      if (factors(i) != 0.)
        for (auto entry = A.begin(this->normals[i]);
             entry != A.end(this->normals[i]);
             ++entry)
          v(entry->column()) += factors(i) * entry->value();
  }



  template class MultigridProblem<2>;
  template class MultigridProblem<3>;
} // namespace Debond
