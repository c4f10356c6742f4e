// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_solution_h
#define debond_solve_minimum_solution_h

#include <debond/solve/minimum/which_minimum.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  /// A minimum of J and how it was found, or why it was not.
  struct Solution
  {
    /// Adds the iterations of a minimisation that followed, and its end.
    void
    add(const Solution &later);

    SolverStatus status = SolverStatus::success;
    std::string  message;

    /// w of ElasticUnknowns: the displacement without what is prescribed.
    DofVector   u;
    LoadFactors load_factor = 1.; ///< of the loads that u belongs to
    double      functional;       ///< J(u), from the strains of u

    /// The first factor of a load path at which the body comes off; the rest is
    /// of the one before.
    std::optional<LoadFactors> comes_off_at = {};

    unsigned int iterations  = 0;
    unsigned int long_steps  = 0;
    unsigned int short_steps = 0;
    unsigned int null_steps  = 0;

    /// The figure of the stop criterion: v_k of a bundle method, the relative
    /// residual of majorise-minimise. A refined result is better than that.
    double criterion = 0.;

    /// The relative descent |v_k| over the strain energy, if there is any, in
    /// the paper's method, whose stop tolerance is an energy.
    std::optional<double> relative_descent = {};

    /// u is a minimiser in extended precision, from where the method ended.
    bool is_refined = false;

    double largest_qp_residual = 0.; ///< of bundle methods

    unsigned int linear_iterations = 0; ///< of conjugate gradients

    /// An estimate of the condition of the elastic problem on the contact
    /// normals, if there is one.
    std::optional<double> condition_estimate;

    /// The kind of the minimum, of a success.
    WhichMinimum minimum;

    /// J of the state that the method led to, if search and proof on this mesh
    /// could replace it by a lower one, and whether they did.
    std::optional<double> functional_from_start;
    bool                  is_searched = false;
    bool                  is_replaced = false;

    /// The notes on what did not go as it should without keeping the method
    /// from its end.
    std::vector<std::string> notes;

    /// Wall seconds by part.
    std::map<std::string, double> parts;

    /// One of them is filled, with iterations numbered from 1 to the end of the
    /// last minimisation.
    std::vector<BundleIteration>           bundle_history;
    std::vector<MajoriseMinimiseIteration> majorise_history;
  };

  /// What a bundle method has to say.
  Solution
  solution_of(const ProximalBundleResult &bundle);

  /// What majorise-minimise has to say.
  Solution
  solution_of(const MajoriseMinimiseResult &minimum);

  /// Makes the functional of a method J, which is more by the @p energy of what
  /// is prescribed.
  template <typename Result>
  void
  add_energy(const double energy, Result &result)
  {
    result.functional += energy;
    for (auto &iteration : result.history)
      iteration.functional += energy;
  }

  /// J(u), from the strains, on the first of several ranks.
  template <int dim>
  double
  functional_of(const Scene<dim> &scene, const DofVector &u);
} // namespace Debond

#endif
