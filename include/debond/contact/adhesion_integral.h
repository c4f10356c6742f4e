// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_adhesion_integral_h
#define debond_contact_adhesion_integral_h

#include <deal.II/lac/vector.h>

#include <debond/contact/boundary.h>
#include <debond/contact/law.h>
#include <debond/contact/quadrature.h>

#include <vector>

namespace Debond
{
  /**
   * Phi(s) = int_{Gamma_C} j_1(s) dGamma of the P1 trace with nodal values s,
   * by quadrature on the contact boundary. The vector s is ordered as
   * ContactBoundary::nodes; fixed vertices count as s = 0.
   *
   * Keeps references to its arguments.
   */
  template <int dim>
  class AdhesionIntegral
  {
  public:
    AdhesionIntegral(const ContactBoundary<dim> &  boundary,
                     const AdhesiveLaw &           law,
                     const ContactQuadrature<dim> &quadrature);

    /// Phi(s), an energy.
    double
    value(const dealii::Vector<double> &s) const;

    /// One element of the Clarke subdifferential of Phi at s (the upper end of
    /// the law's interval at each kink), a force for each node.
    void
    subgradient(const dealii::Vector<double> &s,
                dealii::Vector<double> &      xi) const;

    /// For each node the forces that the law allows: the quadrature of the
    /// Goldstein intervals of j_1 over s +- delta. With delta = 0 this is
    /// the Clarke interval of Phi.
    std::vector<Interval>
    force_intervals(const dealii::Vector<double> &s, const double delta) const;

  private:
    template <typename Integrand>
    void
    for_each_point(const dealii::Vector<double> &s,
                   const Integrand &             integrand) const;

    const ContactBoundary<dim> &  boundary;
    const AdhesiveLaw &           law;
    const ContactQuadrature<dim> &quadrature;
  };
} // namespace Debond

#endif
