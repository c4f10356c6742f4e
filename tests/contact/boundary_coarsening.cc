// SPDX-License-Identifier: LGPL-2.1-or-later
// Coarser spaces of normal displacements, on a line and on a crossed square.

#include <debond/contact/boundary_coarsening.h>

#include <iostream>

#include "../check.h"

using namespace Debond;

namespace
{
  ContactBoundary<2>
  line(const unsigned int n)
  {
    ContactBoundary<2> boundary;
    for (unsigned int i = 0; i < n; ++i)
      {
        ContactBoundary<2>::Node node = {};
        node.position[0]              = i;
        boundary.nodes.push_back(node);
      }
    // The outermost faces end at fixed vertices.
    for (unsigned int i = 0; i <= n; ++i)
      {
        ContactBoundary<2>::Face face = {};
        face.nodes = {{i > 0 ? i - 1 : dealii::numbers::invalid_unsigned_int,
                       i < n ? i : dealii::numbers::invalid_unsigned_int}};
        boundary.faces.push_back(face);
      }
    return boundary;
  }



  ContactBoundary<3>
  square(const unsigned int n)
  {
    // Corners line by line, then centres.
    ContactBoundary<3> boundary;
    const auto         add_node = [&](const double x, const double y) {
      ContactBoundary<3>::Node node = {};
      node.position[0]              = x;
      node.position[2]              = y;
      boundary.nodes.push_back(node);
    };
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
        add_node(i, j);
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
        {
          const unsigned int centre = boundary.nodes.size();
          add_node(i + 0.5, j + 0.5);
          const unsigned int corner = j * (n + 1) + i;
          for (const auto &edge : {std::array<unsigned int, 2>{{0, 1}},
                                   {{1, n + 2}},
                                   {{n + 2, n + 1}},
                                   {{n + 1, 0}}})
            {
              ContactBoundary<3>::Face face = {};
              face.nodes = {{corner + edge[0], corner + edge[1], centre}};
              boundary.faces.push_back(face);
            }
        }
    return boundary;
  }



  template <int dim>
  void
  test(const std::string &name, const ContactBoundary<dim> &boundary)
  {
    const auto prolongations = coarsen(boundary, 10);
    std::cout << name << ": " << boundary.nodes.size();
    bool         fits = true, positive = true, one = true;
    unsigned int rows = boundary.nodes.size();
    for (const auto &P : prolongations)
      {
        std::cout << ' ' << P.cols();
        fits = fits && P.rows() == rows;
        rows = P.cols();
        for (int k = 0; k < P.outerSize(); ++k)
          for (Eigen::SparseMatrix<double>::InnerIterator entry(P, k); entry;
               ++entry)
            positive = positive && entry.value() > 0.;
        const Eigen::VectorXd sums = P * Eigen::VectorXd::Ones(P.cols());
        one = one && (sums.array() - 1.).abs().maxCoeff() < 1e-14;
      }
    std::cout << " nodes, spaces fit: " << verdict(fits)
              << ", weights positive: " << verdict(positive)
              << ", constants kept: " << verdict(one) << '\n';
  }
} // namespace



int
main()
{
  test("line", line(39));
  test("line", line(40));
  test("square", square(8));
  test("single node", line(1));
  test("no node", line(0));

  // On a line: every second node, linear between.
  const auto      P = coarsen(line(31), 20).front();
  Eigen::VectorXd coarse(P.cols());
  for (unsigned int i = 0; i < coarse.size(); ++i)
    coarse(i) = 2. * i;
  const Eigen::VectorXd fine  = P * coarse;
  double                error = 0.;
  for (unsigned int i = 0; i < fine.size(); ++i)
    error = std::max(error, std::abs(fine(i) - i));
  std::cout << "linear functions on a line kept: " << verdict(error, 1e-14)
            << '\n';
}
