// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/vector_memory.h>

#include <debond/solve/functional.h>

namespace Debond
{
  /// J along x + t d: a parabola with precomputed coefficients plus the
  /// adhesion of the contact trace.
  template <int dim>
  class Functional<dim>::Line : public LineRestriction
  {
  public:
    Line(const Functional &functional, const DofVector &x, const DofVector &d)
      : functional(functional)
      , gradient(memory)
      , A_d(memory)
      , s(functional.contact.trace(x))
      , s_d(functional.contact.trace(d))
      , adhesion_at_x(functional.adhesion.change(s))
    {
      gradient->reinit(x, true);
      // The line search of the paper asks for J at many t. Along a line the
      // quadratic part is a parabola, so that two products with A serve for all
      // of them, and only the contact boundary is evaluated anew.
      functional.multiply(*gradient, x);
      *gradient -= functional.f;
      A_d->reinit(d, true);
      functional.multiply(*A_d, d);
      slope     = *gradient * d;
      curvature = *A_d * d;
    }

    double
    change(const double t) const override
    {
      // The change of J is returned instead of J, since near a minimum both
      // values agree in most of their digits, and (14) compares the change with
      // m_L t v_k.
      return t * (slope + 0.5 * t * curvature) +
             (functional.adhesion.change(trace(t)) - adhesion_at_x);
    }

    void
    subgradient(const double t, DofVector &eta) const override
    {
      eta = *gradient;
      eta.add(t, *A_d);
      functional.contact.add_normal(functional.adhesion.subgradient(trace(t)),
                                    eta);
    }

  private:
    Eigen::VectorXd
    trace(const double t) const
    {
      return s + t * s_d;
    }

    const Functional &functional;

    // The vectors of earlier lines are used again.
    dealii::GrowingVectorMemory<DofVector>   memory;
    dealii::VectorMemory<DofVector>::Pointer gradient; ///< A x - f
    dealii::VectorMemory<DofVector>::Pointer A_d;

    Eigen::VectorXd s;
    Eigen::VectorXd s_d;
    double          adhesion_at_x;
    double          slope;
    double          curvature;
  };



  template <int dim>
  Functional<dim>::Functional(const Product               &multiply,
                              const DofVector             &f,
                              const ContactSpace<dim>     &contact,
                              const AdhesionIntegral<dim> &adhesion)
    : multiply(multiply)
    , f(f)
    , contact(contact)
    , adhesion(adhesion)
  {}



  template <int dim>
  double
  Functional<dim>::value(const DofVector &v) const
  {
    // J_n of Problem M_Vn of the paper, with the bonds' energy counted from s =
    // 0.
    DofVector A_v(v);
    multiply(A_v, v);
    return 0.5 * (A_v * v) - f * v + adhesion.change(contact.trace(v));
  }



  template <int dim>
  void
  Functional<dim>::subgradient(const DofVector &v, DofVector &eta) const
  {
    // eta = A v - f + xi, with one xi of Clarke's subdifferential of the bonds'
    // energy (the paper's (12)).
    multiply(eta, v);
    eta -= f;
    contact.add_normal(adhesion.subgradient(contact.trace(v)), eta);
  }



  template <int dim>
  std::unique_ptr<LineRestriction>
  Functional<dim>::along(const DofVector &x, const DofVector &d) const
  {
    return std::make_unique<Line>(*this, x, d);
  }



  template class Functional<2>;
  template class Functional<3>;
} // namespace Debond
