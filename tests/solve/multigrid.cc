// SPDX-License-Identifier: LGPL-2.1-or-later
// What large scenes need: interpolation between crossed meshes, and
// majorise-minimise on all unknowns that ends when it is asked to. Its minima
// are beside those of the condensed problem in oracle/multigrid.

#include <deal.II/base/function_parser.h>
#include <deal.II/base/mpi.h>

#include <debond/contact/adhesion_integral.h>
#include <debond/contact/laws/winkler.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/linear_algebra/aggregation.h>
#include <debond/mesh/box.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/solve/minimum/displacement_problem.h>

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
    if (rotation != 0.)
      box.origin = {{-0.08, 0.3, 0.1}};
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
    const DofVector v =
      interpolate_displacement(*coarse.problem, u, *fine.problem);
    const double energy = coarse.problem->matrix().matrix_norm_square(u);
    check("  difference of the energies",
          std::abs(fine.problem->matrix().matrix_norm_square(v) / energy - 1.),
          1e-12);
    check("  difference of the work",
          std::abs(fine.problem->load() * v - coarse.problem->load() * u) /
            (coarse.problem->load().l2_norm() * u.l2_norm()),
          1e-11);

    const DofVector back =
      interpolate_displacement(*fine.problem, v, *coarse.problem);
    DofVector difference = back;
    difference -= u;
    check("  difference at the vertices of both",
          difference.linfty_norm() / u.linfty_norm(),
          1e-12);
  }



  /// From rest, ended in the middle of a linear solve.
  /// Ends what iterates when it has asked so many times.
  class Allows : public Interruption
  {
  public:
    explicit Allows(const unsigned int n)
      : n(n)
    {}

    bool
    requested() const override
    {
      return ++asked > n;
    }

    mutable unsigned int asked = 0;

  private:
    const unsigned int n;
  };



  template <int dim>
  void
  test_interruption(const unsigned int n, const double rotation)
  {
    const BoxParameters    box = box_of(n, rotation);
    const BodyProblem<dim> body(box);

    const auto distributed = [&](const DofVector &v) {
      return distribute(v, dealii::complete_index_set(v.size()), MPI_COMM_SELF);
    };
    std::vector<DistributedVector> modes;
    for (const DofVector &mode : body.problem->unknowns().rigid_body_modes())
      modes.push_back(distributed(mode));
    const DistributedMatrix &A = body.problem->distributed_matrix();
    TruncatedMultigrid cycle(A, dim, aggregated_prolongations(A, dim, modes));
    DistributedVector  u = distributed(body.problem->load());
    const AdhesiveLaw  law(winkler_law(69., 0.002).pieces);
    for (const std::string rule : {"nodal", "gauss 2"})
      {
        const ContactQuadrature<dim> quadrature(
          ContactQuadratureParameters::parse(rule));
        const AdhesionIntegral<dim> adhesion(
          body.problem->unknowns().contact().boundary(), law, quadrature);
        bool ended = true, kept = true;
        for (const unsigned int allowed : {0, 1, 10, 30})
          {
            u = 0.;
            const Allows        allows(allowed);
            DofVector           last(u.size());
            DisplacementProblem stopped(
              *body.problem, body.problem->load(), adhesion, cycle, u, allows);
            const auto result = MajoriseMinimise({}).minimize(
              stopped, [&](const MajoriseMinimiseIteration &) {
                last = gather(u);
                return true;
              });
            ended = ended && result.status == SolverStatus::interrupted &&
                    allows.asked <= allowed + 2;
            kept = kept && gather(u) == last;
          }
        check("  an interruption ends it within a linear iteration", ended);
        check("  with what the last iteration left", kept);
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
      section("2D, turned by ", rotation);
      test_interpolation<2>(rotation);
      test_interruption<2>(8, rotation);
      section("3D, turned by ", rotation);
      test_interpolation<3>(rotation);
      test_interruption<3>(2, rotation);
    }
}
