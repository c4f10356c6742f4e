// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/cholmod_factor.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/linear_algebra/mumps_factor.h>

#include <memory>

namespace Debond
{
  namespace
  {
    Elimination
    all_but(const std::vector<unsigned int>         &kept,
            const unsigned int                       n,
            const std::function<bool(unsigned int)> &is_excluded,
            const bool                               is_semidefinite)
    {
      Elimination       result{{},
                         static_cast<unsigned int>(kept.size()),
                         is_semidefinite};
      std::vector<char> is_kept(n, 0);
      for (const unsigned int i : kept)
        is_kept[i] = 1;
      for (unsigned int i = 0; i < n; ++i)
        if (is_kept[i] == 0 && !is_excluded(i))
          result.unknowns.push_back(i);
      result.unknowns.insert(result.unknowns.end(), kept.begin(), kept.end());
      return result;
    }
  } // namespace



  Condensation::Condensation(
    const MatrixOnRanks                     &A,
    const DofVector                         &f,
    const std::vector<unsigned int>         &kept,
    const std::function<bool(unsigned int)> &is_excluded,
    const OtherParts                        &others,
    const bool                               is_semidefinite)
    : other_energy(others.energy)
  {
    const Elimination elimination =
      all_but(kept, f.size(), is_excluded, is_semidefinite);
    factor = A.is_shared() ? make_mumps_factor(A, elimination) :
                             make_cholmod_factor(A.A, elimination);

    given = factor->reduce(f);
    if (others.constant_load.size() > 0)
      constant = factor->reduce(others.constant_load);
    if (others.second_load.size() > 0)
      second = factor->reduce(others.second_load);
    scale_load(1.);
  }



  void
  Condensation::scale_load(const double factor_of_load,
                           const double second_factor)
  {
    constant_part =
      other_energy ? other_energy(factor_of_load, second_factor) : 0.;
    reduced = factor_of_load * given;
    if (constant.size() > 0)
      reduced += (1. - factor_of_load) * constant;
    if (second.size() > 0 && second_factor != factor_of_load)
      reduced += (second_factor - factor_of_load) * second;
    g = factor->condensed_load(reduced);
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
    return factor->energy_at_zero(reduced, constant_part);
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
