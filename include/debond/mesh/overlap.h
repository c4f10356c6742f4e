// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_overlap_h
#define debond_mesh_overlap_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace Debond
{
  /// A flat face of one side of an interface.
  template <int dim>
  struct Facet
  {
    std::array<unsigned int, dim>       vertices; ///< their numbers
    std::array<dealii::Point<dim>, dim> corners;
    dealii::Tensor<1, dim>              normal; ///< outward unit normal

    /// Length, in 3D twice the area.
    double
    size() const;
  };



  /// What a facet of one side and one of the other have in common: points for
  /// integrals over the first one.
  template <int dim>
  struct Overlap
  {
    struct Point
    {
      /// Barycentric coordinates on both facets.
      std::array<double, dim> on_first, on_second;

      double weight;   ///< of the length or area
      double distance; ///< to the other facet, negative if it is inside
    };

    unsigned int       first, second; ///< numbers of the facets
    std::vector<Point> points;
  };



  /// The facets with vertices of their own, so that each has its own normal:
  /// the mean at a corner is that of no side.
  template <int dim>
  std::vector<Facet<dim>>
  apart(std::vector<Facet<dim>> facets)
  {
    unsigned int next = 0;
    for (Facet<dim> &facet : facets)
      for (unsigned int &vertex : facet.vertices)
        vertex = next++;
    return facets;
  }



  /// Returns whether two sides lie on each other where they overlap, but for
  /// what facets are off the curve that their vertices are on: an edge of
  /// length h whose ends have normals that turn by an angle is h times an
  /// eighth of it off.
  template <int dim>
  bool
  touch(const std::vector<Facet<dim>>   &first,
        const std::vector<Facet<dim>>   &second,
        const std::vector<Overlap<dim>> &overlaps);



  /// The part of each facet of the first side that overlaps cover.
  template <int dim>
  std::vector<double>
  covered_parts(const std::vector<Facet<dim>>   &first,
                const std::vector<Overlap<dim>> &overlaps);



  /**
   * The common refinement of two sides of an interface, seen from the first
   * one, in the order of its facets. Points go over along the normal of the
   * first side: in 2D that of its vertices (the mean of their facets, by their
   * lengths) interpolated along the facet, so that nothing is left out or
   * counted twice at a vertex of a curved side; in 3D that of the facet. Facets
   * belong together if their normals are more than 120 degrees apart and if
   * they are not farther from each other than @p reach times the length of the
   * first one's edges.
   *
   * Polynomials of degree 4 are integrated exactly over each piece, in 2D of
   * degree 5. See Puso and Laursen, A mortar segment-to-segment contact method
   * for large deformation solid mechanics, 2004.
   */
  template <int dim>
  std::vector<Overlap<dim>>
  find_overlaps(const std::vector<Facet<dim>> &first,
                const std::vector<Facet<dim>> &second,
                const double                   reach);
} // namespace Debond

#endif
