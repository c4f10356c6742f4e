// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interruption.h>
#include <debond/base/memory.h>
#include <debond/base/tolerances.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/contact/boundary_graph.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/global_branch.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/which_minimum.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    /// On contact boundaries with more nodes a search takes more than a fifth
    /// of the solve, so that it has to be asked for: automatic searches on a
    /// coarser one.
    constexpr unsigned int largest_automatic_search = 200;

    /// Of the coarsest space that says where starts are in contact.
    constexpr unsigned int guess_nodes = 50;



    /// Of the bonds at the nodes, or on coarser spaces their means; empty if
    /// all are the same.
    template <int dim>
    std::vector<double>
    stretches(
      const AdhesionIntegral<dim>                    &adhesion,
      const std::vector<Eigen::SparseMatrix<double>> &prolongations = {})
    {
      if (!adhesion.points().has_field())
        return {};
      Eigen::VectorXd mean(adhesion.n_nodes());
      for (unsigned int i = 0; i < adhesion.n_nodes(); ++i)
        mean(i) = adhesion.points().bonds_at(i).stretch;
      for (const Eigen::SparseMatrix<double> &P : prolongations)
        mean = (P.transpose() * mean)
                 .cwiseQuotient(P.transpose() * Eigen::VectorXd::Ones(P.rows()))
                 .eval();
      return {mean.data(), mean.data() + mean.size()};
    }



    /// The coarse unknowns of a prolongation that meet at a fine one.
    NeighbourGraph
    coarse_neighbours(const Eigen::SparseMatrix<double> &P)
    {
      const Eigen::SparseMatrix<double> meeting = P.transpose() * P;
      NeighbourGraph                    graph(P.cols());
      for (unsigned int j = 0; j < meeting.cols(); ++j)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(meeting, j);
             entry;
             ++entry)
          if (entry.row() != j)
            graph[j].insert(static_cast<unsigned int>(entry.row()));
      return graph;
    }



    /// The search and the proof, from a point that they move.
    template <int dim>
    class MinimumSearch
    {
    public:
      MinimumSearch(const SolverParameters      &parameters,
                    const AdhesionIntegral<dim> &adhesion,
                    const Condensation          &condensed,
                    const Interruption          &interruption,
                    Eigen::VectorXd             &s,
                    WhichMinimum                &result)
        : parameters(parameters)
        , adhesion(adhesion)
        , condensed(condensed)
        , interruption(interruption)
        , s(s)
        , result(result)
        , method(parameters.majorise_minimise)
        , graph(neighbours(adhesion.contact_boundary()))
        , lumped(lumped_branches(adhesion.adhesive_law().branches(),
                                 lumped_weights(adhesion),
                                 stretches(adhesion)))
        , work(parameters.search_operations)
      {
        // What the bonds can change in J: at most the most that they can take
        // up, and no more than the contact nodes gain without foundation and
        // bonds, 1/2 g'S^{-1}g.
        result.energy_of_bonds =
          std::min(condensed.energy_of_kept(), lumped.largest_value());
        result.search_nodes = static_cast<unsigned int>(s.size());
      }

      void
      search()
      {
        const Stage stage("search for a lower minimum");
        if (s.size() <= largest_automatic_search)
          search_all_nodes();
        else
          search_coarse_nodes();
        // Full is what automatic does, and more.
        if (parameters.search == BondSearchChoice::full &&
            result.kind != MinimumKind::global)
          search_nodes({});
        const bool is_cut =
          work.requested() && result.kind != MinimumKind::global;
        if (is_cut || (result.kind != MinimumKind::best_known &&
                       result.kind != MinimumKind::global))
          result.kind = kind_without_search(adhesion, s, &condensed);
        if (!is_cut || interruption.requested())
          return;
        if (result.proof_status == ProofStatus::interrupted)
          result.proof_status = ProofStatus::node_limit;
        result.notes.push_back(
          "the search for a lower minimum has ended at its limit of work, "
          "after " +
          std::to_string(result.search_trials) +
          " states: there may be lower ones. Solver/Search = full has no "
          "limit");
      }

      void
      prove()
      {
        const Stage  stage("proof");
        const double functional = condensed_functional(condensed, adhesion, s);
        BranchAndBoundParameters limits = proof_limits();
        limits.maximum_bytes            = memory_left(parameters.memory_limit);
        const BranchAndBoundResult proof =
          branch_and_bound(limits, lumped_problem(), s);
        // That of the search stays if there is one.
        if (result.kind != MinimumKind::global ||
            proof.status == ProofStatus::proved)
          add_proof(proof);
        result.proof_history = proof.history;
        for (ProofProgress &progress : result.proof_history)
          {
            progress.lower += condensed.energy_at_zero();
            progress.upper += condensed.energy_at_zero();
          }
        // A rounding in J is no better minimum.
        if (proof.upper < functional - limits.tolerance)
          s = proof.s;
      }

    private:
      const SolverParameters      &parameters;
      const AdhesionIntegral<dim> &adhesion;
      const Condensation          &condensed;
      const Interruption          &interruption;
      Eigen::VectorXd             &s;
      WhichMinimum                &result;
      const MajoriseMinimise       method;
      const NeighbourGraph         graph;
      const SeparableBranches      lumped;

      WorkLimit work;

      /// For starts on many nodes, else empty.
      ActiveSetGuess guess;

      SearchProblem
      problem()
      {
        return {
          {condensed.schur_complement(), condensed.load(), adhesion, work},
          lumped,
          graph,
          method,
          &guess,
          &work};
      }

      SeparableProblem
      lumped_problem() const
      {
        return {condensed.schur_complement(),
                condensed.load(),
                lumped,
                interruption};
      }

      BranchAndBoundParameters
      proof_limits() const
      {
        BranchAndBoundParameters limits = parameters.proof;
        limits.tolerance *= result.energy_of_bonds;
        return limits;
      }

      void
      add_search(const BranchSearchResult &search)
      {
        result.search_trials += search.trials;
        result.search_improvements += search.improvements;
        result.search_failures += search.failures;
        result.kind = search.complete && result.search_failures == 0 ?
                        MinimumKind::best_known :
                        MinimumKind::stationary;
      }

      void
      add_proof(const BranchAndBoundResult &proof)
      {
        result.proof_attempted = true;
        result.proof_status    = proof.status;
        result.proof_nodes     = proof.nodes;
        result.lower_bound     = proof.lower + condensed.energy_at_zero();
        const double gap       = proof.upper - proof.lower;
        result.relative_gap    = gap > 0. ? gap / result.energy_of_bonds : 0.;
        if (proof.status == ProofStatus::proved)
          result.kind = MinimumKind::global;
      }

      void
      search_all_nodes()
      {
        const GuidedSearchResult guided = guided_search(
          problem(), adhesion.points().is_nodal(), proof_limits(), s);
        add_search(guided.search);
        // What a limit of work has cut may not have come to any bound.
        if (guided.proof && std::isfinite(guided.proof->lower))
          add_proof(*guided.proof);
      }

      /// Starts from rest and from all bonds broken, the rest on coarser nodes.
      void
      search_coarse_nodes()
      {
        if (is_proved_at_start())
          return;
        guess =
          ActiveSetGuess(condensed.schur_complement(),
                         coarsen(adhesion.contact_boundary(), guess_nodes));
        BranchSearchParameters starts;
        starts.maximum_shift = 0;
        starts.flips         = false;
        search_nodes(starts);
        look_on_coarse_mesh();
        BranchSearchParameters edges = starts;
        edges.starts                 = false;
        edges.maximum_shift          = 1;
        search_nodes(edges);
        is_proved_at_start();
      }

      void
      search_nodes(const BranchSearchParameters &moves)
      {
        add_search(search_branches(problem(), moves, s));
      }

      bool
      is_proved_at_start()
      {
        if (!adhesion.points().is_nodal() || !lumped.is_piecewise_quadratic())
          return false;
        BranchAndBoundParameters no_nodes = proof_limits();
        no_nodes.maximum_nodes            = 0;
        const BranchAndBoundResult proof =
          branch_and_bound(no_nodes, lumped_problem(), s);
        if (proof.status == ProofStatus::proved)
          add_proof(proof);
        return proof.status == ProofStatus::proved;
      }

      /// A search on a coarser contact mesh. The best of it is minimised on the
      /// finer ones, and taken if it is lower there.
      void
      look_on_coarse_mesh()
      {
        const auto prolongations =
          coarsen(adhesion.contact_boundary(), largest_automatic_search);
        const auto search = [&](const PiecewiseProblem &coarse,
                                Eigen::VectorXd        &coarse_s) {
          result.search_nodes     = static_cast<unsigned int>(coarse_s.size());
          Eigen::VectorXd weights = lumped_weights(adhesion);
          for (const Eigen::SparseMatrix<double> &P : prolongations)
            weights = (P.transpose() * weights).eval();
          const SeparableBranches coarse_lumped =
            lumped_branches(adhesion.adhesive_law().branches(),
                            weights,
                            stretches(adhesion, prolongations));
          const NeighbourGraph coarse_graph =
            coarse_neighbours(prolongations.back());
          add_search(
            guided_search(
              {coarse, coarse_lumped, coarse_graph, method, nullptr, &work},
              /*is_separable=*/false,
              proof_limits(),
              coarse_s)
              .search);
        };
        std::vector<std::string> failures;
        Eigen::VectorXd          point =
          coarse_start(problem(), prolongations, method, failures, search);
        const auto             S = condensed.schur_complement();
        const Eigen::VectorXd &g = condensed.load();

        CondensedProblem             finest(S, g, adhesion, point);
        const MajoriseMinimiseResult minimum =
          minimise_trial(method, finest, [&](const auto &iteration) {
            work.add(iteration.operations);
            return !work.requested();
          });
        const auto given = CondensedProblem(S, g, adhesion, s).evaluate();
        if (minimum.status != SolverStatus::success)
          result.search_failures += minimum.status != SolverStatus::interrupted;
        else if (minimum.functional <
                 given.functional - given.functional_rounding)
          {
            s = point;
            ++result.search_improvements;
          }
      }
    };
  } // namespace



  std::string
  to_string(const MinimumKind kind)
  {
    static const std::array<const char *, 4> words = {
      {"stationary", "local minimum", "best known", "global"}};
    return words[static_cast<std::size_t>(kind)];
  }



  bool
  wants_search(const SolverParameters &parameters)
  {
    return parameters.search == BondSearchChoice::automatic ?
             parameters.method == SolverMethod::automatic :
             parameters.search != BondSearchChoice::none;
  }



  template <int dim>
  MinimumKind
  kind_without_search(const AdhesionIntegral<dim> &adhesion,
                      const VectorView            &s,
                      const Condensation          *condensed)
  {
    if (adhesion.adhesive_law().branches().size() == 1 || s.size() == 0)
      return MinimumKind::global;
    // So close to a drop of the traction bonds may be on either side.
    if (is_at_drop(adhesion, s, Tolerance::at_kink))
      return MinimumKind::stationary;
    if (!adhesion.softens())
      return MinimumKind::local_minimum;
    if (condensed == nullptr)
      return MinimumKind::stationary;
    // What touches the foundation without pressing on it is free, too.
    const Eigen::MatrixXd S = condensed->schur_complement();
    const Eigen::VectorXd pressure =
      condensed->load() - S * s - adhesion.subgradient(s);
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < s.size(); ++i)
      if (s(i) < 0. || pressure(i) <= Tolerance::at_kink *
                                        condensed->load().cwiseAbs().maxCoeff())
        free.push_back(i);
    Eigen::MatrixXd A = S;
    A += least_second_derivative(adhesion, s, Tolerance::at_kink);
    return is_safely_positive_definite(A(free, free)) ?
             MinimumKind::local_minimum :
             MinimumKind::stationary;
  }



  template <int dim>
  WhichMinimum
  find_better_minimum(const SolverParameters      &parameters,
                      const AdhesionIntegral<dim> &adhesion,
                      const Condensation          &condensed,
                      const Interruption          &interruption,
                      Eigen::VectorXd             &s)
  {
    WhichMinimum result;
    result.kind         = kind_without_search(adhesion, s, &condensed);
    const bool searches = wants_search(parameters);
    if (result.kind == MinimumKind::global || !(searches || parameters.prove))
      return result;

    MinimumSearch<dim> search(
      parameters, adhesion, condensed, interruption, s, result);
    if (searches)
      search.search();
    if (parameters.prove)
      search.prove();
    if (result.proof_attempted)
      result.functional = condensed_functional(condensed, adhesion, s) +
                          condensed.energy_at_zero();
    result.interrupted = interruption.requested();
    return result;
  }



  void
  round_outwards(const double  functional,
                 const double  energy_rounding,
                 WhichMinimum &minimum)
  {
    // At other points the condensed problem is wrong by as much as here.
    const double rounding = 2. * std::abs(functional - minimum.functional) +
                            8. * energy_rounding +
                            16. * std::numeric_limits<double>::epsilon() *
                              (std::abs(functional) + minimum.energy_of_bonds);
    minimum.lower_bound -= rounding;
    for (ProofProgress &progress : minimum.proof_history)
      {
        progress.lower -= rounding;
        progress.upper += rounding;
      }
    if (functional < minimum.lower_bound)
      {
        minimum.kind         = MinimumKind::stationary;
        minimum.proof_status = ProofStatus::no_bound;
        minimum.lower_bound  = -std::numeric_limits<double>::infinity();
      }
    if (minimum.energy_of_bonds > 0.)
      minimum.relative_gap =
        (functional - minimum.lower_bound) / minimum.energy_of_bonds;
  }



  template decltype(kind_without_search<2>) kind_without_search<2>;
  template decltype(kind_without_search<3>) kind_without_search<3>;
  template decltype(find_better_minimum<2>) find_better_minimum<2>;
  template decltype(find_better_minimum<3>) find_better_minimum<3>;
} // namespace Debond
