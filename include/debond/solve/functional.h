// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_functional_h
#define debond_solve_functional_h

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/contact_space.h>
#include <debond/optimization/objective.h>

#include <functional>

namespace Debond
{
  /**
   * The paper's functional (Problem M_Vn)
   *
   *     J(v) = 1/2 <A v, v> - <f, v> + int_{Gamma_C} j_1(v_nu) dGamma
   *
   * on the vector of all degrees of freedom, with one Clarke subgradient.
   * Keeps references to its arguments but the first.
   */
  template <int dim>
  class Functional : public Objective
  {
  public:
    /// Makes of a vector, the second one, its product with A.
    using Product = std::function<void(DofVector &, const DofVector &)>;

    Functional(const Product               &multiply,
               const DofVector             &f,
               const ContactSpace<dim>     &contact,
               const AdhesionIntegral<dim> &adhesion);

    double
    value(const DofVector &v) const override;

    void
    subgradient(const DofVector &v, DofVector &eta) const override;

    /// Needs two products with A; every further value costs only the contact
    /// boundary.
    std::unique_ptr<LineRestriction>
    along(const DofVector &x, const DofVector &d) const override;

  private:
    class Line;

    const Product                multiply;
    const DofVector              f;
    const ContactSpace<dim>     &contact;
    const AdhesionIntegral<dim> &adhesion;
  };
} // namespace Debond

#endif
