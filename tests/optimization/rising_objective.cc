// SPDX-License-Identifier: LGPL-2.1-or-later
// Majorise-minimise with a solver that, against its word, makes J larger: that
// is told, unless rounding explains it. One that leaves the same residual again
// has stagnated, which a search counts as a failure above its second tolerance.

#include <debond/optimization/global/branch_search.h>

#include <iostream>

using namespace Debond;

namespace
{
  class RisingProblem : public MajorantProblem
  {
  public:
    explicit RisingProblem(const double rise)
      : rise(rise)
    {}

    State
    evaluate() override
    {
      return {J, /*functional_rounding=*/1e-12, /*residual=*/1., 0., 1., 0};
    }

    bool
    majorise() override
    {
      return true;
    }

    Minimisation
    minimise(const double) override
    {
      J += rise;
      return {SolverStatus::success, 1, 1};
    }

  private:
    const double rise;
    double       J = 1.;
  };



  /// One majorant, and a solver that leaves the same residual again and again.
  class StagnatingProblem : public MajorantProblem
  {
  public:
    explicit StagnatingProblem(const double residual)
      : residual(residual)
    {}

    State
    evaluate() override
    {
      return {1., 1e-12, residual, 0., 1., 0};
    }

    bool
    majorise() override
    {
      const bool is_first = !majorised;
      majorised           = true;
      return is_first;
    }

    Minimisation
    minimise(const double) override
    {
      return {SolverStatus::stagnated, 1, 1};
    }

  private:
    const double residual;
    bool         majorised = false;
  };



  void
  print(const std::string &what, const MajoriseMinimiseResult &result)
  {
    std::cout << what << ": " << to_string(result.status) << " after "
              << result.history.size() << "\n  " << result.message << '\n';
  }
} // namespace



int
main()
{
  const MajoriseMinimise method({1e-10, 20});
  RisingProblem          rises(1e-3), rises_by_rounding(1e-14);
  print("J rises", method.minimize(rises));
  print("J rises by rounding", method.minimize(rises_by_rounding));

  StagnatingProblem large(1e-4), once_more(1e-4), small(1e-8);
  print("nothing changes", method.minimize(large));
  print("a trial at 1e-4", minimise_trial(method, once_more));
  print("a trial at 1e-8", minimise_trial(method, small));
}
