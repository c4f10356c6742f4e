// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_quadrature_h
#define debond_contact_quadrature_h

#include <array>
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
      gauss,    ///< Gauss' rule with gauss_points points per direction
      exact     ///< split at the kinks of the law, exact for the P1 trace
    };

    Rule         rule         = Rule::nodal;
    unsigned int gauss_points = 2; ///< only for Rule::gauss

    /// Reads "nodal", "midpoint", "gauss N" or "exact". Throws
    /// std::invalid_argument for anything else.
    static ContactQuadratureParameters
    parse(const std::string &text);
  };



  /**
   * Quadrature on a face of the contact boundary, in barycentric coordinates
   * of the face, so that a point's coordinates are the values of the P1 basis
   * functions there. A rule may depend on the trace (Rule::exact splits the
   * face where the trace crosses a kink).
   */
  template <int dim>
  class ContactQuadrature
  {
  public:
    struct QuadraturePoint
    {
      std::array<double, dim> barycentric;
      double                  weight; ///< the weights of a face sum to 1
    };

    /// @p kinks are those of the law, used by Rule::exact only.
    ContactQuadrature(const ContactQuadratureParameters &parameters,
                      const std::vector<double> &        kinks);

    /// The points on a face on which the trace has the given nodal values.
    /// The reference is valid until the next call.
    const std::vector<QuadraturePoint> &
    points(const std::array<double, dim> &trace) const;

  private:
    bool                                 split_at_kinks;
    std::vector<double>                  kinks;
    std::vector<QuadraturePoint>         fixed;
    mutable std::vector<QuadraturePoint> split;
  };
} // namespace Debond

#endif
