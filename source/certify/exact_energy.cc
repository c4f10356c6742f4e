// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/certify/exact_energy.h>

namespace Debond
{
  namespace
  {
    /// Returns the t where c_0 (1 - t)^2 + 2 c_m t (1 - t) + c_1 t^2 is at a
    /// kink, with the ends of (0, 1), in their order.
    std::vector<double>
    pieces_between_kinks(const double               c_0,
                         const double               c_1,
                         const double               c_m,
                         const std::vector<double> &kinks)
    {
      // As c + 2 b t + a t^2. A linear trace has a = 0 and one finite root, c /
      // sum; the other one is infinite or not a number and is not in (0, 1).
      const double        b = c_m - c_0, a = c_1 - c_m - b;
      std::vector<double> ends = {0., 1.};
      for (const double kink : kinks)
        {
          const double c            = c_0 - kink;
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
      return ends;
    }
  } // namespace



  double
  exact_energy(const AdhesionIntegral<2> &adhesion,
               const ContactBoundary<2>  &boundary,
               const AdhesiveLaw         &law,
               const VectorView          &s)
  {
    // Between kinks j_1 is a quadratic of a trace that is quadratic at most, so
    // a polynomial of degree 4, which three Gauss points integrate exactly. The
    // trace is that of Bernstein coefficients: the values at the ends and the
    // coefficient of the edge, for a linear one the mean of the ends.
    const dealii::QGauss<1> rule(3);
    double                  energy = 0.;
    for (const auto &face : boundary.faces)
      {
        const auto   trace = adhesion.points().trace_on(face, s);
        const double middle =
          boundary.degree == 2 ? trace[2] : 0.5 * (trace[0] + trace[1]);
        const BondScale bonds =
          adhesion.points().bonds_at(dealii::Point<2>(0.5 * (face.vertices[0] +
                                                             face.vertices[1])),
                                     face.id);
        // The law of this face has its kinks stretched by the bonds' scale.
        std::vector<double> kinks = law.kinks();
        for (double &kink : kinks)
          kink *= bonds.length;
        const std::vector<double> ends =
          pieces_between_kinks(trace[0], trace[1], middle, kinks);
        for (unsigned int i = 0; i + 1 < ends.size(); ++i)
          for (unsigned int q = 0; q < rule.size(); ++q)
            {
              const double length = ends[i + 1] - ends[i];
              const double t      = ends[i] + rule.point(q)[0] * length;
              const double value  = (1. - t) * (1. - t) * trace[0] +
                                   2. * t * (1. - t) * middle +
                                   t * t * trace[1];
              energy += face.measure * length * rule.weight(q) * bonds.energy *
                        law.value(value / bonds.length);
            }
      }
    return energy;
  }
} // namespace Debond
