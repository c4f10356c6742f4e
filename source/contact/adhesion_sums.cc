// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/contact/adhesion_sums.h>

namespace Debond
{
  template <int dim>
  double
  open_measure(const AdhesionIntegral<dim> &phi, const VectorView &s)
  {
    // A point is open if it is lifted off and nothing can pull on it: its bonds
    // are broken, be it now or by their memory, or there are none.
    double sum = 0.;
    phi.for_each_point(s,
                       [&](const auto &point, double scaled, double reached) {
                         if (scaled < 0. && point.n_entries > 0 &&
                             (point.bonds.energy == 0. ||
                              std::min(reached, scaled) <
                                -point.bonds.law->broken_beyond()))
                           sum += point.weight;
                       });
    return sum;
  }



  template <int dim>
  std::vector<double>
  held_forces(const AdhesionIntegral<dim> &phi, const VectorView &s)
  {
    std::vector<double> forces(phi.contact_boundary().held_vertices.size(), 0.);
    // Vertices that stay at the foundation have no entry in the list.
    if (!forces.empty())
      phi.for_each_point(
        s, [&](const auto &point, double scaled, double reached) {
          if (point.shears())
            {
              // With bonds that shear the force is tau/l times the jump, along
              // the normal and, times the ratio of the stiffnesses, along the
              // boundary.
              const double stiffness = point.force_factor() /
                                       point.bonds.length *
                                       point.bonds.law->secant(scaled, reached);
              const Jump<dim> jump = point.jump(s);
              for (unsigned int k = point.n_nodes; k < point.n_entries; ++k)
                forces[point.index[k]] +=
                  stiffness * point.shape[k] * jump.normal;
              for (const auto &part : point.held_slip)
                forces[part.index] += stiffness * point.bonds.shear *
                                      (part.direction * jump.tangential);
              return;
            }
          // Entries from n_nodes on belong to held vertices, and their indices
          // count these and not the nodes.
          for (unsigned int k = point.n_nodes; k < point.n_entries; ++k)
            forces[point.index[k]] +=
              point.shape[k] * point.force_factor() *
              point.bonds.law->derivative(scaled, reached);
        });
    return forces;
  }



  template <int dim>
  Jump<dim>
  traction(const AdhesionIntegral<dim>                       &phi,
           const typename AdhesionIntegral<dim>::Face        &face,
           const typename AdhesionIntegral<dim>::Barycentric &place,
           const VectorView                                  &s)
  {
    // Displacement and bonds are known at any place, the memory only at the
    // points of the rule. Therefore that of the nearest point is taken.
    const ContactPoint<dim> point   = phi.points().point_at(face, place);
    const BondScale        &bonds   = point.bonds;
    const double            reached = phi.reached_at(face, place);
    const double            scaled  = point.scaled_displacement(s);
    if (!point.shears())
      return {bonds.energy / bonds.length *
                bonds.law->derivative(scaled, reached),
              {}};
    // Per area: the same as in Phi without the weight of a point.
    const double stiffness = bonds.energy / (bonds.length * bonds.length) *
                             bonds.law->secant(scaled, reached);
    Jump<dim> result = point.jump(s);
    result.normal *= stiffness;
    result.tangential *= stiffness * bonds.shear;
    return result;
  }



  template <int dim>
  std::vector<Jump<dim>>
  node_tractions(const AdhesionIntegral<dim> &phi, const VectorView &s)
  {
    std::vector<Jump<dim>> result(phi.n_nodes());
    for (const auto &face : phi.contact_boundary().faces)
      for (unsigned int k = 0; k < phi.contact_boundary().n_face_nodes(); ++k)
        if (!face.is_held(k))
          {
            // A node between faces has a place on each of them, with their
            // bonds there.
            const Jump<dim> here =
              traction(phi, face, coefficient_place<dim>(k), s);
            Jump<dim> &largest = result[face.node(k)];
            if (here.product(here, 1.) > largest.product(largest, 1.))
              largest = here;
          }
    return result;
  }



  template <int dim>
  std::vector<double>
  shear_damage(const AdhesionIntegral<dim> &phi, const VectorView &s)
  {
    // The mean over the points, each with its share of the unknown. Points of
    // bonds in shear that break by themselves have no entries for normal
    // displacements, which tells them from all others.
    std::vector<double> lost(phi.n_unknowns(), 0.), all(phi.n_unknowns(), 0.);
    phi.for_each_point(s,
                       [&](const auto &point, double scaled, double reached) {
                         if (point.n_entries > 0)
                           return;
                         const double damage =
                           point.bonds.law->damage(std::min(reached, scaled));
                         for (const auto &part : point.slip)
                           {
                             const double share =
                               point.weight * part.direction.norm();
                             lost[part.index] += share * damage;
                             all[part.index] += share;
                           }
                       });
    for (unsigned int i = 0; i < lost.size(); ++i)
      lost[i] = all[i] > 0. ? lost[i] / all[i] : 0.;
    return lost;
  }



  template <int dim>
  bool
  is_at_drop(const AdhesionIntegral<dim> &phi,
             const VectorView            &s,
             const double                 part)
  {
    // No minimiser sits on the concave kink where the traction drops, and so
    // close to it rounding decides which piece holds: nothing can be claimed of
    // such a state. A kink that bonds have passed for good by their memory is
    // left out.
    bool is_at = false;
    phi.for_each_point(s,
                       [&](const auto &point, double scaled, double reached) {
                         const auto &pieces = point.bonds.law->pieces();
                         for (unsigned int k = 0; k + 1 < pieces.size(); ++k)
                           is_at =
                             is_at ||
                             (point.bonds.energy > 0. && pieces.has_drop(k) &&
                              pieces[k].lower <= reached &&
                              std::abs(scaled - pieces[k].lower) <=
                                part * std::abs(scaled));
                       });
    return is_at;
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  least_second_derivative(const AdhesionIntegral<dim> &phi,
                          const VectorView            &s,
                          const double                 part)
  {
    // Rounding in s may put a bond on the wrong side of a kink. With the
    // smaller of the second derivatives on both sides, a positive definite S +
    // Phi'' means a local minimum on whichever side the bond is.
    return phi.matrix(
      s,
      [&](const AdhesiveLaw &law, const double scaled, const double reached) {
        return std::min(law.second_derivative((1. + part) * scaled, reached),
                        law.second_derivative((1. - part) * scaled, reached));
      },
      [&](const AdhesiveLaw &law, const double scaled, const double reached) {
        return law.secant((1. + part) * scaled, reached);
      });
  }



  template <int dim>
  Eigen::VectorXd
  lumped_weights(const AdhesionIntegral<dim> &phi)
  {
    // Row sums of the matrix for a law with j_1'' = 1 move all of the stiffness
    // to the diagonal. This is exact for nodal quadrature, and for an s that is
    // the same at all nodes.
    const unsigned int n = phi.n_unknowns();
    const auto one       = [](const AdhesiveLaw &, const double, const double) {
      return 1.;
    };
    return phi.matrix(Eigen::VectorXd::Zero(n), one, one) *
           Eigen::VectorXd::Ones(n);
  }



  DEBOND_INSTANTIATE(open_measure);
  DEBOND_INSTANTIATE(held_forces);
  DEBOND_INSTANTIATE(traction);
  DEBOND_INSTANTIATE(node_tractions);
  DEBOND_INSTANTIATE(shear_damage);
  DEBOND_INSTANTIATE(is_at_drop);
  DEBOND_INSTANTIATE(least_second_derivative);
  DEBOND_INSTANTIATE(lumped_weights);
} // namespace Debond
