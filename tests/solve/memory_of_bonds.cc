// SPDX-License-Identifier: LGPL-2.1-or-later
// What search and proof know of bonds that remember is Phi itself: values and
// forces at random displacements after random histories.

#include <debond/contact/boundary_graph.h>
#include <debond/solve/minimum/lumped_bonds.h>

#include <random>

#include "../check.h"
#include "../solved.h"

using namespace Debond;

namespace
{
  template <int dim>
  void
  test_lumped_bonds(const std::string &name,
                    const double       threshold,
                    const Values      &values)
  {
    const Scene<dim>      scene(parameters_of(values));
    AdhesionIntegral<dim> adhesion = scene.adhesion();
    section(name, " in ", dim, "D");
    check("is a sum over nodes", is_sum_over_nodes(adhesion));
    std::mt19937                           random(dim);
    std::uniform_real_distribution<double> unit(-1., 1.);
    // Most below the threshold, some far beyond.
    const auto draw = [&](const double size) {
      Eigen::VectorXd s(adhesion.n_unknowns());
      for (Eigen::Index i = 0; i < s.size(); ++i)
        s(i) = size * threshold * std::pow(unit(random), 3) * 4.;
      s.head(adhesion.n_nodes()) = -s.head(adhesion.n_nodes()).cwiseAbs();
      return s;
    };
    double       of_values = 0., of_forces = 0., least_left = 1., taken = 0.;
    const double energy =
      adhesion.value(Eigen::VectorXd::Constant(adhesion.n_unknowns(), -1e3));
    for (unsigned int history = 0; history < 40; ++history)
      {
        adhesion.set_memory({});
        for (unsigned int step = 0; step < history % 4; ++step)
          adhesion.break_for_good(draw(0.7));
        NeighbourGraph        graph  = neighbours(adhesion.contact_boundary());
        const SeparableEnergy lumped = lumped_bonds(adhesion, graph);
        raise(taken, adhesion.dissipated_energy() / energy);
        for (unsigned int k = 0; k < 20; ++k)
          {
            const Eigen::VectorXd s = draw(1.);
            raise(of_values,
                  std::abs(lumped.change(s) - adhesion.change(s)) / energy);
            if (lumped.bonds.empty() || lumped.is_piecewise_quadratic())
              raise(of_forces,
                    (lumped.subgradient(s) - adhesion.subgradient(s))
                        .template lpNorm<Eigen::Infinity>() *
                      threshold / energy);
            // What was taken is the least that is left.
            least_left = std::min(least_left, adhesion.change(s) / energy);
          }
      }
    check("bonds break", taken > 0.);
    check("values", of_values, 1e-14);
    check("forces", of_forces, 1e-13);
    check("nothing comes back", -least_left, 1e-15);
  }



  template <int dim>
  void
  test_laws()
  {
    Values body = {"Contact law/Quadrature=nodal",
                   "Contact law/Tangential displacement=free"};
    if (dim == 3)
      body += Values{"Dimension=3",
                     "Mesh/Lengths=1, 0.2, 0.4",
                     "Mesh/Cells=5, 1, 2",
                     "Boundary conditions/Clamped boundaries=top"};
    const std::string field = "*(1 + 0.3*sin(9*x))";
    const Values      shear =
      body + Values{"Contact law/Tangential displacement=bonded",
                    "Contact law/Bond shear stiffness=30",
                    "Contact law/Bond stiffness=69" + field,
                    "Boundary conditions/Clamped boundaries=top"};
    test_lumped_bonds<dim>("winkler", 0.002, body);
    test_lumped_bonds<dim>(
      "winkler, varying",
      0.002,
      body + Values{"Contact law/Bond stiffness=69" + field,
                    "Contact law/Bond threshold=0.002" + field});
    test_lumped_bonds<dim>(
      "sawteeth",
      0.002,
      body + Values{"Contact law/Law=curve",
                    "Contact law/Curve=0:0, 0.001:0.1, 0.001:0.05, 0.002:0.1, "
                    "0.002:0",
                    "Contact law/Traction factor=1" + field});
    const Values soft = {"Contact law/Bond stiffness=69" + field,
                         "Contact law/Bond strength=0.07",
                         "Contact law/Fracture energy=0.0002"};
    for (const std::string law : {"bilinear", "exponential"})
      test_lumped_bonds<dim>(law,
                             0.004,
                             body + Values{"Contact law/Law=" + law} + soft);
    test_lumped_bonds<dim>("rigid at first",
                           0.004,
                           body + Values{"Contact law/Law=curve",
                                         "Contact law/Curve=0:0.1, 0.004:0"});
    test_lumped_bonds<dim>("in shear", 0.002, shear);
    test_lumped_bonds<dim>("apart in shear",
                           0.002,
                           shear +
                             Values{"Contact law/Bond failure=separate",
                                    "Contact law/Shear fracture energy=1e-4"});
  }
} // namespace



int
main(int argc, char **argv)
{
  print_figures = argc > 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test_laws<2>();
  test_laws<3>();
}
