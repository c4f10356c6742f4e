// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_adhesion_integral_h
#define debond_contact_adhesion_integral_h

#include <debond/contact/bond_field.h>
#include <debond/contact/boundary.h>
#include <debond/contact/law.h>
#include <debond/contact/quadrature.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <array>
#include <vector>

namespace Debond
{
  /// The least s that bonds have been at, in terms of the law (of their
  /// stretch): what is above it does not come back. Empty if bonds return.
  struct BondMemory
  {
    std::vector<double> nodes;
    std::vector<double> held;   ///< of vertices that are no nodes
    std::vector<double> points; ///< face by face, unless points are nodes
  };



  /**
   * Phi(s) = int_{Gamma_C} j_1(s) dGamma of the trace with coefficients s, the
   * nodal values of degree 1, by quadrature on the contact boundary. The vector
   * s is ordered as ContactBoundary::nodes; s of vertices that are none is
   * prescribed, and grows with the load.
   *
   * Keeps references to its arguments.
   */
  template <int dim>
  class AdhesionIntegral : public PiecewiseQuadratic
  {
  public:
    AdhesionIntegral(const ContactBoundary<dim>   &contact_boundary,
                     const AdhesiveLaw            &adhesive_law,
                     const ContactQuadrature<dim> &quadrature_rule,
                     const BondField<dim>         *bond_field = nullptr);

    /// Of which s has a component.
    unsigned int
    n_nodes() const;

    const ContactBoundary<dim> &
    contact_boundary() const
    {
      return boundary;
    }

    const AdhesiveLaw &
    adhesive_law() const
    {
      return law;
    }

    /// These bonds where the prescribed displacements are @p factor times those
    /// for the whole load. Throws as BondField does, and so does the
    /// constructor.
    AdhesionIntegral
    at(const double factor) const;

    /// From now on bonds do not return to pieces of the law that they have left
    /// at @p s or before: those of each point of the rule.
    void
    break_for_good(const VectorView &s);

    const BondMemory &
    memory() const
    {
      return broken;
    }

    /// The memory() of these bonds at an earlier time.
    void
    set_memory(const BondMemory &memory);

    /// The memory of the bonds of a node, of all points of its faces where
    /// points are not nodes.
    double
    reached(const unsigned int node) const
    {
      return broken.nodes.empty() ? 0. : broken.nodes[node];
    }

    /// The piece of the law that they have not left for good.
    unsigned int
    least_piece(const unsigned int node) const
    {
      return law.branches().index(reached(node));
    }

    /// The same of the bonds at a point of one of the boundary's faces: those
    /// of the point of the rule that is next to it.
    unsigned int
    least_piece_at(const typename ContactBoundary<dim>::Face &face,
                   const std::array<double, dim>             &barycentric) const
    {
      return law.branches().index(reached_at(face, barycentric));
    }

    /// Whether points that are not nodes have bonds that have broken for good.
    bool
    has_broken_points() const
    {
      return !broken.points.empty();
    }

    /// The length (area) of the points of the rule whose bonds are on the last
    /// piece of the law and have a gap.
    double
    open_measure(const VectorView &s) const;

    /// How far on the way from s to s + @p limit ds bonds come before some
    /// leave their piece of the law, as a multiple of ds: @p limit if none do.
    /// What is prescribed stays as it is.
    double
    first_change(const VectorView &s,
                 const VectorView &ds,
                 const double      limit) const override;

    bool
    softens() const override
    {
      return law.softens();
    }

    Eigen::SparseMatrix<double>
    second_derivative(const VectorView &s) const override;

    /// The same, of each point the least one within @p part of its s: a bound
    /// where bonds are next to a kink.
    Eigen::SparseMatrix<double>
    least_second_derivative(const VectorView &s, const double part) const;

    /// Of each node the factor of the law's second derivative in Phi's, if all
    /// bonds are lumped at nodes.
    Eigen::VectorXd
    lumped_weights() const;

    /// Whether at some point the traction drops within @p part of its s.
    bool
    is_at_drop(const VectorView &s, const double part) const;

    /// What bonds that do not return have taken: Phi(0) with nothing
    /// prescribed.
    double
    dissipated_energy() const;

    /// The coefficients of s on a face, unknown or prescribed.
    typename ContactQuadrature<dim>::Trace
    trace_on(const typename ContactBoundary<dim>::Face &face,
             const VectorView                          &s) const;

    /// s at a vertex of a face, unknown or prescribed, and the bonds there.
    double
    trace_at(const typename ContactBoundary<dim>::Face &face,
             const unsigned int                         vertex,
             const VectorView                          &s) const
    {
      return face.is_held(vertex) ? held_trace(face, vertex) :
                                    s(face.nodes[vertex]);
    }

    BondScale
    bonds_at(const typename ContactBoundary<dim>::Face &face,
             const unsigned int                         vertex) const;

    unsigned int
    least_piece_at(const typename ContactBoundary<dim>::Face &face,
                   const unsigned int                         vertex) const
    {
      return law.branches().index(reached_at(face, vertex));
    }

    /// The memory of the bonds there.
    double
    reached_at(const typename ContactBoundary<dim>::Face &face,
               const unsigned int                         vertex) const;

    double
    reached_at(const typename ContactBoundary<dim>::Face &face,
               const std::array<double, dim>             &barycentric) const;

    /// Phi(s), an energy.
    double
    energy(const VectorView &s) const;

    /// Phi(s) - Phi(0); Phi(0) = 0 if nothing is prescribed and bonds return.
    double
    value(const VectorView &s) const override
    {
      return energy(s) - phi_at_zero;
    }

    double
    energy_at_zero() const
    {
      return phi_at_zero;
    }

    /// One element of the Clarke subdifferential of Phi at s (at a kink the
    /// derivative of the branch on the side of 0), a force for each node.
    Eigen::VectorXd
    subgradient(const VectorView &s) const override;

    /// The second derivative of the same branches, a matrix that
    /// couples the nodes of a face (diagonal for nodal quadrature).
    Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const override;

    /// For each node the forces that the law allows: the quadrature of the
    /// Goldstein intervals of j_1 over s +- delta. With delta = 0 this is
    /// the Clarke interval of Phi.
    std::vector<Interval>
    force_intervals(const VectorView &s, const double delta) const
    {
      return force_intervals(s,
                             std::vector<double>(boundary.nodes.size(), delta));
    }

    /// The same with a radius of its own for each node, delta[i] for the
    /// force on node i.
    std::vector<Interval>
    force_intervals(const VectorView          &s,
                    const std::vector<double> &delta) const;

    /// Whether each node has a multiple of the law for its own, as with nodal
    /// quadrature.
    bool
    is_separable() const;

    /// The derivatives of Phi by the normal displacements of
    /// ContactBoundary::held_vertices.
    std::vector<double>
    held_forces(const VectorView &s) const;

    /// s at a point of a face.
    double
    trace(const typename ContactBoundary<dim>::Face &face,
          const std::array<double, dim>             &barycentric,
          const VectorView                          &s) const;

    /// The derivative of j_1 at a point of a face (at a kink: that of the
    /// branch on the side of 0), minus the traction of the bonds on the body.
    double
    traction(const typename ContactBoundary<dim>::Face &face,
             const std::array<double, dim>             &barycentric,
             const VectorView                          &s) const;

    /// The bonds at a point of a face, as the scene has them there.
    BondScale
    bonds_of(const typename ContactBoundary<dim>::Face &face,
             const std::array<double, dim>             &barycentric) const;

    /// Whether bonds are not the same everywhere.
    bool
    has_field() const
    {
      return field != nullptr;
    }

    /// The bonds at a node. Where boundaries with bonds of their own meet they
    /// have the mean stiffness and fracture energy.
    BondScale
    bonds_at(const dealii::Point<dim>        &position,
             const dealii::types::boundary_id id) const
    {
      return field == nullptr ? BondScale() : field->at(position, id);
    }

    BondScale
    bonds_at(const unsigned int node) const
    {
      return field == nullptr ? BondScale() : bonds_of_nodes[node];
    }

  private:
    using Trace = typename ContactQuadrature<dim>::Trace;

    /// A quadrature point on Gamma_C: the trace there is the sum of shape[k]
    /// s[nodes[k]], k < n_nodes.
    struct Point
    {
      unsigned int                                     n_nodes;
      std::array<unsigned int, n_coefficients(dim, 2)> nodes;
      Trace                                            shape;
      double                                           weight; ///< length, area
      double    offset; ///< what is prescribed of the trace
      BondScale bonds;
      double    reached; ///< the memory

      bool
      is_on_a_node() const;

      double
      trace(const VectorView &s) const;
    };

    /// A prescribed coefficient on a face.
    double
    held_trace(const typename ContactBoundary<dim>::Face &face,
               const unsigned int                         k) const;

    /// The sum of @p of_law at the points, as a second derivative of Phi.
    template <typename Curvature>
    Eigen::SparseMatrix<double>
    matrix(const VectorView &s, const Curvature &of_law) const;

    /// Makes bonds_of_nodes and bonds_of_held.
    void
    collect_bonds();

    /// Writes the points of all faces to point_list.
    void
    collect_points();

    /// Makes point_list.
    void
    update_points();

    /// Replaces the points of point_list that are on a node by one for each
    /// node.
    void
    lump_nodal_points();

    const ContactBoundary<dim>   &boundary;
    const AdhesiveLaw            &law;
    const ContactQuadrature<dim> &quadrature;
    const BondField<dim>         *field;

    /// Empty if bonds are the same everywhere.
    std::vector<BondScale> bonds_of_nodes;
    std::vector<BondScale> bonds_of_held;

    double load_factor = 1.;
    double phi_at_zero = 0.;

    BondMemory broken;

    std::vector<Point> point_list;
  };
} // namespace Debond

#endif
