// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_adhesion_integral_h
#define debond_contact_adhesion_integral_h

#include <deal.II/lac/vector.h>

#include <debond/contact/boundary.h>
#include <debond/contact/law.h>
#include <debond/contact/quadrature.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <array>
#include <vector>

namespace Debond
{
  /**
   * Phi(s) = int_{Gamma_C} j_1(s) dGamma of the P1 trace with nodal values s,
   * by quadrature on the contact boundary. The vector s is ordered as
   * ContactBoundary::nodes; fixed vertices count as s = 0.
   *
   * Keeps references to its arguments. Use from one thread at a time.
   */
  template <int dim>
  class AdhesionIntegral : public PiecewiseQuadratic
  {
  public:
    AdhesionIntegral(const ContactBoundary<dim>   &contact_boundary,
                     const AdhesiveLaw            &adhesive_law,
                     const ContactQuadrature<dim> &quadrature_rule);

    /// Phi(s), an energy.
    double
    value(const dealii::Vector<double> &s) const override;

    /// One element of the Clarke subdifferential of Phi at s (at a kink the
    /// derivative of the branch on the side of 0), a force for each node.
    void
    subgradient(const dealii::Vector<double> &s,
                dealii::Vector<double>       &xi) const override;

    /// The second derivative of the same branches, a matrix that
    /// couples the nodes of a face (diagonal for nodal quadrature).
    Eigen::SparseMatrix<double>
    curvature(const dealii::Vector<double> &s) const override;

    /// For each node the forces that the law allows: the quadrature of the
    /// Goldstein intervals of j_1 over s +- delta. With delta = 0 this is
    /// the Clarke interval of Phi.
    std::vector<Interval>
    force_intervals(const dealii::Vector<double> &s, const double delta) const;

    /// The same with a radius of its own for each node, delta[i] for the
    /// force on node i.
    std::vector<Interval>
    force_intervals(const dealii::Vector<double> &s,
                    const std::vector<double>    &delta) const;

    /// Whether each node has a multiple of the law for its own, as with nodal
    /// quadrature.
    bool
    is_separable() const;

  private:
    /// A quadrature point on Gamma_C: the trace there is the sum of shape[k]
    /// s[nodes[k]], k < n_nodes.
    struct Point
    {
      unsigned int                  n_nodes;
      std::array<unsigned int, dim> nodes;
      std::array<double, dim>       shape;
      double                        weight; ///< length or area

      bool
      is_on_a_node() const;

      double
      trace(const dealii::Vector<double> &s) const;
    };

    /// The quadrature points for the trace s.
    const std::vector<Point> &
    points(const dealii::Vector<double> &s) const;

    /// Writes the points of all faces to point_list.
    void
    collect_points(const dealii::Vector<double> &s) const;

    /// Replaces the points of point_list that are on a node by one for each
    /// node.
    void
    lump_nodal_points();

    const ContactBoundary<dim>   &boundary;
    const AdhesiveLaw            &law;
    const ContactQuadrature<dim> &quadrature;

    /// Made once unless the rule depends on the trace.
    mutable std::vector<Point> point_list;
  };
} // namespace Debond

#endif
