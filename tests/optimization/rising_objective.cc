// SPDX-License-Identifier: LGPL-2.1-or-later
// Majorise-minimise with a solver that, against its word, makes J larger: that
// is told, unless rounding explains it.

#include <debond/optimization/majorise/majorise_minimise.h>

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
      return {J, /*functional_rounding=*/1e-12, /*residual=*/1., 0., 0};
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
      return {true, 1, 1};
    }

  private:
    const double rise;
    double       J = 1.;
  };



  void
  print(const std::string &what, const double rise)
  {
    RisingProblem                problem(rise);
    const MajoriseMinimiseResult result =
      MajoriseMinimise({1e-10, 20}).minimize(problem);
    std::cout << what << ": " << to_string(result.status) << " after "
              << result.history.size() << "\n  " << result.message << '\n';
  }
} // namespace



int
main()
{
  print("J rises", 1e-3);
  print("J rises by rounding", 1e-14);
}
