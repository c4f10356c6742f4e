// SPDX-License-Identifier: LGPL-2.1-or-later
// Equilibrated stresses: the element against its own definition (equilibrium,
// continuity, dimension), a patch test, the hybrid problem of solids beside the
// P1 one, and trace constants beside bounds from above.

#include <deal.II/base/function_parser.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/certify/equilibrium_problem.h>
#include <debond/certify/trace_constant.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/mesh/box.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <iostream>
#include <tuple>

#include "../check.h"

using namespace Debond;
using dealii::Point;
using dealii::Tensor;

namespace
{
  template <int dim = 2>
  std::shared_ptr<const dealii::Function<dim>>
  function(const std::string &expressions)
  {
    auto result = std::make_shared<dealii::FunctionParser<dim>>(dim);
    result->initialize(dim == 2 ? "x,y" : "x,y,z",
                       expressions,
                       std::map<std::string, double>());
    return result;
  }



  template <int dim>
  Point<dim>
  centroid(const SimplexCorners<dim> &corners)
  {
    Point<dim> result;
    for (const Point<dim> &corner : corners)
      result += corner / (dim + 1.);
    return result;
  }



  /// l of an affine displacement u = t + G (x - centroid) on the sides of an
  /// element: (sum_l u_l + u_k) / (dim + 1), as dim times the mean of
  /// lambda_k lambda_l is (1 + delta_kl) / (dim + 1).
  template <int dim>
  Eigen::VectorXd
  affine_displacement(const SimplexCorners<dim> &corners,
                      const Tensor<1, dim>      &t,
                      const Tensor<2, dim>      &G)
  {
    Eigen::VectorXd l(dim * dim * (dim + 1));
    unsigned int    row = 0;
    for (unsigned int side = 0; side <= dim; ++side)
      {
        std::vector<Tensor<1, dim>> u;
        Tensor<1, dim>              sum;
        for (unsigned int corner = 0; corner <= dim; ++corner)
          if (corner != side)
            {
              u.push_back(t + G * (corners[corner] - centroid<dim>(corners)));
              sum += u.back();
            }
        for (const Tensor<1, dim> &value : u)
          for (unsigned int d = 0; d < dim; ++d)
            l(row++) = (sum + value)[d] / (dim + 1.);
      }
    return l;
  }



  template <int dim>
  void
  test_element(const SimplexCorners<dim> &corners,
               const Material            &material,
               const std::string         &name)
  {
    constexpr unsigned int n_components =
      dealii::SymmetricTensor<2, dim>::n_independent_components;
    constexpr unsigned int n_motions = dim * (dim + 1) / 2;
    Tensor<1, dim>         force;
    force[0] = 0.3;
    for (unsigned int d = 1; d < dim; ++d)
      force[d] = -0.7 / d;
    const EquilibriumElement<dim> element(corners, material);
    const double          measure = SimplexGeometry<dim>(corners).measure;
    const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(element.K).eigenvalues();
    const double largest = eigenvalues(eigenvalues.size() - 1);
    check(name + ": " + (dim == 2 ? "three" : "six") +
            " rigid motions, no more",
          static_cast<std::size_t>(eigenvalues.size()) ==
              dim * dim * (dim + 1) &&
            std::abs(eigenvalues(n_motions - 1)) < 1e-12 * largest &&
            eigenvalues(n_motions) > (dim == 2 ? 1e-6 : 1e-7) * largest);

    // A linear displacement has its own stress and energy.
    Tensor<2, dim> G;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int e = 0; e < dim; ++e)
        G[d][e] = 1. / (1. + d + 2. * e) - (d > e ? 0.7 : 0.);
    const Eigen::VectorXd l = affine_displacement<dim>(corners, {}, G);
    const dealii::SymmetricTensor<2, dim> sigma =
      material.elasticity_tensor<dim>() * symmetrize(G);
    const Eigen::VectorXd stress =
      element.stress(l, EquilibriumElement<dim>::Load::Zero());
    double error = 0.;
    for (unsigned int k = 0; k < stress.size(); ++k)
      error = std::max(error,
                       std::abs(stress(k) -
                                sigma.access_raw_entry(k % n_components)));
    check(name + ": stress of a linear displacement",
          error / sigma.norm(),
          1e-12);
    check(name + ": its energy",
          std::abs(l.dot(element.K * l) / (measure * (sigma * symmetrize(G))) -
                   1.),
          1e-12);

    // With a body force: the tractions balance it, moments as well, and the
    // energy that the element has is that of its stress.
    const double                           p = 0.2;
    typename EquilibriumElement<dim>::Load load;
    for (unsigned int d = 0; d < dim; ++d)
      load(d) = force[d];
    load(dim)                       = p;
    const Eigen::VectorXd tractions = element.K * l - element.F(load);
    double                imbalance = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        Tensor<1, dim> translation;
        translation[d] = 1.;
        imbalance += std::abs(
          affine_displacement<dim>(corners, translation, {}).dot(tractions) +
          measure * force[d]);
        for (unsigned int e = 0; e < d; ++e)
          {
            Tensor<2, dim> rotation;
            rotation[d][e] = 1.;
            rotation[e][d] = -1.;
            imbalance += std::abs(
              affine_displacement<dim>(corners, {}, rotation).dot(tractions));
          }
      }
    check(name + ": tractions balance the body force",
          imbalance,
          1e-11 * sigma.norm());
    const Eigen::VectorXd other   = element.stress(l, load);
    constexpr int         n_parts = LinearStress<dim>::RowsAtCompileTime;
    double                dual    = 0.;
    for (unsigned int i = 0; i <= dim; ++i)
      {
        LinearStress<dim> total = other.segment<n_parts>(n_parts * i);
        for (unsigned int k = 0; k < n_parts; ++k)
          if (k % n_components < dim)
            total(k) += p;
        dual -=
          0.5 *
          complementary_energy<dim>(total, measure / (dim + 1.), material);
      }
    dual += l.dot(tractions);
    const double primal = 0.5 * l.dot(element.K * l) - element.F(load).dot(l) +
                          element.constant(load);
    check(name + ": energy of the stress", std::abs(dual / primal - 1.), 1e-11);
  }



  void
  test_tetrahedra()
  {
    Material stiff;
    stiff.poisson_ratio = 0.49;
    test_element<3>({{{0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}},
                    {},
                    "corner");
    test_element<3>(
      {{{0., 0., 0.}, {2., 0.3, 0.1}, {0.5, 1., -0.2}, {1., 1., 1.}}},
      stiff,
      "tetrahedron, nearly incompressible");
    // That of a crossed cube, far from the origin and small.
    test_element<3>({{{1., 1., 1.},
                      {1., 1.001, 1.001},
                      {1., 1.002, 1.},
                      {0.999, 1.001, 1.001}}},
                    {},
                    "small");
  }



  struct Bar
  {
    dealii::Triangulation<2> mesh;
    BoundaryConditions       conditions;
    Loads<2>                 loads;
    Material                 material;

    Bar()
    {
      const BoundaryNames names =
        Box<2>({{{0.4, 0.04, 0.}}, {{10, 2, 1}}}).make_mesh(mesh).boundaries;
      for (const std::string side : {"left", "right"})
        conditions.clamped.insert(names.at(side).begin(), names.at(side).end());
      conditions.contact                        = names.at("bottom");
      loads.tractions[*names.at("top").begin()] = {
        {function("0; if(x<0.2, 0.69, -0.345)")}};
    }
  };



  /// The minimum without any contact.
  double
  minimum(const Condensation &condensed)
  {
    const Eigen::VectorXd &g = condensed.load();
    return condensed.energy_at_zero() -
           0.5 * g.dot(condensed.schur_complement().llt().solve(g));
  }



  /// Bodies of tetrahedra that are all different. A column that stands on
  /// rollers has a stress that is linear in its height if its weight acts, and
  /// a uniform one if it is pulled: both are among the stresses, so that the
  /// minimum is exact. Then a clamped one, beside P1.
  void
  test_solids()
  {
    const Point<3>           lengths(0.3, 0.5, 0.4);
    dealii::Triangulation<3> mesh;
    const BoundaryNames      names =
      Box<3>({{{0.3, 0.5, 0.4}}, {{2, 2, 1}}}).make_mesh(mesh).boundaries;
    dealii::GridTools::distort_random(0.2, mesh, true, 5);
    Material material;
    material.young_modulus = 5.;
    material.poisson_ratio = 0.;
    Supports<3> rollers;
    for (const std::string side : {"left", "bottom", "front"})
      rollers.displacements.push_back({side, names.at(side), true});
    const double f = 0.03, t = 0.2;
    for (const bool is_pulled : {false, true})
      {
        Loads<3> loads;
        if (is_pulled)
          loads.tractions[*names.at("right").begin()] = {
            {function<3>("0.2; 0; 0")}};
        else
          loads.body_force = function<3>("0; -0.03; 0");
        const EquilibriumProblem<3> stresses(
          mesh, {}, rollers, material, loads);
        const double volume = lengths[0] * lengths[1] * lengths[2];
        const double exact =
          is_pulled ? -volume * t * t / (2. * 5.) :
                      -volume * f * f * lengths[1] * lengths[1] / (6. * 5.);
        check(is_pulled ? "a solid that is pulled" : "a solid with weight",
              std::abs(minimum(*stresses.condense()) / exact - 1.),
              1e-9);
        check("its loads are exact", stresses.mesh.loads_are_exact);
      }

    BoundaryConditions conditions;
    conditions.clamped     = names.at("left");
    conditions.contact     = names.at("bottom");
    material.poisson_ratio = 0.3;
    Loads<3> loads;
    loads.tractions[*names.at("top").begin()] = {
      {function<3>("x; 0.2-z; 0.1")}};
    const EquilibriumProblem<3> stresses(mesh, conditions, {}, material, loads);
    ElasticProblem<3>           P1(mesh, conditions);
    P1.assemble(material, loads);
    const Condensation condensed(P1.matrix(),
                                 P1.load(),
                                 {},
                                 [&](const unsigned int i) {
                                   return P1.unknowns().is_constrained(i);
                                 });
    check("a clamped solid: below the P1 displacement",
          minimum(*stresses.condense()) < minimum(condensed));
    check("and linear tractions are exact", stresses.mesh.loads_are_exact);
    loads.tractions[*names.at("top").begin()] = {{function<3>("x*z; 0; 0")}};
    check("others are not",
          !EquilibriumProblem<3>(mesh, conditions, {}, material, loads)
             .mesh.loads_are_exact);
  }



  /// The least quotient of the constant's inequality among P1 displacements of
  /// a mesh, I at y = 0: not below the constant.
  double
  quotient_from_above(const dealii::Triangulation<2>             &mesh,
                      const std::set<dealii::types::boundary_id> &I,
                      const std::set<dealii::types::boundary_id> &left,
                      const Material                             &material,
                      const bool tangential_fixed)
  {
    BoundaryConditions conditions;
    conditions.contact = I;
    if (!tangential_fixed)
      conditions.tangential_displacement = TangentialDisplacement::free;
    // A problem is not made with the motion along the side free.
    Supports<2> supports;
    if (!tangential_fixed)
      supports.displacements.push_back({"left", left, true});
    ElasticProblem<2> problem(mesh, conditions, supports);
    problem.assemble(material, Loads<2>());
    const auto        &contact = problem.unknowns().contact();
    const auto        &normals = contact.normal_dofs();
    const auto        &nodes   = contact.boundary().nodes;
    const Condensation condensed(
      problem.matrix(),
      problem.load(),
      {normals.begin(), normals.end()},
      [&](const unsigned int i) {
        return problem.unknowns().is_constrained(i);
      },
      {},
      true);
    const Eigen::MatrixXd S    = condensed.schur_complement();
    const Eigen::Index    size = S.rows();
    Eigen::MatrixXd       mass = Eigen::MatrixXd::Zero(size, size);
    Eigen::MatrixXd       linear(size, 2);
    for (Eigen::Index i = 0; i < size; ++i)
      linear.row(i) << 1., nodes[i].position[0];
    for (const auto &face : contact.boundary().faces)
      for (const unsigned int i : face.nodes)
        for (const unsigned int j : face.nodes)
          if (i < size && j < size)
            mass(i, j) += face.measure / (i == j ? 3. : 6.);
    // On what is orthogonal to linear functions in L2(I).
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(mass * linear);
    const Eigen::MatrixXd                       complement =
      Eigen::MatrixXd(qr.householderQ()).rightCols(size - 2);
    return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
             complement.transpose() * S * complement,
             complement.transpose() * mass * complement)
      .eigenvalues()(0);
  }



  double
  quotient_from_above(const TriangleAboveSide &Q,
                      const Material          &material,
                      const bool               tangential_fixed)
  {
    dealii::Triangulation<2> mesh;
    dealii::CellData<2>      cell(3);
    cell.vertices = {0, 1, 2};
    mesh.create_triangulation({{0., 0.}, {1., 0.}, {Q.apex, Q.height}},
                              {cell},
                              {});
    mesh.refine_global(5);
    for (const auto &face : mesh.active_face_iterators())
      if (face->at_boundary())
        {
          const Point<2> middle  = face->center();
          const bool     is_left = std::abs(middle[0] * Q.height -
                                        middle[1] * Q.apex) < 1e-9 * Q.height;
          face->set_boundary_id(middle[1] < 1e-9 * Q.height ? 1 :
                                is_left                     ? 2 :
                                                              0);
        }
    return quotient_from_above(mesh, {1}, {2}, material, tangential_fixed);
  }



  /// Of triangles as bisection makes them, and of others.
  void
  test_constants_of_triangles()
  {
    Material material;
    material.poisson_ratio = 0.33;
    for (const bool fixed : {true, false})
      for (const auto &[height, apex, loss] : {std::make_tuple(0.5, 0.5, 0.15),
                                               std::make_tuple(1., 0., 0.15),
                                               std::make_tuple(0.2, 0.8, 0.4),
                                               std::make_tuple(3., 1.5, 0.2)})
        {
          const TriangleAboveSide Q        = {height, apex};
          const double            constant = trace_constant(Q, material, fixed);
          const double above = quotient_from_above(Q, material, fixed);
          std::cout << "triangle, " << (fixed ? "fixed" : "free") << ", height "
                    << height << ", apex " << apex
                    << ": it is below what P1 displacements have: "
                    << verdict(constant < above) << std::endl;
          // Where the side is free these have one motion less.
          if (fixed)
            check("  but not by much", 1. - constant / above, loss);
          check("  in other units",
                std::abs(trace_constant(Q, {69e3, 0.33}, fixed) /
                           (constant * 69e3 / material.young_modulus) -
                         1.),
                1e-9);
          check("  mirrored it is the same",
                std::abs(trace_constant({height, 1. - apex}, material, fixed) /
                           constant -
                         1.),
                1e-6);
        }
  }



  void
  test_temperature()
  {
    Bar bar;
    for (const std::string expression : {"7", "x"})
      {
        auto change = std::make_shared<dealii::FunctionParser<2>>(1);
        change->initialize("x,y", expression, std::map<std::string, double>());
        bar.loads.temperature_change = change;
        std::cout << "a change of temperature " << expression << " is exact: "
                  << (EquilibriumProblem<2>(
                        bar.mesh, bar.conditions, {}, bar.material, bar.loads)
                          .mesh.loads_are_exact ?
                        "yes" :
                        "no")
                  << std::endl;
      }
  }



  /// What is prescribed has to be linear on each side.
  void
  test_prescribed()
  {
    Bar        bar;
    const auto print = [&](const std::string &name,
                           const Supports<2> &supports) {
      std::cout << name << " is exact: "
                << (EquilibriumProblem<2>(bar.mesh,
                                          bar.conditions,
                                          supports,
                                          bar.material,
                                          bar.loads)
                        .mesh.loads_are_exact ?
                      "yes" :
                      "no")
                << std::endl;
    };
    for (const std::string power : {"", "^2"})
      {
        Supports<2> gap, moved;
        auto        distance = std::make_shared<dealii::FunctionParser<2>>(1);
        distance->initialize("x,y",
                             "x" + power,
                             std::map<std::string, double>());
        gap.gaps[*bar.conditions.contact.begin()] = {"", distance};
        print("a gap of x" + power, gap);
        moved.displacements.push_back({"right",
                                       bar.conditions.clamped,
                                       false,
                                       {{false, true}},
                                       function("0; y" + power)});
        print("a displacement of y" + power, moved);
      }
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;

  Material strain;
  strain.hypothesis    = Material::Hypothesis::plane_strain;
  strain.poisson_ratio = 0.49;
  test_element<2>({{{0., 0.}, {1., 0.2}, {0.3, 0.9}}}, {}, "triangle");
  test_element<2>({{{0., 0.}, {0.5, 1.}, {2., 0.3}}},
                  strain,
                  "clockwise, nearly incompressible");
  test_tetrahedra();
  test_solids();
  test_constants_of_triangles();
  test_temperature();
  test_prescribed();
}
