// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/base/memory.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/contact/boundary_graph.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/minimum/lumped_bonds.h>
#include <debond/solve/minimum/which_minimum.h>

namespace Debond
{
  namespace
  {
    /// On contact boundaries with more nodes a search takes more than a fifth
    /// of the solve, so that it has to be asked for: automatic searches on a
    /// coarser one.
    constexpr unsigned int largest_automatic_search = 200;

    /// Up to so many nodes some rounds of the first node of branch and bound
    /// take less than the solve, and may prove what has been found.
    constexpr unsigned int largest_proof_at_root = 400, rounds_at_root = 8;

    /// The nodes of the coarsest space on which active sets of starts are
    /// guessed.
    constexpr unsigned int guess_nodes = 50;



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
        , lumped(lumped_bonds(adhesion, graph))
        , work(parameters.search_operations)
      {
        // The scale of the gap: what the bonds can change in J. That is at most
        // what they can take up when all of them break, and at most what the
        // contact nodes gain without foundation and bonds, 1/2 g'S^{-1}g. |J|
        // itself would hide bonds that matter little beside the energy of the
        // body.
        result.energy_of_bonds =
          std::min(condensed.energy_of_kept(), lumped.largest_value());
        result.search_nodes = adhesion.n_nodes();
      }

      /// Returns whether no bond has anything left to lose, so that J is
      /// convex.
      bool
      is_convex() const
      {
        return is_sum_over_nodes(adhesion) && !lumped.softens() &&
               std::all_of(lumped.f.begin(),
                           lumped.f.end(),
                           [](const PiecewiseEnergy &f) {
                             return f.size() == 1;
                           });
      }

      void
      search()
      {
        const Stage stage("search for a lower minimum");
        // A trial costs a factorisation of S, n^3/3 operations. Beyond this
        // size the fronts are sought on a coarser contact mesh.
        if (s.size() <= largest_automatic_search)
          search_all_nodes();
        else
          search_coarse_nodes();
        // The full search includes what was done so far and has no limit of
        // moves. A state that is proved needs none.
        if (parameters.search == BondSearchChoice::full &&
            result.kind != MinimumKind::global)
          search_nodes({});
        // What a limit of work has cut off has not tried all its moves, so that
        // "best known" would claim too much; then only the state of the bonds
        // counts.
        const bool is_cut =
          work.requested() && result.kind != MinimumKind::global;
        result.operations = work.operations();
        result.is_cut     = is_cut && !interruption.requested();
        if (is_cut || (result.kind != MinimumKind::best_known &&
                       result.kind != MinimumKind::global))
          result.kind = kind_without_search(adhesion, s, &condensed);
        if (!result.is_cut)
          return;
        // The limit stops branch and bound in the way a signal does. Only the
        // signal is to be called an interruption.
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
        if (!is_sum_over_nodes(adhesion))
          {
            result.notes.push_back(
              "no proof: it needs bonds that shear where no support moves their "
              "boundary, or holds it above the foundation");
            return;
          }
        const Stage              stage("proof");
        BranchAndBoundParameters limits = proof_limits();
        // Nodes of the tree that wait keep their intervals. Branch and bound
        // ends with a valid gap before they take the remaining memory.
        limits.maximum_bytes = memory_left(parameters.memory_limit);
        const BranchAndBoundResult proof =
          branch_and_bound(limits, lumped_problem(), s);
        // The search may have proved the result already. A second proof that a
        // limit has ended must not take that away.
        if (result.kind != MinimumKind::global ||
            proof.status == ProofStatus::proved)
          add_proof(proof);
        result.proof_history = proof.history;
        // Branch and bound knows 1/2 s'S s - g's + Phi(s); J has c_0 besides.
        for (ProofProgress &progress : result.proof_history)
          {
            progress.lower += condensed.energy_at_zero();
            progress.upper += condensed.energy_at_zero();
          }
        take_if_lower(proof, limits.tolerance);
        if (limits.keeps_record && proof.status == ProofStatus::proved)
          result.recorded = std::make_shared<const RecordedProof>(
            RecordedProof{{condensed.schur_complement(),
                           condensed.load(),
                           condensed.energy_at_zero(),
                           adhesion.contact_boundary().upper_bounds(),
                           lumped},
                          s,
                          proof.record});
      }

    private:
      const SolverParameters      &parameters;
      const AdhesionIntegral<dim> &adhesion;
      const Condensation          &condensed;
      const Interruption          &interruption;
      Eigen::VectorXd             &s;
      WhichMinimum                &result;
      const MajoriseMinimise       method;
      NeighbourGraph               graph;
      const SeparableEnergy        lumped;

      WorkLimit work;

      /// The guess for starts on many nodes, else empty.
      ActiveSetGuess guess;

      SearchProblem
      problem()
      {
        return {{condensed.schur_complement(),
                 condensed.load(),
                 adhesion.contact_boundary().upper_bounds(),
                 adhesion,
                 work},
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
                adhesion.contact_boundary().upper_bounds(),
                lumped,
                interruption};
      }

      BranchAndBoundParameters
      proof_limits() const
      {
        BranchAndBoundParameters limits = parameters.proof;
        // The tolerance of the scene is relative, branch and bound's is an
        // energy.
        limits.tolerance *= result.energy_of_bonds > 0. ?
                              result.energy_of_bonds :
                              condensed.energy_of_kept();
        return limits;
      }

      void
      add_search(const BranchSearchResult &search)
      {
        result.search_trials += search.trials;
        result.search_improvements += search.improvements;
        result.search_failures += search.failures;
        // A trial that led to no minimum might have led to a lower one.
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
        // A gap below zero is rounding between two ways to compute the same
        // energy.
        result.relative_gap = gap > 0. && result.energy_of_bonds > 0. ?
                                gap / result.energy_of_bonds :
                                0.;
        if (proof.status == ProofStatus::proved)
          result.kind = MinimumKind::global;
      }

      void
      take_if_lower(const BranchAndBoundResult &proof, const double tolerance)
      {
        // A state that is lower by less than the tolerance differs in rounding,
        // and moving to it would only shake the result.
        if (proof.upper <
            condensed_functional(condensed_problem(condensed, adhesion), s) -
              tolerance)
          s = proof.s;
      }

      void
      search_all_nodes()
      {
        // With nodal quadrature each s_i has a law of its own, and Phi is
        // separable, as the bound needs it. With others the lumped bonds only
        // guide the search.
        const GuidedSearchResult guided = guided_search(
          problem(), is_sum_over_nodes(adhesion), proof_limits(), s);
        add_search(guided.search);
        // A proof that a limit of work has cut may not have come to any bound.
        if (guided.proof && std::isfinite(guided.proof->lower))
          add_proof(*guided.proof);
      }

      /// Starts from rest and from all bonds broken, the rest on coarser nodes.
      void
      search_coarse_nodes()
      {
        // The cheapest first: the bound at the point takes one factorisation,
        // and if it proves the result there is nothing to search for.
        if (is_proved_by(/*maximum_nodes=*/0))
          return;
        // Coarser spaces have no tangents.
        if (!adhesion.shears())
          guess =
            ActiveSetGuess(condensed.schur_complement(),
                           coarsen(adhesion.contact_boundary(), guess_nodes));
        // Starts from rest and from all bonds broken find the minima that are
        // far away. They need an active set from coarse spaces, since from afar
        // it takes the more systems the more nodes there are.
        BranchSearchParameters starts;
        starts.maximum_shift = 0;
        starts.flips         = false;
        search_nodes(starts);
        if (!adhesion.shears())
          look_on_coarse_mesh();
        BranchSearchParameters edges = starts;
        edges.starts                 = false;
        // The coarse mesh knows the fronts to within its nodes; moves by one
        // node on the finest mesh put them in their places. The result may now
        // be provable.
        edges.maximum_shift = 1;
        search_nodes(edges);
        is_proved_by(s.size() <= largest_proof_at_root ? 1 : 0);
      }

      void
      search_nodes(const BranchSearchParameters &moves)
      {
        add_search(search_branches(problem(), moves, s));
      }

      /// With no nodes by the bound at the point alone.
      bool
      is_proved_by(const unsigned int maximum_nodes)
      {
        // The bounds need laws that are separable and have finitely many
        // quadratic pieces.
        if (!is_sum_over_nodes(adhesion) || !lumped.is_piecewise_quadratic())
          return false;
        BranchAndBoundParameters limits = proof_limits();
        limits.maximum_nodes            = maximum_nodes;
        limits.rounds_of_root           = rounds_at_root;
        const BranchAndBoundResult proof =
          branch_and_bound(limits, lumped_problem(), s);
        if (proof.status != ProofStatus::proved)
          return false;
        add_proof(proof);
        take_if_lower(proof, limits.tolerance);
        return true;
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
          // The user has to know on how many nodes the whole search was done.
          result.search_nodes = static_cast<unsigned int>(coarse_s.size());
          // The coarse bonds act on s = P_1 ... P_k s_k, so that their Phi is
          // not separable. What the proof calls a minimum of the lumped one is
          // only another start.
          Eigen::VectorXd weights = lumped_weights(adhesion);
          for (const Eigen::SparseMatrix<double> &P : prolongations)
            weights = (P.transpose() * weights).eval();
          const SeparableEnergy coarse_lumped =
            lumped_energy(adhesion.adhesive_law().pieces(),
                          weights,
                          scales_of_bonds(adhesion, prolongations));
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
        CondensedProblem finest(problem(), point);
        // The best coarse state, prolongated level by level, is minimised on
        // the finest nodes as far as the limit of work allows.
        const MajoriseMinimiseResult minimum =
          minimise_trial(method, finest, [&](const auto &iteration) {
            work.add(iteration.operations);
            return !work.requested();
          });
        // A trial that fails weakens the word, one that the limit has stopped
        // does not: the limit itself is reported. A state that is lower by
        // rounding alone is none.
        const auto given = CondensedProblem(problem(), s).evaluate();
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
    const bool searches = parameters.searches();
    if (s.size() == 0 || !(searches || parameters.prove))
      return result;

    // Without anything that bonds can lose J is convex, and its minimum is the
    // only one; a proof is for others to check then.
    MinimumSearch<dim> search(
      parameters, adhesion, condensed, interruption, s, result);
    if (search.is_convex())
      result.kind = MinimumKind::global;
    const bool is_known = result.kind == MinimumKind::global;
    if (is_known && !parameters.proof.keeps_record)
      return result;
    // The search comes first: a good upper value lets branch and bound discard
    // more nodes.
    if (searches && !is_known)
      search.search();
    if (parameters.prove)
      search.prove();
    if (result.proof_attempted)
      result.functional =
        condensed_functional(condensed_problem(condensed, adhesion), s) +
        condensed.energy_at_zero();
    if (parameters.proof.keeps_record && parameters.prove &&
        result.recorded == nullptr)
      result.notes.push_back("no proof.json: the minimum is not proved");
    result.interrupted = interruption.requested();
    return result;
  }



  void
  round_outwards(const double  functional,
                 const double  energy_rounding,
                 WhichMinimum &minimum)
  {
    // S and g are taken as given by branch and bound, although elimination has
    // rounded them. At the result the effect of that is known, as the
    // difference between the condensed J and J from the strains, and it is as
    // large at the point that the bound is about: hence twice. eps <u, D u>
    // stands for what the rows of A lose, the last term for the sums of the
    // bound itself.
    const double rounding = 2. * std::abs(functional - minimum.functional) +
                            8. * energy_rounding +
                            16. * std::numeric_limits<double>::epsilon() *
                              (std::abs(functional) + minimum.energy_of_bonds);
    minimum.rounding = rounding;
    minimum.lower_bound -= rounding;
    for (ProofProgress &progress : minimum.proof_history)
      {
        progress.lower -= rounding;
        progress.upper += rounding;
      }
    // J below its own lower bound shows that something rounds worse than was
    // assumed. Then nothing is known, and the proof is withdrawn.
    if (functional < minimum.lower_bound)
      {
        minimum.kind         = MinimumKind::stationary;
        minimum.proof_status = ProofStatus::no_bound;
        minimum.lower_bound  = -infinity;
      }
    if (minimum.energy_of_bonds > 0.)
      minimum.relative_gap =
        (functional - minimum.lower_bound) / minimum.energy_of_bonds;
  }



  DEBOND_INSTANTIATE(find_better_minimum);
} // namespace Debond
