// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_bundle_qp_tolerances_h
#define debond_optimization_bundle_bundle_qp_tolerances_h

#include <limits>

namespace Debond
{
  /// All tolerances of BundleQP, relative ones.
  namespace QPTolerance
  {
    /// Units of rounding by which terms may miss zero.
    constexpr double rounding = 64. * std::numeric_limits<double>::epsilon();

    /// Part of its squared length by which a cut (or bound) has to stand out
    /// of the working set to enter it. The Gram matrix has the square of the
    /// relative accuracy of the subgradients, so this is close to rounding.
    constexpr double independence = 1e-13;

    /// A cut enters if it exceeds v by more than this part of |v|.
    constexpr double cut = 1e-12;

    /// A bound enters if d exceeds it by more than this part of |d|.
    constexpr double bound = 1e-13;

    /// Residual of the linear system above which it is refined.
    constexpr double refinement = 1e-14;

    /// Residual of a solution above which the factor is made anew, once.
    constexpr double repair = 1e-10;

    /// Range of kappa over the mean diagonal of H in which the factor is kept.
    constexpr double kappa_range = 1e2;
  } // namespace QPTolerance
} // namespace Debond

#endif
