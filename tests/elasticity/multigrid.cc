// SPDX-License-Identifier: LGPL-2.1-or-later
// What large scenes need: interpolation between crossed meshes, rigid body
// modes, conjugate gradients with multigrid, and majorise-minimise on all
// unknowns, against the condensed problem.

#include <deal.II/base/function_parser.h>
#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_cg.h>

#include <debond/contact/adhesion_integral.h>
#include <debond/contact/laws/winkler.h>
#include <debond/elasticity/displacement_problem.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/mesh/box.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "../check.h"

using namespace Debond;

namespace
{
  template <int dim>
  struct BodyProblem
  {
    BodyProblem(const BoxParameters &box)
    {
      make_box(box, mesh);
      BoundaryConditions conditions;
      conditions.clamped = {box_sides<dim>().at("left"),
                            box_sides<dim>().at("right")};
      conditions.contact = {box_sides<dim>().at("bottom")};
      problem = std::make_unique<ElasticProblem<dim>>(mesh, conditions);

      // The paper's load, turned with the box.
      const double      angle = box.rotation * dealii::numbers::PI / 180.;
      const std::string along = "(" + std::to_string(std::cos(angle)) + "*x+" +
                                std::to_string(std::sin(angle)) + "*y)";
      const std::string q    = "if(" + along + "<0.2,0.69,-0.345)";
      std::string expression = std::to_string(-std::sin(angle)) + "*" + q +
                               ";" + std::to_string(std::cos(angle)) + "*" + q +
                               (dim == 3 ? ";0" : "");
      auto load = std::make_shared<dealii::FunctionParser<dim>>(dim);
      load->initialize(dim == 2 ? "x,y" : "x,y,z", expression, {});
      Loads<dim> loads;
      loads.tractions[box_sides<dim>().at("top")] = {{load}};
      Material material;
      material.young_modulus = 69.;
      material.poisson_ratio = 0.33;
      problem->assemble(material, loads);
    }

    dealii::Triangulation<dim>           mesh;
    std::unique_ptr<ElasticProblem<dim>> problem;
  };



  BoxParameters
  box_of(const unsigned int n, const double rotation)
  {
    BoxParameters box;
    box.cells    = {{10 * n, n, n}};
    box.rotation = rotation;
    return box;
  }



  /// A P1 field and its interpolant on a mesh of twice as many cells are the
  /// same function: same energy, and the same values at common vertices.
  template <int dim>
  void
  test_interpolation(const double rotation)
  {
    const BoxParameters    coarse_box = box_of(1, rotation);
    const BoxParameters    fine_box   = box_of(2, rotation);
    const BodyProblem<dim> coarse(coarse_box);
    const BodyProblem<dim> fine(fine_box);

    DofVector u(coarse.problem->unknowns().n_dofs());
    for (unsigned int i = 0; i < u.size(); ++i)
      u(i) = coarse.problem->unknowns().is_constrained(i) ?
               0. :
               std::sin(1. + i * i);
    const DofVector v      = interpolate_displacement(Box<dim>(coarse_box),
                                                 *coarse.problem,
                                                 u,
                                                 *fine.problem);
    const double    energy = coarse.problem->matrix().matrix_norm_square(u);
    check("  difference of the energies",
          std::abs(fine.problem->matrix().matrix_norm_square(v) / energy - 1.),
          1e-12);
    check("  difference of the work",
          std::abs(fine.problem->load() * v - coarse.problem->load() * u) /
            (coarse.problem->load().l2_norm() * u.l2_norm()),
          1e-11);

    const DofVector back       = interpolate_displacement(Box<dim>(fine_box),
                                                    *fine.problem,
                                                    v,
                                                    *coarse.problem);
    DofVector       difference = back;
    difference -= u;
    check("  difference at the vertices of both",
          difference.linfty_norm() / u.linfty_norm(),
          1e-12);
  }



  template <int dim>
  void
  test_multigrid(const unsigned int n, const double rotation)
  {
    const BoxParameters    box = box_of(n, rotation);
    const BodyProblem<dim> body(box);

    // Modes are in the null space except next to the supports: the elastic
    // energy of a mode that is cut off there is no larger than that of a
    // vector of its size, which would be about n^2 dim times larger.
    const auto &A = body.problem->trilinos_matrix();
    DofVector   product(body.problem->unknowns().n_dofs());
    double      rows_with_force = 0.;
    for (const auto &mode : body.problem->unknowns().rigid_body_modes())
      {
        body.problem->vmult(product, mode);
        unsigned int count = 0;
        for (const double entry : product)
          count += std::abs(entry) > 1e-10 * A.frobenius_norm();
        rows_with_force =
          std::max(rows_with_force, 1. * count / product.size());
      }
    check("  part of the rows where a mode meets a force",
          rows_with_force,
          0.5);

    const auto distributed = [&](const DofVector &v) {
      return distribute(v, dealii::complete_index_set(v.size()), MPI_COMM_SELF);
    };
    std::vector<DistributedVector> modes;
    for (const DofVector &mode : body.problem->unknowns().rigid_body_modes())
      modes.push_back(distributed(mode));
    TruncatedMultigrid      cycle(A, dim, modes);
    const DistributedVector load = distributed(body.problem->load());
    DistributedVector       u    = load;
    u                            = 0.;
    dealii::SolverControl control(60, 1e-10 * load.l2_norm());
    dealii::SolverCG<DistributedVector>(control).solve(A, u, load, cycle);
    std::cout << "  conjugate gradients within 60 iterations: "
              << verdict(control.last_step(), 60) << '\n';


    // The same minimum as the condensed problem's, from its neighbourhood.
    const AdhesiveLaw law(winkler_law(69., 0.002).branches);
    for (const std::string rule : {"nodal", "gauss 2"})
      {
        const ContactQuadrature<dim> quadrature(
          ContactQuadratureParameters::parse(rule));
        const AdhesionIntegral<dim> adhesion(
          body.problem->unknowns().contact().boundary(), law, quadrature);
        std::vector<unsigned int> normals;
        for (const auto normal : body.problem->unknowns().contact().normals())
          normals.push_back(normal);
        const Condensation condensed(
          body.problem->matrix(),
          body.problem->load(),
          normals,
          [&](const unsigned int i) {
            return body.problem->unknowns().is_constrained(i);
          });
        Eigen::VectorXd  s = Eigen::VectorXd::Zero(normals.size());
        CondensedProblem small(condensed.schur_complement(),
                               condensed.load(),
                               adhesion,
                               s);
        const auto       exact = MajoriseMinimise({}).minimize(small);
        const double     J     = exact.functional + condensed.energy_at_zero();

        u = 0.;
        DisplacementProblem large(
          *body.problem, body.problem->load(), adhesion, cycle, u);
        const auto iterated = MajoriseMinimise({}).minimize(large);
        std::cout << "  " << rule << ": "
                  << to_string(exact.status) + ", " + to_string(iterated.status)
                  << '\n';
        check("  difference of the functionals",
              std::abs(iterated.functional / J - 1.),
              1e-11);
        DofVector    difference = condensed.expand(s);
        const double size       = difference.linfty_norm();
        difference -= gather(u);
        check("  difference of the displacements",
              difference.linfty_norm() / size,
              1e-8);
        double rise = 0.;
        for (unsigned int k = 1; k < iterated.history.size(); ++k)
          rise = std::max(rise,
                          iterated.history[k].functional -
                            iterated.history[k - 1].functional);
        check("  relative rise", rise / std::abs(J), 1e-12);

        // From rest, ended in the middle of a linear solve.
        bool ended = true, kept = true;
        for (const unsigned int allowed : {0, 1, 10, 30})
          {
            u                         = 0.;
            unsigned int        asked = 0;
            DofVector           last(u.size());
            DisplacementProblem stopped(
              *body.problem, body.problem->load(), adhesion, cycle, u);
            stopped.may_go_on = [&]() { return ++asked <= allowed; };
            const auto result = MajoriseMinimise({}).minimize(
              stopped, [&](const MajoriseMinimiseIteration &) {
                last = gather(u);
                return true;
              });
            ended = ended && result.status == SolverStatus::interrupted &&
                    asked <= allowed + 2;
            kept = kept && gather(u) == last;
          }
        std::cout << "  an interruption ends it within a linear iteration: "
                  << verdict(ended)
                  << ", with what the last iteration left: " << verdict(kept)
                  << '\n';
      }
  }
} // namespace



int
main(int argc, char *argv[])
{
  print_figures = argc > 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  for (const double rotation : {0., 30.})
    {
      std::cout << "2D, turned by " << rotation << '\n';
      test_interpolation<2>(rotation);
      test_multigrid<2>(8, rotation);
      std::cout << "3D, turned by " << rotation << '\n';
      test_interpolation<3>(rotation);
      test_multigrid<3>(2, rotation);
    }
}
