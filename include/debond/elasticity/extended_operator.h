// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_extended_operator_h
#define debond_elasticity_extended_operator_h

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
    /// stress, if @p u is rounded to double precision.
    double
    stress_rounding(const ExtendedVector &u) const;

  private:
    /// sigma[d][e].
    using Stress = std::array<std::array<long double, dim>, dim>;

    struct Cell
    {
      std::array<std::array<unsigned int, dim>, dim + 1> dofs;

      /// Of the basis functions of all vertices but the first.
      std::array<std::array<long double, dim>, dim> gradients;

      long double volume;
      long double lambda; ///< Lame's
      long double mu;
    };

    ExtendedVector
    cartesian(const ExtendedVector &u) const;

    Stress
    stress(const Cell &cell, const ExtendedVector &cartesian_u) const;

    const ElasticProblem<dim> &problem;
    std::vector<Cell>          cells;
  };
} // namespace Debond

#endif
