// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/linear_algebra/elimination_factor.h>

namespace Debond
{
  std::vector<int>
  Elimination::positions(const unsigned int n) const
  {
    // Rows that are left out, such as those of constrained unknowns, keep -1.
    std::vector<int> result(n, -1);
    for (unsigned int i = 0; i < unknowns.size(); ++i)
      result[unknowns[i]] = static_cast<int>(i);
    return result;
  }



  Elimination
  eliminate_all_but(const std::vector<unsigned int>         &kept,
                    const unsigned int                       n,
                    const std::function<bool(unsigned int)> &is_excluded,
                    const bool                               is_semidefinite)
  {
    // The eliminated unknowns come first in ascending order, as factorisations
    // want them, and then the kept ones in the order in which the caller has
    // them, which becomes that of S and g.
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



  double
  EliminationFactor::condition_estimate() const
  {
    const dealii::types::blas_int n_kept =
      static_cast<dealii::types::blas_int>(S.m());
    if (n_kept == 0)
      return 1.;
    // LAPACK estimates the norm of the inverse by a few solutions with the
    // factor, in O(n^2), and needs the norm of the matrix for its reciprocal
    // condition.
    const double                         norm = S.l1_norm();
    double                               reciprocal;
    std::vector<double>                  work(3 * n_kept);
    std::vector<dealii::types::blas_int> integers(n_kept);
    dealii::types::blas_int              info;
    // L_ss by rows is its transpose by columns, the upper factor.
    dealii::pocon("U",
                  &n_kept,
                  &L_ss(0, 0),
                  &n_kept,
                  &norm,
                  &reciprocal,
                  work.data(),
                  integers.data(),
                  &info);
    AssertThrow(info == 0, dealii::ExcInternalError());
    return 1. / reciprocal;
  }



  IndefiniteMatrix::IndefiniteMatrix(const std::string &where)
    : std::runtime_error(
        "Condensation: rounding has made the elasticity matrix indefinite (" +
        where +
        "): the body is too slender, or its moduli are too far apart, for "
        "double precision with this mesh. Another number of cells may do.")
  {}
} // namespace Debond
