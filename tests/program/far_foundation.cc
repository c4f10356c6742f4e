// SPDX-License-Identifier: LGPL-2.1-or-later
// A foundation that is far below a body, beside its displacements: as long as
// it is not touched the body moves as one without a gap whose lower side rises,
// which has no lifting that could be lost in rounding.

#include <deal.II/base/mpi.h>

#include <iostream>

#include "../check.h"
#include "solve_scene.h"

namespace
{
  double
  relative(const Json &value, const Json &expected)
  {
    return std::abs(value.get<double>() / expected.get<double>() - 1.);
  }



  Values
  gap(const std::string &value)
  {
    return {"Contact law/Initial gap=" + value};
  }



  /// Without the message, whose figures are rounding.
  Json
  solve_quietly(const Values &scene)
  {
    const std::ostringstream message;
    std::streambuf *const    before = std::cerr.rdbuf(message.rdbuf());
    const Json               result = solve_scene(scene);
    std::cerr.rdbuf(before);
    return result;
  }



  void
  check_same(const std::string &name,
             const Json        &far,
             const double       distance,
             const Json        &near,
             const std::string &status = "success")
  {
    std::cout << "-- " << name << std::endl;
    check(status, far["status"] == status);
    check("J", relative(far["functional"], near["functional"]), 1e-9);
    // The solution is w = u - gap in double precision.
    const double of_far  = far["largest_displacement"],
                 of_near = near["largest_displacement"];
    check("largest displacement",
          std::abs(of_far - of_near) / (1e-9 * of_near + 2.2e-16 * distance),
          1.);
  }



  /// A strip of height 1 that is pulled lengthwise, so that it gets thinner.
  Values
  strip(const unsigned int dim, const std::string &length)
  {
    return {"Dimension=" + std::to_string(dim),
            "Mesh/Lengths=" + length + (dim == 2 ? ", 1" : ", 1, 1"),
            std::string("Mesh/Cells=") + (dim == 2 ? "200, 2" : "30, 1, 1"),
            "Material/Young modulus=1",
            "Material/Poisson ratio=0.3",
            "Boundary conditions/Clamped boundaries=left",
            "Boundary conditions/Contact boundary=bottom",
            "Contact law/Law=none",
            "Contact law/Tangential displacement=free",
            std::string("Loads/Traction right=1e-7; 0") +
              (dim == 2 ? "" : "; 0")};
  }



  void
  test_strips()
  {
    for (const unsigned int dim : {2, 3})
      for (const std::string length : {"1000", "10000"})
        {
          std::cout << "== Strip in " << dim << "D of length " << length
                    << std::endl;
          const Values scene = strip(dim, length);
          const Json   near  = solve_scene(scene);
          for (const std::string distance : {"1e-3", "1", "10"})
            check_same("gap " + distance,
                       solve_scene(scene + gap(distance)),
                       std::stod(distance),
                       near);
          // Rounding of w makes forces of more than 1e-6 of the reaction.
          check_same("gap 1e4",
                     solve_quietly(scene + gap("1e4")),
                     1e4,
                     near,
                     "not verified");
          check_same("energy bundle",
                     solve_scene(scene + gap("1") +
                                 Values{"Solver/Method=energy bundle"}),
                     1.,
                     near);
          check_same("load path",
                     solve_scene(scene + gap("1") +
                                 Values{"Load path/Factors=0.5, 1"}),
                     1.,
                     near);
        }
    const Values scene =
      strip(2, "1000") + Values{"Solver/Method=majorise minimise",
                                "Solver/Linear solver=multigrid"};
    check_same("multigrid",
               solve_scene(scene + gap("1")),
               1.,
               solve_scene(scene));
  }



  /// A steel bar whose displacements are 1e-9 of the gap and less, turned by
  /// 30 degrees.
  void
  test_bar()
  {
    std::cout << "== Bar" << std::endl;
    const Values scene     = {"Mesh/Lengths=1, 0.25",
                              "Mesh/Cells=16, 4",
                              "Mesh/Rotation=30",
                              "Material/Young modulus=210e9",
                              "Material/Poisson ratio=0.3",
                              "Boundary conditions/Clamped boundaries=left",
                              "Boundary conditions/Contact boundary=bottom",
                              "Contact law/Law=none",
                              "Contact law/Tangential displacement=free"};
    const Values multigrid = {"Solver/Method=majorise minimise",
                              "Solver/Linear solver=multigrid"};
    for (const auto &[load, status] :
         {std::make_pair("-0.3; 1", "not verified"),
          std::make_pair("-30; 100", "success")})
      {
        const Values loaded =
          scene + Values{std::string("Loads/Traction right=") + load};
        const Json near = solve_scene(loaded + gap("1e-5"));
        check_same(std::string("load ") + load,
                   solve_quietly(loaded + gap("1")),
                   1.,
                   near,
                   status);
        check_same("multigrid",
                   solve_quietly(loaded + gap("1") + multigrid),
                   1.,
                   near,
                   status);
      }
  }



  void
  test_no_load()
  {
    std::cout << "== No load" << std::endl;
    for (const std::string law : {"none", "winkler"})
      {
        const Values scene = {"Mesh/Lengths=1, 0.25",
                              "Mesh/Cells=16, 4",
                              "Boundary conditions/Clamped boundaries=left",
                              "Boundary conditions/Contact boundary=bottom",
                              "Contact law/Law=" + law,
                              "Contact law/Bond threshold=1e-4",
                              "Contact law/Tangential displacement=free",
                              "Contact law/Initial gap=0.001 * (1 + x)"};
        const Json   rest  = solve_scene(scene);
        check("at rest", rest["status"] == "success");
        check("largest displacement",
              rest["largest_displacement"].get<double>(),
              1e-17);
        check("no stress is said to change",
              rest["notes"].dump().find("rounding") == std::string::npos);

        const Json path =
          solve_scene(scene + Values{"Loads/Traction top=0; -0.01",
                                     "Load path/Factors=0:0.25:1"});
        check("load path", path["status"] == "success");
        check("all steps", path["path"].size() == 5);
      }
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_figures = argc > 1;
  test_strips();
  test_bar();
  test_no_load();
}
