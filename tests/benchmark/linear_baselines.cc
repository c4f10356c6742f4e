// SPDX-License-Identifier: LGPL-2.1-or-later
// The linear solves that contact solves are measured against.

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>

#include <debond/benchmark/linear_baselines.h>
#include <debond/mesh/box.h>

#include <iostream>
#include <memory>
#include <string>

#include "../check.h"

using namespace Debond;

namespace
{
  /// |A u - f| / |f|.
  template <int dim>
  double
  residual(const ElasticProblem<dim> &problem, const DofVector &u)
  {
    DofVector r(u.size());
    return problem.matrix().residual(r, u, problem.load()) /
           problem.load().l2_norm();
  }



  template <int dim>
  void
  test(const BoxParameters &box,
       const bool           tangential_displacement_fixed,
       const unsigned int   most_cycles)
  {
    dealii::Triangulation<dim> mesh;
    make_box(box, mesh);
    BoundaryConditions conditions;
    conditions.clamped                       = {box_sides<dim>().at("left")};
    conditions.contact                       = {box_sides<dim>().at("bottom")};
    conditions.tangential_displacement_fixed = tangential_displacement_fixed;
    ElasticProblem<dim> problem(mesh, conditions);
    Material            material;
    material.young_modulus = 69.;
    material.hypothesis    = Material::Hypothesis::plane_strain;
    Loads<dim> loads;
    loads.tractions[box_sides<dim>().at("top")] =
      std::make_shared<dealii::Functions::ConstantFunction<dim>>(0.69, dim);
    problem.assemble(material, loads, MatrixStorage::trilinos);
    const LinearSolve by_ml = solve_by_ml(problem);
    problem.assemble(material, loads);
    const LinearSolve direct =
      solve_by_cholesky(problem.matrix(), problem.load());
    std::cout << "  CHOLMOD: residual below 5e-10: "
              << verdict(residual(problem, direct.u), 5e-10) << std::endl;

    const auto compare = [&](const std::string &name,
                             const LinearSolve &iterative,
                             const unsigned int most_iterations) {
      DofVector difference = direct.u;
      difference -= iterative.u;
      std::cout << "  " << name << ": residual below 5e-10: "
                << verdict(residual(problem, iterative.u), 5e-10)
                << "; the solution to 1e-9: "
                << verdict(difference.l2_norm() / direct.u.l2_norm(), 1e-9)
                << "; at most " << most_iterations << " CG steps: "
                << verdict(iterative.iterations, most_iterations) << std::endl;
    };
    compare("ML", by_ml, 34);
    compare("hypre", solve_by_hypre(problem), 130);
    compare("levels", solve_by_levels(Box<dim>(box), problem), most_cycles);
  }
} // namespace



int
main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  BoxParameters box;
  box.cells = {{160, 16, 1}};
  std::cout << "2D" << std::endl;
  test<2>(box, true, 18);
  std::cout << "2D, turned, free to slide" << std::endl;
  box.rotation = 30.;
  test<2>(box, false, 18);

  std::cout << "3D, turned, free to slide" << std::endl;
  box.cells = {{20, 2, 2}};
  test<3>(box, false, 18);
}
