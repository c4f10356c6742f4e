// SPDX-License-Identifier: LGPL-2.1-or-later
// How many digits of J are true: the result of majorise-minimise beside the
// same discrete problem assembled, solved and evaluated in extended precision
// (64 bits) by code of its own. It takes over the mesh, f and the state of the
// bonds, which decide what the discrete minimum is; f is compared with its
// exact value, a change of f by df changes the minimum by -<df, u>.

#include <debond/check/verification.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <cmath>
#include <iostream>
#include <sstream>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  using Real    = long double;
  using VectorX = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  /// A triangle's volume and gradients of its P1 basis.
  struct Triangle
  {
    Real volume;
    Real gradients[3][2];
  };



  template <typename CellIterator>
  Triangle
  triangle(const CellIterator &cell)
  {
    Real x[3][2];
    for (unsigned int v = 0; v < 3; ++v)
      for (unsigned int d = 0; d < 2; ++d)
        x[v][d] = cell->vertex(v)[d];
    Triangle   result;
    const Real twice = (x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) -
                       (x[2][0] - x[0][0]) * (x[1][1] - x[0][1]);
    result.volume = twice / 2;
    for (unsigned int v = 0; v < 3; ++v)
      {
        const Real *a          = x[(v + 1) % 3];
        const Real *b          = x[(v + 2) % 3];
        result.gradients[v][0] = (a[1] - b[1]) / twice;
        result.gradients[v][1] = (b[0] - a[0]) / twice;
      }
    return result;
  }



  /// The stiffness between two vertices of a triangle: entry (k, l) is the
  /// energy product of phi_v e_k and phi_w e_l.
  Real
  stiffness(const Triangle    &t,
            const unsigned int v,
            const unsigned int k,
            const unsigned int w,
            const unsigned int l,
            const Real         lambda,
            const Real         mu)
  {
    const auto &g = t.gradients;
    return t.volume *
           (lambda * g[v][k] * g[w][l] + mu * g[v][l] * g[w][k] +
            (k == l ? mu * (g[v][0] * g[w][0] + g[v][1] * g[w][1]) : Real(0)));
  }



  /// The minimum of J with the contact nodes and broken bonds of u.
  struct ExtendedMinimum
  {
    Real value;
    Real value_at_u; ///< J(u) of the result, evaluated in extended precision

    DofVector rounded; ///< the minimiser, rounded to double
  };



  /// The work of the exact load on u: q in the left half of the top, -q/2 in
  /// the right one. The jump is at a vertex.
  Real
  exact_work(const ElasticProblem<2> &problem,
             const double             q,
             const DofVector         &u)
  {
    Real work = 0;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() &&
            face->boundary_id() == box_sides<2>().at("top"))
          {
            const Real length = std::abs(static_cast<Real>(face->vertex(1)[0]) -
                                         face->vertex(0)[0]);
            const Real traction = face->center()[0] < 0.2 ? q : -q / 2;
            for (unsigned int v = 0; v < 2; ++v)
              work += traction * length / 2 * u(face->vertex_dof_index(v, 1));
          }
    return work;
  }



  /// For a contact boundary "bottom" with the normal (0, -1).
  ExtendedMinimum
  extended_minimum(const Parameters &parameters,
                   const Scene<2>   &scene,
                   const DofVector  &u)
  {
    const ElasticProblem<2> &problem = scene.problem();
    const Real               E  = parameters.materials.everywhere.young_modulus;
    const Real               nu = parameters.materials.everywhere.poisson_ratio;
    const bool plane_stress     = parameters.materials.everywhere.hypothesis ==
                              Material::Hypothesis::plane_stress;
    const Real        mu     = E / (2 * (1 + nu));
    const Real        lambda = plane_stress ? E * nu / (1 - nu * nu) :
                                              E * nu / ((1 + nu) * (1 - 2 * nu));
    const AdhesiveLaw law(parameters.law.branches);
    const Real        a = law.curvature(0.);
    const Real        M = law.bond_threshold();

    // The unknowns' frame at a contact node has u_nu = -u_y first and the
    // tangential displacement second.
    const unsigned int n = problem.unknowns().n_dofs();
    std::vector<Real>  value(n), direction(n, 1);
    std::vector<int>   component(n, -1);
    for (unsigned int i = 0; i < n; ++i)
      value[i] = u(i);

    std::vector<char> fixed(n, 0);
    for (unsigned int i = 0; i < n; ++i)
      fixed[i] = problem.unknowns().is_constrained(i);
    std::vector<Real> spring(n, 0);
    Real              broken_energy = 0;
    const auto       &contact       = problem.unknowns().contact();
    for (unsigned int i = 0; i < contact.size(); ++i)
      {
        const auto   dof     = contact.normals()[i];
        const double measure = contact.boundary().nodes[i].measure;
        direction[dof]       = -1;
        component[dof]       = 1;
        component[dof + 1]   = 0;
        if (u(dof) == 0.)
          fixed[dof] = 1;
        else if (u(dof) < -law.bond_threshold())
          broken_energy += a * M * M / 2 * measure;
        else
          spring[dof] = a * measure;
      }

    std::vector<int> place(n, -1);
    int              n_unknowns = 0;
    for (unsigned int i = 0; i < n; ++i)
      if (fixed[i] == 0)
        place[i] = n_unknowns++;

    std::vector<Eigen::Triplet<Real>> entries;
    Real                              energy_of_u = 0;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        const Triangle t              = triangle(cell);
        Real           gradient[2][2] = {{0, 0}, {0, 0}};
        for (unsigned int v = 0; v < 3; ++v)
          for (unsigned int c = 0; c < 2; ++c)
            {
              const auto i = cell->vertex_dof_index(v, c);
              const int  k =
                component[i] < 0 ? static_cast<int>(c) : component[i];
              for (unsigned int d = 0; d < 2; ++d)
                gradient[k][d] += direction[i] * value[i] * t.gradients[v][d];
              if (place[i] < 0)
                continue;
              for (unsigned int w = 0; w < 3; ++w)
                for (unsigned int e = 0; e < 2; ++e)
                  {
                    const auto j = cell->vertex_dof_index(w, e);
                    const int  l =
                      component[j] < 0 ? static_cast<int>(e) : component[j];
                    if (place[j] >= 0 && place[j] <= place[i])
                      entries.emplace_back(
                        place[i],
                        place[j],
                        direction[i] * direction[j] *
                          stiffness(t, v, k, w, l, lambda, mu));
                  }
            }
        const Real trace = gradient[0][0] + gradient[1][1];
        const Real shear = gradient[0][1] + gradient[1][0];
        energy_of_u += t.volume * (lambda / 2 * trace * trace +
                                   mu * (gradient[0][0] * gradient[0][0] +
                                         gradient[1][1] * gradient[1][1] +
                                         shear * shear / 2));
      }

    VectorX f(n_unknowns);
    for (unsigned int i = 0; i < n; ++i)
      {
        energy_of_u += spring[i] / 2 * value[i] * value[i] -
                       static_cast<Real>(problem.load()(i)) * value[i];
        if (place[i] >= 0)
          {
            f(place[i]) = problem.load()(i);
            entries.emplace_back(place[i], place[i], spring[i]);
          }
      }
    Eigen::SparseMatrix<Real> A(n_unknowns, n_unknowns);
    A.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Real>> factor(A);
    const VectorX                                          x = factor.solve(f);
    DofVector                                              rounded(n);
    for (unsigned int i = 0; i < n; ++i)
      if (place[i] >= 0)
        rounded(i) = x(place[i]);
    return {broken_energy - f.dot(x) / 2, broken_energy + energy_of_u, rounded};
  }



  double
  law_violation(const Scene<2> &scene, const DofVector &u)
  {
    return verify(scene.problem(), scene.adhesion(), scene.law(), u)
      .law_violation;
  }



  void
  test(const std::string &name, const double q, const Values &assignments)
  {
    const Parameters parameters =
      parameters_of(Values{"Loads/Traction top=0; if(x < 0.2, q, -q/2)",
                           "Loads/Constants=q=" + text(q),
                           "Solver/Method=majorise minimise"} +
                    assignments);
    const Scene<2>    scene  = scene_of<2>(parameters);
    const SolveResult result = solved(parameters, scene);

    const ExtendedMinimum minimum =
      extended_minimum(parameters, scene, result.u);
    const auto error = [&](const Real value) {
      return static_cast<double>(
        std::abs((value - minimum.value) / minimum.value));
    };
    Real work = exact_work(scene.problem(), q, result.u);
    for (unsigned int i = 0; i < result.u.size(); ++i)
      work -= static_cast<Real>(scene.problem().load()(i)) * result.u(i);
    const auto load_error = static_cast<double>(std::abs(work / minimum.value));
    // What the products with A would give, for comparison.
    const double from_matrix = scene.functional().value(result.u);
    std::cout << name << ": " << to_string(result.status)
              << ", J to 1e-12: " << verdict(error(result.functional), 1e-12)
              << ", J of u is the minimum to 1e-12: "
              << verdict(error(minimum.value_at_u), 1e-12)
              << ", effect of the load's error to 1e-12: "
              << verdict(load_error, 1e-12) << '\n';
    if (print_figures)
      std::cout << "  " << error(result.functional) << ", u "
                << error(minimum.value_at_u) << ", condensed "
                << error(result.majorise_history.back().functional)
                << ", from A " << error(from_matrix) << ", load " << load_error
                << ", law violation " << law_violation(scene, result.u)
                << ", of the rounded minimiser "
                << law_violation(scene, minimum.rounded) << '\n';
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  test("20x2", 0.69, {"Mesh/Cells=20, 2"});
  test("40x4", 0.69, {"Mesh/Cells=40, 4"});
  test("80x8", 0.69, {"Mesh/Cells=80, 8"});
  test("160x16", 0.69, {"Mesh/Cells=160, 16"});
  for (const std::string nu : {"0.49", "0.499", "0.4999"})
    test("nu = " + nu,
         0.69,
         {"Material/Hypothesis=plane strain", "Material/Poisson ratio=" + nu});
  test("slender", 0.69, {"Mesh/Lengths=0.4, 0.01", "Mesh/Cells=80, 2"});
  test("very slender", 0.69, {"Mesh/Lengths=0.4, 0.002", "Mesh/Cells=200, 1"});
  test("load 10", 6.9, {});
  test("a = 690", 0.69, {"Contact law/Bond stiffness=690"});
  test("no adhesion", 0.69, {"Contact law/Law=none"});
  test("Pa",
       0.69e9,
       {"Material/Young modulus=69e9", "Contact law/Bond stiffness=69e9"});
}
