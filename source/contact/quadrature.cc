// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/contact/quadrature.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// More is of no use for a function with kinks.
    constexpr unsigned int max_gauss_points_2d = 99;

    /// What deal.II has for triangles.
    constexpr unsigned int max_gauss_points_3d = 7;



    /// A rule on the reference simplex in barycentric coordinates, its weights
    /// relative to their sum.
    template <int dim>
    std::vector<typename ContactQuadrature<dim>::QuadraturePoint>
    in_barycentric_coordinates(const dealii::Quadrature<dim - 1> &rule)
    {
      double sum = 0.;
      for (const double weight : rule.get_weights())
        sum += weight;

      std::vector<typename ContactQuadrature<dim>::QuadraturePoint> points(
        rule.size());
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          points[q].weight         = rule.weight(q) / sum;
          points[q].barycentric[0] = 1.;
          for (unsigned int k = 1; k < dim; ++k)
            {
              points[q].barycentric[k] = rule.point(q)[k - 1];
              points[q].barycentric[0] -= rule.point(q)[k - 1];
            }
        }
      return points;
    }



    template <int dim>
    dealii::Quadrature<dim - 1>
    gauss_rule(const unsigned int n)
    {
      const unsigned int largest =
        dim == 2 ? max_gauss_points_2d : max_gauss_points_3d;
      if (n < 1 || n > largest)
        throw std::invalid_argument(
          "The contact quadrature \"gauss " + std::to_string(n) +
          "\" does not exist in " + std::to_string(dim) +
          "D; allowed are \"gauss 1\" to \"gauss " + std::to_string(largest) +
          "\"");

      // Unlike QGaussSimplex, these rules do not depend on the numbering of
      // the vertices, so that a symmetric problem stays symmetric.
      return dealii::QWitherdenVincentSimplex<dim - 1>(n);
    }



    /// Points strictly inside, exact to degree 2, of a quadratic trace 4: what
    /// the derivative of a quadratic, or the quadratic itself, of the trace
    /// needs, with a basis function as factor of the former.
    template <int dim>
    dealii::Quadrature<dim - 1>
    quadratic_rule([[maybe_unused]] const unsigned int degree)
    {
      if constexpr (dim == 2)
        return dealii::QGauss<1>(degree + 1);
      else
        return dealii::QWitherdenVincentSimplex<2>(1, false);
    }



    template <int dim>
    std::vector<typename ContactQuadrature<dim>::QuadraturePoint>
    rule_on_face(const ContactQuadratureParameters &parameters,
                 const unsigned int                 degree)
    {
      using Rule            = ContactQuadratureParameters::Rule;
      using QuadraturePoint = typename ContactQuadrature<dim>::QuadraturePoint;

      if (degree == 2 && parameters.rule != Rule::gauss &&
          !(dim == 2 && parameters.rule == Rule::exact))
        throw std::invalid_argument(
          "quadratic displacements (Mesh/Degree = 2) need \"gauss N\"" +
          std::string(dim == 2 ? " or \"exact\"" : ""));
      std::vector<QuadraturePoint> points;
      switch (parameters.rule)
        {
          case Rule::nodal:
            points.resize(dim);
            for (unsigned int k = 0; k < dim; ++k)
              {
                points[k].weight = 1. / dim;
                points[k].barycentric.fill(0.);
                points[k].barycentric[k] = 1.;
              }
            break;
          case Rule::midpoint:
            points.resize(1);
            points[0].weight = 1.;
            points[0].barycentric.fill(1. / dim);
            break;
          case Rule::gauss:
            points = in_barycentric_coordinates<dim>(
              gauss_rule<dim>(parameters.gauss_points));
            break;
          case Rule::exact:
            points =
              in_barycentric_coordinates<dim>(quadratic_rule<dim>(degree));
            break;
        }
      return points;
    }
  } // namespace



  ContactQuadratureParameters
  ContactQuadratureParameters::parse(const std::string &text)
  {
    const std::string gauss_prefix = "gauss ";

    ContactQuadratureParameters parameters;
    if (text == "nodal")
      parameters.rule = Rule::nodal;
    else if (text == "midpoint")
      parameters.rule = Rule::midpoint;
    else if (text == "exact")
      parameters.rule = Rule::exact;
    else
      {
        const std::string number =
          text.compare(0, gauss_prefix.size(), gauss_prefix) == 0 ?
            text.substr(gauss_prefix.size()) :
            "";
        const bool valid =
          (number.size() == 1 || number.size() == 2) && number[0] != '0' &&
          number.find_first_not_of("0123456789") == std::string::npos;
        if (!valid)
          throw std::invalid_argument(
            "The contact quadrature \"" + text +
            "\" is unknown; allowed are: nodal, midpoint, gauss N (N >= 1, in "
            "2D at most " +
            std::to_string(max_gauss_points_2d) + ", in 3D at most " +
            std::to_string(max_gauss_points_3d) + "), exact");
        parameters.rule         = Rule::gauss;
        parameters.gauss_points = static_cast<unsigned int>(std::stoul(number));
      }
    return parameters;
  }



  template <int dim>
  ContactQuadrature<dim>::ContactQuadrature(
    const ContactQuadratureParameters &parameters,
    const std::vector<double>         &law_kinks,
    const unsigned int                 degree)
    : degree(degree)
    , split_at_kinks(parameters.rule ==
                     ContactQuadratureParameters::Rule::exact)
    , nodal(parameters.rule == ContactQuadratureParameters::Rule::nodal)
    , kinks(law_kinks)
    , fixed(rule_on_face<dim>(parameters, degree))
  {}



  template <int dim>
  bool
  ContactQuadrature<dim>::depends_on_trace() const
  {
    return split_at_kinks;
  }



  template <int dim>
  bool
  ContactQuadrature<dim>::is_nodal() const
  {
    return nodal;
  }



  template <int dim>
  bool
  ContactQuadrature<dim>::is_split_at_kinks() const
  {
    return split_at_kinks;
  }



  template <int dim>
  const std::vector<typename ContactQuadrature<dim>::QuadraturePoint> &
  ContactQuadrature<dim>::points(const std::array<double, dim> &trace) const
  {
    if (!split_at_kinks)
      return fixed;

    Piece face;
    face.trace = trace;
    for (unsigned int k = 0; k < dim; ++k)
      {
        face.vertices[k].fill(0.);
        face.vertices[k][k] = 1.;
      }

    split.clear();
    append(face, 1.);
    return split;
  }



  template <int dim>
  const std::vector<typename ContactQuadrature<dim>::QuadraturePoint> &
  ContactQuadrature<dim>::points_of(const Trace &trace) const
  {
    if (degree == 1)
      {
        std::array<double, dim> at_vertices;
        std::copy_n(trace.begin(), dim, at_vertices.begin());
        return points(at_vertices);
      }
    if (!split_at_kinks)
      return fixed;
    split.clear();
    split_line(trace);
    return split;
  }



  template <int dim>
  void
  ContactQuadrature<dim>::split_line(const Trace &trace) const
  {
    // trace(t) = c + 2 b t + a t^2.
    const double        b = trace[dim] - trace[0];
    const double        a = trace[1] - trace[dim] - b;
    std::vector<double> ends{0., 1.};
    for (const double kink : kinks)
      {
        const double c            = trace[0] - kink;
        const double discriminant = b * b - a * c;
        if (discriminant <= 0.)
          continue;
        // The root that loses no digits, and the other one from the product.
        const double sum = -(b + std::copysign(std::sqrt(discriminant), b));
        for (const double root : {sum / a, c / sum})
          if (root > 0. && root < 1.)
            ends.push_back(root);
      }
    std::sort(ends.begin(), ends.end());

    for (unsigned int i = 0; i + 1 < ends.size(); ++i)
      for (const QuadraturePoint &point : fixed)
        {
          const double    length = ends[i + 1] - ends[i];
          QuadraturePoint image;
          image.weight         = point.weight * length;
          image.barycentric[1] = ends[i] + point.barycentric[1] * length;
          image.barycentric[0] = 1. - image.barycentric[1];
          split.push_back(image);
        }
  }



  template <int dim>
  void
  ContactQuadrature<dim>::append(const Piece &piece, const double measure) const
  {
    // Bisect an edge where it crosses a kink. Both halves get a vertex that is
    // on the kink exactly, so this ends: a half has fewer crossings.
    for (const double kink : kinks)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          if (piece.trace[i] < kink && kink < piece.trace[j])
            {
              const double t =
                (kink - piece.trace[i]) / (piece.trace[j] - piece.trace[i]);
              std::array<double, dim> crossing;
              for (unsigned int k = 0; k < dim; ++k)
                crossing[k] =
                  (1. - t) * piece.vertices[i][k] + t * piece.vertices[j][k];

              Piece below       = piece;
              below.vertices[j] = crossing;
              below.trace[j]    = kink;
              append(below, t * measure);

              Piece above       = piece;
              above.vertices[i] = crossing;
              above.trace[i]    = kink;
              append(above, (1. - t) * measure);
              return;
            }

    for (const QuadraturePoint &point : fixed)
      {
        QuadraturePoint image;
        image.weight = point.weight * measure;
        image.barycentric.fill(0.);
        for (unsigned int v = 0; v < dim; ++v)
          for (unsigned int k = 0; k < dim; ++k)
            image.barycentric[k] += point.barycentric[v] * piece.vertices[v][k];
        split.push_back(image);
      }
  }



  template class ContactQuadrature<2>;
  template class ContactQuadrature<3>;
} // namespace Debond
