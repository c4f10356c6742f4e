// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/infinity.h>
#include <debond/solve/meshes/mesh_growth.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace Debond
{
  namespace
  {
    /// The part of Accuracy/Target that a mesh is made for, so that the last
    /// one does not miss it by little.
    constexpr double aim = 0.9;

    /// The largest factor by which the error may exceed what the residuals say.
    /// J that falls although the residual estimate grows comes from a first
    /// mesh that does not see what there is; larger factors belong to exponents
    /// below 0.1.
    constexpr double largest_factor = 20.;

    /// The growth by cells that are cut for others, so that there are no
    /// hanging nodes.
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
    , least_ratio(degree == 1 ? 2. : 1.4)
    , smooth_rate(2. * degree / dim)
    , rate(smooth_rate)
  {}



  // Residuals tell what one more halving of the cells would bring; the error is
  // the sum of all halvings, and how fast that converges depends on the
  // exponents of corners (doc/reference/theory.md). So it is measured: what J
  // fell by, without what searches found, over what the estimate did.
  void
  MeshGrowth::add(AdaptiveLevel &level)
  {
    if (!levels.empty())
      {
        const AdaptiveLevel &before = levels.back();
        level.error_factor          = before.error_factor;
        // The rate of the last two meshes extrapolates to the next one. A
        // single pair of meshes may say anything, so it is kept between half
        // and one and a half times that of smooth solutions.
        rate =
          std::clamp(std::log(before.residual_error / level.residual_error) /
                       std::log(static_cast<double>(level.unknowns) /
                                before.unknowns),
                     0.5 * smooth_rate,
                     1.5 * smooth_rate);
      }
    // The last mesh with sufficiently fewer unknowns gives the factor: closer
    // ones differ by little more than rounding and chance in where cells are
    // cut. What searches found on the way since then is not the mesh's merit.
    double found = level.search_gain;
    for (auto before = levels.rbegin(); before != levels.rend(); ++before)
      {
        if (before->step == level.step &&
            least_ratio * before->unknowns <= level.unknowns)
          {
            const double fall = before->functional - level.functional - found;
            // theta_k = (J_i - J_k) / (e_i - e_k) of the theory page, with J as
            // energies. If the estimate does not fall although J does, the
            // largest factor is assumed; if neither does, the estimate is all
            // that is known.
            const double explained = before->residual_error * before->scale -
                                     level.residual_error * level.scale;
            level.error_factor =
              explained > 0. ?
                std::clamp(fall / explained, 1., largest_factor) :
              fall > 0. ? largest_factor :
                          1.;
            break;
          }
        found += before->search_gain;
      }
    levels.push_back(level);
  }



  bool
  MeshGrowth::meets_target() const
  {
    const AdaptiveLevel &last = levels.back();
    // An estimate without a measured factor counts only if even the largest one
    // would do.
    return last.error_factor.value_or(largest_factor) * last.residual_error <=
           accuracy.target;
  }



  double
  MeshGrowth::next() const
  {
    const AdaptiveLevel &last  = levels.back();
    double               whole = infinity;
    if (accuracy.target > 0.)
      whole =
        std::pow(last.estimated_error() / (aim * accuracy.target), 1. / rate);
    if (accuracy.maximum_unknowns > 0)
      whole =
        std::min(whole, accuracy.maximum_unknowns / (closure * last.unknowns));
    // Without any aim each mesh is as much larger as is still efficient.
    if (!std::isfinite(whole))
      return largest_growth;
    // The way to the aim in equal steps, as few as the largest growth allows;
    // and if the factor is not known yet, a step that is large enough to
    // measure it.
    const double steps =
      std::max(1., std::ceil(std::log(whole) / std::log(largest_growth)));
    return std::max(last.error_factor ? least_growth : least_ratio,
                    std::pow(whole, 1. / steps));
  }



  std::vector<unsigned int>
  divisions(const std::vector<double> &parts,
            const unsigned int         dim,
            const double               growth)
  {
    // Cells with the largest parts are cut first; of equal ones the first, so
    // that the mesh does not depend on the queue.
    using Piece = std::pair<double, int>;
    std::priority_queue<Piece> pieces;
    for (unsigned int cell = 0; cell < parts.size(); ++cell)
      pieces.emplace(parts[cell], -static_cast<int>(cell));

    const double              of_a_half = std::pow(2., -(2. + dim) / dim);
    std::vector<unsigned int> times(parts.size(), 0);
    double                    n    = static_cast<double>(parts.size());
    const double              goal = growth * n;
    // Each further division of a cell doubles its pieces. All of them are taken
    // for equal, with 2^(-(2 + d)/d) of the part before.
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
