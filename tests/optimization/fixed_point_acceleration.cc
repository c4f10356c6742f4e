// SPDX-License-Identifier: LGPL-2.1-or-later
// Maps whose limits are known: linear ones with some slow directions, a curved
// one, and what starts anew.

#include <debond/optimization/majorise/fixed_point_acceleration.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "../check.h"

using namespace Debond;
using Eigen::VectorXd;

namespace
{
  using Map = std::function<VectorXd(const VectorXd &)>;



  /// After how many maps from a part of the limit x is within 1e-12 of the
  /// limit, relatively; at most 10000.
  unsigned int
  maps_to(const VectorXd &limit,
          const Map      &map,
          const bool      accelerated,
          const double    start = 0.)
  {
    FixedPointAcceleration acceleration;
    VectorXd               x = start * limit;
    for (unsigned int k = 1; k < 10000; ++k)
      {
        const VectorXd image = map(x);
        if ((image - limit).norm() <= 1e-12 * limit.norm())
          return k;
        x = accelerated ? acceleration.next(x, image) : image;
      }
    return 10000;
  }



  /// x -> limit + Q diag(rates) Q' (x - limit) with an orthogonal Q.
  Map
  linear(const VectorXd &rates, const VectorXd &limit)
  {
    const Eigen::Index n = rates.size();
    Eigen::MatrixXd    numbers(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        numbers(i, j) = std::sin(1. + 3. * i + 7. * i * j + j * j);
    const Eigen::MatrixXd Q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(numbers).householderQ();
    const Eigen::MatrixXd B = Q * rates.asDiagonal() * Q.transpose();
    return [=](const VectorXd &x) { return VectorXd(limit + B * (x - limit)); };
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures            = argc > 1;
  constexpr Eigen::Index n = 20;
  VectorXd               limit(n);
  for (Eigen::Index i = 0; i < n; ++i)
    limit(i) = std::cos(2. * i);

  for (const unsigned int n_slow : {1, 2, 4})
    {
      VectorXd rates = VectorXd::Zero(n);
      for (unsigned int k = 0; k < n_slow; ++k)
        rates(k) = 0.99 - 0.1 * k;
      std::cout << "== " << n_slow << " slow directions" << std::endl;
      const Map map = linear(rates, limit);
      check("maps without it, more than 2000",
            maps_to(limit, map, false) > 2000);
      check("maps with it", maps_to(limit, map, true), 4. * n_slow);
    }

  // Each component on its own: x -> x - (x^2 - c) / 40 comes to sqrt(c).
  VectorXd near_one = VectorXd::Constant(n, 1.);
  for (Eigen::Index i = 0; i < n; ++i)
    near_one(i) += 0.01 * limit(i);
  const VectorXd of_near_one = near_one.cwiseAbs2();
  const Map      bent        = [&](const VectorXd &x) {
    return VectorXd(x - (x.cwiseAbs2() - of_near_one) / 40.);
  };
  std::cout << "== Curved" << std::endl;
  const unsigned int alone = maps_to(near_one, bent, false, 0.8);
  check("a quarter of the maps and less",
        maps_to(near_one, bent, true, 0.8),
        0.25 * alone);

  // In other units, and at the limit.
  std::cout << "== Units and ends" << std::endl;
  VectorXd rates = VectorXd::Zero(n);
  rates(0)       = 0.99;
  rates(1)       = 0.9;
  for (const double unit : {1e-100, 1e100})
    check("the same number of maps in other units",
          maps_to(unit * limit, linear(rates, unit * limit), true) ==
            maps_to(limit, linear(rates, limit), true));
  FixedPointAcceleration acceleration;
  bool                   stays = true;
  for (unsigned int k = 0; k < 10; ++k)
    stays = stays && acceleration.next(limit, limit) == limit;
  check("stays at the limit", stays);

  // Steps along a line, each half of the one before: the third one knows the
  // limit, unless a longer one or restart() came between.
  const auto step = [](const double x, const double image) {
    return std::make_pair(VectorXd::Constant(1, x),
                          VectorXd::Constant(1, image));
  };
  FixedPointAcceleration line;
  const auto             go = [&](const double x, const double image) {
    const auto [from, to] = step(x, image);
    return line.next(from, to)(0);
  };
  check("too few are known", go(0., 8.) == 8. && go(8., 12.) == 12.);
  check("the third", std::abs(go(12., 14.) - 16.), 1e-14);
  check("a longer one", go(14., 20.) == 20. && go(20., 23.) == 23.);
  check("and two more", std::abs(go(23., 24.5) - 26.), 1e-13);
  line.restart();
  check("nothing known", go(0., 8.) == 8. && go(8., 12.) == 12.);
}
