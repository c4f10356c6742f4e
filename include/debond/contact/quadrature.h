// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_quadrature_h
#define debond_contact_quadrature_h

#include <debond/mesh/bernstein.h>

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
      gauss,    ///< exact to degree 2 gauss_points - 1
      exact     ///< split at the kinks of the law, exact for the trace
    };

    Rule rule = Rule::nodal;
    /// Only for Rule::gauss: 1 or more, in 3D at most 7.
    unsigned int gauss_points = 2;

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
   *
   * For displacements of degree 2 there are Gauss points, and in 2D the exact
   * rule.
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

    /// The trace on a face: its coefficients, see bernstein().
    using Trace = std::array<double, n_coefficients(dim, 2)>;

    /// @p law_kinks are those of the law, used by Rule::exact only; @p degree
    /// is that of the trace. Throws std::invalid_argument if there is no rule
    /// of that many Gauss points, or no such rule for that degree.
    ContactQuadrature(const ContactQuadratureParameters &parameters,
                      const std::vector<double>         &law_kinks,
                      const unsigned int                 degree = 1);

    /// Whether points() gives different points for different traces.
    bool
    depends_on_trace() const;

    /// Whether all points are vertices.
    bool
    is_nodal() const;

    /// Whether the points depend on the trace.
    bool
    is_split_at_kinks() const;

    /// The points on a face on which the trace has the given nodal values.
    /// The reference is valid until the next call (one thread at a time).
    const std::vector<QuadraturePoint> &
    points(const std::array<double, dim> &trace) const;

    /// The same from the coefficients of a trace of the rule's degree.
    const std::vector<QuadraturePoint> &
    points_of(const Trace &trace) const;

  private:
    /// A piece of a face: barycentric coordinates of its vertices and the
    /// trace there.
    struct Piece
    {
      std::array<std::array<double, dim>, dim> vertices;
      std::array<double, dim>                  trace;
    };

    /// Appends to `split` the points of a piece of the given part of the
    /// face's measure, cut where the trace crosses a kink.
    void
    append(const Piece &piece, const double measure) const;

    /// Writes the points between the crossings of a quadratic trace on a line
    /// to `split`.
    void
    split_line(const Trace &trace) const;

    unsigned int        degree;
    bool                split_at_kinks;
    bool                nodal;
    std::vector<double> kinks;

    /// The rule on a face, or on each piece of it if split_at_kinks.
    std::vector<QuadraturePoint>         fixed;
    mutable std::vector<QuadraturePoint> split;
  };
} // namespace Debond

#endif
