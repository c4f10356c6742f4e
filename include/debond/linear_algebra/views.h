// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_views_h
#define debond_linear_algebra_views_h

#include <Eigen/Core>

namespace Debond
{
  /// To read small vectors and matrices, of Eigen or seen by  or
  /// , without a copy. Valid as long as what they show.
  using VectorView = Eigen::Ref<const Eigen::VectorXd>;
  using MatrixView = Eigen::Ref<const Eigen::MatrixXd>;
} // namespace Debond

#endif
