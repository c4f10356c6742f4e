// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/base/instantiate.h>
#include <debond/contact/quadrature.h>

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
      // On the reference simplex the weights sum to its measure, 1 or 1/2; here
      // to 1, as faces have their own measure.
      double sum = 0.;
      for (const double weight : rule.get_weights())
        sum += weight;

      std::vector<typename ContactQuadrature<dim>::QuadraturePoint> points(
        rule.size());
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          points[q].weight = rule.weight(q) / sum;
          // deal.II's coordinates of the reference simplex are the barycentric
          // ones of all vertices but the first.
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

      // Unlike QGaussSimplex, these rules do not depend on the numbering of the
      // vertices, so that a symmetric problem stays symmetric. Their weights
      // are positive, without which a sum of majorants would be no majorant of
      // Phi.
      return dealii::QWitherdenVincentSimplex<dim - 1>(n);
    }



    template <int dim>
    std::vector<typename ContactQuadrature<dim>::QuadraturePoint>
    rule_on_face(const ContactQuadratureParameters &parameters,
                 const unsigned int                 degree)
    {
      using Rule            = ContactQuadratureParameters::Rule;
      using QuadraturePoint = typename ContactQuadrature<dim>::QuadraturePoint;

      // The vertices alone do not see what an edge's coefficient does, and sums
      // over them would leave it without bonds.
      if (degree == 2 && parameters.rule != Rule::gauss)
        throw std::invalid_argument(
          "quadratic displacements (Mesh/Degree = 2) need \"gauss N\"");
      std::vector<QuadraturePoint> points;
      switch (parameters.rule)
        {
          // Each vertex has the integral of its hat function, so that linear
          // functions are integrated exactly. In 2D this is the trapezoidal
          // rule.
          case Rule::nodal:
            points.resize(dim);
            for (unsigned int k = 0; k < dim; ++k)
              {
                points[k].weight = 1. / dim;
                points[k].barycentric.fill(0.);
                points[k].barycentric[k] = 1.;
              }
            break;
          // One point a face is as exact for linear functions as the vertices,
          // but it couples the nodes of the face.
          case Rule::midpoint:
            points.resize(1);
            points[0].weight = 1.;
            points[0].barycentric.fill(1. / dim);
            break;
          case Rule::gauss:
            points = in_barycentric_coordinates<dim>(
              gauss_rule<dim>(parameters.gauss_points));
            break;
        }
      // The centroid of the function lambda_k on a simplex with dim corners:
      // with the density lambda_k the mean of lambda_l is (1 + delta_kl) / (1 +
      // dim). A linear density of the measure, such as that of a body of
      // revolution, has there its mean with the weight lambda_k.
      for (QuadraturePoint &point : points)
        for (unsigned int k = 0; k < dim; ++k)
          point.centroid[k] = parameters.rule == Rule::nodal ?
                                (1. + point.barycentric[k]) / (1. + dim) :
                                point.barycentric[k];
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
    else
      {
        const std::string number =
          text.compare(0, gauss_prefix.size(), gauss_prefix) == 0 ?
            text.substr(gauss_prefix.size()) :
            "";
        // One or two digits without a leading zero, which std::stoul would not
        // insist on.
        const bool valid =
          (number.size() == 1 || number.size() == 2) && number[0] != '0' &&
          number.find_first_not_of("0123456789") == std::string::npos;
        if (!valid)
          throw std::invalid_argument(
            "The contact quadrature \"" + text +
            "\" is unknown; allowed are: nodal, midpoint, gauss N (N >= 1, in "
            "2D at most " +
            std::to_string(max_gauss_points_2d) + ", in 3D at most " +
            std::to_string(max_gauss_points_3d) + ")");
        parameters.rule         = Rule::gauss;
        parameters.gauss_points = static_cast<unsigned int>(std::stoul(number));
      }
    return parameters;
  }



  template <int dim>
  ContactQuadrature<dim>::ContactQuadrature(
    const ContactQuadratureParameters &parameters,
    const unsigned int                 degree)
    : nodal(parameters.rule == ContactQuadratureParameters::Rule::nodal)
    , on_face(rule_on_face<dim>(parameters, degree))
  {}



  DEBOND_INSTANTIATE_CLASS(ContactQuadrature);
} // namespace Debond
