// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/minimum/refinement.h>
#include <debond/solve/path/global_branch.h>

namespace Debond
{
  namespace
  {
    /// The parts of the remaining work that a search may take.
    constexpr double most_parts = 4.;



    /// The search and the proof at one factor after the other.
    template <int dim>
    class BranchSearch
    {
    public:
      BranchSearch(const SolverParameters    &solver_parameters,
                   const CondensedScene<dim> &scene,
                   const Interruption        &interruption)
        : parameters(solver_parameters)
        , scene(scene)
        , interruption(interruption)
        , operations_left(parameters.search_operations)
      {
        // The search is full unless its work is limited: then it tries only
        // what is worth its time. A proof comes last, for the points that
        // remain.
        parameters.method = SolverMethod::automatic;
        parameters.search = std::isfinite(operations_left) ?
                              BondSearchChoice::automatic :
                              BondSearchChoice::full;
        parameters.prove  = false;
      }

      /// One of @p n_left searches that share the remaining work. Many ask for
      /// less than their part, so that others may have several.
      void
      search(const LoadFactors factors,
             const std::size_t n_left,
             BranchPoint      &point)
      {
        // The limit of one search is several parts of an equal share, as most
        // searches end long before it. What each has taken is subtracted from
        // what the later ones share.
        parameters.search_operations =
          most_parts * operations_left / double(n_left);
        point.which = improve(parameters, factors, point);
        operations_left -= point.which.operations;
        // If nothing is applied or prescribed, no gap either, no energy is
        // less than at rest.
        if (scene.scene.problem().load(factors).linfty_norm() == 0.)
          point.which.kind = MinimumKind::global;
      }

      void
      prove(const LoadFactors factors, BranchPoint &point)
      {
        if (point.which.kind == MinimumKind::global)
          return;
        // The point is the best that all searches have found, so the proof
        // searches no more. If it does not succeed, what the search knew still
        // holds.
        SolverParameters proof = parameters;
        proof.search           = BondSearchChoice::none;
        proof.prove            = true;
        const MinimumKind kind = point.which.kind;
        point.which            = improve(proof, factors, point);
        if (point.which.kind != MinimumKind::global)
          point.which.kind = kind;
      }

      /// Takes what majorise-minimise finds from @p neighbour if that is lower.
      bool
      start_from(const BranchPoint &neighbour,
                 const LoadFactors  factors,
                 BranchPoint       &point)
      {
        const AdhesionIntegral<dim> bonds     = scene.bonds(factors);
        const Condensation          condensed = scene.at(factors);
        // If the neighbour's minimum lives on under this load,
        // majorise-minimise finds it within a few steps.
        Eigen::VectorXd  s = neighbour.s;
        CondensedProblem problem(condensed_problem(condensed, bonds), s);
        problem.factorise_by(factor);
        const MajoriseMinimiseResult minimum =
          MajoriseMinimise(
            scene.scene.minimisation(parameters.majorise_minimise))
            .minimize(problem, [this](const auto &iteration) {
              operations_left -= iteration.operations;
              return !interruption.requested();
            });
        // Only a state that is lower by more than rounding is taken; otherwise
        // neighbours would hand the same minimum back and forth.
        const double rounding = problem.evaluate().functional_rounding;
        if (!can_be_verified(minimum.status) ||
            minimum.functional >= point.functional - rounding)
          return false;
        point.s          = s;
        point.functional = minimum.functional;
        return true;
      }

    private:
      WhichMinimum
      improve(const SolverParameters &what,
              const LoadFactors       factors,
              BranchPoint            &point)
      {
        const AdhesionIntegral<dim> bonds     = scene.bonds(factors);
        const Condensation          condensed = scene.at(factors);
        WhichMinimum                which =
          find_better_minimum(what, bonds, condensed, interruption, point.s);
        point.functional =
          condensed_functional(condensed_problem(condensed, bonds), point.s);
        // The bound of the condensed problem is moved outwards, to hold for J
        // from the strains at this factor.
        if (which.proof_attempted)
          round_outwards(point.functional + condensed.energy_at_zero(),
                         rounding_of_energy(scene.scene.problem(),
                                            factors,
                                            condensed.expand(point.s)),
                         which);
        return which;
      }

      SolverParameters           parameters;
      const CondensedScene<dim> &scene;
      const Interruption        &interruption;
      double                     operations_left;
      BorderedCholesky           factor; ///< of the last step from a neighbour
    };
  } // namespace



  template <int dim>
  Branch
  global_branch(const GlobalBranch         wanted,
                const SolverParameters    &parameters,
                const CondensedScene<dim> &scene,
                const Branch              &start,
                const Interruption        &interruption,
                const BranchMonitor       &monitor)
  {
    BranchSearch<dim> search(parameters, scene, interruption);
    const bool        proves = wanted == GlobalBranch::prove;

    // Minima live on over intervals of factors, so the lowest one at a factor
    // is often known from its neighbour. The way up hands on states of small
    // factors (mostly bonded), the way down those of large ones (mostly
    // broken). Proofs come last, since a proof about a state that is replaced
    // afterwards would be lost.
    Branch             branch;
    const BranchPoint *last   = nullptr;
    std::size_t        n_left = 2 * start.size();
    for (const auto &[factors, given] : start)
      {
        if (interruption.requested())
          return branch;
        BranchPoint point = given;
        if (last != nullptr)
          search.start_from(*last, factors, point);
        search.search(factors, n_left--, point);
        last = &(branch[factors] = point);
        if (!proves)
          monitor(factors, point);
      }

    last = nullptr;
    for (auto entry = branch.rbegin(); entry != branch.rend(); ++entry)
      {
        if (interruption.requested())
          return branch;
        // A full search is worth its time only if the neighbour has given
        // something new.
        auto &[factors, point] = *entry;
        if (last != nullptr && search.start_from(*last, factors, point))
          search.search(factors, n_left, point);
        --n_left;
        if (proves)
          {
            search.prove(factors, point);
            monitor(factors, point);
          }
        last = &point;
      }
    return branch;
  }



  template <int dim>
  void
  energetic_path(
    const SolverParameters                                     &parameters,
    const CondensedScene<dim>                                  &scene,
    const std::vector<std::pair<LoadFactors, Eigen::VectorXd>> &starts,
    const Interruption                                         &interruption,
    const EnergeticObserver<dim>                               &observer)
  {
    // The search is of the scene with the memory of the step that it is at.
    CondensedScene<dim> at_step = scene;
    BranchSearch<dim>   search(parameters, at_step, interruption);
    const bool          proves =
      scene.scene.parameters().load_path.global_branch == GlobalBranch::prove;
    bool        is_proved = true; // what has led to this step
    BranchPoint last      = {starts[0].second, infinity, {}};
    for (unsigned int k = 0; k < starts.size(); ++k)
      {
        // The state before and the one that is given are where the search
        // begins, from the lower one of what they lead to.
        const auto &[factors, given] = starts[k];
        const BranchPoint other      = {given, infinity, {}};
        BranchPoint       point      = {last.s, infinity, {}};
        search.start_from(last, factors, point);
        search.start_from(other, factors, point);
        search.search(factors, starts.size() - k, point);
        if (proves)
          search.prove(factors, point);
        if (interruption.requested())
          return;
        MinimumKind &kind      = point.which.kind;
        const bool   is_global = kind == MinimumKind::global;
        if (is_global && !is_proved)
          kind = MinimumKind::best_known;
        is_proved                   = is_proved && is_global;
        AdhesionIntegral<dim> bonds = at_step.bonds(factors);
        if (!observer(k, point, bonds))
          return;
        at_step.memory = bonds.memory();
        last           = point;
      }
  }



  DEBOND_INSTANTIATE(global_branch);
  DEBOND_INSTANTIATE(energetic_path);
} // namespace Debond
