// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_laws_stepped_h
#define debond_contact_laws_stepped_h

#include <debond/contact/law.h>

namespace Debond
{
  /**
   * Bonds that break in n steps: springs of stiffness a_1 (force per volume) up
   * to the displacement M_1 (length), of a_2 up to M_2, ..., and nothing beyond
   * M_n. With M_0 = 0 and a_{n+1} = 0
   *
   *     j_1(s) = e_k + a_k s^2 / 2  for -M_k < s <= -M_{k-1},
   *     e_1 = 0,  e_{k+1} = e_k + (a_k - a_{k+1}) M_k^2 / 2,
   *
   * continuous, e_k being the energy that the steps before have taken. It is
   * the least of its n + 1 branches because a_1 > a_2 > ... > a_n > 0 and M_1 <
   * M_2 < ...: the difference of two neighbours, (a_k - a_{k+1}) (s^2 - M_k^2)
   * / 2, changes its sign at -M_k only. One step is the law of winkler_law().
   *
   * The branches are called bonded, partly broken (1), (2), ... by the steps
   * behind them, and broken.
   *
   * Throws std::invalid_argument unless there are as many stiffnesses as
   * thresholds, in that order, positive and finite.
   */
  ContactLawParameters
  stepped_law(const std::vector<double> &stiffnesses,
              const std::vector<double> &thresholds);

  LawKind
  stepped_kind();
} // namespace Debond

#endif
