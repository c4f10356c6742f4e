// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/displacement_problem.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  DisplacementProblem::DisplacementProblem(
    const DofVector                 &load,
    const PiecewiseQuadratic        &nonsmooth,
    const std::vector<unsigned int> &contact_normals,
    const DofVector                 &diagonal_of_A,
    DofVector                       &start,
    const std::function<bool()>     &go_on)
    : f(load)
    , phi(nonsmooth)
    , u(start)
    , normals(contact_normals)
    , diagonal(diagonal_of_A)
    , may_go_on(go_on ? go_on : []() { return true; })
    , active(contact_normals.size())
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      active[i] = normals[i] != dealii::numbers::invalid_unsigned_int &&
                  u(normals[i]) == 0.;
  }



  Eigen::VectorXd
  DisplacementProblem::trace(const DofVector &v) const
  {
    Eigen::VectorXd s(normals.size());
    for (unsigned int i = 0; i < normals.size(); ++i)
      s(i) = v(normals[i]);
    return s;
  }



  void
  DisplacementProblem::add_normal(const VectorView &s, DofVector &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (normals[i] != dealii::numbers::invalid_unsigned_int)
        v(normals[i]) += s(i);
  }



  double
  DisplacementProblem::product(const DofVector &a, const DofVector &b) const
  {
    return a * b;
  }



  double
  DisplacementProblem::norm(const DofVector &v) const
  {
    return std::sqrt(product(v, v));
  }



  MajorantProblem::State
  DisplacementProblem::evaluate()
  {
    DofVector internal(u.size());
    multiply(internal, u);
    const Eigen::VectorXd s  = trace(u);
    const Eigen::VectorXd xi = phi.subgradient(s);

    State        state;
    const double energy   = 0.5 * product(internal, u);
    const double work     = product(f, u);
    const double adhesion = phi.value(s);
    state.functional      = energy - work + adhesion;

    // The terms of a row of A u are as large as diagonal times displacement,
    // and cancel.
    DofVector terms = diagonal;
    terms.scale(u);
    force_rounding = 4. * std::numeric_limits<double>::epsilon() * norm(terms);
    state.functional_rounding = force_rounding * norm(u);

    DofVector violation = f;
    violation -= internal;
    largest_force  = std::max({norm(f), norm(internal), xi.norm()});
    state.n_active = 0;
    for (unsigned int i = 0; i < normals.size(); ++i)
      {
        if (s(i) == 0.)
          ++state.n_active;
        if (normals[i] == dealii::numbers::invalid_unsigned_int)
          continue;
        // On a node in contact only a force that pulls violates the law.
        double &force = violation(normals[i]);
        force -= xi(i);
        if (s(i) == 0.)
          force = std::min(force, 0.);
      }
    const double scale      = largest_force == 0. ? 1. : 1. / largest_force;
    state.residual          = scale * norm(violation);
    state.residual_rounding = scale * force_rounding;
    return state;
  }



  bool
  DisplacementProblem::majorise()
  {
    // Phi <= Phi(s_k) + xi'(s - s_k) + 1/2 (s - s_k)'E (s - s_k).
    const Eigen::VectorXd             s            = trace(u);
    const Eigen::SparseMatrix<double> previous_E   = E;
    const Eigen::VectorXd             previous_b_c = b_c;
    E                                              = phi.curvature(s);
    const Eigen::VectorXd E_s                      = E * s;
    b_c                                            = E_s - phi.subgradient(s);
    if (previous_b_c.size() != b_c.size())
      return true;
    constexpr double noise = 1e-12;
    return (b_c - previous_b_c).norm() > noise * (E_s.norm() + b_c.norm()) ||
           curvature_norm(E - previous_E) > noise * curvature_norm(E);
  }



  void
  DisplacementProblem::majorant_force(DofVector &force) const
  {
    multiply(force, u);
    force.sadd(-1., 1., f);
    const Eigen::VectorXd E_s = E * trace(u);
    add_normal(b_c - E_s, force);
  }



  void
  DisplacementProblem::multiply_majorant(DofVector       &dst,
                                         const DofVector &src) const
  {
    multiply(dst, src);
    add_normal(E * trace(src), dst);
    restrict_to_free(dst);
  }



  void
  DisplacementProblem::restrict_to_free(DofVector &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (active[i] != 0 && normals[i] != dealii::numbers::invalid_unsigned_int)
        v(normals[i]) = 0.;
  }
} // namespace Debond
