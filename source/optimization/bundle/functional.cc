// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/bundle/functional.h>

namespace Debond
{
  Functional::Functional(const Product                   &multiply,
                         const DofVector                 &f,
                         const std::vector<unsigned int> &contact_dofs,
                         const PiecewiseQuadratic        &phi)
    : multiply(multiply)
    , f(f)
    , contact_dofs(contact_dofs)
    , phi(phi)
  {}



  double
  Functional::value(const DofVector &v) const
  {
    DofVector A_v(v);
    multiply(A_v, v);
    return 0.5 * (A_v * v) - f * v + phi.change(trace(v));
  }



  void
  Functional::subgradient(const DofVector &v, DofVector &eta) const
  {
    multiply(eta, v);
    eta -= f;
    add_phi(trace(v), eta);
  }



  Eigen::VectorXd
  Functional::trace(const DofVector &v) const
  {
    Eigen::VectorXd s(contact_dofs.size());
    for (unsigned int i = 0; i < contact_dofs.size(); ++i)
      s(i) = v(contact_dofs[i]);
    return s;
  }



  void
  Functional::add_phi(const Eigen::VectorXd &s, DofVector &eta) const
  {
    const Eigen::VectorXd xi = phi.subgradient(s);
    for (unsigned int i = 0; i < contact_dofs.size(); ++i)
      eta(contact_dofs[i]) += xi(i);
  }



  Functional::Line::Line(const Functional &functional,
                         const DofVector  &x,
                         const DofVector  &d)
    : functional(functional)
    , gradient(memory)
    , A_d(memory)
    , s(functional.trace(x))
    , s_d(functional.trace(d))
    , phi_at_x(functional.phi.change(s))
  {
    gradient->reinit(x, true);
    functional.multiply(*gradient, x);
    *gradient -= functional.f;
    A_d->reinit(d, true);
    functional.multiply(*A_d, d);
    // J_quadratic(x + t d) - J_quadratic(x) = t (slope + t/2 curvature), in
    // which J(x) does not occur.
    slope     = *gradient * d;
    curvature = *A_d * d;
  }



  double
  Functional::Line::change(const double t) const
  {
    return t * (slope + 0.5 * t * curvature) +
           (functional.phi.change(s + t * s_d) - phi_at_x);
  }



  void
  Functional::Line::subgradient(const double t, DofVector &eta) const
  {
    eta = *gradient;
    eta.add(t, *A_d);
    functional.add_phi(s + t * s_d, eta);
  }
} // namespace Debond
