// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_mean_problem_h
#define debond_certify_mean_problem_h

#include <debond/certify/certified_side.h>
#include <debond/certify/equilibrium_problem.h>
#include <debond/optimization/global/separable_energy.h>

namespace Debond
{
  /// The right side of theorem 2 for shifts D. What the terms that are not
  /// quadratic or m <= 0 are for is a function of some means s,
  ///     constant + 1/2 s'S s - g's + phi(s);
  /// the others, and after them the slopes k of all sides, are eliminated:
  /// offset + to_others s are those that belong to s. J is at least this.
  struct MeanProblem
  {
    double constant;
    double rounding; ///< what elimination may have lost of it

    Eigen::MatrixXd                  S;
    Eigen::VectorXd                  g;
    std::unique_ptr<SeparableEnergy> phi;

    // Of the sides: D, and the pieces of the law that are certain (theorem 2).
    std::vector<double>                      shifts;
    std::vector<std::optional<unsigned int>> pieces;

    /// What stands for j_1 on each side, but for constants: of the mean, or of
    /// p where a piece of the law is certain.
    std::vector<std::vector<PiecewiseEnergy::Piece>> laws;

    std::vector<unsigned int> kept; ///< sides of s
    std::vector<unsigned int> eliminated;

    Eigen::VectorXd offset;
    Eigen::MatrixXd to_others;
    Eigen::MatrixXd inverse_in_others;

    unsigned int
    n_sides() const
    {
      return static_cast<unsigned int>(pieces.size());
    }

    /// Returns the means of all sides, then the slopes.
    Eigen::VectorXd
    all(const Eigen::VectorXd &s) const
    {
      const Eigen::VectorXd others = offset + to_others * s;
      Eigen::VectorXd       result(2 * n_sides());
      result(kept)           = s;
      result(eliminated)     = others.head(eliminated.size());
      result.tail(n_sides()) = others.tail(n_sides());
      return result;
    }
  };



  /**
   * Makes these problems (theorems 1 and 2 of
   * doc/reference/certificate.md) of a body, for shifts that are chosen here.
   * All that is given or returned by side is in the order of
   * EquilibriumMesh::contact_sides.
   */
  class MeanProblems
  {
  public:
    /// @p trace_constants: Lambda of each side, @p laws: of each; @p energies:
    /// of the strains in the cells above the sides, of a good displacement, for
    /// the choice of shifts. References to all are kept.
    MeanProblems(const EquilibriumProblem<2>        &equilibrium,
                 const std::vector<double>          &trace_constants,
                 const std::vector<PiecewiseEnergy> &laws,
                 const std::vector<double>          &energies);

    const std::vector<EquilibriumMesh<2>::Side> &
    contact_sides() const
    {
      return sides;
    }

    const std::vector<PiecewiseEnergy> &
    laws_of_sides() const
    {
      return laws;
    }

    /// Returns shifts that are large enough for the law not to be rounded at
    /// the mean, if that can be with the given multiple of the bonds'
    /// stiffness.
    std::vector<double>
    shifts_for_means(const Eigen::VectorXd &means, const double multiple) const;

    /// Returns the shifts that lose least: large enough for the piece of the
    /// law to be certain, if that can be, or for means and slopes near the
    /// given ones to lose little by stiffness, slopes and rounding together,
    /// but at least the given multiple of the bonds' stiffness.
    std::vector<double>
    shifts_for_ranges(const std::vector<CertifiedSide> &ranges,
                      const Eigen::VectorXd            &means,
                      const Eigen::VectorXd            &slopes,
                      const double                      least_multiple) const;

    /// Returns how much the sides lose at these means and slopes: by stiffness,
    /// and where no piece is certain by slopes and the rounded law.
    std::vector<double>
    losses(const MeanProblem     &problem,
           const Eigen::VectorXd &means_and_slopes) const;

    /// Returns the problem of shifts D, which are made smaller until there is
    /// one. At @p means it measures its rounding. Throws EquilibriumError if
    /// there is none.
    MeanProblem
    mean_problem(const std::vector<CertifiedSide> &ranges,
                 const Eigen::VectorXd            &means,
                 std::vector<double>               D) const;

  private:
    /// Returns nothing if the problem is not convex in the slopes, or the means
    /// do not determine the stresses.
    std::optional<MeanProblem>
    try_mean_problem(const std::vector<CertifiedSide> &ranges,
                     const Eigen::VectorXd            &means,
                     const std::vector<double>        &D) const;

    /// Returns the largest shift of a side: at least a tenth of an element's
    /// stiffness stays.
    double
    available(const unsigned int i) const
    {
      return 0.9 * trace_constants[i] /
             sharers[sides[i].cell->active_cell_index()];
    }

    const EquilibriumProblem<2>                 &equilibrium;
    const std::vector<double>                   &trace_constants;
    const std::vector<double>                   &energies;
    const std::vector<PiecewiseEnergy>          &laws;
    const std::vector<EquilibriumMesh<2>::Side> &sides;
    const unsigned int                           n;
    std::vector<unsigned int> sharers; ///< contact sides of each cell
  };
} // namespace Debond

#endif
