// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/solve/path/coulomb.h>

#include <Eigen/QR>

#include <cmath>
#include <deque>

namespace Debond
{
  namespace
  {
    /// How often a step is done with new pressures, and from when on they are
    /// accelerated, as what sticks and slides is nearly known.
    constexpr unsigned int most_pressures = 1000, plain_repetitions = 5;

    constexpr unsigned int repetitions_of_round = 100;

    constexpr std::size_t remembered_repetitions = 6;



    class AndersonAcceleration
    {
    public:
      /// The next point, after the map has led from @p x to @p image.
      Eigen::VectorXd
      next(const Eigen::VectorXd &x, const Eigen::VectorXd &image)
      {
        residuals.push_back(image - x);
        images.push_back(image);
        if (images.size() > remembered_repetitions)
          {
            residuals.pop_front();
            images.pop_front();
          }
        // The combination of images whose residual, were the map affine, would
        // be least.
        const Eigen::Index m = Eigen::Index(images.size()) - 1;
        if (m == 0)
          return image;
        Eigen::MatrixXd of_residuals(x.size(), m), of_images(x.size(), m);
        for (Eigen::Index j = 0; j < m; ++j)
          {
            of_residuals.col(j) = residuals[j + 1] - residuals[j];
            of_images.col(j)    = images[j + 1] - images[j];
          }
        return image - of_images * of_residuals.colPivHouseholderQr().solve(
                                     residuals.back());
      }

    private:
      std::deque<Eigen::VectorXd> residuals, images;
    };
  } // namespace



  template <int dim>
  Solution
  settle_friction(const StepWithFriction &step, AdhesionIntegral<dim> &bonds)
  {
    Solution             result;
    AndersonAcceleration acceleration;
    Eigen::VectorXd      pressures;
    // Pressures that vanish are small beside those that there were.
    double change = infinity, largest = 0.;
    for (unsigned int k = 0; k < most_pressures; ++k)
      {
        result.add(step.minimise());
        if (!can_be_verified(result.status))
          return result;
        const Eigen::VectorXd image = step.pressures();
        change                      = bonds.press(image);
        largest = std::max(largest, bonds.kinks().weight.maxCoeff());
        if (change <= Tolerance::pressure_of_friction * largest)
          return result;
        // Where what sticks and slides changes acceleration may go round in a
        // circle. Then shorter and shorter steps, and acceleration again from
        // where they lead.
        const unsigned int round = k / repetitions_of_round;
        Eigen::VectorXd    next  = image;
        if (k >= plain_repetitions && round % 2 == 0)
          next = acceleration.next(pressures, image).cwiseMax(0.);
        else if (k >= plain_repetitions)
          {
            const double part = std::ldexp(1., -1 - int(round) / 2);
            next              = pressures + part * (image - pressures);
            acceleration      = {};
          }
        bonds.press(next);
        pressures = next;
      }
    result.status = SolverStatus::iteration_limit;
    result.message =
      words("friction: the pressures change by ",
            change / largest,
            " of the largest one after ",
            most_pressures,
            " repetitions, required is ",
            Tolerance::pressure_of_friction,
            ". Try smaller steps, or a smaller Friction coefficient.");
    return result;
  }



  DEBOND_INSTANTIATE(settle_friction);
} // namespace Debond
