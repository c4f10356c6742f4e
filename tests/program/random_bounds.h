// SPDX-License-Identifier: LGPL-2.1-or-later
// What the checks of bounds on random scenes share.
#ifndef debond_tests_program_random_bounds_h
#define debond_tests_program_random_bounds_h

#include <debond/mesh/bisected_body.h>
#include <debond/solve/certificate.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "../check.h"
#include "generator.h"
#include "solved.h"

/// What was found in all scenes.
struct BoundCounts
{
  unsigned int        unsolved = 0, above = 0, negative = 0;
  unsigned int        inexact = 0, beyond_reserve = 0; ///< sums of gaps
  std::vector<double> distances; ///< of the bound from the least J found

  std::map<std::string, unsigned int> refused; ///< by reason

  /// Of a certificate with the branches as they are.
  void
  add_parts(const Debond::Certificate &certificate)
  {
    const double scale = std::abs(certificate.upper);
    double       sum   = 0.;
    for (const double gap : certificate.gaps)
      {
        sum += gap;
        negative += gap < -1e-12 * scale;
      }
    const double error = std::abs(certificate.upper - certificate.lower -
                                  certificate.reserve - sum);
    inexact += error > 1e-10 * scale;
    beyond_reserve += error > certificate.reserve;
  }

  /// A bound above @p upper is one too many.
  void
  add_bound(const unsigned int number,
            const double       lower,
            const double       upper,
            const Values      &values)
  {
    if (lower <= upper)
      return;
    ++above;
    std::cout << "scene " << number << ": " << text(lower) << " is above "
              << text(upper) << '\n';
    for (const std::string &value : values)
      std::cout << "  " << value << '\n';
  }

  /// Of @p n scenes, of which @p n_bounds have a bound.
  void
  check_all(const unsigned int n, const std::size_t n_bounds) const
  {
    check("bounds above what is found", above, 0);
    check("parts of a gap below zero", negative, 0);
    check("their sum is the gap but for the reserve for rounding",
          beyond_reserve,
          0);
    check("more than 1e-10 of J beside it", inexact, n / 5);
    check("most scenes have one", n_bounds > n / 2);
  }

  void
  print(const std::size_t n_bounds)
  {
    std::sort(distances.begin(), distances.end());
    std::cout << n_bounds << " bounds, " << unsolved << " not solved; "
              << distances.size() << " beside finer meshes, below by "
              << distances.front() << " at least, "
              << distances[distances.size() / 2] << " in the median; "
              << negative << " negative parts, " << inexact << " inexact sums, "
              << beyond_reserve << " beyond the reserve\n";
    for (const auto &[reason, times] : refused)
      std::cout << times << " refused: " << reason << '\n';
  }
};



/// With each cell cut as often as a random one of @p times says.
template <int dim>
std::shared_ptr<const Debond::Scene<dim>>
cut_scene(const Debond::Parameters        &parameters,
          const unsigned int               number,
          const std::vector<unsigned int> &times)
{
  const Debond::BisectedBody<dim> whole(
    std::dynamic_pointer_cast<const Debond::Body<dim>>(parameters.body));
  Generator                 random(number + 1000000);
  std::vector<unsigned int> of_cells;
  for (unsigned int k = 0; k < whole.n_cells(); ++k)
    of_cells.push_back(random.choice(times));
  return std::make_shared<const Debond::Scene<dim>>(parameters,
                                                    whole.refined(of_cells));
}



/// On the mesh as it is, or every third with cells cut.
template <int dim>
std::shared_ptr<const Debond::Scene<dim>>
coarse_scene(const Debond::Parameters        &parameters,
             const unsigned int               number,
             const std::vector<unsigned int> &times)
{
  return number % 3 == 0 ?
           cut_scene<dim>(parameters, number, times) :
           std::make_shared<const Debond::Scene<dim>>(parameters);
}

#endif
