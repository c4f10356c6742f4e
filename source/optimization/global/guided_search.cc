// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/guided_search.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    /// A node takes about n^3 operations, of which this is a few seconds'
    /// worth.
    constexpr double       most_operations = 4e8;
    constexpr unsigned int most_nodes      = 500;

    /// With more unknowns a few relaxations take longer than the first search.
    constexpr unsigned int largest_first_look = 100;

    /// Each is begun because the one before found a lower point.
    constexpr unsigned int most_proofs = 4;



    /// For one problem.
    class GuidedSearch
    {
    public:
      GuidedSearch(const SearchProblem          &problem,
                   const bool                    is_separable,
                   const GuidedSearchParameters &parameters)
        : problem(problem)
        , is_separable(is_separable)
        , parameters(parameters)
      {}

      GuidedSearchResult
      run(const std::function<bool(bool)> &may_end, Eigen::VectorXd &s)
      {
        const bool has_tried = is_separable || parameters.proof_first;
        const bool looks_at_node =
          parameters.proof_first || s.size() <= largest_first_look;
        const Eigen::VectorXd given = s;
        if (has_tried && (is_proved(s,
                                    looks_at_node ? 1 : 0,
                                    /*only_while_halving=*/
                                    !parameters.proof_first) ||
                          (s != given && is_proved(s, 0))))
          return result;
        BranchSearchParameters quick;
        quick.maximum_shift = 1;
        quick.flips         = false;
        search(quick, s);
        const bool found = result.search.improvements > 0;
        // The same point has the same bounds.
        const bool is_same = has_tried && !found;
        if (!problem.may_go_on() || (!is_same && is_proved(s, 0)))
          return result;
        if ((may_end && may_end(found)) || !problem.may_go_on() ||
            (!(is_same && parameters.proof_first) && is_proved(s, 1)))
          return result;
        search({}, s);
        const double       n       = double(s.size());
        const unsigned int n_nodes = static_cast<unsigned int>(std::ceil(
          std::min(double(most_nodes), most_operations / (n * n * n))));
        // What the proof finds is where moves have not been tried from.
        for (unsigned int k = 0; k < most_proofs && problem.may_go_on(); ++k)
          {
            const Eigen::VectorXd searched = s;
            if (is_proved(s, n_nodes) || s == searched || !problem.may_go_on())
              break;
            search({}, s);
          }
        return result;
      }

    private:
      /// Adds what it did to the result.
      void
      search(const BranchSearchParameters &moves, Eigen::VectorXd &s)
      {
        const BranchSearchResult more = search_branches(problem, moves, s);
        BranchSearchResult      &sum  = result.search;
        sum.trials += more.trials;
        sum.improvements += more.improvements;
        sum.failures += more.failures;
        sum.complete   = sum.complete && more.complete;
        sum.functional = more.functional;
      }

      /// Branch and bound, and whether it ends with a proof. What it finds is
      /// taken if it is lower.
      bool
      is_proved(Eigen::VectorXd   &s,
                const unsigned int maximum_nodes,
                const bool         only_while_halving = false)
      {
        const double functional = condensed(s).evaluate().functional;
        BranchAndBoundParameters limits;
        limits.tolerance          = parameters.tolerance;
        limits.maximum_nodes      = maximum_nodes;
        limits.only_while_halving = only_while_halving;
        limits.n_threads          = parameters.n_threads;
        const BranchAndBoundResult proof =
          branch_and_bound(limits,
                           problem.S,
                           problem.g,
                           problem.lumped,
                           s,
                           [this](const ProofProgress &) {
                             return problem.may_go_on();
                           });
        if (is_separable)
          result.proof = proof;
        Eigen::VectorXd  other         = proof.s;
        CondensedProblem other_problem = condensed(other);
        if (!is_separable &&
            minimise_trial(problem.method, other_problem).status !=
              SolverStatus::success)
          {
            ++result.search.failures;
            return false;
          }
        const MajorantProblem::State state = other_problem.evaluate();
        if (state.functional < functional - state.functional_rounding)
          s = other;
        result.is_closed = proof.status == ProofStatus::proved;
        return result.is_closed;
      }

      CondensedProblem
      condensed(Eigen::VectorXd &s) const
      {
        return CondensedProblem(problem.S, problem.g, problem.phi, s);
      }

      const SearchProblem          &problem;
      const bool                    is_separable;
      const GuidedSearchParameters &parameters;
      GuidedSearchResult            result;
    };
  } // namespace



  SeparableBranches
  lumped_branches(const PiecewiseQuadratic  &phi,
                  const unsigned int         n,
                  const BranchMinimum       &branches,
                  const std::vector<double> &stretches)
  {
    const Eigen::VectorXd curvature =
      phi.curvature(Eigen::VectorXd::Zero(n)) * Eigen::VectorXd::Ones(n);
    std::vector<BranchMinimum> f;
    for (unsigned int i = 0; i < n; ++i)
      f.push_back(
        branches.with_first_curvature(curvature(i),
                                      stretches.empty() ? 1. : stretches[i]));
    return SeparableBranches(f);
  }



  GuidedSearchResult
  guided_search(const SearchProblem             &problem,
                const bool                       is_separable,
                const GuidedSearchParameters    &parameters,
                Eigen::VectorXd                 &s,
                const std::function<bool(bool)> &may_end)
  {
    return GuidedSearch(problem, is_separable, parameters).run(may_end, s);
  }
} // namespace Debond
