// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_boundary_h
#define debond_contact_boundary_h

#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <debond/mesh/bernstein.h>
#include <debond/mesh/symmetry.h>
#include <debond/optimization/interval.h>

#include <Eigen/Core>

#include <vector>

namespace Debond
{
  /**
   * The contact boundary Gamma_C as the discrete problem sees it: the nodes
   * whose normal displacement is unknown, and the faces, on which the normal
   * displacement is the polynomial with the nodes' numbers as coefficients (see
   * bernstein()): its values at the vertices, and of degree 2 the coefficients
   * of the edges as well. What is unknown is s = u_nu - gap <= 0, minus the
   * opening between body and foundation.
   */
  template <int dim>
  struct ContactBoundary
  {
    /// A direction along the boundary in which bonds shear: of those of a
    /// vertex, which are orthonormal, those in which it does not stay.
    struct Tangent
    {
      dealii::Tensor<1, dim> direction;

      /// Whether the displacement is prescribed, and its number among
      /// `held_vertices` then, else among all unknowns.
      bool         is_held;
      unsigned int index;
    };

    struct Node
    {
      dealii::Point<dim> position;

      /// Outward unit normal of the body.
      dealii::Tensor<1, dim> normal;

      /// Integral of the nodal basis function over Gamma_C: an area in 3D and
      /// of a body of revolution, else a length.
      double measure;

      /// The distance to the foundation of the body at rest.
      double gap = 0.;

      std::vector<Tangent> tangents = {}; ///< none without bonds that shear
    };

    /// A vertex (an edge) whose normal displacement is prescribed, or the
    /// displacement along one of its tangents, which is its `normal` then.
    struct HeldVertex
    {
      /// For the whole load.
      double normal_displacement;

      double gap; ///< as of a node

      unsigned int support; ///< of ElasticUnknowns::support_names()

      dealii::Tensor<1, dim> normal;

      dealii::Point<dim> position;

      /// The support of the body on the low side of an interface, if there is
      /// one.
      unsigned int low_support = dealii::numbers::invalid_unsigned_int;

      bool is_tangential = false;

      /// A piece of the body's boundary that it belongs to.
      dealii::types::boundary_id boundary = 0;

      std::vector<Tangent> tangents = {}; ///< as of a node
    };

    struct Face
    {
      /// Indices into `nodes`, or dealii::numbers::invalid_unsigned_int for a
      /// vertex whose normal displacement is fixed to zero.
      std::array<unsigned int, dim> nodes;

      /// Indices into `held_vertices` of the others, if it has any.
      std::array<unsigned int, dim> held = {};

      /// The nodes, or held vertices, of the edges, with degree 2.
      std::array<unsigned int, n_simplex_edges(dim)> edge_nodes = {};
      std::array<unsigned int, n_simplex_edges(dim)> edge_held  = {};

      std::array<dealii::Point<dim>, dim> vertices;

      /// Outward unit normal of the body.
      dealii::Tensor<1, dim> normal;

      /// Length, or area.
      double measure;

      /// Its length; of a triangle twice the edge of a square of its area.
      double
      size() const
      {
        return dim == 2 ? vertices[0].distance(vertices[1]) :
                          2. * std::sqrt(measure);
      }

      /// The piece of the body's boundary that it belongs to.
      dealii::types::boundary_id id = 0;

      /// Its place in the order of the cells of the whole mesh.
      dealii::types::coarse_cell_id cell = 0;

      /// Returns the contact node of the k-th coefficient, see `nodes`.
      unsigned int
      node(const unsigned int k) const
      {
        return k < dim ? nodes[k] : edge_nodes[k - dim];
      }

      bool
      is_held(const unsigned int k) const
      {
        return node(k) == dealii::numbers::invalid_unsigned_int;
      }

      /// See `held`.
      unsigned int
      held_at(const unsigned int k) const
      {
        return k < dim ? held[k] : edge_held[k - dim];
      }
    };

    Symmetry symmetry = Symmetry::none;

    /// The ratio of the measure around a point of a face, by its barycentric
    /// coordinates, to the mean of the face: that of the radii of a body of
    /// revolution.
    double
    density(const Face &face, const std::array<double, dim> &place) const
    {
      if (symmetry == Symmetry::none)
        return 1.;
      double radius = 0., mean = 0.;
      for (unsigned int k = 0; k < dim; ++k)
        {
          radius += place[k] * face.vertices[k][0];
          mean += face.vertices[k][0] / dim;
        }
      return radius / mean;
    }

    /// The integral over a face of the basis function of its k-th coefficient.
    /// The functions of a face have the same integral; with a linear density
    /// it is that times the density at the function's centroid.
    double
    integral(const Face &face, const unsigned int k) const
    {
      std::array<double, dim> centroid;
      for (unsigned int v = 0; v < dim; ++v)
        centroid[v] = (k >= dim ? 2. :
                       v == k   ? 1. + degree :
                                  1.) /
                      (degree + dim);
      return face.measure / n_face_nodes() * density(face, centroid);
    }

    /// The degree of the displacement, 1 or 2.
    unsigned int degree = 1;

    /// The number of coefficients on a face.
    unsigned int
    n_face_nodes() const
    {
      return n_coefficients(dim, degree);
    }

    /// The number of unknowns that bonds and contact depend on: s of all nodes,
    /// and after them the displacements along tangents.
    unsigned int
    n_unknowns() const
    {
      return static_cast<unsigned int>(nodes.size()) + n_tangents;
    }

    /// Returns the upper bounds of the unknowns: the body does not enter the
    /// foundation, and may slide as far as it likes.
    Eigen::VectorXd
    upper_bounds() const
    {
      Eigen::VectorXd bounds = Eigen::VectorXd::Zero(n_unknowns());
      bounds.tail(n_tangents).setConstant(infinity);
      return bounds;
    }

    /// In lexicographic order of their positions.
    std::vector<Node> nodes;
    std::vector<Face> faces;

    /// The number of tangents that are not held.
    unsigned int n_tangents = 0;

    /// Empty if they are all at the foundation and stay there.
    std::vector<HeldVertex> held_vertices;
  };
} // namespace Debond

#endif
