// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/solve/minimum/lumped_bonds.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    /// Gives each bond the memory of its points: that of the least damaged one
    /// where there are several, which in nodal quadrature are the same.
    template <int dim>
    void
    remember(const AdhesionIntegral<dim> &adhesion, SeparableEnergy &energy)
    {
      if (adhesion.memory().reached.empty())
        return;
      constexpr double    none = -infinity;
      std::vector<double> reached(energy.f.size(), none);
      const auto add = [&](const unsigned int unknown, const double own) {
        double &of_bond =
          reached[energy.bonds.empty() ? unknown : energy.bonds[unknown]];
        of_bond = std::max(of_bond, own);
      };
      adhesion.for_each_point(Eigen::VectorXd::Zero(adhesion.n_unknowns()),
                              [&](const auto &point,
                                  double,
                                  const double scaled) {
                                if (point.bonds.energy == 0.)
                                  return;
                                const double own = scaled * point.bonds.length;
                                for (unsigned int k = 0; k < point.n_nodes; ++k)
                                  add(point.index[k], own);
                                for (const auto &part : point.slip)
                                  add(part.index, own);
                              });
      for (std::size_t i = 0; i < reached.size(); ++i)
        if (reached[i] != none)
          energy.f[i] = energy.f[i].after(reached[i]);
    }
  } // namespace



  template <int dim>
  std::vector<double>
  scales_of_bonds(const AdhesionIntegral<dim>                    &adhesion,
                  const std::vector<Eigen::SparseMatrix<double>> &prolongations)
  {
    if (!adhesion.points().has_field())
      return {};
    Eigen::VectorXd mean(adhesion.n_nodes());
    for (unsigned int i = 0; i < adhesion.n_nodes(); ++i)
      mean(i) = adhesion.points().bonds_at(i).length;
    // A coarse bond stands for the fine ones below it; its length is their
    // mean, weighted by the entries of P, which are not negative.
    for (const Eigen::SparseMatrix<double> &P : prolongations)
      mean = (P.transpose() * mean)
               .cwiseQuotient(P.transpose() * Eigen::VectorXd::Ones(P.rows()))
               .eval();
    return {mean.data(), mean.data() + mean.size()};
  }



  template <int dim>
  SeparableEnergy
  lumped_bonds(const AdhesionIntegral<dim> &adhesion, NeighbourGraph &graph)
  {
    // With nodal quadrature Phi is a sum over the nodes. With other rules this
    // is an approximation, in which row sums move all stiffness to the
    // diagonal, and which guides a search but proves nothing. If bonds shear,
    // each is a function of l = -sqrt(s^2 + r |t|^2) with the unknowns of its
    // node: `bonds` of the result says to which bond an unknown belongs, and
    // `weights` what its square counts in l.
    const PiecewiseEnergy &pieces  = adhesion.adhesive_law().pieces();
    const Eigen::VectorXd  weights = lumped_weights(adhesion);
    const unsigned int     n       = adhesion.n_nodes();
    SeparableEnergy        result =
      lumped_energy(pieces, weights.head(n), scales_of_bonds(adhesion));
    // Those of a node with a tail of its own are not those of the law.
    const auto energy_of = [](const BondScale &bonds, const double stiffness) {
      return bonds.law->pieces().scaled(stiffness * bonds.length * bonds.length,
                                        bonds.length);
    };
    for (unsigned int i = 0; i < n; ++i)
      if (const BondScale bonds = adhesion.points().bonds_at(i);
          bonds.tail != 1.)
        result.f[i] = energy_of(bonds, weights(i));
    if (!adhesion.shears())
      {
        remember(adhesion, result);
        return result;
      }
    result.friction                      = adhesion.kinks();
    const ContactBoundary<dim> &boundary = adhesion.contact_boundary();
    result.bonds.resize(weights.size());
    std::iota(result.bonds.begin(), result.bonds.begin() + n, 0);
    result.weights = Eigen::VectorXd::Ones(weights.size());
    // Bonds that break separately in shear, and those of vertices that are held
    // along the normal, are bonds of their own, with numbers after those of the
    // nodes. `weights` has the second derivative of Phi along the tangent for a
    // law with j_1'' = 1. The energy of the bond is this, times the square of
    // its length, over the ratio of the stiffnesses.
    std::vector<unsigned int> shear_bonds(n, 0); // of nodes, 0 is none
    const auto                add = [&](const auto      &vertex,
                         const BondScale &bonds,
                         const bool       has_own,
                         unsigned int     bond) {
      bool is_first = has_own;
      for (const auto &tangent : vertex.tangents)
        if (!tangent.is_held)
          {
            if (is_first)
              {
                is_first = false;
                bond = static_cast<unsigned int>(result.f.size());
                result.f.push_back(
                  energy_of(bonds, weights(tangent.index) / bonds.shear));
                graph.emplace_back();
              }
            result.bonds[tangent.index] = bond;
            // Without bonds any weight will do.
            if (bonds.shear > 0.)
              result.weights(tangent.index) = bonds.shear;
          }
      return bond;
    };
    for (unsigned int i = 0; i < n; ++i)
      {
        BondScale  bonds     = adhesion.points().bonds_at(i);
        const bool separates = bonds.shear_energy > 0.;
        // What only friction holds along the boundary has no energy here.
        if (bonds.shear == 0.)
          {
            bonds.shear = 1.;
            add(boundary.nodes[i], bonds, true, i);
            continue;
          }
        shear_bonds[i] = add(boundary.nodes[i],
                             separates ? bonds.in_shear() : bonds,
                             separates,
                             i);
      }
    for (unsigned int i = 0; i < n; ++i)
      // Bonds in shear are neighbours if their nodes are, so that a search
      // moves the edges of what slips as it moves those of what is open.
      if (shear_bonds[i] >= n)
        for (const unsigned int j : graph[i])
          if (shear_bonds[j] >= n)
            graph[shear_bonds[i]].insert(shear_bonds[j]);
    for (const auto &vertex : boundary.held_vertices)
      if (!vertex.tangents.empty())
        {
          BondScale bonds =
            adhesion.points().bonds_at(vertex.position, vertex.boundary);
          if (bonds.shear_energy > 0.)
            bonds = bonds.in_shear();
          if (bonds.shear == 0.)
            bonds.shear = 1.;
          add(vertex, bonds, true, 0);
        }
    remember(adhesion, result);
    return result;
  }



  template <int dim>
  bool
  is_sum_over_nodes(const AdhesionIntegral<dim> &adhesion)
  {
    // A bond with a prescribed displacement in its jump is no function of
    // unknowns alone: its l does not vanish with them.
    return adhesion.points().is_nodal() &&
           std::none_of(adhesion.points().list().begin(),
                        adhesion.points().list().end(),
                        [](const auto &point) {
                          return point.shears() && (point.offset != 0. ||
                                                    !point.held_slip.empty());
                        });
  }



  DEBOND_INSTANTIATE(scales_of_bonds);
  DEBOND_INSTANTIATE(lumped_bonds);
  DEBOND_INSTANTIATE(is_sum_over_nodes);
} // namespace Debond
