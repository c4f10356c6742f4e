// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/solve/mesh_growth.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace Debond
{
  namespace
  {
    /// The part of Accuracy/Target that a mesh is made for.
    constexpr double aim = 0.9;

    /// Cells that are cut for others.
    constexpr double closure = 1.1;
  } // namespace



  // The next mesh has at most, and unless it would be too large at least, so
  // many times the cells, without those that have to be cut for others. The
  // error of a mesh with so many cells does not depend on how many meshes led
  // to it with linear displacements; with quadratic ones it does
  // (doc/notes/speed.md).
  MeshGrowth::MeshGrowth(const AccuracyParameters &accuracy,
                         const unsigned int        dim,
                         const unsigned int        degree)
    : accuracy(accuracy)
    , least_growth(degree == 1 ? 1.25 : 1.1)
    , largest_growth(degree == 1 ? 4. : 1.4)
    , smooth_rate(2. * degree / dim)
    , rate(smooth_rate)
  {}



  void
  MeshGrowth::add(const double n_unknowns, const double relative_error)
  {
    if (unknowns > 0. && error > 0. && relative_error > 0.)
      rate = std::clamp(std::log(error / relative_error) /
                          std::log(n_unknowns / unknowns),
                        0.5 * smooth_rate,
                        1.5 * smooth_rate);
    unknowns = n_unknowns;
    error    = relative_error;
  }



  double
  MeshGrowth::next() const
  {
    double whole = std::numeric_limits<double>::infinity();
    if (accuracy.target > 0.)
      whole = std::pow(error / (aim * accuracy.target), 1. / rate);
    if (accuracy.maximum_unknowns > 0)
      whole = std::min(whole, accuracy.maximum_unknowns / (closure * unknowns));
    if (!std::isfinite(whole))
      return largest_growth;
    const double steps =
      std::max(1., std::ceil(std::log(whole) / std::log(largest_growth)));
    return std::max(least_growth, std::pow(whole, 1. / steps));
  }



  std::vector<unsigned int>
  divisions(const std::vector<double> &parts,
            const unsigned int         dim,
            const double               growth)
  {
    // By the part, the first of equal cells.
    using Piece = std::pair<double, int>;
    std::priority_queue<Piece> pieces;
    for (unsigned int cell = 0; cell < parts.size(); ++cell)
      pieces.emplace(parts[cell], -static_cast<int>(cell));

    const double              of_a_half = std::pow(2., -(2. + dim) / dim);
    std::vector<unsigned int> times(parts.size(), 0);
    double                    n    = static_cast<double>(parts.size());
    const double              goal = growth * n;
    while (n < goal && pieces.top().first > 0.)
      {
        const auto [part, cell] = pieces.top();
        pieces.pop();
        n += std::ldexp(1., static_cast<int>(times[-cell]++));
        pieces.emplace(part * of_a_half, cell);
      }
    return times;
  }
} // namespace Debond
