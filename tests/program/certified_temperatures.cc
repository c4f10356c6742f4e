// SPDX-License-Identifier: LGPL-2.1-or-later
// Temperatures that are constant in each cell but not in the body: certified
// intervals of degree 2 beside those of degree 1 on finer meshes, all for the
// least J of the same continuous body, so that they meet.

#include <deal.II/base/mpi.h>

#include <iostream>

#include "../check.h"
#include "solve_scene.h"

namespace
{
  void
  test(const std::string &name,
       const Values      &scene,
       const std::string &cells,
       const std::string &fine_cells)
  {
    std::cout << "== " << name << std::endl;
    const auto certificate = [&](const std::string &degree,
                                 const std::string &mesh) {
      const Json result = solve_scene(
        scene + Values{"Mesh/Degree=" + degree, "Mesh/Cells=" + mesh});
      check("success", result["status"] == "success");
      check("loads are exact", result["certificate"]["loads_are_exact"]);
      const double lower = result["certificate"]["lower"],
                   upper = result["certificate"]["upper"];
      check("an interval", lower <= upper);
      // What bounds J is J of the same displacement.
      check("upper end",
            std::abs(upper / result["functional"].get<double>() - 1.),
            1e-7);
      return std::make_pair(lower, upper);
    };
    const auto [lower, upper]           = certificate("2", cells);
    const auto [fine_lower, fine_upper] = certificate("1", fine_cells);
    check("the intervals meet", lower <= fine_upper && fine_lower <= upper);
    check("that of degree 2 in 100 of |J|",
          100. * (upper - lower) / -upper,
          10.);
  }



  Values
  body(const unsigned int dim, const std::string &kind)
  {
    return {"Dimension=" + std::to_string(dim),
            std::string("Mesh/Lengths=1, 0.5") + (dim == 2 ? "" : ", 0.5"),
            "Material/Young modulus=1",
            "Material/Poisson ratio=0.3",
            "Material/Thermal expansion=1e-3",
            "Boundary conditions/Clamped boundaries=left",
            "Boundary conditions/Contact boundary=bottom",
            "Contact law/Law=none",
            std::string("Contact law/Quadrature=") +
              (dim == 2 ? "gauss 8" : "gauss 2"),
            "Contact law/Tangential displacement=free",
            "Loads/Temperature change=10",
            "Certificate/Kind=" + kind};
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_figures = argc > 1;

  const Values half   = {"Parts/cold=x > 0.5",
                         "Material/Thermal expansion cold=0"};
  const Values shrunk = {"Parts/cold=y > 0.25",
                         "Material/Thermal expansion cold=-1e-3"};
  for (const std::string kind : {"global", "fixed state"})
    {
      test(kind + ", a half is cold", body(2, kind) + half, "4, 2", "16, 8");
      test(kind + ", the upper half shrinks",
           body(2, kind) + shrunk,
           "8, 4",
           "32, 16");
    }
  test("3D", body(3, "fixed state") + half, "2, 1, 1", "8, 4, 4");
}
