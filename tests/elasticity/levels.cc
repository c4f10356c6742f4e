// SPDX-License-Identifier: LGPL-2.1-or-later
// The coarser levels of an elastic problem: matrices and loads are those of the
// coarser meshes where these are nested, the cycle is symmetric and positive
// definite, truncated or not, and truncation is what a cycle of the truncated
// matrix would be.

#include <debond/contact/adhesion_integral.h>
#include <debond/contact/laws/winkler.h>
#include <debond/elasticity/elastic_levels.h>
#include <debond/elasticity/level_problem.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/mesh/box.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <cmath>
#include <iostream>

#include "../check.h"

using namespace Debond;

namespace
{
  using Vector = DofVector;



  template <int dim>
  struct BodyProblem
  {
    explicit BodyProblem(const BoxParameters &parameters)
      : box(parameters)
      , names(box.make_mesh(mesh).boundaries)
      , problem(mesh, conditions())
    {
      Loads<dim> loads;
      loads.tractions[box_sides<dim>().at("top")] = {
        {std::make_shared<dealii::Functions::ConstantFunction<dim>>(0.7, dim)}};
      Material material;
      material.young_modulus = 69.;
      material.poisson_ratio = 0.33;
      problem.assemble(material, loads);
    }

    static BoundaryConditions
    conditions()
    {
      BoundaryConditions conditions;
      conditions.clamped = {box_sides<dim>().at("left")};
      conditions.contact = {box_sides<dim>().at("bottom")};
      return conditions;
    }

    const Box<dim>             box;
    dealii::Triangulation<dim> mesh;
    const BoundaryNames        names;
    ElasticProblem<dim>        problem;
  };



  Vector
  noise(const unsigned int size, const double phase)
  {
    Vector v(size);
    for (unsigned int i = 0; i < size; ++i)
      v(i) = std::sin(phase + 12.9898 * i);
    return v;
  }



  template <int dim>
  Vector
  free_noise(const ElasticProblem<dim> &problem, const double phase)
  {
    Vector v = noise(problem.unknowns().n_dofs(), phase);
    problem.unknowns().constraints().set_zero(v);
    return v;
  }



  /// Fields on the coarser mesh have the energy and do the work that the level
  /// says.
  template <int dim>
  void
  test_nested(const BoxParameters &fine_box, const BoxParameters &coarse_box)
  {
    const BodyProblem<dim> fine(fine_box), coarse(coarse_box);
    const auto   levels = ElasticLevels<dim>::make(fine.box, fine.problem);
    const Vector v      = free_noise(coarse.problem, 1.);
    const Vector u      = levels->from_vertex_displacements(
      1,
      coarse.box.interpolate(coarse.mesh,
                             vertex_displacements(coarse.problem, v),
                             levels->vertices(1)));
    Vector product(u.size());
    levels->vmult(1, product, u);
    const double energy = coarse.problem.matrix().matrix_norm_square(v);
    check("  relative difference of the energy of the coarser mesh",
          std::abs(u * product / energy - 1.),
          1e-12);
    const double work = coarse.problem.load() * v;
    check("  of the work", std::abs(u * levels->load(1) / work - 1.), 1e-11);

    const Vector fine_u = levels->prolongate(1, u);
    check("  of the energy of the same field on the fine one",
          std::abs(fine.problem.matrix().matrix_norm_square(fine_u) / energy -
                   1.),
          1e-12);
    // s = P s_1.
    Eigen::VectorXd coarse_s(levels->normals(1).size());
    for (unsigned int i = 0; i < coarse_s.size(); ++i)
      coarse_s(i) = u(levels->normals(1)[i]);
    const Eigen::VectorXd fine_s = levels->trace_prolongation(1) * coarse_s;
    double                error  = 0.;
    for (unsigned int i = 0; i < fine_s.size(); ++i)
      error =
        std::max(error, std::abs(fine_s(i) - fine_u(levels->normals(0)[i])));
    check("  difference of the normal displacements", error, 1e-14);
  }



  template <int dim>
  void
  test_cycle(const BoxParameters &box)
  {
    const BodyProblem<dim> body(box);
    const auto     levels = ElasticLevels<dim>::make(body.box, body.problem);
    const unsigned n      = body.problem.unknowns().n_dofs();
    auto          &cycle  = levels->cycle();

    // P and its transpose.
    Vector coarse = noise(levels->n_unknowns(1), 1.), fine = noise(n, 2.);
    Vector restricted(coarse.size());
    cycle.transfer(0).restrict_to(restricted.begin(), fine.begin());
    check("  restriction is the transpose of prolongation",
          std::abs(levels->prolongate(1, coarse) * fine - coarse * restricted) /
            (coarse.l2_norm() * fine.l2_norm()),
          1e-12);

    const auto  &normals = levels->normals(0);
    const Vector x       = free_noise(body.problem, 1.),
                 y       = free_noise(body.problem, 2.);
    Vector     Bx(n), By(n);
    const auto test_definite = [&](const std::string &name) {
      cycle.vmult(Bx, x);
      cycle.vmult(By, y);
      check("  " + name + ": asymmetry",
            std::abs(Bx * y - x * By) / std::sqrt((Bx * x) * (By * y)),
            1e-5);
      check("  positive", Bx * x > 0. && By * y > 0.);
    };
    test_definite("A");
    const Vector before = Bx;

    // Half of the nodes held, the others with bonds.
    std::vector<unsigned int>   held;
    Eigen::SparseMatrix<double> E(normals.size(), normals.size());
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (i % 4 < 2)
        held.push_back(normals[i]);
      else
        E.insert(i, i) = 10.;
    cycle.truncate(0, held, normals, E);
    test_definite("truncated");
    double largest = 0.;
    for (const unsigned int i : held)
      largest = std::max(largest, std::abs(Bx(i)));
    check("  what is held stays", largest, 0.);

    // No held unknown feels anything, and nothing feels the force on it.
    Vector other = x;
    for (const unsigned int i : held)
      other(i) += 1.;
    cycle.vmult(By, other);
    By -= Bx;
    check("  forces on it have no effect",
          By.linfty_norm() / Bx.linfty_norm(),
          1e-5);

    cycle.truncate(0,
                   {},
                   normals,
                   Eigen::SparseMatrix<double>(E.rows(), E.cols()));
    cycle.vmult(Bx, x);
    Bx -= before;
    check("  and back", Bx.linfty_norm() / before.linfty_norm(), 0.);

    // On a coarser level, too.
    cycle.truncate(1,
                   {levels->normals(1).front()},
                   levels->normals(1),
                   Eigen::SparseMatrix<double>(levels->normals(1).size(),
                                               levels->normals(1).size()));
    Vector       z = noise(levels->n_unknowns(1), 3.), product(z.size());
    const Vector r = [&]() {
      // In the range of A, which has rows that are zero.
      Vector result(z.size());
      levels->vmult(1, result, z);
      return result;
    }();
    cycle.vmult(product, r);
    check("  positive on the next level", product * r > 0.);
  }



  /// The contact problem, ended in the middle of a linear solve.
  template <int dim>
  void
  test_interruption(const BoxParameters &box)
  {
    const BodyProblem<dim> body(box);
    const auto        levels = ElasticLevels<dim>::make(body.box, body.problem);
    const AdhesiveLaw law(winkler_law(69., 0.002).branches);
    const ContactQuadrature<dim> quadrature(
      ContactQuadratureParameters::parse("nodal"));
    const AdhesionIntegral<dim> adhesion(
      body.problem.unknowns().contact().boundary(), law, quadrature);
    bool ended = true, kept = true;
    for (const unsigned int allowed : {0, 1, 5, 10})
      {
        Vector               u(body.problem.unknowns().n_dofs());
        Vector               last  = u;
        unsigned int         asked = 0;
        LevelCorrection<dim> cycle(*levels);
        LevelProblem<dim>    problem(cycle, adhesion, u, [&]() {
          return ++asked <= allowed;
        });
        const auto           result =
          MajoriseMinimise({}).minimize(problem,
                                        [&](const MajoriseMinimiseIteration &) {
                                          last = u;
                                          return true;
                                        });
        ended = ended && result.status == SolverStatus::interrupted &&
                asked <= allowed + 2;
        kept = kept && u == last;
      }
    check("  an interruption ends it within a cycle", ended);
    check("  with what the last iteration left", kept);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  for (const double rotation : {0., 30.})
    {
      std::cout << "2D, turned by " << rotation << '\n';
      test_nested<2>({{{0.4, 0.04, 0.}}, {{80, 8, 0}}, rotation},
                     {{{0.4, 0.04, 0.}}, {{40, 4, 0}}, rotation});
      test_cycle<2>({{{0.4, 0.04, 0.}}, {{75, 7, 0}}, rotation});
      test_interruption<2>({{{0.4, 0.04, 0.}}, {{80, 8, 0}}, rotation});
      std::cout << "3D, turned by " << rotation << '\n';
      test_nested<3>({{{0.4, 0.04, 0.04}}, {{20, 2, 2}}, rotation},
                     {{{0.4, 0.04, 0.04}}, {{10, 1, 1}}, rotation});
      test_cycle<3>({{{0.4, 0.04, 0.04}}, {{37, 5, 3}}, rotation});
      test_interruption<3>({{{0.4, 0.04, 0.04}}, {{20, 2, 2}}, rotation});
    }
}
