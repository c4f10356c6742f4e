// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_functional_h
#define debond_contact_functional_h

#include <debond/contact/adhesion_integral.h>
#include <debond/optimization/objective.h>

namespace Debond
{
  /// The constraint v_nu <= 0 as bounds on degrees of freedom.
  template <int dim>
  UpperBounds
  unilateral_constraint(const ContactBoundary<dim> &boundary);



  /**
   * The paper's functional (Problem M_Vn)
   *
   *     J(v) = 1/2 <A v, v> - <f, v> + int_{Gamma_C} j_1(v_nu) dGamma
   *
   * on the vector of all degrees of freedom, with one Clarke subgradient.
   * Needs of MatrixType only vmult(). Keeps references to its arguments.
   */
  template <int dim, typename MatrixType, typename VectorType>
  class Functional : public Objective<VectorType>
  {
  public:
    Functional(const MatrixType            &A,
               const VectorType            &f,
               const ContactBoundary<dim>  &boundary,
               const AdhesionIntegral<dim> &adhesion);

    double
    value(const VectorType &v) const override;

    void
    subgradient(const VectorType &v, VectorType &eta) const override;

    /// Needs two products with A; every further value costs only the contact
    /// boundary.
    std::unique_ptr<LineRestriction<VectorType>>
    along(const VectorType &x, const VectorType &d) const override;

    /// The normal displacements s of the contact nodes.
    dealii::Vector<double>
    normal_trace(const VectorType &v) const;

  private:
    class Line;

    const MatrixType            &A;
    const VectorType            &f;
    const ContactBoundary<dim>  &boundary;
    const AdhesionIntegral<dim> &adhesion;
  };
} // namespace Debond

#endif
