// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/field_value.h>
#include <debond/mesh/interfaces.h>
#include <debond/mesh/overlap.h>

namespace Debond
{
  namespace
  {
    /// The outer faces that one side of an interface may have.
    template <int dim>
    struct InterfaceSide
    {
      std::vector<typename dealii::Triangulation<dim>::face_iterator> faces;
      std::vector<Facet<dim>>                                         facets;
    };



    /// The outer faces of cells for which this holds.
    template <int dim, typename Predicate>
    InterfaceSide<dim>
    outer_faces(const dealii::Triangulation<dim> &mesh, const Predicate &is_in)
    {
      InterfaceSide<dim> side;
      for (const auto &cell : mesh.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && is_in(cell, face))
            {
              Facet<dim> facet;
              for (unsigned int v = 0; v < dim; ++v)
                {
                  facet.vertices[v] = face->vertex_index(v);
                  facet.corners[v]  = face->vertex(v);
                }
              dealii::Tensor<1, dim> normal;
              if constexpr (dim == 2)
                normal =
                  dealii::cross_product_2d(facet.corners[1] - facet.corners[0]);
              else
                normal =
                  dealii::cross_product_3d(facet.corners[1] - facet.corners[0],
                                           facet.corners[2] - facet.corners[0]);
              if (normal * (face->center() - cell->center()) < 0.)
                normal *= -1.;
              facet.normal = normal / normal.norm();
              side.faces.push_back(face);
              side.facets.push_back(facet);
            }
      return side;
    }



    /// The faces of a boundary, or all outer ones of a region.
    template <int dim>
    InterfaceSide<dim>
    faces_of(const std::string                &name,
             const PieceNames                 &names,
             const dealii::Triangulation<dim> &mesh)
    {
      const auto boundary = names.boundaries.find(name);
      return outer_faces(mesh, [&](const auto &cell, const auto &face) {
        return boundary != names.boundaries.end() ?
                 boundary->second.count(face->boundary_id()) > 0 :
                 names.regions.at(name).count(cell->material_id()) > 0;
      });
    }



    /// Whether each facet of the high side lies on the low one by more than
    /// half of it, and whether something of these lies on each of the low side,
    /// which may be much larger.
    template <int dim>
    std::array<std::vector<char>, 2>
    lie_on_each_other(const std::vector<Facet<dim>> &high,
                      const std::vector<Facet<dim>> &low)
    {
      const auto overlaps =
        find_overlaps(apart(high), low, Tolerance::touching);
      std::array<std::vector<char>, 2> result;
      for (const double part : covered_parts(high, overlaps))
        result[0].push_back(part > 0.5);
      std::vector<double> by_high(low.size(), 0.);
      for (const Overlap<dim> &overlap : overlaps)
        if (result[0][overlap.first])
          for (const auto &point : overlap.points)
            by_high[overlap.second] +=
              point.weight / high[overlap.first].size();
      for (const double part : by_high)
        result[1].push_back(part > Tolerance::same_place);
      return result;
    }



    /// Gives the faces of a region that lie on the other side ids of their own,
    /// which all names of the faces have as well.
    template <int dim>
    std::set<dealii::types::boundary_id>
    separate(const InterfaceSide<dim>         &side,
             const std::vector<char>          &is_on_interface,
             const dealii::Triangulation<dim> &mesh,
             PieceNames                       &names)
    {
      dealii::types::boundary_id next = 0;
      for (const auto id : mesh.get_boundary_ids())
        next = std::max<dealii::types::boundary_id>(next, id + 1);
      std::map<dealii::types::boundary_id, dealii::types::boundary_id> new_ids;
      std::set<dealii::types::boundary_id>                             ids;
      for (unsigned int f = 0; f < side.faces.size(); ++f)
        if (is_on_interface[f])
          {
            const auto [entry, is_new] =
              new_ids.emplace(side.faces[f]->boundary_id(), next);
            next += is_new;
            ids.insert(entry->second);
            side.faces[f]->set_boundary_id(entry->second);
          }
      const auto in_use = mesh.get_boundary_ids();
      for (auto &[unused, of_name] : names.boundaries)
        for (const auto &[old_id, new_id] : new_ids)
          if (of_name.count(old_id) > 0)
            {
              of_name.insert(new_id);
              // Names have no ids that do not occur.
              if (std::count(in_use.begin(), in_use.end(), old_id) == 0)
                of_name.erase(old_id);
            }
      return ids;
    }



    /// Moves the vertices of a high side that lies on the low one, but for
    /// those at its edge, along their normals to where the distance is zero in
    /// the mean.
    template <int dim>
    void
    close_curved_side(const std::set<dealii::types::boundary_id> &high_ids,
                      const InterfaceSide<dim>                   &low,
                      const dealii::Triangulation<dim>           &mesh)
    {
      // The facets of a curve on two meshes are apart by the square of their
      // lengths, between vertices that are on the curve. If the side that
      // carries the jumps is what the projection P makes of the other one,
      // turning both bodies together has no jumps, and what acts across the
      // curve is of second order. See MortarInterface for the functions psi; on
      // a facet that is covered psi_i = (dim + 1) phi_i - 1. Each round leaves
      // a small part of the distances.
      const auto is_high = [&](const auto &, const auto &face) {
        return high_ids.count(face->boundary_id()) > 0;
      };
      std::set<unsigned int> at_edge;
      for (const Facet<dim> &facet :
           outer_faces(mesh, [&](const auto &cell, const auto &face) {
             return !is_high(cell, face);
           }).facets)
        at_edge.insert(facet.vertices.begin(), facet.vertices.end());
      for (unsigned int round = 0; round < 5; ++round)
        {
          const InterfaceSide<dim> high = outer_faces(mesh, is_high);
          const auto               overlaps =
            find_overlaps(high.facets, low.facets, Tolerance::touching);
          const auto parts = covered_parts(high.facets, overlaps);
          if (*std::min_element(parts.begin(), parts.end()) <
                Tolerance::covered ||
              !touch(high.facets, low.facets, overlaps))
            return;
          struct Sums
          {
            double                 weight = 0., distance = 0.;
            dealii::Tensor<1, dim> normal = {};
          };
          std::map<unsigned int, Sums> sums;
          for (const Overlap<dim> &overlap : overlaps)
            for (const auto &point : overlap.points)
              for (unsigned int v = 0; v < dim; ++v)
                {
                  const Facet<dim> &facet = high.facets[overlap.first];
                  const double      psi =
                    point.weight * ((dim + 1.) * point.on_first[v] - 1.);
                  Sums &of_vertex = sums[facet.vertices[v]];
                  of_vertex.weight += psi;
                  of_vertex.distance += psi * point.distance;
                  of_vertex.normal += point.weight * facet.normal;
                }
          for (std::size_t f = 0; f < high.faces.size(); ++f)
            for (unsigned int v = 0; v < dim; ++v)
              if (const auto at = sums.find(high.facets[f].vertices[v]);
                  at != sums.end() && at_edge.count(at->first) == 0)
                {
                  const double way = at->second.distance / at->second.weight;
                  if (std::abs(way) >
                      Tolerance::same_cell * high.facets[f].corners[0].distance(
                                               high.facets[f].corners[1]))
                    high.faces[f]->vertex(v) +=
                      way / at->second.normal.norm() * at->second.normal;
                  sums.erase(at);
                }
        }
    }
  } // namespace



  template <int dim>
  PieceNames
  name_interfaces(const std::vector<Interface> &interfaces,
                  PieceNames                    names,
                  dealii::Triangulation<dim>   &mesh)
  {
    std::set<dealii::types::boundary_id> taken;
    for (const Interface &interface : interfaces)
      {
        const std::array<std::string, 2> sides = {
          {interface.high, interface.low}};
        std::array<InterfaceSide<dim>, 2> all;
        for (unsigned int k = 0; k < 2; ++k)
          all[k] = faces_of(sides[k], names, mesh);
        const auto is_region = [&](const unsigned int k) {
          return names.boundaries.count(sides[k]) == 0;
        };
        // What lies on the other side is found before any id changes.
        std::array<std::vector<char>, 2> is_on_interface;
        if (is_region(0) || is_region(1))
          is_on_interface = lie_on_each_other(all[0].facets, all[1].facets);
        for (unsigned int k = 0; k < 2; ++k)
          if (is_region(k) && std::count(is_on_interface[k].begin(),
                                         is_on_interface[k].end(),
                                         1) == 0)
            throw EntryError(
              "Mesh/Interfaces",
              words("no outer face of the region ",
                    sides[k],
                    " lies on ",
                    sides[1 - k],
                    "; regions of one mesh that have vertices in common are "
                    "cut apart by Mesh/Cuts = ",
                    interface.low,
                    " | ",
                    interface.high,
                    ", and sides with a gap between them are named as "
                    "boundaries"));
        const auto refuse_taken = [&](const unsigned int               k,
                                      const dealii::types::boundary_id id) {
          if (taken.count(id) > 0)
            throw EntryError("Mesh/Interfaces",
                             words(sides[k],
                                   " has faces that are on two sides of "
                                   "interfaces: ",
                                   boundary_name(names.boundaries, id)));
        };
        std::array<std::set<dealii::types::boundary_id>, 2> ids;
        for (unsigned int k = 0; k < 2; ++k)
          if (is_region(k))
            for (unsigned int f = 0; f < all[k].faces.size(); ++f)
              if (is_on_interface[k][f])
                refuse_taken(k, all[k].faces[f]->boundary_id());
        for (unsigned int k = 0; k < 2; ++k)
          ids[k] = is_region(k) ?
                     separate(all[k], is_on_interface[k], mesh, names) :
                     names.boundaries.at(sides[k]);
        for (unsigned int k = 0; k < 2; ++k)
          for (const auto id : ids[k])
            {
              refuse_taken(k, id);
              taken.insert(id);
            }
        close_curved_side(ids[0],
                          outer_faces(mesh,
                                      [&](const auto &, const auto &face) {
                                        return ids[1].count(
                                                 face->boundary_id()) > 0;
                                      }),
                          mesh);
        names.boundaries[interface.name + "_high"] = ids[0];
        names.boundaries[interface.name + "_low"]  = ids[1];
        ids[0].insert(ids[1].begin(), ids[1].end());
        names.boundaries[interface.name] = ids[0];
        names.interfaces.insert(interface.name);
      }
    return names;
  }



  DEBOND_INSTANTIATE(name_interfaces);
} // namespace Debond
