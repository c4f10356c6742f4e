// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/tria_description.h>

#include <debond/base/tolerances.h>
#include <debond/certify/mean_problem.h>
#include <debond/certify/trace_constant.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace Debond
{
  namespace
  {
    /// A triangle with its side I from 0 to (1, 0), divided into n x n; I is
    /// the boundary 1.
    void
    make_divided_triangle(const TriangleAboveSide  &Q,
                          const unsigned int        n,
                          dealii::Triangulation<2> &mesh)
    {
      std::vector<dealii::Point<2>>    points;
      std::vector<dealii::CellData<2>> cells;
      std::vector<unsigned int>        first;
      // Points by rows parallel to I, n + 1 - j of them in row j. Between two
      // rows there are triangles that stand on their side, the ones similar to
      // Q, and others that stand on their apex, which are these turned by 180
      // degrees.
      for (unsigned int j = 0; j <= n; ++j)
        {
          first.push_back(static_cast<unsigned int>(points.size()));
          for (unsigned int i = 0; i <= n - j; ++i)
            points.emplace_back((i + Q.apex * j) / n, Q.height * j / n);
        }
      const auto add = [&cells](const std::vector<unsigned int> &vertices) {
        cells.emplace_back(3);
        std::copy(vertices.begin(),
                  vertices.end(),
                  cells.back().vertices.begin());
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
              cell->face(face)->center()[1] < 0.25 * Q.height / n ? 1 : 0);
    }



    /// The traces that are linear on each of n sides of the length 1/n of a
    /// side from 0 to 1, by means and slopes, without those that are linear on
    /// all of it: an orthonormal basis in L2 in columns.
    Eigen::MatrixXd
    not_linear_traces(const std::vector<EquilibriumMesh<2>::Side> &I)
    {
      const Eigen::Index n = static_cast<Eigen::Index>(I.size());
      // With means and slopes the L2 product on I is diagonal, 1/n for a mean
      // and 1/(3 n) for a slope.
      Eigen::VectorXd mass =
        Eigen::VectorXd::Constant(2 * n, 1. / static_cast<double>(n));
      mass.tail(n) /= 3.;
      Eigen::MatrixXd linear = Eigen::MatrixXd::Zero(2 * n, 2);
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const double a = I[i].corners[0][0], b = I[i].corners[1][0];
          linear(i, 0)     = 1.;
          linear(i, 1)     = 0.5 * (a + b);
          linear(n + i, 1) = 0.5 * (b - a);
        }
      // In the coordinates root x the L2 product is Euclidean. The last columns
      // of Q are orthogonal there to the two linear traces; divided by root
      // they are orthonormal in L2. Least eigenvalues with this basis are
      // Rayleigh quotients by |v_nu - p|_I^2.
      const Eigen::VectorXd                       root = mass.cwiseSqrt();
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(root.asDiagonal() *
                                                     linear);
      const Eigen::MatrixXd                       Q = qr.householderQ();
      return root.cwiseInverse().asDiagonal() * Q.rightCols(2 * n - 2);
    }
  } // namespace



  double
  trace_constant(const TriangleAboveSide &Q,
                 const Material          &material,
                 const bool               tangential_fixed,
                 const unsigned int       n)
  {
    // Scaled, so that systems of units do not matter.
    const double modulus = material.extreme_moduli()[1];
    Material     unit    = material;
    unit.young_modulus   = 1.;
    // Poisson's ratios and angles have no unit.
    if (material.orthotropy)
      for (unsigned int i = 0; i < 3; ++i)
        {
          unit.orthotropy->young_moduli[i] /= modulus;
          unit.orthotropy->shear_moduli[i] /= modulus;
        }
    dealii::Triangulation<2> mesh;
    make_divided_triangle(Q, n, mesh);
    BoundaryConditions conditions;
    conditions.contact = {1};
    if (!tangential_fixed)
      conditions.tangential_displacement = TangentialDisplacement::free;
    EquilibriumProblem<2> problem(mesh, conditions, {}, unit, Loads<2>());
    const auto           &sides = problem.mesh.contact_sides;
    // If v_tau is free, a motion along I has no energy, and one unknown is
    // fixed to make the matrix definite. That motion has no v_nu, so that no
    // trace is lost.
    if (!tangential_fixed)
      problem.mesh.is_fixed[sides[0].first_unknown + 1] = 1;
    const Eigen::MatrixXd basis = not_linear_traces(sides);

    // The lemma of doc/reference/certificate.md: Lambda >= lambda_min(theta)
    // for each theta with theta n > 1, of which a few are tried and the best
    // one counts.
    double best = 0.;
    for (const double theta_n : {1.1, 1.5, 2.5, 5.})
      {
        std::vector<double> weights(mesh.n_active_cells(), 1.);
        for (const auto &side : sides)
          // theta may be at most 0.9, so that the cells at I keep a tenth of
          // their stiffness whatever n is.
          weights[side.cell->active_cell_index()] =
            1. - std::min(theta_n / n, 0.9);
        const MeansAndSlopes  condensed(*problem.condense(weights));
        const Eigen::MatrixXd S = basis.transpose() * condensed.A * basis;
        best                    = std::max(best,
                        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                          S, Eigen::EigenvaluesOnly)
                          .eigenvalues()(0));
      }
    // Rounding of the eigenvalue must not raise the constant, which is in the
    // unit of the moduli again, per length 1 of the side.
    return (1. - Tolerance::certificate) * best * modulus;
  }
} // namespace Debond
