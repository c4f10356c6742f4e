// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>

#include <debond/base/entry_error.h>
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/elasticity/contact_frame.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace Debond
{
  namespace
  {
    /// For each face the number of a face that is the same for all that are
    /// connected by pairs of faces whose normals differ by less than @p
    /// degrees.
    template <int dim>
    std::vector<unsigned int>
    join_faces(const std::vector<dealii::Tensor<1, dim>> &normals,
               const double                               degrees)
    {
      const double cosine = std::cos(degrees * dealii::numbers::PI / 180.);
      std::vector<unsigned int> groups(normals.size());
      std::iota(groups.begin(), groups.end(), 0u);
      for (unsigned int i = 0; i < normals.size(); ++i)
        for (unsigned int j = 0; j < i; ++j)
          if (const unsigned int mine = groups[i], other = groups[j];
              mine != other && normals[i] * normals[j] > cosine)
            std::replace(groups.begin(), groups.end(), mine, other);
      return groups;
    }
  } // namespace



  template <int dim>
  VertexNormals<dim>::VertexNormals(
    const std::vector<dealii::Tensor<1, dim>> &face_normals,
    const std::vector<double>                 &face_measures)
    : groups(join_faces(face_normals, 31.4))
  {
    std::vector<dealii::Tensor<1, dim>> sums(groups.size());
    for (unsigned int f = 0; f < groups.size(); ++f)
      sums[groups[f]] += face_measures[f] * face_normals[f];
    std::set<unsigned int> apart;
    for (unsigned int f = 0; f < groups.size(); ++f)
      if (face_normals[f] * sums[groups[f]] < 0.1 * sums[groups[f]].norm())
        apart.insert(groups[f]);

    std::map<unsigned int, unsigned int> numbers;
    for (unsigned int f = 0; f < groups.size(); ++f)
      {
        const auto [entry, is_new] =
          numbers.emplace(apart.count(groups[f]) > 0 ? f : groups[f],
                          static_cast<unsigned int>(normals.size()));
        groups[f] = entry->second;
        if (is_new)
          {
            normals.emplace_back();
          }
        normals[groups[f]] += face_measures[f] * face_normals[f];
      }
    for (auto &normal : normals)
      {
        normal /= normal.norm();
        for (unsigned int d = 0; d < dim; ++d)
          if (std::abs(normal[d]) < Tolerance::zero_in_normal)
            normal[d] = 0.;
        normal /= normal.norm();
      }
  }



  template <int dim>
  dealii::Tensor<2, dim>
  contact_frame(const std::vector<dealii::Tensor<1, dim>> &normals)
  {
    AssertIndexRange(normals.size() - 1, dim);

    dealii::Tensor<2, dim> frame;
    for (unsigned int i = 0; i < normals.size(); ++i)
      frame[i] = normals[i];

    const dealii::Tensor<1, dim> n = frame[0];
    if (normals.size() == 1 && dim == 2)
      {
        frame[1][0] = -n[1];
        frame[1][1] = n[0];
      }

    if constexpr (dim == 3)
      {
        if (normals.size() == 1)
          {
            // The axis farthest from the normal gives the first tangent.
            unsigned int axis = 0;
            for (unsigned int d = 1; d < dim; ++d)
              if (std::abs(n[d]) < std::abs(n[axis]))
                axis = d;
            frame[1] = -n[axis] * n;
            frame[1][axis] += 1.;
            frame[1] /= frame[1].norm();
          }
        if (normals.size() <= 2)
          {
            frame[2] = dealii::cross_product_3d(n, frame[1]);
            if (frame[2].norm() > 0.)
              frame[2] /= frame[2].norm();
          }
      }

    // Faces of two groups are at least 31.4 degrees apart, so a small
    // determinant means opposite normals (or three in one plane), not
    // neighbours.
    if (std::abs(dealii::determinant(frame)) < Tolerance::dependent_normals)
      throw EntryError(
        "Boundary conditions/Contact boundary",
        "contact sides that meet at a vertex have opposite normals, or three "
        "in one plane; contact is with a rigid foundation, that of the faces "
        "of a crack with each other is Mesh/Cuts");
    return frame;
  }



  DEBOND_INSTANTIATE_CLASS(VertexNormals);
  template dealii::Tensor<2, 2>
  contact_frame(const std::vector<dealii::Tensor<1, 2>> &);
  template dealii::Tensor<2, 3>
  contact_frame(const std::vector<dealii::Tensor<1, 3>> &);
} // namespace Debond
