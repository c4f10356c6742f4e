// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/face_groups.h>
#include <debond/mesh/field_value.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    /// Finds the faces of a group and turns them alike.
    template <int dim>
    class FaceGroup
    {
    public:
      FaceGroup(const Cut<dim>                   &cut,
                const PieceNames                 &names,
                const dealii::Triangulation<dim> &mesh)
        : cut(cut)
        , points(mesh.get_vertices())
      {
        take_faces(names, mesh);
        turn_alike();
      }

      std::vector<CutFace<dim>> faces;

    private:
      /// What two faces that hang together share: a vertex, in 3D an edge.
      using Ridge = std::array<unsigned int, dim - 1>;

      [[noreturn]] void
      fail(const std::string &what, const unsigned int vertex) const
      {
        throw std::invalid_argument("the group " + cut.group + what +
                                    point_text(points[vertex]));
      }

      void
      take_faces(const PieceNames                 &names,
                 const dealii::Triangulation<dim> &mesh)
      {
        std::set<dealii::types::manifold_id> inner;
        std::set<dealii::types::boundary_id> outer;
        if (names.inner_groups.count(cut.group) > 0)
          inner = names.inner_groups.at(cut.group).ids;
        if (names.boundaries.count(cut.group) > 0)
          outer = names.boundaries.at(cut.group);
        std::vector<CutFace<dim>> outside;
        for (const auto &cell : mesh.active_cell_iterators())
          for (const unsigned int f : cell->face_indices())
            {
              const auto face     = cell->face(f);
              const bool is_outer = face->at_boundary();
              if (is_outer ? outer.count(face->boundary_id()) == 0 :
                             inner.count(face->manifold_id()) == 0)
                continue;
              auto other = cell;
              if (!is_outer)
                other = cell->neighbor(f);
              // A face inside is visited from both of its cells.
              if (other->active_cell_index() < cell->active_cell_index())
                continue;
              std::vector<unsigned int> vertices;
              for (const unsigned int v : face->vertex_indices())
                vertices.push_back(face->vertex_index(v));
              (is_outer ? outside : faces)
                .push_back({cell->face_index(f),
                            {{cell, other}},
                            {{vertices, vertices}},
                            face->boundary_id()});
            }
        if (faces.empty() && outside.empty())
          throw std::invalid_argument("the group " + cut.group +
                                      " has no face inside the body");
        if (!faces.empty() && !outside.empty())
          fail(" lies inside the body and on its outside, which cannot be cut "
               "off: leave out its faces there, as at ",
               outside[0].vertices[0][0]);
        join_pairs(outside);
      }

      /// Makes one face of each two outer ones at the same place, as files have
      /// them whose crack is open already.
      void
      join_pairs(const std::vector<CutFace<dim>> &outside)
      {
        // Pairs are found by their centres and compared by their vertices.
        std::vector<dealii::Point<dim>> centres;
        for (const CutFace<dim> &face : outside)
          {
            dealii::Point<dim> sum;
            for (const unsigned int v : face.vertices[0])
              sum += points[v];
            centres.push_back(sum / dim);
          }
        const auto tree = dealii::pack_rtree_of_indices(centres);
        for (std::size_t k = 0; k < outside.size(); ++k)
          {
            const auto  &own = outside[k].vertices[0];
            const double near =
              Tolerance::same_place * points[own[0]].distance(points[own[1]]);
            dealii::BoundingBox<dim> box(
              std::vector<dealii::Point<dim>>{centres[k]});
            box.extend(near);
            std::vector<std::size_t> found;
            tree.query(boost::geometry::index::intersects(box),
                       std::back_inserter(found));
            // The vertices of the other face at the places of its own.
            std::vector<unsigned int> twins;
            const std::size_t         other =
              found.size() == 2 ? found[found[0] == k ? 1 : 0] : k;
            if (other != k)
              for (const unsigned int v : own)
                for (const unsigned int w : outside[other].vertices[0])
                  if (points[v].distance(points[w]) <= near)
                    {
                      twins.push_back(w);
                      joined[v] = std::min(v, w);
                    }
            if (twins.size() != dim)
              fail(
                " lies on the outside of the body, where only two of its faces "
                "at one place can be the sides of a cut, unlike at ",
                own[0]);
            if (k < other)
              faces.push_back({outside[k].index,
                               {{outside[k].cells[0], outside[other].cells[0]}},
                               {{own, twins}},
                               outside[k].before});
          }
      }

      /// The corners of a face, in the order in which the normal by the right
      /// hand points out of its low cell.
      std::vector<unsigned int>
      corners(const CutFace<dim> &face) const
      {
        // Cells have positive volumes. Without the vertex v the others have the
        // sign of v in the boundary of a simplex.
        std::vector<unsigned int> result;
        bool                      is_turned = false;
        for (const unsigned int v : face.cells[0]->vertex_indices())
          {
            const unsigned int w   = face.cells[0]->vertex_index(v);
            const auto        &own = face.vertices[0];
            if (std::find(own.begin(), own.end(), w) != own.end())
              result.push_back(w);
            else
              is_turned = v % 2 == 1;
          }
        if (is_turned)
          std::swap(result[0], result[1]);
        return result;
      }

      /// The ridges of a face with the directions that these corners give them.
      std::vector<std::pair<Ridge, bool>>
      ridges(const CutFace<dim> &face) const
      {
        // The direction is the sign of the ridge without the corner i in the
        // boundary of the face, times that of sorting its ends. Faces that are
        // turned alike give a ridge opposite ones. The vertices at one place of
        // an open crack count as one.
        std::vector<std::pair<Ridge, bool>> result;
        for (unsigned int i = 0; i < dim; ++i)
          {
            std::vector<unsigned int> ends = corners(face);
            ends.erase(ends.begin() + i);
            for (unsigned int &v : ends)
              if (joined.count(v) > 0)
                v = joined.at(v);
            const bool is_sorted = std::is_sorted(ends.begin(), ends.end());
            std::sort(ends.begin(), ends.end());
            Ridge ridge;
            std::copy(ends.begin(), ends.end(), ridge.begin());
            result.emplace_back(ridge, (i % 2 == 0) == is_sorted);
          }
        return result;
      }

      void
      turn_alike()
      {
        std::map<Ridge, std::map<std::size_t, bool>> faces_at; // and directions
        for (std::size_t k = 0; k < faces.size(); ++k)
          for (const auto &[ridge, direction] : ridges(faces[k]))
            if (faces_at[ridge].emplace(k, direction);
                faces_at[ridge].size() > 2)
              fail(" branches, and cannot be cut along as one, at ", ridge[0]);
        std::vector<int> turns(faces.size(), 0); // 1 or -1 once it is known
        for (std::size_t first = 0; first < faces.size(); ++first)
          {
            if (turns[first] != 0)
              continue;
            std::vector<std::size_t> piece{first};
            turns[first] = 1;
            for (std::size_t k = 0; k < piece.size(); ++k)
              for (const auto &[ridge, direction] : ridges(faces[piece[k]]))
                for (const auto &[other, of_other] : faces_at[ridge])
                  if (other != piece[k])
                    {
                      const int turn = of_other == direction ?
                                         -turns[piece[k]] :
                                         turns[piece[k]];
                      if (turns[other] == -turn)
                        fail(" has one side only, as a twisted band: it cannot "
                             "be cut along as one, at ",
                             ridge[0]);
                      if (turns[other] == 0)
                        piece.push_back(other);
                      turns[other] = turn;
                    }
            choose_high_side(piece, turns);
          }
      }

      void
      choose_high_side(const std::vector<std::size_t> &piece,
                       const std::vector<int>         &turns)
      {
        // By the divergence theorem the normals of a closed surface have the
        // sum zero, and their products with places have the volume inside,
        // which is positive if they point out of it. The places are relative to
        // a vertex, since the sum is not exactly zero. A tube that is open at
        // its ends has no such sum either.
        const dealii::Point<dim> &origin =
          points[faces[piece[0]].vertices[0][0]];
        dealii::Tensor<1, dim> sum;
        double                 area = 0., high = 0.;
        for (const std::size_t k : piece)
          {
            const std::vector<unsigned int> own = corners(faces[k]);
            dealii::Tensor<1, dim> normal = points[own[1]] - points[own[0]];
            if constexpr (dim == 2)
              normal = dealii::cross_product_2d(normal);
            else
              normal =
                dealii::cross_product_3d(normal,
                                         points[own[2]] - points[own[0]]);
            sum += turns[k] * normal;
            area += normal.norm();
            for (const unsigned int v : own)
              high += turns[k] * normal * (points[v] - origin);
          }
        if (sum.norm() > Tolerance::closed_surface * area)
          {
            // Of coordinates that are equal but for rounding the first decides,
            // as on a diagonal.
            sum  = transpose(cut.rotation) * sum;
            high = sum[0];
            for (unsigned int d = 1; d < dim; ++d)
              if (std::abs(sum[d]) >
                  (1. + Tolerance::closed_surface) * std::abs(high))
                high = sum[d];
          }
        for (const std::size_t k : piece)
          if (turns[k] * high < 0.)
            {
              std::swap(faces[k].cells[0], faces[k].cells[1]);
              std::swap(faces[k].vertices[0], faces[k].vertices[1]);
            }
      }

      const Cut<dim>                        &cut;
      const std::vector<dealii::Point<dim>> &points;

      /// One for the two vertices at a place on an open crack.
      std::map<unsigned int, unsigned int> joined;
    };
  } // namespace



  template <int dim>
  std::vector<CutFace<dim>>
  faces_of_group(const Cut<dim>                   &cut,
                 const PieceNames                 &names,
                 const dealii::Triangulation<dim> &mesh)
  {
    return FaceGroup<dim>(cut, names, mesh).faces;
  }



  DEBOND_INSTANTIATE(faces_of_group);
} // namespace Debond
