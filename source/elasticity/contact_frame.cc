// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <debond/elasticity/contact_frame.h>

#include <cmath>
#include <stdexcept>

namespace Debond
{
  template <int dim>
  unsigned int
  VertexNormals<dim>::add_face(const dealii::Tensor<1, dim> &normal,
                               const double                  measure)
  {
    static const double cosine = std::cos(dealii::numbers::PI / 6.);

    unsigned int group = 0;
    while (group < n_groups() && normal * weighted_normals[group] <=
                                   cosine * weighted_normals[group].norm())
      ++group;

    if (group == n_groups())
      {
        weighted_normals.emplace_back();
        measures.push_back(0.);
      }
    weighted_normals[group] += measure * normal;
    measures[group] += measure / dim;
    return group;
  }



  template <int dim>
  unsigned int
  VertexNormals<dim>::n_groups() const
  {
    return static_cast<unsigned int>(measures.size());
  }



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  VertexNormals<dim>::normals() const
  {
    std::vector<dealii::Tensor<1, dim>> result = weighted_normals;
    for (auto &normal : result)
      {
        normal /= normal.norm();
        for (unsigned int d = 0; d < dim; ++d)
          if (std::abs(normal[d]) < 1e-14)
            normal[d] = 0.;
        normal /= normal.norm();
      }
    return result;
  }



  template <int dim>
  double
  VertexNormals<dim>::measure(const unsigned int group) const
  {
    return measures[group];
  }



  template <int dim>
  dealii::Tensor<2, dim>
  contact_frame(const std::vector<dealii::Tensor<1, dim>> &normals)
  {
    if (normals.empty() || normals.size() > dim)
      throw std::invalid_argument("Contact sides of " +
                                  std::to_string(normals.size()) +
                                  " different normals meet at a vertex; 1 to " +
                                  std::to_string(dim) + " are possible.");

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

    // The normals are at least 30 degrees apart, so a small determinant means
    // opposite ones (or three in one plane), not neighbours.
    if (std::abs(dealii::determinant(frame)) < 1e-3)
      throw std::invalid_argument(
        "The normals of the contact sides that meet at a vertex are linearly "
        "dependent.");
    return frame;
  }



  template class VertexNormals<2>;
  template class VertexNormals<3>;
  template dealii::Tensor<2, 2>
  contact_frame(const std::vector<dealii::Tensor<1, 2>> &);
  template dealii::Tensor<2, 3>
  contact_frame(const std::vector<dealii::Tensor<1, 3>> &);
} // namespace Debond
