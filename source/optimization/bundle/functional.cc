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
    // This is the functional of Problem M_{V_n} of the paper less the constant
    // Phi(0), which no comparison of two values needs.
    DofVector A_v(v);
    multiply(A_v, v);
    return 0.5 * (A_v * v) - f * v + phi.change(trace(v));
  }



  void
  Functional::subgradient(const DofVector &v, DofVector &eta) const
  {
    // All but Phi is differentiable, so that the gradient of the rest and any
    // element of the subdifferential of Phi make an element of that of J.
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
    // At a kink of j_1 it is the derivative of the piece on the side of 0, one
    // element of Clarke's subdifferential.
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
    // The two products with A are all that a line search costs: each trial t
    // then needs the contact nodes only, and a subgradient the sum of two
    // vectors.
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
    // Near the minimum the descent is far below the last digit of J, so that a
    // difference of two values of J would be nothing but rounding, and (14)
    // could not be tested.
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
