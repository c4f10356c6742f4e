// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/cholmod_factor.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/linear_algebra/mumps_factor.h>

#include <memory>
#include <utility>

namespace Debond
{
  namespace
  {
    std::shared_ptr<const EliminationFactor>
    factorise(const MatrixOnRanks &A, const Elimination &elimination)
    {
      return A.is_shared() ? make_mumps_factor(A, elimination) :
                             make_cholmod_factor(A.A, elimination);
    }
  } // namespace



  Condensation::Condensation(
    const MatrixOnRanks                     &A,
    const DofVector                         &f,
    const std::vector<unsigned int>         &kept,
    const std::function<bool(unsigned int)> &is_excluded,
    const double                             other_energy,
    const bool                               is_semidefinite)
    : Condensation(factorise(A,
                             eliminate_all_but(kept,
                                               f.size(),
                                               is_excluded,
                                               is_semidefinite)),
                   f,
                   other_energy)
  {}



  Condensation::Condensation(std::shared_ptr<const EliminationFactor> factor,
                             const DofVector                         &f,
                             const double other_energy)
    : factor(std::move(factor))
    , reduced(this->factor->reduce(f))
    , other_energy(other_energy)
    , g(this->factor->condensed_load(reduced))
  {}



  Condensation
  Condensation::with_load(const DofVector &f, const double energy) const
  {
    return Condensation(factor, f, energy);
  }



  MatrixView
  Condensation::schur_complement() const
  {
    // deal.II's matrices have contiguous rows, Eigen's contiguous columns,
    // which for a symmetric one is the same.
    const dealii::FullMatrix<double> &S = factor->schur_complement();
    return Eigen::Map<const Eigen::MatrixXd>(S.empty() ? nullptr : &S(0, 0),
                                             S.m(),
                                             S.n());
  }



  double
  Condensation::energy_at_zero() const
  {
    return factor->energy_at_zero(reduced, other_energy);
  }



  double
  Condensation::energy_without_contact() const
  {
    return factor->energy_without_contact(reduced);
  }



  double
  Condensation::energy_of_kept() const
  {
    return factor->energy_of_kept(reduced);
  }



  double
  Condensation::condition_estimate() const
  {
    return factor->condition_estimate();
  }



  DofVector
  Condensation::solve(
    const DofVector &other_f,
    const std::function<Eigen::VectorXd(const Eigen::VectorXd &)>
      &kept_unknowns) const
  {
    const Eigen::VectorXd other = factor->reduce(other_f);
    return factor->expand(other, kept_unknowns(factor->condensed_load(other)));
  }
} // namespace Debond
