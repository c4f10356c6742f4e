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
      // Each face begins as a group of its own, and whenever a pair of faces of
      // different groups has nearly the same normal, one group takes over the
      // other. A vertex has few faces, so that all pairs are compared. The
      // result is the connected components of that relation, whatever the order
      // of the faces.
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
    // The mean is weighted by the measures, not by angles: it has the direction
    // of the integral of the normal over the group. A face more than 84 degrees
    // from the mean, with a cosine below 0.1, shows that the group bends around
    // a tip. Such a group is taken apart.
    std::vector<dealii::Tensor<1, dim>> sums(groups.size());
    for (unsigned int f = 0; f < groups.size(); ++f)
      sums[groups[f]] += face_measures[f] * face_normals[f];
    std::set<unsigned int> apart;
    for (unsigned int f = 0; f < groups.size(); ++f)
      if (face_normals[f] * sums[groups[f]] < 0.1 * sums[groups[f]].norm())
        apart.insert(groups[f]);

    // The groups are numbered in the order in which their first faces come. The
    // faces of a group that is taken apart stand for themselves, with their own
    // number in place of the group's.
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
        // Components of the order of rounding become exact zeros, and the
        // vector is normalised again. A side along an axis then has a unit
        // vector as its normal, for which no frame is needed and nothing is
        // rounded.
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

    // The normals are the first rows, exactly as they are given. The remaining
    // rows complete them to a basis: they are orthonormal to each other and to
    // all normals, so that in a frame with one normal the inverse is the
    // transpose.
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
            // The first tangent is the projection of the axis that is farthest
            // from the normal, whose length is at least sqrt(2/3). Any other
            // axis could be nearly parallel to the normal and would lose
            // digits.
            unsigned int axis = 0;
            for (unsigned int d = 1; d < dim; ++d)
              if (std::abs(n[d]) < std::abs(n[axis]))
                axis = d;
            frame[1] = -n[axis] * n;
            frame[1][axis] += 1.;
            frame[1] /= frame[1].norm();
          }
        // The cross product is orthogonal to the first two rows. With two
        // normals its length is the sine of the angle between them, which is
        // zero if they are opposite: then it stays zero, and the determinant
        // below is zero too.
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
