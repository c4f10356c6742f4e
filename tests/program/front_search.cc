// SPDX-License-Identifier: LGPL-2.1-or-later
// Fronts that are some nodes off go back by windows: J falls by what it is
// said to, u_nu stays admissible, and a solve from there ends where the search
// on all contact nodes does.

#include <debond/contact/boundary_graph.h>
#include <debond/solve/front_search.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/solve.h>

#include <iostream>
#include <sstream>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  using Vector = DofVector;



  template <int dim>
  double
  functional(const Scene<dim> &scene, const Vector &u)
  {
    return scene.problem().fields().elastic_functional(u) +
           scene.adhesion().energy(
             scene.problem().unknowns().contact().trace(u));
  }



  template <int dim>
  void
  test(const std::string &name, const Values &values, const int shift)
  {
    const Parameters  searching = parameters_of(values);
    const Scene<dim>  scene(searching);
    const SolveResult best = solved(searching, scene);

    // The patches of broken bonds grow by some nodes, or shrink.
    const auto             &contact = scene.problem().unknowns().contact();
    const auto              graph   = neighbours(contact.boundary());
    const SeparableBranches bonds = lumped_bonds(scene.law(), scene.adhesion());
    const unsigned int      piece = shift > 0 ? 1 : 0;
    Vector                  u     = best.u;
    for (int k = 0; k < std::abs(shift); ++k)
      {
        const Eigen::VectorXd s = contact.trace(u);
        for (unsigned int i = 0; i < s.size(); ++i)
          for (const unsigned int j : graph[i])
            if (bonds.f[j].index(s(j)) == piece &&
                bonds.f[i].index(s(i)) != piece)
              u(contact.normals()[i]) = bonds.f[i].point_inside(piece);
      }
    const Parameters following =
      parameters_of(with(values, {"Solver/Search=none"}));
    const auto follow = [&](const Vector &start) {
      return solved(following, scene, &start);
    };
    const SolveResult off = follow(u);

    Vector                  moved  = off.u;
    const FrontSearchResult search = search_fronts(
      scene,
      MajoriseMinimise(searching.solver.majorise_minimise),
      []() { return true; },
      moved);
    const SolveResult result = follow(moved);

    const double lost = off.functional - best.functional;
    std::cout << name << ": " << search.windows << " windows, " << search.trials
              << " trials, " << search.improvements << " of them improvements, "
              << search.failures << " failures, "
              << (search.complete ? "complete" : "incomplete") << std::endl;
    check("  least J of all, relative to what the shift lost",
          (best.functional - result.functional) / lost,
          1e-9);
    check("  J with the fronts of the windows",
          (functional(scene, moved) - off.functional) / lost,
          -0.15);
    check("  J of a solve from there",
          (result.functional - off.functional) / lost,
          -0.4);
    double largest = 0.;
    for (const double opening : contact.trace(moved))
      largest = std::max(largest, opening);
    check("  penetration", largest, 0.);
  }
} // namespace



int
main()
{
  for (const int shift : {3, -3})
    test<2>("bar",
            {"Mesh/Cells=80, 8",
             "Loads/Traction top=0; if(x<0.2,0.69,-0.345)",
             "Contact law/Bond stiffness=690",
             "Solver/Method=automatic",
             "Solver/Search=full",
             "Solver/Linear solver=direct"},
            shift);
  test<3>("tape",
          {"Dimension=3",
           "Mesh/Lengths=60, 2, 20",
           "Mesh/Cells=30, 1, 10",
           "Material/Young modulus=50",
           "Material/Poisson ratio=0.4",
           "Boundary conditions/Clamped boundaries=left",
           "Loads/Traction right=0; if(z > 10, 0.1, 0); 0",
           "Contact law/Bond stiffness=2",
           "Contact law/Bond threshold=0.2",
           "Contact law/Tangential displacement=free",
           "Solver/Method=automatic",
           "Solver/Linear solver=direct"},
          2);
}
