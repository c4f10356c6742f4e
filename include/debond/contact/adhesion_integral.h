// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_adhesion_integral_h
#define debond_contact_adhesion_integral_h

#include <debond/contact/contact_points.h>
#include <debond/contact/law.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <vector>

namespace Debond
{
  /// For each of ContactPoints::list() the least stretch that its bonds have
  /// been at: what is above it does not come back. Empty if bonds return.
  using BondMemory = std::vector<double>;



  /**
   * Phi(s) = int_{Gamma_C} j_1(s) dGamma, the energy of the bonds: a sum of the
   * law over the ContactPoints, whose order s has.
   *
   * Keeps references to its arguments.
   */
  template <int dim>
  class AdhesionIntegral : public PiecewiseQuadratic
  {
  public:
    using Face        = typename ContactPoints<dim>::Face;
    using Barycentric = typename ContactPoints<dim>::Barycentric;

    /// See ContactPoints.
    AdhesionIntegral(const ContactBoundary<dim>   &contact_boundary,
                     const AdhesiveLaw            &adhesive_law,
                     const ContactQuadrature<dim> &quadrature_rule,
                     const BondField<dim>         *bond_field = nullptr);

    /// The number of components of s.
    unsigned int
    n_nodes() const
    {
      return static_cast<unsigned int>(contact_boundary().nodes.size());
    }

    const ContactBoundary<dim> &
    contact_boundary() const
    {
      return contact_points.boundary();
    }

    const AdhesiveLaw &
    adhesive_law() const
    {
      return law;
    }

    const ContactPoints<dim> &
    points() const
    {
      return contact_points;
    }

    /// These bonds where the prescribed displacements are @p factor times those
    /// for the whole load.
    AdhesionIntegral
    at(const double factor) const;

    /// From now on bonds do not return to pieces of the law that they have left
    /// at @p s or before.
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

    /// The memory of the bonds of a node; where points are not nodes the
    /// largest of the points around it.
    double
    reached(const unsigned int node) const
    {
      return broken.empty() ? 0. : reached_of_nodes[node];
    }

    /// Returns the least s that the bonds at a vertex of a face have reached;
    /// the vertex may be held.
    double
    reached_at(const Face &face, const unsigned int vertex) const;

    /// The memory of the point of the rule next to a place on a face.
    double
    reached_at(const Face &face, const Barycentric &place) const
    {
      return broken.empty() ? 0. : broken[contact_points.nearest(face, place)];
    }

    /// The piece of the law that the bonds of a node have not left for good.
    unsigned int
    least_piece(const unsigned int node) const
    {
      return law.pieces().index(reached(node));
    }

    /// Calls @p visit(point, stretch, reached) for all points: sums over them
    /// are made of it.
    template <typename Visit>
    void
    for_each_point(const VectorView &s, const Visit &visit) const
    {
      for (unsigned int q = 0; q < contact_points.list().size(); ++q)
        {
          const ContactPoint<dim> &point = contact_points.list()[q];
          visit(point, point.stretch(s), broken.empty() ? 0. : broken[q]);
        }
    }

    /// The second derivative of Phi at @p s if that of the law is @p of_law
    /// (stretch, reached): a matrix that couples the nodes of a face, diagonal
    /// for nodal quadrature.
    template <typename Curvature>
    Eigen::SparseMatrix<double>
    matrix(const VectorView &s, const Curvature &of_law) const
    {
      std::vector<Eigen::Triplet<double>> entries;
      for_each_point(s, [&](const auto &point, double stretch, double reached) {
        const double curvature =
          point.force() / point.bonds.stretch * of_law(stretch, reached);
        if (curvature != 0.)
          for (unsigned int k = 0; k < point.n_nodes; ++k)
            for (unsigned int l = 0; l < point.n_nodes; ++l)
              entries.emplace_back(point.index[k],
                                   point.index[l],
                                   curvature * point.shape[k] * point.shape[l]);
      });
      Eigen::SparseMatrix<double> result(s.size(), s.size());
      result.setFromTriplets(entries.begin(), entries.end());
      return result;
    }

    /// Phi(s), an energy.
    double
    value(const VectorView &s) const;

    /// Phi(0), which is zero if nothing is prescribed and bonds return.
    double
    value_at_zero() const
    {
      return phi_at_zero;
    }

    double
    change(const VectorView &s) const override
    {
      return value(s) - phi_at_zero;
    }

    /// One element of the Clarke subdifferential of Phi at s (at a kink the
    /// derivative of the piece on the side of 0), a force for each node.
    Eigen::VectorXd
    subgradient(const VectorView &s) const override;

    Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const override;

    Eigen::SparseMatrix<double>
    second_derivative(const VectorView &s) const override;

    bool
    softens() const override
    {
      return law.softens();
    }

    /// Prescribed displacements stay as they are on the way.
    double
    first_change(const VectorView &s,
                 const VectorView &ds,
                 const double      limit) const override;

    /// For each node the forces that the law allows: the quadrature of the
    /// Goldstein intervals of j_1 over s +- delta. With delta = 0 this is
    /// the Clarke interval of Phi.
    std::vector<Interval>
    force_intervals(const VectorView &s, const double delta) const
    {
      return force_intervals(s, std::vector<double>(n_nodes(), delta));
    }

    /// Returns these intervals with a radius of its own for each node, delta[i]
    /// for the force on node i.
    std::vector<Interval>
    force_intervals(const VectorView          &s,
                    const std::vector<double> &delta) const;

  private:
    /// Adapts what follows from the points and their memory.
    void
    update();

    ContactPoints<dim>  contact_points;
    const AdhesiveLaw  &law;
    BondMemory          broken;
    std::vector<double> reached_of_nodes; ///< empty as broken is
    double              phi_at_zero = 0.;
  };
} // namespace Debond

#endif
