// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_side_ranges_h
#define debond_certify_side_ranges_h

#include <debond/certify/mean_problem.h>

namespace Debond
{
  /// Shrinks @p ranges of displacements with J at most @p upper, one of each
  /// contact side, to where these are by theorem 2, with at most 32 boxes; if
  /// @p is_quick with 4 that are bounded less well. If @p interruption says no
  /// they are left as they are by then. @p record gets what shows it; may be
  /// null.
  void
  shrink_ranges(const MeanProblem          &problem,
                const double                upper,
                const bool                  is_quick,
                const Interruption         &interruption,
                std::vector<CertifiedSide> &ranges,
                ProofRecord *const          record = nullptr);
} // namespace Debond

#endif
