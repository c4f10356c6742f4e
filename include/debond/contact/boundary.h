// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_boundary_h
#define debond_contact_boundary_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <array>
#include <vector>

namespace Debond
{
  /**
   * The contact boundary Gamma_C as the discrete problem sees it: the nodes
   * whose normal displacement is unknown, and the faces, on which the normal
   * displacement is the linear interpolant of its nodal values. What is
   * unknown is s = u_nu - gap <= 0, minus the opening between body and
   * foundation.
   */
  template <int dim>
  struct ContactBoundary
  {
    struct Node
    {
      dealii::Point<dim> position;

      /// Outward unit normal of the body.
      dealii::Tensor<1, dim> normal;

      /// Integral of the nodal basis function over Gamma_C (area in 3D,
      /// length in 2D).
      double measure;

      /// The distance to the foundation of the body at rest.
      double gap = 0.;
    };

    /// A vertex whose normal displacement is prescribed.
    struct HeldVertex
    {
      /// For the whole load.
      double normal_displacement;

      double gap; ///< as of a node

      unsigned int support; ///< of ElasticUnknowns::support_names()

      dealii::Tensor<1, dim> normal;

      dealii::Point<dim> position;
    };

    struct Face
    {
      /// Indices into `nodes`, or dealii::numbers::invalid_unsigned_int for a
      /// vertex whose normal displacement is fixed to zero.
      std::array<unsigned int, dim> nodes;

      /// Indices into `held_vertices` of the others, if it has any.
      std::array<unsigned int, dim> held = {};

      std::array<dealii::Point<dim>, dim> vertices;

      /// Outward unit normal of the body.
      dealii::Tensor<1, dim> normal;

      /// Length or area.
      double measure;
    };

    /// In lexicographic order of their positions.
    std::vector<Node> nodes;
    std::vector<Face> faces;

    /// Empty if they are all at the foundation and stay there.
    std::vector<HeldVertex> held_vertices;
  };
} // namespace Debond

#endif
