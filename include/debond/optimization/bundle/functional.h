// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_functional_h
#define debond_optimization_bundle_functional_h

#include <deal.II/lac/vector_memory.h>

#include <debond/base/dof_vector.h>
#include <debond/optimization/piecewise_quadratic.h>

namespace Debond
{
  /**
   * The paper's functional (Problem M_Vn)
   *
   *     J(v) = 1/2 <A v, v> - <f, v> + Phi(s),
   *
   * Phi = int_{Gamma_C} j_1(v_nu) dGamma and s some entries of v, as the bundle
   * method sees it: its value, less what it is at v = 0, and one element of its
   * Clarke subdifferential at each point. Keeps a reference to Phi.
   */
  class Functional
  {
  public:
    /// Makes of a vector, the second one, its product with A.
    using Product = std::function<void(DofVector &, const DofVector &)>;

    /// @p contact_dofs: the entries of v that are s.
    Functional(const Product                   &multiply,
               const DofVector                 &f,
               const std::vector<unsigned int> &contact_dofs,
               const PiecewiseQuadratic        &phi);

    double
    value(const DofVector &v) const;

    /// Written to @p eta, which has the size of v.
    void
    subgradient(const DofVector &v, DofVector &eta) const;

    /// t -> J(x + t d), a parabola and Phi. It takes two products with A, and
    /// then the many values that a line search asks for cost Phi alone.
    class Line
    {
    public:
      /// Keeps a reference to the functional.
      Line(const Functional &functional,
           const DofVector  &x,
           const DofVector  &d);

      /// J(x + t d) - J(x), without the cancellation of the plain difference in
      /// the quadratic part.
      double
      change(const double t) const;

      /// One element of the Clarke subdifferential of J at x + t d.
      void
      subgradient(const double t, DofVector &eta) const;

    private:
      const Functional &functional;

      // The vectors of earlier lines are used again.
      dealii::GrowingVectorMemory<DofVector>   memory;
      dealii::VectorMemory<DofVector>::Pointer gradient; ///< A x - f
      dealii::VectorMemory<DofVector>::Pointer A_d;

      const Eigen::VectorXd s, s_d;
      const double          phi_at_x;
      double                slope, curvature;
    };

  private:
    Eigen::VectorXd
    trace(const DofVector &v) const;

    /// Adds the subgradient of Phi at @p s.
    void
    add_phi(const Eigen::VectorXd &s, DofVector &eta) const;

    const Product                   multiply;
    const DofVector                 f;
    const std::vector<unsigned int> contact_dofs;
    const PiecewiseQuadratic       &phi;
  };
} // namespace Debond

#endif
