// SPDX-License-Identifier: LGPL-2.1-or-later
// Equilibrated stresses: the element against its own definition (equilibrium,
// continuity, dimension), a patch test, the hybrid problem beside the P1 one,
// and trace constants beside bounds from above.

#include <deal.II/base/function_parser.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/equilibrium_problem.h>
#include <debond/elasticity/trace_constant.h>
#include <debond/mesh/box.h>

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
  std::shared_ptr<const dealii::Function<2>>
  function(const std::string &expressions)
  {
    auto result = std::make_shared<dealii::FunctionParser<2>>(2);
    result->initialize("x,y", expressions, std::map<std::string, double>());
    return result;
  }



  /// l of a linear displacement u = G x on the sides of an element.
  Eigen::VectorXd
  linear_displacement(const EquilibriumElement &element, const Tensor<2, 2> &G)
  {
    const unsigned int n = element.corners.size();
    Eigen::VectorXd    l(4 * n);
    for (unsigned int i = 0; i < n; ++i)
      {
        const Tensor<1, 2> first = G * element.corners[i];
        const Tensor<1, 2> last  = G * element.corners[(i + 1) % n];
        for (unsigned int d = 0; d < 2; ++d)
          {
            l(4 * i + d)     = 0.5 * (first + last)[d];
            l(4 * i + 2 + d) = 0.5 * (last - first)[d];
          }
      }
    return l;
  }



  void
  test_element(const std::vector<Point<2>> &corners,
               const Material              &material,
               const std::string           &name)
  {
    const Tensor<1, 2>       force({0.3, -0.7});
    const EquilibriumElement element(corners, material, {}, 0.);
    const Eigen::VectorXd    eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(element.K).eigenvalues();
    const double largest = eigenvalues(eigenvalues.size() - 1);
    check(name + ": three rigid motions, no more",
          std::abs(eigenvalues(2)) < 1e-12 * largest &&
            eigenvalues(3) > 1e-6 * largest);

    // A linear displacement has its own stress and energy.
    Tensor<2, 2> G;
    G[0][0]                               = 1.;
    G[0][1]                               = 0.4;
    G[1][0]                               = -0.2;
    G[1][1]                               = 0.5;
    const Eigen::VectorXd               l = linear_displacement(element, G);
    const dealii::SymmetricTensor<2, 2> sigma =
      material.elasticity_tensor<2>() * symmetrize(G);
    const Eigen::VectorXd stress = element.stress(l);
    double                error  = 0.;
    for (unsigned int k = 0; k < stress.size(); k += 3)
      error = std::max({error,
                        std::abs(stress(k) - sigma[0][0]),
                        std::abs(stress(k + 1) - sigma[1][1]),
                        std::abs(stress(k + 2) - sigma[0][1])});
    check(name + ": stress of a linear displacement",
          error / sigma.norm(),
          1e-12);
    check(name + ": its energy",
          std::abs(l.dot(element.K * l) /
                     (element.area * (sigma * symmetrize(G))) -
                   1.),
          1e-12);

    // With a body force: the tractions balance it, moments as well, and the
    // energy that the element has is that of its stress.
    const double             p = 0.2;
    const EquilibriumElement loaded(corners, material, force, p);
    const Eigen::VectorXd    tractions = loaded.K * l - loaded.F;
    Tensor<1, 2>             resultant;
    double                   moment = 0.;
    for (unsigned int i = 0; i < corners.size(); ++i)
      {
        const Point<2> &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const Tensor<1, 2> mean({tractions(4 * i), tractions(4 * i + 1)});
        const Tensor<1, 2> slope({tractions(4 * i + 2), tractions(4 * i + 3)});
        const Tensor<1, 2> middle = 0.5 * (a + b) - loaded.centre;
        const Tensor<1, 2> half   = 0.5 * (b - a);
        resultant += mean;
        moment += middle[0] * mean[1] - middle[1] * mean[0] +
                  half[0] * slope[1] - half[1] * slope[0];
      }
    check(name + ": tractions balance the body force",
          (resultant + loaded.area * force).norm() +
            std::abs(moment) / std::sqrt(loaded.area),
          1e-11 * sigma.norm());
    const Eigen::VectorXd other = loaded.stress(l);
    double                dual  = 0.;
    for (unsigned int i = 0; i < corners.size(); ++i)
      {
        Eigen::Matrix<double, 9, 1> total = other.segment<9>(9 * i);
        for (unsigned int k = 0; k < 9; k += 3)
          {
            total(k) += p;
            total(k + 1) += p;
          }
        // Both kinds of cells have equal parts.
        dual -=
          0.5 *
          complementary_energy(total, loaded.area / corners.size(), material);
      }
    dual += l.dot(tractions);
    const double primal =
      0.5 * l.dot(loaded.K * l) - loaded.F.dot(l) + loaded.constant;
    check(name + ": energy of the stress", std::abs(dual / primal - 1.), 1e-11);
  }



  struct Bar
  {
    dealii::Triangulation<2> mesh;
    BoundaryConditions       conditions;
    Loads<2>                 loads;
    Material                 material;

    Bar(const unsigned int nx,
        const unsigned int ny,
        const double       distortion = 0.)
    {
      const BoundaryNames names =
        Box<2>({{{0.4, 0.04, 0.}}, {{nx, ny, 1}}}).make_mesh(mesh).boundaries;
      for (const std::string side : {"left", "right"})
        conditions.clamped.insert(names.at(side).begin(), names.at(side).end());
      conditions.contact = names.at("bottom");
      loads.tractions[*names.at("top").begin()] =
        function("0; if(x<0.2, 0.69, -0.345)");
      if (distortion > 0.)
        dealii::GridTools::distort_random(distortion, mesh, true, 5);
    }
  };



  /// The minimum without any contact.
  double
  minimum(const Condensation &condensed)
  {
    return condensed.energy_at_zero() - condensed.energy_of_kept();
  }



  /// J of the linear problem from below and from above.
  void
  test_bounds()
  {
    // 640x64 by P1 and by stresses have it between -6.3818e-4 and -6.3806e-4.
    const double exact = -6.3809e-4;
    double       error = 0., previous = 0.;
    for (const unsigned int n : {2, 4, 8})
      {
        const Bar                bar(10 * n, n);
        const EquilibriumProblem stresses(
          bar.mesh, bar.conditions, {}, bar.material, bar.loads);
        ElasticProblem<2> P1(bar.mesh, bar.conditions);
        P1.assemble(bar.material, bar.loads);
        const Condensation condensed(P1.matrix(),
                                     P1.load(),
                                     {},
                                     [&](const unsigned int i) {
                                       return P1.unknowns().is_constrained(i);
                                     });
        const double       lower = minimum(*stresses.condense(true));
        previous                 = error;
        error                    = (exact - lower) / std::abs(exact);
        std::cout << 10 * n << 'x' << n << ": " << stresses.n_unknowns()
                  << " unknowns, below the P1 displacement: "
                  << verdict(lower < minimum(condensed))
                  << ", and closer to the truth: "
                  << verdict(exact - lower < 0.2 * (minimum(condensed) - exact))
                  << std::endl;
      }
    check("second order but for the corners", error / previous, 0.4);

    const Bar                bar(40, 4, 0.15);
    const EquilibriumProblem stresses(
      bar.mesh, bar.conditions, {}, bar.material, bar.loads);
    check("distorted cells are triangles", stresses.elements().size() > 160);
    const double lower = minimum(*stresses.condense(true));
    check("also below there", lower < exact);
    check("and close", (exact - lower) / std::abs(exact), 3e-3);
    check("the load is linear on each side", stresses.loads_are_exact());

    Bar rough(40, 4);
    for (auto &[id, traction] : rough.loads.tractions)
      traction = function("0; if(x<0.203, 0.69, -0.345)");
    check("a jump inside of a side is seen",
          !EquilibriumProblem(
             rough.mesh, rough.conditions, {}, rough.material, rough.loads)
             .loads_are_exact());
    rough.loads.tractions.clear();
    rough.loads.body_force = function("0; x");
    check("and a body force that varies",
          !EquilibriumProblem(
             rough.mesh, rough.conditions, {}, rough.material, rough.loads)
             .loads_are_exact());
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
    conditions.contact                       = I;
    conditions.tangential_displacement_fixed = tangential_fixed;
    // A problem is not made with the motion along the side free.
    Supports<2> supports;
    if (!tangential_fixed)
      supports.displacements.push_back({"left", left, true});
    ElasticProblem<2> problem(mesh, conditions, supports);
    problem.assemble(material, Loads<2>());
    const auto        &contact = problem.unknowns().contact();
    const auto        &normals = contact.normals();
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
  quotient_from_above(const RectangleAboveSide &Q,
                      const Material           &material,
                      const bool                tangential_fixed,
                      const unsigned int        n)
  {
    dealii::Triangulation<2> mesh;
    const BoundaryNames names = Box<2>({{{Q.width, Q.height, 0.}}, {{n, n, 1}}})
                                  .make_mesh(mesh)
                                  .boundaries;
    return quotient_from_above(
      mesh, names.at("bottom"), names.at("left"), material, tangential_fixed);
  }



  double
  quotient_from_above(const TriangleAboveSide &Q,
                      const Material          &material,
                      const bool               tangential_fixed)
  {
    dealii::Triangulation<2> mesh;
    dealii::CellData<2>      cell(3);
    cell.vertices = {0, 1, 2};
    mesh.create_triangulation({{0., 0.}, {Q.width, 0.}, {Q.apex, Q.height}},
                              {cell},
                              {});
    mesh.refine_global(5);
    for (const auto &face : mesh.active_face_iterators())
      if (face->at_boundary())
        {
          const Point<2> middle = face->center();
          const bool     is_left =
            std::abs(middle[0] * Q.height - middle[1] * Q.apex) <
            1e-9 * Q.width * Q.height;
          face->set_boundary_id(middle[1] < 1e-9 * Q.height ? 1 :
                                is_left                     ? 2 :
                                                              0);
        }
    return quotient_from_above(mesh, {1}, {2}, material, tangential_fixed);
  }



  void
  test_trace_constants()
  {
    Material material;
    material.poisson_ratio = 0.33;
    for (const bool fixed : {true, false})
      for (const double aspect : {0.01, 0.3, 1., 3., 100.})
        {
          const double elementary =
            elementary_trace_constant(RectangleAboveSide{1., aspect},
                                      material,
                                      fixed);
          const double better =
            trace_constant(RectangleAboveSide{1., aspect}, material, fixed, 8);
          std::cout << (fixed ? "fixed" : "free") << ", aspect " << aspect
                    << ": the elementary one is not larger: "
                    << verdict(elementary <= better) << std::endl;
          const double above = quotient_from_above(
            RectangleAboveSide{1., aspect}, material, fixed, 32);
          std::cout << "  it is below what P1 displacements have: "
                    << verdict(better < above) << std::endl;
          if (fixed && aspect == 1.)
            check("  but not by much",
                  1. - trace_constant(RectangleAboveSide{1., 1.},
                                      material,
                                      fixed) /
                         above,
                  0.05);
          check("units do not matter",
                std::abs(trace_constant(RectangleAboveSide{1e3, 1e3 * aspect},
                                        {69e3, 0.33},
                                        fixed,
                                        8) /
                           better -
                         1.),
                1e-9);
        }
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
          const TriangleAboveSide Q        = {1., height, apex};
          const double            constant = trace_constant(Q, material, fixed);
          const double above = quotient_from_above(Q, material, fixed);
          std::cout << "triangle, " << (fixed ? "fixed" : "free") << ", height "
                    << height << ", apex " << apex
                    << ": it is below what P1 displacements have: "
                    << verdict(constant < above) << std::endl;
          // Where the side is free these have one motion less.
          if (fixed)
            check("  but not by much", 1. - constant / above, loss);
          check("  mirrored it is the same",
                std::abs(
                  trace_constant({1., height, 1. - apex}, material, fixed) /
                    constant -
                  1.),
                1e-6);
        }
  }



  void
  test_temperature()
  {
    Bar bar(10, 2);
    for (const std::string expression : {"7", "x"})
      {
        auto change = std::make_shared<dealii::FunctionParser<2>>(1);
        change->initialize("x,y", expression, std::map<std::string, double>());
        bar.loads.temperature_change = change;
        std::cout << "a change of temperature " << expression << " is exact: "
                  << (EquilibriumProblem(
                        bar.mesh, bar.conditions, {}, bar.material, bar.loads)
                          .loads_are_exact() ?
                        "yes" :
                        "no")
                  << std::endl;
      }
  }



  void
  test_refusals()
  {
    Bar         bar(10, 2);
    Supports<2> gap, moved;
    gap.gaps[*bar.conditions.contact.begin()] = {
      "", std::make_shared<dealii::Functions::ConstantFunction<2>>(1., 1)};
    print_error([&]() {
      EquilibriumProblem(
        bar.mesh, bar.conditions, gap, bar.material, bar.loads);
    });
    moved.displacements.push_back({"right",
                                   bar.conditions.clamped,
                                   false,
                                   {{false, true}},
                                   function("0; 1")});
    print_error([&]() {
      EquilibriumProblem(
        bar.mesh, bar.conditions, moved, bar.material, bar.loads);
    });
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;

  Material strain;
  strain.hypothesis    = Material::Hypothesis::plane_strain;
  strain.poisson_ratio = 0.49;
  test_element({{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}}, {}, "square");
  test_element({{0., 0.}, {2., 0.3}, {2.5, 1.3}, {0.5, 1.}},
               strain,
               "parallelogram, nearly incompressible");
  test_element({{0., 0.}, {1., 0.2}, {0.3, 0.9}}, {}, "triangle");
  test_bounds();
  test_trace_constants();
  test_constants_of_triangles();
  test_temperature();
  test_refusals();
}
