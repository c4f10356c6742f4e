// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of a face that is open and not bonded against sampling it, and bonds
// that do not heal.

#include <debond/check/broken_zone.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/contact/laws/curve.h>
#include <debond/contact/laws/softening.h>
#include <debond/contact/laws/winkler.h>

#include <array>
#include <cmath>
#include <random>

#include "../check.h"

using namespace Debond;

namespace
{
  constexpr double M = 0.1;



  /// One face with the vertices of the reference simplex.
  template <int dim>
  ContactBoundary<dim>
  one_face()
  {
    ContactBoundary<dim>                boundary;
    typename ContactBoundary<dim>::Face face;
    face.measure = 3.;
    for (unsigned int k = 0; k < dim; ++k)
      {
        typename ContactBoundary<dim>::Node node = {};
        if (k > 0)
          node.position[k - 1] = 1.;
        node.measure = face.measure / dim;
        boundary.nodes.push_back(node);
        face.nodes[k]    = k;
        face.vertices[k] = node.position;
      }
    boundary.faces.push_back(face);
    return boundary;
  }



  /// The part of the face where the opening is beyond @p threshold.
  template <int dim>
  double
  sampled(const Eigen::VectorXd &s, const double threshold)
  {
    const unsigned int n    = dim == 2 ? 100000 : 1000;
    unsigned int       open = 0, all = 0;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < (dim == 2 ? 1 : n - i); ++j)
        {
          const double x = (i + 1. / 3.) / n,
                       y = dim == 2 ? 0. : (j + 1. / 3.) / n;
          const double value =
            s(0) * (1. - x - y) + s(1) * x + (dim == 2 ? 0. : s(dim - 1) * y);
          ++all;
          open += value < -threshold;
        }
    return double(open) / all;
  }



  template <int dim>
  void
  test()
  {
    const ContactBoundary<dim>   boundary = one_face<dim>();
    const AdhesiveLaw            law(winkler_law(5., M).pieces);
    const ContactQuadrature<dim> nodal({});
    std::mt19937                 random(7);
    double                       error = 0., error_for_good = 0.;
    for (unsigned int k = 0; k < 50; ++k)
      {
        AdhesionIntegral<dim> adhesion(boundary, law, nodal);
        Eigen::VectorXd       s(dim);
        for (unsigned int i = 0; i < dim; ++i)
          s(i) = -2. * M * (random() % 1000) / 1000.;
        error = std::max(error,
                         std::abs(broken_zone(boundary, adhesion, s) / 3. -
                                  sampled<dim>(s, M)));

        // Once all bonds are broken, all that is open counts.
        adhesion.break_for_good(Eigen::VectorXd::Constant(dim, -2. * M));
        s(0) = 0.;
        error_for_good =
          std::max(error_for_good,
                   std::abs(broken_zone(boundary, adhesion, s) / 3. - 1.));
        error_for_good = std::max(error_for_good,
                                  std::abs(adhesion.dissipated_energy() /
                                             (0.5 * 5. * M * M * 3.) -
                                           1.));
      }
    check(std::to_string(dim) + "D, sampled", error, 3e-3);
    check("broken for good", error_for_good, 1e-12);
  }



  /// Bonds that decay count as broken where they have a hundredth of their
  /// stiffness, and those that hold at any distance never.
  void
  test_without_end()
  {
    const ContactBoundary<2>   boundary = one_face<2>();
    const ContactQuadrature<2> nodal({});
    const auto part = [&](const AdhesiveLaw &law, const double opening) {
      return broken_zone(boundary,
                         AdhesionIntegral<2>(boundary, law, nodal),
                         Eigen::Vector2d(0., -opening)) /
             3.;
    };
    // Of 0.5 exp(-decay (d - 0.1)) = 0.01 5 d, which Newton's method solves.
    const double decay = 0.5 / (1. - 0.5 * 0.5 / (2. * 5.));
    double       d     = 1.;
    for (unsigned int k = 0; k < 50; ++k)
      d -= (decay * (d - 0.1) + std::log(0.1 * d)) / (decay + 1. / d);
    const AdhesiveLaw decays(exponential_law({5., 0.5, 1.}).pieces);
    check("decays, all hold", part(decays, 0.999 * d), 0.);
    check("decays, half is broken", std::abs(part(decays, 2. * d) - 0.5), 1e-9);
    const AdhesiveLaw holds(
      curve_law({{0., 0.}, {0.1, 0.5}, {0.2, 0.3}, {0.4, 0.3}}).pieces);
    check("holds at any distance", part(holds, 1e6), 0.);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  test<2>();
  test<3>();
  test_without_end();
}
