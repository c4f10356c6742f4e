// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/memory.h>
#include <debond/base/run_watch.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/contact/boundary_graph.h>
#include <debond/input/bad_input.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/global_branch.h>
#include <debond/solve/which_minimum.h>

#include <cmath>
#include <ctime>
#include <limits>

namespace Debond
{
  namespace
  {
    /// Displacements this close to the kink, relative, count as on it.
    constexpr double kink_width = 1e-6;



    /// On contact boundaries with more nodes a search takes more than a fifth
    /// of the solve, so that it has to be asked for: automatic searches on a
    /// coarser one.
    constexpr unsigned int largest_automatic_search = 200;



    /// Where a proof is cheap: automatic looks there before it goes on, with
    /// the proof first.
    constexpr unsigned int coarse_look = 50;



    void
    add_search(const BranchSearchResult &search,
               const unsigned int        n_nodes,
               WhichMinimum             &result)
    {
      result.search_trials += search.trials;
      result.search_improvements += search.improvements;
      result.search_failures += search.failures;
      result.search_nodes = n_nodes;
      result.kind         = search.complete && result.search_failures == 0 ?
                              MinimumKind::best_known :
                              MinimumKind::stationary;
    }



    /// What the bonds can change in J: at most the most that they can take up,
    /// and no more than the contact nodes gain without foundation and bonds,
    /// 1/2 g'S^{-1}g.
    double
    energy_of_bonds(const Condensation      &condensed,
                    const SeparableBranches &lumped)
    {
      return std::min(condensed.energy_of_kept(), lumped.largest_value());
    }



    void
    add_proof(const BranchAndBoundResult &proof,
              const SeparableBranches    &lumped,
              const Condensation         &condensed,
              WhichMinimum               &result)
    {
      result.proof_attempted = true;
      result.proof_status    = proof.status;
      result.proof_nodes     = proof.nodes;
      result.lower_bound     = proof.lower + condensed.energy_at_zero();
      result.energy_of_bonds = energy_of_bonds(condensed, lumped);
      const double gap       = proof.upper - proof.lower;
      result.relative_gap    = gap > 0. ? gap / result.energy_of_bonds : 0.;
      if (proof.status == ProofStatus::proved)
        result.kind = MinimumKind::global;
    }



    GuidedSearchParameters
    guided_search_parameters(const SolverParameters &parameters,
                             const double            energy,
                             const bool              proof_first)
    {
      GuidedSearchParameters guided;
      guided.tolerance   = parameters.proof.tolerance * energy;
      guided.n_threads   = parameters.proof.n_threads;
      guided.proof_first = proof_first;
      return guided;
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



    /// Of the bonds at the nodes, empty if all are the same.
    template <int dim>
    std::vector<double>
    stretches(const AdhesionIntegral<dim> &adhesion)
    {
      std::vector<double> result;
      if (adhesion.has_field())
        for (unsigned int i = 0; i < adhesion.n_nodes(); ++i)
          result.push_back(adhesion.bonds_at(i).stretch);
      return result;
    }



    /// Of the bonds of coarser unknowns: the means of finer ones.
    std::vector<double>
    coarse_stretches(
      const std::vector<double>                      &fine,
      const std::vector<Eigen::SparseMatrix<double>> &prolongations)
    {
      if (fine.empty())
        return {};
      Eigen::VectorXd mean =
        Eigen::Map<const Eigen::VectorXd>(fine.data(), fine.size());
      for (const Eigen::SparseMatrix<double> &P : prolongations)
        mean = (P.transpose() * mean)
                 .cwiseQuotient(P.transpose() * Eigen::VectorXd::Ones(P.rows()))
                 .eval();
      return {mean.data(), mean.data() + mean.size()};
    }



    /// The search, and, of Search = automatic, how far it can be from the
    /// minimum.
    template <int dim>
    class MinimumSearch
    {
    public:
      MinimumSearch(const SolverParameters      &parameters,
                    const ContactBoundary<dim>  &boundary,
                    const AdhesiveLaw           &law,
                    const AdhesionIntegral<dim> &adhesion,
                    const Condensation          &condensed,
                    const std::function<bool()> &may_go_on,
                    Eigen::VectorXd             &s,
                    WhichMinimum                &result)
        : parameters(parameters)
        , boundary(boundary)
        , law(law)
        , adhesion(adhesion)
        , condensed(condensed)
        , S(condensed.schur_complement())
        , g(condensed.load())
        , may_go_on(may_go_on)
        , s(s)
        , result(result)
        , method(parameters.majorise_minimise)
        , graph(neighbours(boundary))
        , lumped(lumped_bonds(law, adhesion))
        , energy(energy_of_bonds(condensed, lumped))
        , separable(adhesion.is_separable())
      {
        result.search_nodes = static_cast<unsigned int>(s.size());
      }

      /// Of Search = automatic: all on the contact nodes themselves, with a
      /// look at coarser ones before the expensive part.
      void
      search_all_nodes()
      {
        const auto look_at_coarser = [&](const bool found) {
          return s.size() > coarse_look && !found &&
                 look_on_coarse_mesh(coarse_look);
        };
        const GuidedSearchResult guided =
          guided_search(problem(),
                        separable,
                        guided_search_parameters(parameters,
                                                 energy,
                                                 /*proof_first=*/false),
                        s,
                        look_at_coarser);
        const bool rests_on_coarse = result.closed_nodes > 0;
        add_search(guided.search, static_cast<unsigned int>(s.size()), result);
        // What a limit of time has cut may not have come to any bound.
        if (guided.proof && !rests_on_coarse &&
            std::isfinite(guided.proof->lower))
          add_proof(*guided.proof, lumped, condensed, result);
      }

      /// Of Search = automatic: starts from rest and from all bonds broken, the
      /// rest on coarser nodes.
      void
      search_coarse_nodes()
      {
        if (separable && is_proved_at_start())
          return;
        BranchSearchParameters starts;
        starts.maximum_shift = 0;
        starts.flips         = false;
        if (!search_nodes(starts) && look_on_coarse_mesh(coarse_look))
          return;
        look_on_coarse_mesh(largest_automatic_search);
        BranchSearchParameters edges = starts;
        edges.starts                 = false;
        edges.maximum_shift          = 1;
        search_nodes(edges);
        if (separable)
          is_proved_at_start();
      }

      /// With the given moves. Returns whether it found something.
      bool
      search_nodes(const BranchSearchParameters &moves)
      {
        const unsigned int before = result.search_improvements;
        add_search(search_branches(problem(), moves, s),
                   result.search_nodes,
                   result);
        return result.search_improvements > before;
      }

    private:
      /// With a guess where starts from afar are in contact.
      SearchProblem
      problem()
      {
        if (guess.empty())
          guess = ActiveSetGuess(S, coarsen(boundary, coarse_look));
        return {S, g, adhesion, lumped, graph, method, may_go_on, &guess};
      }

      bool
      is_proved_at_start()
      {
        BranchAndBoundParameters no_nodes;
        no_nodes.maximum_nodes = 0;
        no_nodes.tolerance     = parameters.proof.tolerance * energy;
        const BranchAndBoundResult proof =
          branch_and_bound(no_nodes, S, g, lumped, s);
        if (proof.status != ProofStatus::proved)
          return false;
        add_proof(proof, lumped, condensed, result);
        return true;
      }

      /// A search on a coarser contact mesh of at most @p n_nodes. The best of
      /// it is minimised on the finer ones, and taken if it is lower there.
      /// Returns whether the coarse minimum is known, if lumped, and
      /// leads to the state that is known already.
      bool
      look_on_coarse_mesh(const unsigned int n_nodes)
      {
        const auto prolongations = coarsen(boundary, n_nodes);
        const auto monitor       = [&](const auto &) { return may_go_on(); };
        bool       is_closed     = false;

        std::vector<std::string> failures;
        Eigen::VectorXd          point = coarse_start(
          S,
          g,
          adhesion,
          prolongations,
          method,
          failures,
          monitor,
          [&](const MatrixView         &coarse_S,
              const VectorView         &coarse_g,
              const PiecewiseQuadratic &phi,
              Eigen::VectorXd          &coarse_s) {
            const unsigned int n = static_cast<unsigned int>(coarse_s.size());
            const SeparableBranches coarse_lumped =
              lumped_branches(phi,
                              n,
                              law.branches(),
                              coarse_stretches(stretches(adhesion),
                                               prolongations));
            const NeighbourGraph coarse_graph =
              coarse_neighbours(prolongations.back());
            const GuidedSearchResult guided = guided_search(
              {coarse_S,
               coarse_g,
               phi,
               coarse_lumped,
               coarse_graph,
               method,
               may_go_on},
              false,
              guided_search_parameters(parameters, energy, n <= coarse_look),
              coarse_s);
            add_search(guided.search, n, result);
            is_closed = guided.is_closed;
          });
        CondensedProblem             problem(S, g, adhesion, point);
        const MajoriseMinimiseResult minimum =
          minimise_trial(method, problem, monitor);
        const auto   given = CondensedProblem(S, g, adhesion, s).evaluate();
        const double above = minimum.functional - given.functional;
        if (minimum.status != SolverStatus::success)
          {
            result.search_failures +=
              minimum.status != SolverStatus::interrupted;
            return false;
          }
        if (above < -given.functional_rounding)
          {
            s = point;
            ++result.search_improvements;
          }
        is_closed = is_closed && std::abs(above) <= given.functional_rounding;
        if (is_closed)
          result.closed_nodes = result.search_nodes;
        return is_closed;
      }

      const SolverParameters      &parameters;
      const ContactBoundary<dim>  &boundary;
      const AdhesiveLaw           &law;
      const AdhesionIntegral<dim> &adhesion;
      const Condensation          &condensed;
      const MatrixView             S;
      const VectorView             g;
      const std::function<bool()> &may_go_on;
      Eigen::VectorXd             &s;
      WhichMinimum                &result;
      const MajoriseMinimise       method;
      const NeighbourGraph         graph;
      const SeparableBranches      lumped;
      const double                 energy; ///< of bonds
      const bool                   separable;
      ActiveSetGuess               guess;
    };



    template <int dim>
    void
    prove(const SolverParameters      &parameters,
          const AdhesiveLaw           &law,
          const AdhesionIntegral<dim> &adhesion,
          const Condensation          &condensed,
          const std::function<bool()> &may_go_on,
          Eigen::VectorXd             &s,
          WhichMinimum                &result)
    {
      const SeparableBranches lumped = lumped_bonds(law, adhesion);
      const double functional = condensed_functional(condensed, adhesion, s);
      BranchAndBoundParameters proof_parameters = parameters.proof;
      proof_parameters.tolerance *= energy_of_bonds(condensed, lumped);
      proof_parameters.maximum_bytes = memory_left(parameters.memory_limit);
      const BranchAndBoundResult proof =
        branch_and_bound(proof_parameters,
                         condensed.schur_complement(),
                         condensed.load(),
                         lumped,
                         s,
                         [&](const ProofProgress &) { return may_go_on(); });
      add_proof(proof, lumped, condensed, result);
      result.proof_history = proof.history;
      for (ProofProgress &progress : result.proof_history)
        {
          progress.lower += condensed.energy_at_zero();
          progress.upper += condensed.energy_at_zero();
        }
      // A rounding in J is no better minimum.
      if (proof.upper < functional - proof_parameters.tolerance)
        s = proof.s;
    }
  } // namespace



  std::string
  to_string(const MinimumKind kind)
  {
    switch (kind)
      {
        case MinimumKind::stationary:
          return "stationary";
        case MinimumKind::local_minimum:
          return "local minimum";
        case MinimumKind::best_known:
          return "best known";
        case MinimumKind::global:
          return "global";
      }
    return "unknown";
  }



  bool
  wants_search(const SolverParameters &parameters)
  {
    return parameters.search == BondSearchChoice::automatic ?
             parameters.method == SolverMethod::automatic :
             parameters.search != BondSearchChoice::none;
  }



  template <int dim>
  SeparableBranches
  lumped_bonds(const AdhesiveLaw &law, const AdhesionIntegral<dim> &adhesion)
  {
    return lumped_branches(adhesion,
                           adhesion.n_nodes(),
                           law.branches(),
                           stretches(adhesion));
  }



  template <int dim>
  MinimumKind
  kind_without_search(const AdhesiveLaw           &law,
                      const AdhesionIntegral<dim> &adhesion,
                      const VectorView            &s)
  {
    if (law.branches().size() == 1 || s.size() == 0)
      return MinimumKind::global;

    // No quadrature point is so close to the kink that it changes its branch.
    const Eigen::SparseMatrix<double> difference =
      adhesion.curvature((1. + kink_width) * s) -
      adhesion.curvature((1. - kink_width) * s);
    return difference.norm() == 0. ? MinimumKind::local_minimum :
                                     MinimumKind::stationary;
  }



  template <int dim>
  WhichMinimum
  find_better_minimum(const SolverParameters      &parameters,
                      const ContactBoundary<dim>  &boundary,
                      const AdhesiveLaw           &law,
                      const AdhesionIntegral<dim> &adhesion,
                      const Condensation          &condensed,
                      const std::function<bool()> &may_go_on,
                      Eigen::VectorXd             &s)
  {
    WhichMinimum result;
    result.kind = kind_without_search(law, adhesion, s);
    if (result.kind == MinimumKind::global)
      return result;

    if (law.curvature(0.) == 0. &&
        (wants_search(parameters) || parameters.prove))
      {
        // The nodes' multiples of the law are known by their curvature at 0.
        const std::string reason = "needs a law with a curvature at 0";
        if (parameters.prove)
          throw BadInput({"Solver/Prove " + reason});
        if (parameters.search != BondSearchChoice::automatic)
          throw BadInput({"Solver/Search " + reason});
        result.notes.push_back("no search for a lower minimum: that " + reason);
        return result;
      }

    if (wants_search(parameters))
      {
        const Stage stage("search for a lower minimum");
        // Processor time: what else the machine does changes no result.
        const auto is_late = [&, first = std::clock()]() {
          return static_cast<double>(std::clock() - first) >
                 parameters.search_seconds * CLOCKS_PER_SEC;
        };
        const std::function<bool()> has_time = [&]() {
          return may_go_on() && !is_late();
        };
        MinimumSearch<dim> search(
          parameters, boundary, law, adhesion, condensed, has_time, s, result);
        if (s.size() <= largest_automatic_search)
          search.search_all_nodes();
        else
          search.search_coarse_nodes();
        // Full is what automatic does, and more.
        if (parameters.search == BondSearchChoice::full &&
            result.kind != MinimumKind::global &&
            search.search_nodes(BranchSearchParameters()))
          result.closed_nodes = 0;
        const bool is_cut = !has_time() && result.kind != MinimumKind::global;
        if (is_cut || (result.kind != MinimumKind::best_known &&
                       result.kind != MinimumKind::global))
          result.kind = kind_without_search(law, adhesion, s);
        if (is_cut && may_go_on() &&
            result.proof_status == ProofStatus::interrupted)
          result.proof_status = ProofStatus::time_limit;
        if (is_cut && may_go_on())
          result.notes.push_back(
            "the search for a lower minimum has ended at its limit of time, "
            "after " +
            std::to_string(result.search_trials) +
            " states: there may be lower ones. Solver/Search = full has no "
            "limit");
      }
    const Stage stage("proof");
    if (parameters.prove)
      prove(parameters, law, adhesion, condensed, may_go_on, s, result);
    if (result.proof_attempted)
      result.functional = condensed_functional(condensed, adhesion, s) +
                          condensed.energy_at_zero();
    result.interrupted = !may_go_on();
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



  template decltype(lumped_bonds<2>)        lumped_bonds<2>;
  template decltype(lumped_bonds<3>)        lumped_bonds<3>;
  template decltype(kind_without_search<2>) kind_without_search<2>;
  template decltype(kind_without_search<3>) kind_without_search<3>;
  template decltype(find_better_minimum<2>) find_better_minimum<2>;
  template decltype(find_better_minimum<3>) find_better_minimum<3>;
} // namespace Debond
