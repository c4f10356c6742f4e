// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_quadrature_h
#define debond_contact_quadrature_h

#include <debond/mesh/bernstein.h>

#include <string>
#include <vector>

namespace Debond
{
  /// A quadrature rule on Gamma_C by name.
  struct ContactQuadratureParameters
  {
    enum class Rule
    {
      nodal,    ///< the vertices (trapezoidal rule in 2D)
      midpoint, ///< the barycentre
      gauss     ///< exact to degree 2 gauss_points - 1
    };

    Rule rule = Rule::nodal;
    /// Only for Rule::gauss: 1 or more, in 3D at most 7.
    unsigned int gauss_points = 2;

    /// Reads "nodal", "midpoint" or "gauss N". Throws
    /// std::invalid_argument for anything else.
    static ContactQuadratureParameters
    parse(const std::string &text);
  };



  /**
   * Quadrature on a face of the contact boundary, in barycentric coordinates
   * of the face, so that a point's coordinates are the values of the P1 basis
   * functions there. For displacements of degree 2 there are Gauss points.
   */
  template <int dim>
  class ContactQuadrature
  {
  public:
    struct QuadraturePoint
    {
      std::array<double, dim> barycentric;
      double                  weight; ///< the weights of a face sum to 1

      /// Where a linear density of the measure is taken: of a vertex at the
      /// centroid of its basis function, else at the point.
      std::array<double, dim> centroid;
    };

    /// The trace on a face: its coefficients, see bernstein().
    using Trace = std::array<double, n_coefficients(dim, 2)>;

    /// @p degree is that of the trace. Throws std::invalid_argument if there is
    /// no rule of that many Gauss points, or no such rule for that degree.
    ContactQuadrature(const ContactQuadratureParameters &parameters,
                      const unsigned int                 degree = 1);

    /// Returns whether all points are vertices.
    bool
    is_nodal() const
    {
      return nodal;
    }

    const std::vector<QuadraturePoint> &
    points() const
    {
      return on_face;
    }

  private:
    bool                         nodal;
    std::vector<QuadraturePoint> on_face;
  };
} // namespace Debond

#endif
