// SPDX-License-Identifier: LGPL-2.1-or-later
// The condensation onto the contact normals against dense elimination.

#include <deal.II/base/function_parser.h>
#include <deal.II/lac/full_matrix.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/mesh/box.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "../check.h"

using namespace Debond;

namespace
{
  template <int dim>
  void
  test(const BoxParameters &box,
       const double         modulus,
       const std::string   &clamped = "left")
  {
    dealii::Triangulation<dim> mesh;
    make_box(box, mesh);
    BoundaryConditions conditions;
    conditions.clamped                       = {box_sides<dim>().at(clamped)};
    conditions.contact                       = {box_sides<dim>().at("bottom")};
    conditions.tangential_displacement_fixed = dim == 2;
    ElasticProblem<dim> problem(mesh, conditions);

    Material material;
    material.young_modulus = modulus;
    material.hypothesis    = Material::Hypothesis::plane_strain;
    Loads<dim>   loads;
    const double q = 0.01 * modulus;
    const auto   load =
      std::make_shared<dealii::Functions::ConstantFunction<dim>>(q, dim);
    if (clamped == "left")
      loads.tractions[box_sides<dim>().at("top")] = {{load}};
    else
      loads.body_force = load;
    problem.assemble(material, loads);

    std::vector<unsigned int> kept, others;
    std::vector<char>         is_kept(problem.unknowns().n_dofs(), 0);
    for (const auto normal : problem.unknowns().contact().normals())
      {
        kept.push_back(normal);
        is_kept[normal] = 1;
      }
    for (unsigned int i = 0; i < problem.unknowns().n_dofs(); ++i)
      if (!problem.unknowns().is_constrained(i) && is_kept[i] == 0)
        others.push_back(i);
    const auto excluded = [&](const unsigned int i) {
      return problem.unknowns().is_constrained(i);
    };
    Condensation condensed(problem.matrix(), problem.load(), kept, excluded);

    // S = A_ss - A_so A_oo^{-1} A_os by dense elimination.
    const auto block = [&](const std::vector<unsigned int> &rows,
                           const std::vector<unsigned int> &columns) {
      dealii::FullMatrix<double> result(rows.size(), columns.size());
      for (unsigned int i = 0; i < rows.size(); ++i)
        for (unsigned int j = 0; j < columns.size(); ++j)
          result(i, j) = problem.matrix().el(rows[i], columns[j]);
      return result;
    };
    dealii::FullMatrix<double> inverse = block(others, others);
    inverse.gauss_jordan();
    dealii::FullMatrix<double> elimination(kept.size(), others.size());
    block(kept, others).mmult(elimination, inverse);
    dealii::FullMatrix<double> S = block(kept, kept), product(S);
    elimination.mmult(product, block(others, kept));
    S.add(-1., product);

    DofVector f_others(others.size()), g(kept.size()), interior(others.size());
    for (unsigned int i = 0; i < others.size(); ++i)
      f_others(i) = problem.load()(others[i]);
    elimination.vmult(g, f_others);
    for (unsigned int i = 0; i < kept.size(); ++i)
      g(i) = problem.load()(kept[i]) - g(i);
    inverse.vmult(interior, f_others);
    const double c_0 = -0.5 * (f_others * interior);

    double S_error = 0., g_error = 0.;
    for (unsigned int i = 0; i < kept.size(); ++i)
      {
        g_error = std::hypot(g_error, condensed.load()(i) - g(i));
        for (unsigned int j = 0; j < kept.size(); ++j)
          S_error =
            std::hypot(S_error, condensed.schur_complement()(i, j) - S(i, j));
      }
    check("Schur complement to 1e-12", S_error / S.frobenius_norm(), 1e-12);
    check("load to 1e-12", g_error / g.l2_norm(), 1e-12);
    check("energy at zero to 1e-11",
          std::abs(condensed.energy_at_zero() / c_0 - 1.),
          1e-11);

    // For any s: equilibrium inside, S s - g on the contact nodes, the same
    // energy.
    Eigen::VectorXd s(kept.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      s(i) = -0.001 * (1 + i % 5);
    Eigen::VectorXd force = condensed.schur_complement() * s;
    const double    energy =
      condensed.energy_at_zero() + 0.5 * s.dot(force) - condensed.load().dot(s);
    force -= condensed.load();

    const DofVector u = condensed.expand(s);
    DofVector       A_u(u.size());
    problem.matrix().vmult(A_u, u);
    const double energy_of_u = 0.5 * (u * A_u) - problem.load() * u;
    A_u -= problem.load();
    double inside = 0., contact = 0.;
    for (const unsigned int i : others)
      raise(inside, std::abs(A_u(i)));
    for (unsigned int i = 0; i < kept.size(); ++i)
      raise(contact, std::abs(A_u(kept[i]) - force(i)));
    const double largest = force.lpNorm<Eigen::Infinity>();
    check("equilibrium inside to 1e-11", inside / largest, 1e-11);
    check("contact forces to 1e-12", contact / largest, 1e-12);
    check("energy to 1e-11", std::abs(energy_of_u / energy - 1.), 1e-11);

    // The same under a multiple of the load.
    const double factor      = -0.3;
    DofVector    scaled_load = problem.load();
    scaled_load *= factor;
    const Condensation scaled = condensed.with_load(scaled_load);
    force                     = scaled.schur_complement() * s;
    const double scaled_energy =
      scaled.energy_at_zero() + 0.5 * s.dot(force) - scaled.load().dot(s);
    const DofVector scaled_u = scaled.expand(s);
    problem.matrix().vmult(A_u, scaled_u);
    const double energy_of_scaled_u =
      0.5 * (scaled_u * A_u) - factor * (problem.load() * scaled_u);
    A_u.add(-factor, problem.load());
    inside = 0.;
    for (const unsigned int i : others)
      raise(inside, std::abs(A_u(i)));
    section("scaled load");
    check("equilibrium inside to 1e-11", inside / largest, 1e-11);
    check("energy to 1e-11",
          std::abs((scaled_energy - energy_of_scaled_u) / energy),
          1e-11);

    // Without contact: A u = f.
    dealii::FullMatrix<double> S_inverse(S);
    S_inverse.gauss_jordan();
    DofVector s_free(kept.size());
    S_inverse.vmult(s_free, g);
    const double energy_free =
      0.5 *
      (problem.load() *
       condensed.expand(
         Eigen::Map<const Eigen::VectorXd>(s_free.begin(), s_free.size())));
    check("energy without contact to 1e-8",
          std::abs(condensed.energy_without_contact() / energy_free - 1.),
          1e-8);
  }



  /// Where all unknowns are kept S is A.
  void
  test_without_others(const unsigned int n)
  {
    dealii::SparsityPattern pattern(n, n, 3);
    for (unsigned int i = 0; i + 1 < n; ++i)
      {
        pattern.add(i, i + 1);
        pattern.add(i + 1, i);
      }
    pattern.compress();
    dealii::SparseMatrix<double> A(pattern);
    DofVector                    f(n);
    std::vector<unsigned int>    kept;
    for (unsigned int i = 0; i < n; ++i)
      {
        f(i) = i + 1.;
        kept.push_back(i);
        A.set(i, i, 3.);
        if (i > 0)
          {
            A.set(i, i - 1, -1.);
            A.set(i - 1, i, -1.);
          }
      }
    const Condensation condensed(A, f, kept, [](unsigned int) {
      return false;
    });
    double             error = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        raise(error, std::abs(condensed.load()(i) - f(i)));
        for (unsigned int j = 0; j < n; ++j)
          raise(error,
                std::abs(condensed.schur_complement()(i, j) - A.el(i, j)));
      }
    check("S is A, g is f, to 1e-14", error, 1e-14);
  }
} // namespace



int
main()
{
  BoxParameters box;
  box.cells = {{12, 3, 2}};
  section("2D");
  test<2>(box, 69.);
  section("2D in other units");
  test<2>(box, 69e9);
  section("2D turned");
  box.rotation = 40.;
  test<2>(box, 69.);
  box.rotation = 0.;
  box.cells    = {{4, 2, 1}};
  section("3D");
  test<3>(box, 69.);
  // The eliminated unknowns fall apart into a piece for each cell.
  box.cells = {{12, 1, 1}};
  section("2D, one cell through the thickness, clamped opposite");
  test<2>(box, 69., "top");
  section("3D, one cell through the thickness, clamped opposite");
  test<3>(box, 69., "top");

  section("One contact normal and nothing else");
  test_without_others(1);
  section("Three contact normals and nothing else");
  test_without_others(3);

  // A matrix that is not positive definite is refused.
  dealii::SparsityPattern pattern(3, 3, 2);
  pattern.add(0, 1);
  pattern.add(1, 0);
  pattern.compress();
  dealii::SparseMatrix<double> indefinite(pattern);
  for (unsigned int i = 0; i < 3; ++i)
    indefinite.set(i, i, 1.);
  indefinite.set(0, 1, 2.);
  indefinite.set(1, 0, 2.);
  print_error([&] {
    Condensation(indefinite, DofVector(3), {2}, [](const unsigned int) {
      return false;
    });
  });
}
