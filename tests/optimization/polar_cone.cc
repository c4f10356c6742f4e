// SPDX-License-Identifier: LGPL-2.1-or-later
// Projections on polar cones beside the best of all choices of active columns.

#include <debond/optimization/polar_cone.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "../check.h"

using namespace Debond;

namespace
{
  std::mt19937 engine(7);

  double
  uniform(const double lower, const double upper)
  {
    return std::uniform_real_distribution<double>(lower, upper)(engine);
  }



  /// The least distance from f to a nonnegative combination of columns
  /// that are linearly independent: the length of the projection.
  double
  enumerated_length(Eigen::MatrixXd B, const Eigen::VectorXd &f)
  {
    for (auto column : B.colwise())
      column.normalize();
    double least = f.norm();
    for (unsigned int set = 1; set < (1u << B.cols()); ++set)
      {
        std::vector<Eigen::Index> active;
        for (Eigen::Index i = 0; i < B.cols(); ++i)
          if ((set >> i) & 1u)
            active.push_back(i);
        if (static_cast<Eigen::Index>(active.size()) > B.rows())
          continue;
        const Eigen::MatrixXd A = B(Eigen::seqN(0, B.rows()), active);
        Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
        qr.setThreshold(1e-10);
        if (qr.compute(A).rank() < A.cols())
          continue;
        const Eigen::VectorXd lambda = qr.solve(f);
        if (lambda.minCoeff() >= 0.)
          least = std::min(least, (f - A * lambda).norm());
      }
    return least;
  }



  struct Errors
  {
    double violation = 0., length = 0., angle = 0.;
  };



  void
  add_errors(const Eigen::MatrixXd &B, const Eigen::VectorXd &f, Errors &errors)
  {
    const Eigen::VectorXd p = project_on_polar_cone(B, f).value();
    for (Eigen::Index i = 0; i < B.cols(); ++i)
      if (B.col(i).norm() > 0.)
        errors.violation =
          std::max(errors.violation,
                   B.col(i).dot(p) / B.col(i).norm() / f.norm());
    errors.length =
      std::max(errors.length,
               std::abs(p.norm() - enumerated_length(B, f)) / f.norm());
    // f - p stands on p.
    errors.angle =
      std::max(errors.angle, std::abs((f - p).dot(p)) / f.squaredNorm());
  }



  /// Of any size; some columns parallel, opposite or zero.
  Eigen::MatrixXd
  random_columns(const Eigen::Index rows, const Eigen::Index columns)
  {
    Eigen::MatrixXd B(rows, columns);
    for (Eigen::Index i = 0; i < columns; ++i)
      {
        const double kind = uniform(0., 1.);
        if (i > 0 && kind < 0.2)
          B.col(i) = uniform(-2., 2.) * B.col(i - 1);
        else if (kind < 0.25)
          B.col(i).setZero();
        else
          for (Eigen::Index k = 0; k < rows; ++k)
            B(k, i) = uniform(-1., 1.);
        B.col(i) *= std::pow(10., uniform(-9., 9.));
      }
    return B;
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  Errors errors;
  for (unsigned int k = 0; k < 3000; ++k)
    {
      const Eigen::Index    rows = 1 + static_cast<Eigen::Index>(engine() % 6);
      const Eigen::Index    columns = static_cast<Eigen::Index>(engine() % 9);
      const Eigen::MatrixXd B       = random_columns(rows, columns);
      Eigen::VectorXd       f(rows);
      for (Eigen::Index i = 0; i < rows; ++i)
        f[i] = uniform(-1., 1.);
      add_errors(B, std::pow(10., uniform(-9., 9.)) * f, errors);
    }
  std::cout << "3000 random cones" << std::endl;
  check("b'p <= 0 for each column", errors.violation, 1e-13);
  check("as long as the best of all active sets", errors.length, 1e-12);
  check("f - p stands on p", errors.angle, 1e-12);

  // Normal displacements of many nodes of a pad under a translation and two
  // rotations: hardly different columns.
  Eigen::MatrixXd pad(3, 40 * 40);
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j)
      pad.col(40 * i + j) << -1., -(i / 39. - 0.5), j / 39. - 0.5;
  const auto turned = [&](const double x, const double y) {
    return project_on_polar_cone(pad, Eigen::Vector3d(-1., -x, y)).value();
  };
  std::cout << "A pad of 40x40 nodes" << std::endl;
  check("pressed within it", turned(0.3, -0.49).norm(), 1e-13);
  check("pressed at a corner", turned(0.5, 0.5).norm(), 1e-13);
  check("pressed outside of it",
        (turned(0.6, 0.) - Eigen::Vector3d(0.05, -0.1, 0.) / 1.25).norm(),
        1e-13);
}
