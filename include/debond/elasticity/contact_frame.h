// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_frame_h
#define debond_elasticity_contact_frame_h

#include <deal.II/base/tensor.h>

#include <vector>

namespace Debond
{
  /**
   * The normals of one vertex of the contact boundary: the normals of the
   * faces around it, where those that differ by less than 30 degrees are one,
   * their mean weighted by the faces' measures.
   */
  template <int dim>
  class VertexNormals
  {
  public:
    /// Adds a face by its outward unit normal and its length or area. Returns
    /// the number of the group that it joins or founds.
    unsigned int
    add_face(const dealii::Tensor<1, dim> &normal, const double measure);

    unsigned int
    n_groups() const;

    /// Unit normal of each group. A component that is zero but for rounding is
    /// zero, so that sides along the axes have exact normals.
    std::vector<dealii::Tensor<1, dim>>
    normals() const;

    /// Integral of the vertex' basis function over the faces of a group.
    double
    measure(const unsigned int group) const;

  private:
    std::vector<dealii::Tensor<1, dim>> weighted_normals;
    std::vector<double>                 measures;
  };



  /**
   * The matrix whose rows are the given unit normals followed by an
   * orthonormal basis of their complement: it takes Cartesian components to
   * (u_nu of each normal, tangential components). Throws
   * std::invalid_argument if the normals are more than dim or (nearly)
   * dependent, as at the tip of a wedge of no thickness.
   */
  template <int dim>
  dealii::Tensor<2, dim>
  contact_frame(const std::vector<dealii::Tensor<1, dim>> &normals);
} // namespace Debond

#endif
