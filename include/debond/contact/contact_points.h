// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_contact_points_h
#define debond_contact_contact_points_h

#include <debond/base/views.h>
#include <debond/contact/bond_field.h>
#include <debond/contact/boundary.h>
#include <debond/contact/quadrature.h>

namespace Debond
{
  /// A displacement across the contact boundary, along the normal and along the
  /// boundary.
  template <int dim>
  struct Jump
  {
    double                 normal = 0.;
    dealii::Tensor<1, dim> tangential;

    /// Returns the product in which the square of an opening is that of a jump
    /// with itself; see BondScale::shear.
    double
    product(const Jump &other, const double shear) const
    {
      return normal * other.normal + shear * (tangential * other.tangential);
    }

    /// Returns the part of shear in what bonds at this jump have stored, from 0
    /// to 1; no number where they have stored nothing.
    double
    part_of_shear(const double shear) const
    {
      return shear * tangential.norm_square() / product(*this, shear);
    }

    /// Returns this jump and @p part of @p way.
    Jump
    moved(const Jump &way, const double part) const
    {
      return {normal + part * way.normal, tangential + part * way.tangential};
    }
  };



  /// One of the points that integrals over Gamma_C are sums over. The normal
  /// displacement there is `offset` and the sum of shape[k] s(index[k]) over
  /// the first `n_nodes` entries. The entries after them, up to `n_entries`,
  /// belong to held vertices, whose part is in the offset.
  template <int dim>
  struct ContactPoint
  {
    unsigned int                                     n_nodes   = 0;
    unsigned int                                     n_entries = 0;
    std::array<unsigned int, n_coefficients(dim, 2)> index     = {};
    typename ContactQuadrature<dim>::Trace           shape     = {};

    double    weight = 0.; ///< a length or area
    double    offset = 0.; ///< the prescribed part of the displacement
    BondScale bonds;

    /// What a displacement along a tangent makes of that of the point, times
    /// the value of the shape function.
    struct Slip
    {
      unsigned int           index;
      dealii::Tensor<1, dim> direction;
    };

    /// The displacement along the boundary is `slip_offset`, which is
    /// prescribed, and the sum of the unknowns' parts in `slip`. `held_slip`
    /// has the vertices that the offset is from. Without bonds that shear both
    /// lists are empty.
    std::vector<Slip>      slip = {}, held_slip = {};
    dealii::Tensor<1, dim> slip_offset;

    /// Returns whether the bonds depend on more than the normal displacement.
    bool
    shears() const
    {
      return !slip.empty() || !held_slip.empty();
    }

    double
    normal_displacement(const VectorView &s) const
    {
      double sum = offset;
      for (unsigned int k = 0; k < n_nodes; ++k)
        sum += shape[k] * s(index[k]);
      return sum;
    }

    /// The displacement that stretches bonds.
    Jump<dim>
    jump(const VectorView &s) const
    {
      Jump<dim> result = {std::min(normal_displacement(s), 0.), slip_offset};
      for (const Slip &part : slip)
        result.tangential += s(part.index) * part.direction;
      return result;
    }

    /// Minus the opening in terms of the law, which is that of bonds of unit
    /// length.
    double
    scaled_displacement(const VectorView &s) const
    {
      return shears() ? scaled_displacement(jump(s)) :
                        normal_displacement(s) / bonds.length;
    }

    double
    scaled_displacement(const Jump<dim> &jump) const
    {
      return -std::sqrt(jump.product(jump, bonds.shear)) / bonds.length;
    }

    /// Calls @p visit (unknown, derivative of the jump by it) for all unknowns
    /// of a point whose bonds shear.
    template <typename Visit>
    void
    for_each_unknown(const Visit &visit) const
    {
      for (unsigned int k = 0; k < n_nodes; ++k)
        visit(index[k], Jump<dim>{shape[k], {}});
      for (const Slip &part : slip)
        visit(part.index, Jump<dim>{0., part.direction});
    }

    /// The factor of the law's derivative in forces.
    double
    force_factor() const
    {
      return weight * bonds.energy / bonds.length;
    }
  };



  /**
   * The quadrature points of the contact boundary with their weights and bonds.
   * The vector s has the nodal values (of degree 2: the coefficients) in the
   * order of ContactBoundary::nodes, and those along tangents after them; the
   * displacements of vertices that are no nodes are prescribed, and grow with
   * the load.
   *
   * With nodal quadrature the first points are the nodes in their order, one
   * for all faces around each; the others follow face by face. At the end are
   * those of bonds in shear that break by themselves.
   *
   * Keeps references to its arguments.
   */
  template <int dim>
  class ContactPoints
  {
  public:
    using Face        = typename ContactBoundary<dim>::Face;
    using Trace       = typename ContactQuadrature<dim>::Trace;
    using Barycentric = std::array<double, dim>;

    /// Bonds are those of @p law everywhere if @p bond_field is null. Throws as
    /// BondField does.
    ContactPoints(const ContactBoundary<dim>   &contact_boundary,
                  const AdhesiveLaw            &law,
                  const ContactQuadrature<dim> &quadrature_rule,
                  const BondField<dim>         *bond_field);

    const ContactBoundary<dim> &
    boundary() const
    {
      return contact;
    }

    const std::vector<ContactPoint<dim>> &
    list() const
    {
      return points;
    }

    /// Prescribes @p factor times the displacements for the whole load.
    void
    set_factor(const double factor);

    /// Gives the bonds of each point what they have with this part of shear; an
    /// empty list is of zeros.
    void
    set_modes(const std::vector<double> &by_point);

    /// Returns whether what bonds take depends on the mode.
    bool
    depends_on_mode() const
    {
      return field != nullptr && field->depends_on_mode();
    }

    /// The bonds of the point number @p q with the part @p m of shear.
    BondScale
    at_mode(const std::size_t q, const double m) const
    {
      return at_mode(in_opening[q], m);
    }

    /// Returns whether all points are vertices, so that each node has a law of
    /// its own.
    bool
    is_nodal() const
    {
      return quadrature.is_nodal();
    }

    /// Returns whether bonds are not the same everywhere.
    bool
    has_field() const
    {
      return field != nullptr;
    }

    /// Returns the coefficients on a face, see bernstein(), of what has these
    /// @p values at all points: by least squares or, if the rule has less
    /// points than coefficients, the largest value for each.
    Trace
    coefficients(const Face &face, const std::vector<double> &values) const;

    /// The number of the point of the rule on a face that is next to a place,
    /// by the face's barycentric coordinates.
    unsigned int
    nearest(const Face &face, const Barycentric &place) const;

    /// The bonds at a position on the boundary @p id, as the scene has them.
    BondScale
    bonds_at(const dealii::Point<dim>        &position,
             const dealii::types::boundary_id id) const
    {
      return with_law(field == nullptr ? BondScale() : field->at(position, id));
    }

    BondScale
    bonds_at(const Face &face, const Barycentric &place) const;

    /// The bonds at a node. Where boundaries with bonds of their own meet they
    /// have the mean stiffness and fracture energy.
    BondScale
    bonds_at(const unsigned int node) const
    {
      if (field == nullptr)
        return with_law({});
      return modes.empty() ?
               bonds_of_nodes[node] :
               at_mode(bonds_of_nodes[node], modes_of_nodes[node]);
    }

    /// The coefficients of the displacement on a face, see bernstein().
    Trace
    trace_on(const Face &face, const VectorView &s) const;

    /// The displacement at a place on a face.
    double
    trace(const Face        &face,
          const Barycentric &place,
          const VectorView  &s) const;

    /// A point at a place on a face with the bonds there, without a weight.
    ContactPoint<dim>
    point_at(const Face &face, const Barycentric &place) const;

    /// How far bonds are opened at a place on a face: minus trace(), or where
    /// they shear in all directions.
    double
    opening(const Face        &face,
            const Barycentric &place,
            const VectorView  &s) const
    {
      const ContactPoint<dim> point = point_at(face, place);
      return point.shears() ?
               -point.bonds.length * point.scaled_displacement(s) :
               -trace(face, place, s);
    }

  private:
    /// A prescribed coefficient on a face.
    double
    held_trace(const Face &face, const unsigned int k) const;

    /// Adds to a point on @p face the displacements along tangents of its
    /// coefficients, which have these @p shape functions.
    void
    add_slip(const Face        &face,
             const Trace       &shape,
             ContactPoint<dim> &point) const;

    /// Where bonds in shear break by themselves they have a point of their own.
    void
    separate_shear();

    /// Returns @p bonds with their own law, see BondScale::law.
    BondScale
    with_law(BondScale bonds) const;

    BondScale
    at_mode(const BondScale &bonds, const double m) const
    {
      return m == 0. ? bonds : with_law(field->at_mode(bonds, m));
    }

    /// The bonds at a place in opening.
    BondScale
    in_opening_at(const Face &face, const Barycentric &place) const;

    /// Makes bonds_of_nodes, in opening, and bonds_of_held.
    void
    collect_bonds();

    void
    collect_points();

    const ContactBoundary<dim>   &contact;
    const AdhesiveLaw            &law;
    const ContactQuadrature<dim> &quadrature;
    const BondField<dim>         *field;

    /// In opening; empty if bonds are the same everywhere.
    std::vector<BondScale> bonds_of_nodes, bonds_of_held;

    double              load_factor = 1.;
    std::vector<double> modes, modes_of_nodes; ///< set_modes()

    std::vector<ContactPoint<dim>> points;
    std::vector<BondScale>         in_opening; ///< of the points
    std::vector<unsigned int>      places;     ///< in `points`, face by face
  };
} // namespace Debond

#endif
