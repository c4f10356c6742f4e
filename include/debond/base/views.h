// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_views_h
#define debond_base_views_h

#include <Eigen/Core>

namespace Debond
{
  /// To read small vectors and matrices, of Eigen or seen by eigen_view(),
  /// without a copy. Valid as long as what they show.
  using VectorView = Eigen::Ref<const Eigen::VectorXd>;
  using MatrixView = Eigen::Ref<const Eigen::MatrixXd>;
} // namespace Debond

#endif
