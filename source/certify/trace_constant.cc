// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <debond/certify/equilibrium_problem.h>
#include <debond/certify/trace_constant.h>
#include <debond/mesh/box.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>

namespace Debond
{
  namespace
  {
    /// The parts of the stiffness that are tried: theta n has to be more than
    /// 1.
    std::array<double, 4>
    parts_of_stiffness(const unsigned int n)
    {
      std::array<double, 4> theta = {{1.1, 1.5, 2.5, 5.}};
      for (double &part : theta)
        part = std::min(part / n, 0.9);
      return theta;
    }



    /// The least value of S relative to the mass matrix of the traces that are
    /// linear on each of n sides, without those that are linear on all of them;
    /// S comes from a part 1 - theta of the stiffness at the sides, for each of
    /// parts_of_stiffness().
    std::array<double, 4>
    least_eigenvalues(const dealii::Triangulation<2>             &mesh,
                      const std::set<dealii::types::boundary_id> &I,
                      const double                                width,
                      const Material                             &material,
                      const bool         tangential_fixed,
                      const unsigned int n)
    {
      BoundaryConditions conditions;
      conditions.contact                       = I;
      conditions.tangential_displacement_fixed = tangential_fixed;
      EquilibriumProblem<2> problem(mesh, conditions, {}, material, Loads<2>());
      // A motion along I does not change the energy.
      if (!tangential_fixed)
        problem.fix(problem.contact_sides()[0].unknowns[0] + 1);

      const auto     &sides = problem.contact_sides();
      const double    h     = width / n;
      Eigen::VectorXd mass(2 * n);
      Eigen::MatrixXd linear = Eigen::MatrixXd::Zero(2 * n, 2);
      for (unsigned int i = 0; i < n; ++i)
        {
          mass(i)      = h;
          mass(n + i)  = h / 3.;
          linear(i, 0) = 1.;
          linear(i, 1) =
            0.5 * (sides[i].corners[0][0] + sides[i].corners[1][0]);
          linear(n + i, 1) =
            0.5 * (sides[i].corners[1][0] - sides[i].corners[0][0]);
        }
      const Eigen::VectorXd                       root = mass.cwiseSqrt();
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(root.asDiagonal() *
                                                     linear);
      const Eigen::MatrixXd                       complement =
        Eigen::MatrixXd(qr.householderQ()).rightCols(2 * n - 2);
      const Eigen::MatrixXd scaled =
        root.cwiseInverse().asDiagonal() * complement;

      const std::array<double, 4> theta = parts_of_stiffness(n);
      std::array<double, 4>       least;
      for (unsigned int k = 0; k < theta.size(); ++k)
        {
          std::vector<double> weights(problem.elements().size(), 1.);
          for (const EquilibriumProblem<2>::ContactSide &side : sides)
            weights[side.element] = 1. - theta[k];
          const auto            condensed = problem.condense(weights);
          const Eigen::MatrixXd S =
            scaled.transpose() * condensed->schur_complement() * scaled;
          least[k] = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                       S, Eigen::EigenvaluesOnly)
                       .eigenvalues()(0);
        }
      return least;
    }



    constexpr double constant_rounding = 1e-9;



    /// A triangle with its side I from 0 to (1, 0), divided into n x n; I is
    /// the boundary 1.
    void
    make_divided_triangle(const dealii::Point<2>   &apex,
                          const unsigned int        n,
                          dealii::Triangulation<2> &mesh)
    {
      std::vector<dealii::Point<2>>    points;
      std::vector<dealii::CellData<2>> cells;
      std::vector<unsigned int>        first;
      for (unsigned int j = 0; j <= n; ++j)
        {
          first.push_back(static_cast<unsigned int>(points.size()));
          for (unsigned int i = 0; i <= n - j; ++i)
            points.emplace_back((i + apex[0] * j) / n, apex[1] * j / n);
        }
      const auto add = [&cells](const std::vector<unsigned int> &vertices) {
        cells.emplace_back(3);
        cells.back().vertices = vertices;
      };
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n - j; ++i)
          {
            const unsigned int a = first[j] + i, b = first[j + 1] + i;
            add({a, a + 1, b});
            if (i + 1 < n - j)
              add({a + 1, b + 1, b});
          }
      mesh.create_triangulation(points, cells, {});
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int face : cell->face_indices())
          if (cell->face(face)->at_boundary())
            cell->face(face)->set_boundary_id(
              cell->face(face)->center()[1] < 0.25 * apex[1] / n ? 1 : 0);
    }
  } // namespace



  double
  elementary_trace_constant(const RectangleAboveSide &Q,
                            const Material           &material,
                            const bool                tangential_fixed)
  {
    const double w = Q.width / dealii::numbers::PI, h = Q.height;
    const double bound =
      tangential_fixed ?
        4. / std::pow(h, 4) *
          (2. / 3. * w * w * std::pow(h, 3) + std::pow(w, 4) * h +
           std::pow(h, 5) / 20.) :
        64. / std::pow(h, 6) *
          (w * w * std::pow(h, 5) / 24. + std::pow(w, 4) * std::pow(h, 3) / 4. +
           std::pow(h, 7) / 64.);
    // The least of 2 mu |epsilon|^2 + lambda (tr epsilon)^2.
    const double stiffness =
      2. * (material.shear_modulus() + std::min(0., material.lame_lambda<2>()));
    return stiffness / bound;
  }



  double
  trace_constant(const RectangleAboveSide &Q,
                 const Material           &material,
                 const bool                tangential_fixed,
                 const unsigned int        n)
  {
    // Scaled, so that systems of units do not matter.
    Material unit                  = material;
    unit.young_modulus             = 1.;
    const RectangleAboveSide shape = {1., Q.height / Q.width};

    dealii::Triangulation<2> mesh;
    const BoundaryNames      names =
      Box<2>({{{shape.width, shape.height, 0.}}, {{n, n, 1}}})
        .make_mesh(mesh)
        .boundaries;
    const std::array<double, 4> theta = parts_of_stiffness(n);
    const std::array<double, 4> least = least_eigenvalues(
      mesh, names.at("bottom"), 1., unit, tangential_fixed, n);

    double constant = elementary_trace_constant(shape, unit, tangential_fixed);
    for (double previous = 0.; constant > (1. + 1e-6) * previous;)
      {
        previous = constant;
        for (unsigned int k = 0; k < theta.size(); ++k)
          constant =
            std::max(constant, std::min(least[k], theta[k] * n * previous));
      }
    return (1. - constant_rounding) * constant * material.young_modulus /
           Q.width;
  }



  double
  trace_constant(const TriangleAboveSide &Q,
                 const Material          &material,
                 const bool               tangential_fixed,
                 const unsigned int       n)
  {
    Material unit      = material;
    unit.young_modulus = 1.;
    dealii::Triangulation<2> mesh;
    make_divided_triangle({Q.apex / Q.width, Q.height / Q.width}, n, mesh);

    const std::array<double, 4> least =
      least_eigenvalues(mesh, {1}, 1., unit, tangential_fixed, n);
    return (1. - constant_rounding) *
           *std::max_element(least.begin(), least.end()) *
           material.young_modulus / Q.width;
  }
} // namespace Debond
