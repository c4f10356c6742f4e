// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_side_ranges_h
#define debond_certify_side_ranges_h

#include <debond/certify/certified_side.h>
#include <debond/certify/mean_problem.h>

#include <functional>
#include <vector>

namespace Debond
{
  /// @p ranges are of displacements with J at most @p upper, one of each
  /// contact side. Tries, for one side after the other, whether it can be
  /// beyond the kinks that are nearest to where it is at @p means (of all
  /// sides), and takes what it cannot be from its range. Those that are
  /// farthest from their kinks come first. If @p may_go_on says no they are
  /// left as they are by then.
  void
  exclude_pieces(const MeanProblem           &problem,
                 const double                 upper,
                 const Eigen::VectorXd       &means,
                 const std::function<bool()> &may_go_on,
                 std::vector<CertifiedSide>  &ranges);



  /// Shrinks such ranges to where these displacements are by theorem 2, with at
  /// most 32 boxes; if @p is_quick with 4 that are bounded less well. Returns
  /// false if it proves that there are none.
  bool
  shrink_ranges(const MeanProblem           &problem,
                const double                 upper,
                const bool                   is_quick,
                const std::function<bool()> &may_go_on,
                std::vector<CertifiedSide>  &ranges);
} // namespace Debond

#endif
