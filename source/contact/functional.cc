// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/lac/vector_memory.h>

#include <debond/contact/functional.h>

namespace Debond
{
  template <int dim>
  UpperBounds
  unilateral_constraint(const ContactBoundary<dim> &boundary)
  {
    UpperBounds bounds;
    for (const auto &node : boundary.nodes)
      bounds.indices.push_back(node.dof);
    bounds.upper.assign(boundary.nodes.size(), 0.);
    return bounds;
  }



  /// J along x + t d: a parabola with precomputed coefficients plus the
  /// adhesion of the contact trace.
  template <int dim, typename MatrixType, typename VectorType>
  class Functional<dim, MatrixType, VectorType>::Line
    : public LineRestriction<VectorType>
  {
  public:
    Line(const Functional &functional, const VectorType &x, const VectorType &d)
      : functional(functional)
      , gradient(memory)
      , A_d(memory)
      , s(functional.normal_trace(x))
      , s_d(functional.normal_trace(d))
      , s_t(s)
      , xi(s)
      , adhesion_at_x(functional.adhesion.value(s))
    {
      gradient->reinit(x, true);
      functional.A.vmult(*gradient, x);
      *gradient -= functional.f;
      A_d->reinit(d, true);
      functional.A.vmult(*A_d, d);
      slope     = *gradient * d;
      curvature = *A_d * d;
    }

    double
    change(const double t) const override
    {
      return t * (slope + 0.5 * t * curvature) +
             (functional.adhesion.value(trace(t)) - adhesion_at_x);
    }

    void
    subgradient(const double t, VectorType &eta) const override
    {
      eta = *gradient;
      eta.add(t, *A_d);
      functional.adhesion.subgradient(trace(t), xi);
      for (unsigned int i = 0; i < xi.size(); ++i)
        eta(functional.boundary.nodes[i].dof) += xi(i);
    }

  private:
    const dealii::Vector<double> &
    trace(const double t) const
    {
      s_t = s;
      s_t.add(t, s_d);
      return s_t;
    }

    const Functional &functional;

    // The vectors of earlier lines are used again.
    dealii::GrowingVectorMemory<VectorType>            memory;
    typename dealii::VectorMemory<VectorType>::Pointer gradient; ///< A x - f
    typename dealii::VectorMemory<VectorType>::Pointer A_d;

    dealii::Vector<double>         s;
    dealii::Vector<double>         s_d;
    mutable dealii::Vector<double> s_t;
    mutable dealii::Vector<double> xi;
    double                         adhesion_at_x;
    double                         slope;
    double                         curvature;
  };



  template <int dim, typename MatrixType, typename VectorType>
  Functional<dim, MatrixType, VectorType>::Functional(
    const MatrixType            &A,
    const VectorType            &f,
    const ContactBoundary<dim>  &boundary,
    const AdhesionIntegral<dim> &adhesion)
    : A(A)
    , f(f)
    , boundary(boundary)
    , adhesion(adhesion)
  {}



  template <int dim, typename MatrixType, typename VectorType>
  double
  Functional<dim, MatrixType, VectorType>::value(const VectorType &v) const
  {
    VectorType A_v(v);
    A.vmult(A_v, v);
    return 0.5 * (A_v * v) - f * v + adhesion.value(normal_trace(v));
  }



  template <int dim, typename MatrixType, typename VectorType>
  void
  Functional<dim, MatrixType, VectorType>::subgradient(const VectorType &v,
                                                       VectorType &eta) const
  {
    A.vmult(eta, v);
    eta -= f;
    dealii::Vector<double> xi(static_cast<unsigned int>(boundary.nodes.size()));
    adhesion.subgradient(normal_trace(v), xi);
    for (unsigned int i = 0; i < xi.size(); ++i)
      eta(boundary.nodes[i].dof) += xi(i);
  }



  template <int dim, typename MatrixType, typename VectorType>
  std::unique_ptr<LineRestriction<VectorType>>
  Functional<dim, MatrixType, VectorType>::along(const VectorType &x,
                                                 const VectorType &d) const
  {
    return std::make_unique<Line>(*this, x, d);
  }



  template <int dim, typename MatrixType, typename VectorType>
  dealii::Vector<double>
  Functional<dim, MatrixType, VectorType>::normal_trace(
    const VectorType &v) const
  {
    dealii::Vector<double> s(static_cast<unsigned int>(boundary.nodes.size()));
    for (unsigned int i = 0; i < s.size(); ++i)
      s(i) = v(boundary.nodes[i].dof);
    return s;
  }



  template UpperBounds
  unilateral_constraint(const ContactBoundary<2> &);
  template UpperBounds
  unilateral_constraint(const ContactBoundary<3> &);
  template class Functional<2,
                            dealii::SparseMatrix<double>,
                            dealii::Vector<double>>;
  template class Functional<3,
                            dealii::SparseMatrix<double>,
                            dealii::Vector<double>>;
  template class Functional<2,
                            dealii::FullMatrix<double>,
                            dealii::Vector<double>>;
  template class Functional<3,
                            dealii::FullMatrix<double>,
                            dealii::Vector<double>>;
  template class Functional<2,
                            dealii::TrilinosWrappers::SparseMatrix,
                            dealii::Vector<double>>;
  template class Functional<3,
                            dealii::TrilinosWrappers::SparseMatrix,
                            dealii::Vector<double>>;
} // namespace Debond
