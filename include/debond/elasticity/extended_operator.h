// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_extended_operator_h
#define debond_elasticity_extended_operator_h

#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/elastic_problem.h>

#include <Eigen/Core>

#include <array>
#include <vector>

namespace Debond
{
  /// Numbers with at least 64 bits of mantissa where the machine has them.
  using ExtendedVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;



  /**
   * A of an ElasticProblem in extended precision and without being assembled:
   * forces from stresses, stresses from the differences of the displacements of
   * neighbours. Rows of an assembled A nearly cancel, so that rounding its
   * entries alone changes the bending of slender bodies.
   */
  template <int dim>
  class ExtendedOperator
  {
  public:
    /// Keeps a reference to the problem, which has to be assembled.
    explicit ExtendedOperator(const ElasticProblem<dim> &problem);

    /// A u, zero where constrained.
    ExtendedVector
    operator*(const ExtendedVector &u) const;

    /// How much the largest change of a stress is, relative to the largest
    /// stress, if @p u is rounded to @p rounded_u.
    double
    stress_rounding(const ExtendedVector &u,
                    const ExtendedVector &rounded_u) const;

  private:
    /// sigma[d][e].
    using Stress = std::array<std::array<long double, dim>, dim>;

    using Dofs     = std::array<unsigned int, dim>;
    using Gradient = std::array<long double, dim>;

    struct Cell
    {
      std::array<Dofs, dim + 1> dofs;

      /// Of the barycentric coordinates of all vertices but the first.
      std::array<Gradient, dim> gradients;

      long double volume;
      long double lambda; ///< Lame's
      long double mu;
    };

    ExtendedVector
    cartesian(const ExtendedVector &u) const;

    /// The gradients at a point of BernsteinSimplex of all basis functions but
    /// the first.
    void
    make_gradients(const Cell            &cell,
                   const unsigned int     point,
                   std::vector<Gradient> &gradients) const;

    Stress
    stress(const unsigned int           cell,
           const std::vector<Gradient> &gradients,
           const ExtendedVector        &cartesian_u) const;

    const Dofs &
    dofs(const unsigned int cell, const unsigned int node) const
    {
      return node <= dim ? cells[cell].dofs[node] :
                           edge_dofs[cell][node - (dim + 1)];
    }

    const ElasticProblem<dim> &problem;
    const unsigned int         degree;
    const unsigned int         n_points; ///< of BernsteinSimplex
    std::vector<Cell>          cells;

    /// Of each cell, of degree 2.
    std::vector<std::array<Dofs, n_simplex_edges(dim + 1)>> edge_dofs;
  };
} // namespace Debond

#endif
