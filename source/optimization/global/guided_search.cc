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
      GuidedSearch(const MatrixView             &S,
                   const VectorView             &g,
                   const PiecewiseQuadratic     &phi,
                   const SeparableBranches      &lumped,
                   const bool                    is_separable,
                   const NeighbourGraph         &neighbours,
                   const MajoriseMinimise       &method,
                   const GuidedSearchParameters &parameters,
                   const std::function<bool()>  &monitor,
                   const ActiveSetGuess         &guess)
        : S(S)
        , g(g)
        , phi(phi)
        , lumped(lumped)
        , is_separable(is_separable)
        , neighbours(neighbours)
        , method(method)
        , parameters(parameters)
        , monitor(monitor)
        , guess(guess)
      {}

      GuidedSearchResult
      run(const std::function<bool(bool, Eigen::VectorXd &)> &may_end,
          Eigen::VectorXd                                    &s)
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
        quick.splits        = false;
        search(quick, s);
        bool found = false;
        for (const unsigned int improvements : result.search.improvements)
          found = found || improvements > 0;
        // The same point has the same bounds.
        const bool is_same = has_tried && !found;
        if (!monitor() || (!is_same && is_proved(s, 0)))
          return result;
        if ((may_end && may_end(found, s)) || !monitor() ||
            (!(is_same && parameters.proof_first) && is_proved(s, 1)))
          return result;
        search({}, s);
        const double       n       = double(s.size());
        const unsigned int n_nodes = static_cast<unsigned int>(std::ceil(
          std::min(double(most_nodes), most_operations / (n * n * n))));
        // What the proof finds is where moves have not been tried from.
        for (unsigned int k = 0; k < most_proofs && monitor(); ++k)
          {
            const Eigen::VectorXd searched = s;
            if (is_proved(s, n_nodes) || s == searched || !monitor())
              break;
            search({}, s);
          }
        return result;
      }

    private:
      void
      search(const BranchSearchParameters &moves, Eigen::VectorXd &s)
      {
        add(search_branches(
              S, g, phi, lumped, neighbours, method, moves, s, monitor, guess),
            result.search);
      }

      /// Branch and bound, and whether it ends with a proof. What it finds is
      /// taken if it is lower.
      bool
      is_proved(Eigen::VectorXd   &s,
                const unsigned int maximum_nodes,
                const bool         only_while_halving = false)
      {
        CondensedProblem         problem(S, g, phi, s);
        const double             functional = problem.evaluate().functional;
        BranchAndBoundParameters limits;
        limits.tolerance                 = parameters.tolerance;
        limits.maximum_nodes             = maximum_nodes;
        limits.only_while_halving        = only_while_halving;
        limits.n_threads                 = parameters.n_threads;
        const BranchAndBoundResult proof = BranchAndBound(limits).minimize(
          S, g, lumped, s, [this](const ProofProgress &) { return monitor(); });
        if (is_separable)
          result.proof = proof;
        Eigen::VectorXd  other = proof.s;
        CondensedProblem other_problem(S, g, phi, other);
        if (!is_separable && minimise_trial(method, other_problem).status !=
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

      const MatrixView             &S;
      const VectorView             &g;
      const PiecewiseQuadratic     &phi;
      const SeparableBranches      &lumped;
      const bool                    is_separable;
      const NeighbourGraph         &neighbours;
      const MajoriseMinimise       &method;
      const GuidedSearchParameters &parameters;
      const std::function<bool()>  &monitor;
      const ActiveSetGuess         &guess;
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



  void
  add(const BranchSearchResult &more, BranchSearchResult &search)
  {
    for (unsigned int k = 0; k < more.trials.size(); ++k)
      {
        search.trials[k] += more.trials[k];
        search.improvements[k] += more.improvements[k];
      }
    search.failures += more.failures;
    search.complete   = search.complete && more.complete;
    search.functional = more.functional;
  }



  GuidedSearchResult
  guided_search(const MatrixView             &S,
                const VectorView             &g,
                const PiecewiseQuadratic     &phi,
                const SeparableBranches      &lumped,
                const bool                    is_separable,
                const NeighbourGraph         &neighbours,
                const MajoriseMinimise       &method,
                const GuidedSearchParameters &parameters,
                Eigen::VectorXd              &s,
                const std::function<bool()>  &monitor,
                const std::function<bool(bool, Eigen::VectorXd &)> &may_end,
                const ActiveSetGuess                               &guess)
  {
    return GuidedSearch(S,
                        g,
                        phi,
                        lumped,
                        is_separable,
                        neighbours,
                        method,
                        parameters,
                        monitor,
                        guess)
      .run(may_end, s);
  }
} // namespace Debond
