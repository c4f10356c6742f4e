// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/fixed_point_acceleration.h>

#include <Eigen/QR>

#include <limits>

namespace Debond
{
  namespace
  {
    /// Differences that are combined, at least and at most: more of them take
    /// no fewer steps and pass on more of the rounding.
    constexpr unsigned int least_differences = 2;
    constexpr unsigned int most_differences  = 3;

    /// Differences of steps that are dependent but for this part say nothing.
    constexpr double dependent_steps = 1e-10;
  } // namespace



  Eigen::VectorXd
  FixedPointAcceleration::next(const Eigen::VectorXd &x,
                               const Eigen::VectorXd &image)
  {
    const Eigen::VectorXd step = image - x;
    if (!steps.empty() && step.norm() > steps.back().norm())
      restart();
    steps.push_back(step);
    images.push_back(image);
    if (steps.size() > most_differences + 1)
      {
        steps.pop_front();
        images.pop_front();
      }
    const Eigen::Index n = static_cast<Eigen::Index>(steps.size()) - 1;
    if (n < least_differences)
      return image;

    // The columns get shorter and shorter.
    Eigen::MatrixXd of_steps(x.size(), n), of_images(x.size(), n);
    for (Eigen::Index k = 0; k < n; ++k)
      {
        const Eigen::VectorXd difference = steps[k + 1] - steps[k];
        const double          length     = difference.norm();
        if (!(length >= std::numeric_limits<double>::min()))
          return image;
        of_steps.col(k)  = difference / length;
        of_images.col(k) = (images[k + 1] - images[k]) / length;
      }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    qr.setThreshold(dependent_steps);
    const Eigen::VectorXd combination = qr.compute(of_steps).solve(step);
    const Eigen::VectorXd result      = image - of_images * combination;
    return result.allFinite() ? result : image;
  }



  void
  FixedPointAcceleration::restart()
  {
    steps.clear();
    images.clear();
  }
} // namespace Debond
