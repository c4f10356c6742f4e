// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_frame_h
#define debond_elasticity_contact_frame_h

#include <deal.II/base/tensor.h>

#include <vector>

namespace Debond
{
  /// The cosine to a normal up to which a direction counts as along the
  /// boundary: planes of symmetry meet the mean normal of a polygon at up to
  /// half of its largest angle (VertexNormals).
  constexpr double most_inclined = 0.28;



  /**
   * The normals of one vertex of the contact boundary, those of groups of the
   * faces around it. Two faces are joined where their normals differ by less
   * than 31.4 degrees, and so is all that such pairs connect, so that the order
   * of the faces makes no difference. A regular polygon has 30 degrees at 12
   * sides and 32.7 at 11, so that rounding decides on neither.
   */
  template <int dim>
  struct VertexNormals
  {
    /// @p face_normals: outward unit normals; @p face_measures: lengths or
    /// areas.
    VertexNormals(const std::vector<dealii::Tensor<1, dim>> &face_normals,
                  const std::vector<double>                 &face_measures);

    /// The number of the group of each face. In place of a group with a face
    /// more than 84 degrees off the mean, as at the tip of a needle, each face
    /// is a group of its own: nothing has the mean as its normal.
    std::vector<unsigned int> groups;

    /// The normal of each group, the mean weighted by the faces' measures. A
    /// component that is zero but for rounding is zero, so that sides along the
    /// axes have exact normals.
    std::vector<dealii::Tensor<1, dim>> normals;

    /// Integral of the vertex' basis function over the faces of each group.
  };



  /**
   * The matrix whose rows are the given unit normals followed by an
   * orthonormal basis of their complement: it takes Cartesian components to
   * (u_nu of each of the 1 to dim normals, tangential components). Throws
   * std::invalid_argument if the normals are (nearly) dependent, as at the tip
   * of a wedge of no thickness.
   */
  template <int dim>
  dealii::Tensor<2, dim>
  contact_frame(const std::vector<dealii::Tensor<1, dim>> &normals);
} // namespace Debond

#endif
