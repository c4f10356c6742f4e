// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_kinks_h
#define debond_optimization_kinks_h

#include <debond/base/tolerances.h>
#include <debond/base/views.h>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Debond
{
  /// The sum of weight_i |x_i - place_i|, weight_i >= 0: friction with a given
  /// bound. All lists are empty if there is no such term.
  ///
  /// A component may have a partner, with which it has one term, the weight of
  /// both times the length of (x_i - place_i, x_j - place_j): a cone.
  struct Kinks
  {
    Eigen::VectorXd weight = {}, place = {};

    /// Of each component its partner, or itself; empty if there are no pairs.
    std::vector<Eigen::Index> partner = {};

    /// Returns whether x_i has a term.
    bool
    has(const Eigen::Index i) const
    {
      return weight.size() > 0 && weight(i) > 0.;
    }

    bool
    is_paired(const Eigen::Index i) const
    {
      return has(i) && !partner.empty() && partner[i] != i;
    }

    /// The first components of all pairs.
    std::vector<Eigen::Index>
    pairs() const
    {
      std::vector<Eigen::Index> result;
      for (Eigen::Index i = 0; i < Eigen::Index(partner.size()); ++i)
        if (is_paired(i) && i < partner[i])
          result.push_back(i);
      return result;
    }

    /// The component and its partner, if it has one.
    std::vector<Eigen::Index>
    group(const Eigen::Index i) const
    {
      return is_paired(i) ? std::vector<Eigen::Index>{i, partner[i]} :
                            std::vector<Eigen::Index>{i};
    }

    /// The length of x - place for the component, or for its pair.
    double
    way(const Eigen::Index i, const VectorView &x) const
    {
      return is_paired(i) ?
               std::hypot(x(i) - place(i), x(partner[i]) - place(partner[i])) :
               std::abs(x(i) - place(i));
    }

    /// That of a force.
    double
    size(const Eigen::Index i, const VectorView &force) const
    {
      return is_paired(i) ? std::hypot(force(i), force(partner[i])) :
                            std::abs(force(i));
    }

    double
    value(const VectorView &x) const
    {
      double sum = 0.;
      for (Eigen::Index i = 0; i < weight.size(); ++i)
        if (has(i) && !(is_paired(i) && partner[i] < i))
          sum += weight(i) * way(i, x);
      return sum;
    }

    /// The gradient, with 0 at kinks themselves.
    Eigen::VectorXd
    gradient(const VectorView &x) const
    {
      Eigen::VectorXd result = Eigen::VectorXd::Zero(x.size());
      for (Eigen::Index i = 0; i < weight.size(); ++i)
        if (const double length = has(i) ? way(i, x) : 0.; length > 0.)
          result(i) = weight(i) * ((x(i) - place(i)) / length);
      return result;
    }

    /// What rounding of x and of the place may change in a component of the
    /// gradient: the direction of a short way is hardly known.
    double
    rounding(const Eigen::Index i, const VectorView &x) const
    {
      if (!is_paired(i))
        return 0.;
      double size = 0.;
      for (const Eigen::Index j : group(i))
        size = std::max({size, std::abs(x(j)), std::abs(place(j))});
      const double length = way(i, x);
      return weight(i) *
             (length == 0. ?
                0. :
                std::min(2., 4. * Tolerance::epsilon * size / length));
    }

    /// The second derivative, without what is at its kink.
    Eigen::SparseMatrix<double>
    curvature(const VectorView &x) const
    {
      // Of w |v| it is w / |v| across v, and nothing along it.
      std::vector<Eigen::Triplet<double>> entries;
      for (const Eigen::Index i : pairs())
        if (const double length = way(i, x); length > 0.)
          {
            const Eigen::Index    j = partner[i];
            const Eigen::Vector2d across(-(x(j) - place(j)) / length,
                                         (x(i) - place(i)) / length);
            for (const auto &[row, k] : {std::make_pair(i, 0), {j, 1}})
              for (const auto &[column, l] : {std::make_pair(i, 0), {j, 1}})
                entries.emplace_back(
                  row, column, weight(i) / length * across(k) * across(l));
          }
      Eigen::SparseMatrix<double> result(x.size(), x.size());
      result.setFromTriplets(entries.begin(), entries.end());
      return result;
    }
  };
} // namespace Debond

#endif
