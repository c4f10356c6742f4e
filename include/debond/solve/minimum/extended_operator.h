// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_extended_operator_h
#define debond_solve_minimum_extended_operator_h

#include <debond/elasticity/elastic_problem.h>

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

  private:
    using Gradient = dealii::Tensor<1, dim, long double>;
    using Stress   = dealii::Tensor<2, 3, long double>; ///< of the solid

    static constexpr unsigned int most_nodes = dim == 2 ? 6 : 10; ///< of a cell

    struct Cell
    {
      /// By node, those of one after the other.
      std::vector<dealii::types::global_dof_index> dofs;

      /// Columns are the gradients of all barycentric coordinates but the
      /// first.
      dealii::Tensor<2, dim, long double> gradients;

      /// Without a symmetry axis the radii of the vertices are not used.
      std::array<long double, dim + 1> radii = {};

      long double volume;
      long double lambda = 0.L; ///< Lame's
      long double mu     = 0.L;

      /// In place of them if the material is orthotropic, or around an axis.
      const dealii::SymmetricTensor<4, 3> *stiffness = nullptr;
    };

    bool
    has_axis() const
    {
      return problem.unknowns().symmetry() == Symmetry::axis;
    }

    void
    make_reference_gradients();

    /// Adds the forces of a cell under nodal displacements.
    void
    add_forces(const Cell           &cell,
               const ExtendedVector &displacement,
               ExtendedVector       &forces) const;

    /// The distance of a point of the rule from the axis.
    long double
    radius(const Cell &cell, const unsigned int point) const;

    Stress
    stress(const Cell &cell, const Stress &gradient) const;

    const ElasticProblem<dim> &problem;
    std::vector<Cell>          cells;

    /// The gradients of the basis functions but the first at each point of
    /// strain_rule(), by all barycentric coordinates but the first.
    std::vector<std::vector<Gradient>> reference_gradients;

    /// The values of all basis functions and barycentric coordinates there.
    std::vector<std::vector<long double>> reference_values, barycentric;
  };
} // namespace Debond

#endif
