// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/polar_cone.h>

#include <Eigen/QR>

#include <algorithm>
#include <vector>

namespace Debond
{
  std::optional<Eigen::VectorXd>
  project_on_polar_cone(const MatrixView &B, const Eigen::VectorXd &f)
  {
    // With lambda >= 0 of least |f - B lambda|, p = f - B lambda is orthogonal
    // to the columns with lambda > 0 and has b'p <= 0 for all: Moreau's
    // decomposition of f. As with active sets for bounds, one column joins at a
    // time, and those whose lambda would become negative leave on the way to
    // the least squares of the others.
    Eigen::MatrixXd directions = B;
    // Only the directions of the columns matter for the cone; with unit lengths
    // one rounding fits all.
    for (auto direction : directions.colwise())
      direction.normalize();
    const double rounding = Tolerance::in_cone * f.norm();

    std::vector<Eigen::Index> active;
    Eigen::VectorXd           lambda; // of the active columns
    Eigen::VectorXd           p = f;
    // Columns that rounding keeps from bringing p closer to 0.
    std::vector<bool> is_useless(directions.cols(), false);
    // Else each change of the active set does; this is far above what scenes
    // need.
    for (Eigen::Index step = 0; step < 100 * (B.cols() + B.rows()); ++step)
      {
        // The column whose condition b'p <= 0 is violated most joins the active
        // ones. If there is none, p is in the cone, and as what least squares
        // leave of f it is the nearest point.
        Eigen::Index next    = -1;
        double       largest = rounding;
        for (Eigen::Index i = 0; i < directions.cols(); ++i)
          if (const double product = directions.col(i).dot(p);
              product > largest && !is_useless[i])
            {
              largest = product;
              next    = i;
            }
        if (next < 0)
          return p;
        const double length = p.norm();
        active.push_back(next);
        lambda.conservativeResize(lambda.size() + 1);
        lambda.tail<1>().setZero();

        for (;;)
          {
            // Least squares on the active columns alone, which may be dependent
            // where columns are parallel.
            const Eigen::MatrixXd A =
              directions(Eigen::seqN(0, directions.rows()), active);
            Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
            qr.setThreshold(Tolerance::dependent);
            const Eigen::VectorXd least_squares = qr.compute(A).solve(f);
            // As far towards it as no multiplier becomes negative.
            double       part   = 1.;
            Eigen::Index leaves = -1;
            for (Eigen::Index i = 0; i < lambda.size(); ++i)
              if (least_squares[i] <= 0.)
                {
                  const double until =
                    lambda[i] / (lambda[i] - least_squares[i]);
                  if (leaves < 0 || until < part)
                    {
                      part   = until;
                      leaves = i;
                    }
                }
            if (leaves < 0)
              {
                lambda = least_squares;
                p      = f - A * lambda;
                break;
              }
            lambda += part * (least_squares - lambda);
            active.erase(active.begin() + leaves);
            const Eigen::Index behind      = lambda.size() - leaves - 1;
            lambda.segment(leaves, behind) = lambda.tail(behind).eval();
            lambda.conservativeResize(lambda.size() - 1);
            if (active.empty())
              {
                p = f;
                break;
              }
          }
        // Each change of the set that makes p shorter is progress, as no set
        // comes twice. One that does not is rounding, and its column is left
        // alone until there is progress again.
        if (p.norm() < length)
          std::fill(is_useless.begin(), is_useless.end(), false);
        else
          is_useless[next] = true;
      }
    return {};
  }
} // namespace Debond
