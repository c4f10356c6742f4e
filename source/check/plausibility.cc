// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_tools.h>

#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/check/plausibility.h>
#include <debond/mesh/owned_cells.h>

namespace Debond
{
  template <int dim>
  LargestValues
  largest_values(const ElasticProblem<dim> &problem,
                 const DofVector           &u,
                 const LoadFactors          factors)
  {
    // All ranks have the displacements of all nodes, while gradients and
    // stresses are those of their own cells, and need the largest of all ranks.
    const DofVector displacement =
      problem.unknowns().cartesian_displacement(u, factors);
    LargestValues largest;
    for (unsigned int i = 0; i < displacement.size(); i += dim)
      {
        dealii::Tensor<1, dim> at_node;
        for (unsigned int d = 0; d < dim; ++d)
          at_node[d] = displacement(i + d);
        largest.displacement = std::max(largest.displacement, at_node.norm());
      }
    CellStresses<dim> means(problem.fields(), displacement, factors);
    for (const auto &cell : owned_cells(problem.unknowns().dof_handler()))
      {
        means.reinit(cell);
        largest.gradient = std::max(largest.gradient, means.gradient(0).norm());
        largest.von_mises =
          std::max(largest.von_mises, von_mises(means.stress(0)));
      }
    const MPI_Comm ranks = problem.unknowns().communicator();
    largest.gradient     = dealii::Utilities::MPI::max(largest.gradient, ranks);
    largest.von_mises = dealii::Utilities::MPI::max(largest.von_mises, ranks);
    return largest;
  }



  template <int dim>
  double
  faces_in_softening_zone(const ElasticProblem<dim>   &problem,
                          const AdhesionIntegral<dim> &adhesion)
  {
    // Along the boundary bonds soften over about E' G / strength^2, and a front
    // is resolved if some faces fit into this length. Bonds that never soften,
    // or that take energy without end, have no such length.
    const AdhesiveLaw &law = adhesion.adhesive_law();
    if (!law.softens() || !std::isfinite(law.pieces().largest_value()))
      return infinity;

    // All ranks know all faces of the contact boundary, but only the materials
    // of their own cells. So the number of faces over E' is kept by cell, and
    // E' multiplies it in the loop over own cells.
    const auto         &handler = problem.unknowns().dof_handler();
    std::vector<double> faces_by_modulus(
      handler.get_triangulation().n_global_active_cells(), infinity);
    std::array<double, dim> middle;
    middle.fill(1. / dim);
    for (const auto &face : adhesion.contact_boundary().faces)
      if (const BondScale bonds = adhesion.points().bonds_at(face, middle);
          bonds.energy > 0.)
        {
          const double strength =
            law.bond_strength() * bonds.energy / bonds.length;
          // G is the law's largest energy per area times that of the bonds
          // here. The size of a face divides the length of the zone.
          double &faces = faces_by_modulus[face.cell];
          faces         = std::min(faces,
                           bonds.law->pieces().largest_value() * bonds.energy /
                             (strength * strength * face.size()));
        }
    double least = infinity;
    for (const auto &cell : owned_cells(handler))
      {
        const Material &material = problem.fields().material(cell);
        least                    = std::min(least,
                         material.plane_modulus<dim>() *
                           faces_by_modulus[cell->id().get_coarse_cell_id()]);
      }
    return dealii::Utilities::MPI::min(least,
                                       problem.unknowns().communicator());
  }



  namespace
  {
    /// A zone that softens with fewer faces in it moves in jumps from node to
    /// node.
    constexpr double least_faces_in_zone = 3.;

    /// What faces may press with, to what all bonds could bear.
    constexpr double largest_pressure_by_facets = 0.01;

    /// Beyond it the strains of linear elasticity are wrong by some percent.
    constexpr double largest_small_gradient = 0.05;
  } // namespace



  std::vector<std::string>
  plausibility_notes(const LargestValues &largest,
                     const double         faces_in_softening_zone,
                     const double         cell_size_at_edge)
  {
    std::vector<std::string> notes;
    const auto               add = [&notes](const auto &...parts) {
      notes.push_back(words(std::setprecision(2), parts...));
    };

    if (largest.gradient > largest_small_gradient)
      add("displacement gradients up to ",
          largest.gradient,
          " are beyond linear elasticity, which is for small strains and "
          "rotations, below about ",
          largest_small_gradient);
    if (faces_in_softening_zone < least_faces_in_zone)
      add("the zone in which bonds soften, about E' G / strength^2 long, has ",
          faces_in_softening_zone,
          " faces of the contact boundary, which should be three at least: "
          "fronts move in jumps, and forces are off by some 5 % with one face, "
          "by less than 1 % with two. Take smaller cells there, or a lower "
          "strength with the same energy");
    if (cell_size_at_edge > Tolerance::cell_size_at_edge)
      // What doc/guide/load-path.md measures.
      add("E*/a is about ",
          1. / cell_size_at_edge,
          " cells where bonds end: a path breaks late there, by up to some ",
          70. * std::pow(cell_size_at_edge, 0.75),
          " %. Take smaller cells there");
    return notes;
  }



  template <int dim>
  std::vector<std::string>
  bond_notes(const dealii::Triangulation<dim>    &body,
             const std::vector<ContactNodeState> &nodes)
  {
    // Bonds that are broken at rest, or that break beyond the size of the body,
    // mostly have a wrong unit. The gap at rest is u_nu - s, whatever the load,
    // and opens bonds by as much.
    double      least_threshold = infinity;
    std::size_t n_bonds = 0, n_broken = 0;
    for (const ContactNodeState &node : nodes)
      if (node.branch != BondState::free)
        {
          const double gap = node.u_nu - node.s;
          least_threshold  = std::min(least_threshold, node.bond_threshold);
          ++n_bonds;
          n_broken += gap > node.bond_threshold;
        }
    if (nodes.empty())
      return {};
    if (!std::isfinite(least_threshold))
      return {"no node of the contact boundary has bonds"};
    if (n_broken > 0)
      return {
        words(n_broken == n_bonds ?
                "all bonds" :
                words("the bonds of ", n_broken, " of ", n_bonds, " nodes"),
              " are broken at rest: the initial gap is beyond their "
              "threshold")};
    // The body's thickness is the least side of its box, of which each rank has
    // that of its own cells.
    const auto box  = dealii::GridTools::compute_bounding_box(body);
    double     size = infinity;
    for (unsigned int d = 0; d < dim; ++d)
      size = std::min(size,
                      dealii::Utilities::MPI::max(box.upper_bound(d),
                                                  body.get_communicator()) -
                        dealii::Utilities::MPI::min(box.lower_bound(d),
                                                    body.get_communicator()));
    if (least_threshold > size)
      return {words("bonds break beyond an opening of ",
                    least_threshold,
                    ", more than the body's thickness, ",
                    size,
                    "; are they in the same unit?")};
    return {};
  }



  template <int dim>
  std::vector<std::string>
  sliding_notes(const AdhesionIntegral<dim> &adhesion,
                const Verification<dim>     &verification,
                const bool                   are_glued,
                const bool                   is_curved)
  {
    // Two sums of forces are compared with what all bonds could bear, the sum
    // of their strengths times the measures of their nodes. One is of the
    // forces along the boundary at nodes whose bonds do not shear, which are
    // held there; of what is free to slide they are zero. The other one is of
    // the pressures at nodes that slide, as their bonds have broken, where the
    // flat faces of a curved boundary may lock.
    double along = 0., could_bear = 0., pressed = 0.;
    for (unsigned int i = 0; i < adhesion.n_nodes(); ++i)
      {
        const ContactNodeState &node  = verification.nodes[i];
        const BondScale         bonds = adhesion.points().bonds_at(i);
        could_bear += adhesion.adhesive_law().bond_strength() * bonds.energy /
                      bonds.length *
                      adhesion.contact_boundary().nodes[i].measure;
        if (!node.mode_mixity)
          along += verification.tangential_forces[i].norm();
        else if (node.state == BondState::broken_but_closed ||
                 node.shear_damage == 1.)
          pressed += std::max(0., node.normal_force);
      }

    std::vector<std::string> notes;
    if (are_glued && along > could_bear && could_bear > 0.)
      notes.push_back(
        words("the contact boundary bears ",
              along,
              " along itself, its bonds could bear ",
              could_bear,
              ": Contact law/Tangential displacement = fixed lets "
              "nothing slide, not even where bonds are broken; "
              "bonded lets them shear and break"));
    if (is_curved && pressed > largest_pressure_by_facets * could_bear)
      notes.push_back(
        words("bodies that slide along a curved contact boundary "
              "press on each other with ",
              pressed,
              " where bonds are broken: the flat faces of the "
              "mesh lock. Give the normals of the smooth boundary "
              "as Boundary conditions/Foundation normal"));
    return notes;
  }



  DEBOND_INSTANTIATE(sliding_notes);
  DEBOND_INSTANTIATE(bond_notes);
  DEBOND_INSTANTIATE(faces_in_softening_zone);
  DEBOND_INSTANTIATE(largest_values);
} // namespace Debond
