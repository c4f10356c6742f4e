// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_functional_h
#define debond_contact_functional_h

#include <debond/contact/adhesion_integral.h>
#include <debond/contact/contact_space.h>
#include <debond/optimization/objective.h>

namespace Debond
{
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
               const ContactSpace<dim>     &contact,
               const AdhesionIntegral<dim> &adhesion);

    double
    value(const VectorType &v) const override;

    void
    subgradient(const VectorType &v, VectorType &eta) const override;

    /// Needs two products with A; every further value costs only the contact
    /// boundary.
    std::unique_ptr<LineRestriction<VectorType>>
    along(const VectorType &x, const VectorType &d) const override;

  private:
    class Line;

    const MatrixType            &A;
    const VectorType            &f;
    const ContactSpace<dim>     &contact;
    const AdhesionIntegral<dim> &adhesion;
  };
} // namespace Debond

#endif
