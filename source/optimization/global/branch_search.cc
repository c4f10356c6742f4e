// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <utility>

namespace Debond
{
  namespace
  {
    /// States that are minimised, at most.
    constexpr unsigned int maximum_trials = 100000;

    /// States on the ways of trials are remembered until they have so many
    /// nodes in all, which takes some 100 MB.
    constexpr std::size_t most_pieces_on_ways = 20000000;

    /// What a node of branch and bound takes, to the cube of the unknowns, in
    /// the time of a factorisation's operations (measured on 159 unknowns).
    constexpr double operations_of_node = 10.;



    /// What a trial comes from: a start, from which the search goes on wherever
    /// it leads to, or a move of moves_from() or of moves_by_stretch().
    enum class MoveKind
    {
      start,
      patch,
      stretch
    };



    /// One search_branches(). A state is the pieces that the unknowns are on.
    class StateSearch
    {
    public:
      StateSearch(const SearchProblem          &problem,
                  const BranchSearchParameters &parameters,
                  Eigen::VectorXd              &s)
        : problem(problem)
        , parameters(parameters)
        , s(s)
        , is_separable(
            is_diagonal(problem.phi.curvature(Eigen::VectorXd::Zero(s.size()))))
        , states_are_majorants(is_separable && !problem.phi.softens())
      {
        // Differences within the rounding of J are no improvements: taken, they
        // would let the search go round in circles.
        const auto state  = CondensedProblem(problem, s).evaluate();
        result.functional = state.functional;
        rounding          = state.functional_rounding;
        tried.insert(problem.lumped.state(s));
        for (const PiecewiseEnergy &f : problem.lumped.f)
          n_pieces = std::max(n_pieces, f.size() + f.n_left());
      }

      BranchSearchResult
      run()
      {
        const Eigen::VectorXd given            = s;
        const double          given_functional = result.functional;
        NodeSet               all;
        for (unsigned int i = 0; i < problem.lumped.f.size(); ++i)
          all.insert(all.end(), i);
        // All nodes on the last piece, the one before, and so on, and all on
        // the first: minima with much or little broken, far from the given one.
        std::vector<PieceMove> starts;
        for (unsigned int piece = n_pieces; piece-- > 1;)
          starts.push_back({piece, all, {}});
        starts.push_back({1, {}, all});
        for (const PieceMove &start : starts)
          {
            Eigen::VectorXd point = given;
            if (parameters.starts && may_go_on() &&
                attempt(start, MoveKind::start, point))
              descend(point);
          }
        // The given point has had no moves yet, and is where the lowest minimum
        // mostly is.
        functional = given_functional;
        descend(given);
        return result;
      }

    private:
      const SearchProblem          &problem;
      const BranchSearchParameters &parameters;
      Eigen::VectorXd              &s;
      const bool                    is_separable; ///< each node has its own law
      const bool                    states_are_majorants;
      BranchSearchResult            result;
      double                        functional = 0.; ///< where moves start
      double                        rounding;
      unsigned int                  n_pieces = 0;
      BorderedCholesky              factor; ///< of the last trial
      // States that trials have started from or ended in.
      std::set<PieceState> tried;

      /// A minimum that a trial has ended in.
      struct End
      {
        double          functional;
        Eigen::VectorXd s;
      };
      std::vector<End>                  ends;
      std::map<PieceState, std::size_t> end_of_way; ///< by states on the way

      bool
      may_go_on()
      {
        result.complete = result.complete && result.trials < maximum_trials &&
                          !problem.interruption.requested();
        return result.complete;
      }

      /// Moves until none is left that lowers the functional.
      void
      descend(Eigen::VectorXd point)
      {
        // Patches first: they find most, and are few.
        while (move_patches(point) || move_by_stretch(point))
          ;
      }

      /// The first move of a patch that pays; its edge then goes on, by twice
      /// as many layers each time.
      bool
      move_patches(Eigen::VectorXd &point)
      {
        for (PieceMove move : moves_from(problem.lumped.state(point),
                                         problem.neighbours,
                                         n_pieces,
                                         parameters.maximum_shift,
                                         parameters.flips))
          {
            if (!may_go_on())
              return false;
            if (!attempt(move, MoveKind::patch, point))
              continue;
            for (unsigned int n = 2; may_go_on(); n *= 2)
              {
                // From where the move has led, n layers further at once: a
                // front that travels far takes as many trials as the logarithm
                // of its way.
                move = beyond(move,
                              problem.lumped.state(point),
                              problem.neighbours,
                              n);
                if ((move.down.empty() && move.up.empty()) ||
                    !attempt(move, MoveKind::patch, point))
                  break;
              }
            return true;
          }
        return false;
      }

      bool
      move_by_stretch(Eigen::VectorXd &point)
      {
        // A search of starts alone has no moves.
        if (parameters.maximum_shift == 0)
          return false;
        for (const PieceMove &move :
             moves_by_stretch(problem.lumped.state(point),
                              problem.lumped.displacements(point),
                              n_pieces))
          if (!may_go_on())
            return false;
          else if (attempt(move, MoveKind::stretch, point))
            return true;
        return false;
      }

      static bool
      is_diagonal(const Eigen::SparseMatrix<double> &E)
      {
        for (int j = 0; j < E.outerSize(); ++j)
          for (Eigen::SparseMatrix<double>::InnerIterator entry(E, j); entry;
               ++entry)
            if (entry.row() != j)
              return false;
        return true;
      }

      /// Minimises from the changed state. Returns whether the functional is
      /// below that of @p point, which then moves.
      bool
      attempt(const PieceMove &move,
              const MoveKind   kind,
              Eigen::VectorXd &point)
      {
        // A trial: the nodes of the move are put on the other side of their
        // kink, majorise-minimise takes the point to a minimum, and the search
        // continues from there if J is lower. States say which trials have been
        // made before.
        const std::vector<PiecewiseEnergy> &f = problem.lumped.f;

        // The nodes of the move go inside the piece, from where majorise-
        // minimise takes them to a minimum that has them there, if there is
        // one.
        Eigen::VectorXd       next = point;
        const Eigen::VectorXd l    = problem.lumped.displacements(point);
        // Where there are no bonds no piece is to be left, and what bonds have
        // left for good is none of theirs.
        const auto piece_of = [&](const unsigned int i) {
          const unsigned int left = f[i].n_left();
          return left < move.piece && move.piece < f[i].size() + left ?
                   move.piece - left :
                   0;
        };
        for (const unsigned int i : move.down)
          if (const unsigned int piece = piece_of(i); piece > 0)
            problem.lumped.set_displacement(
              i, std::min(l(i), f[i].point_inside(piece)), next);
        for (const unsigned int i : move.up)
          if (const unsigned int piece = piece_of(i); piece > 0)
            problem.lumped.set_displacement(
              i, std::max(l(i), f[i].point_inside(piece - 1)), next);
        next = next.cwiseMin(problem.upper);
        // A state that has been tried leads where it led before.
        const PieceState start = problem.lumped.state(next);
        // Where points between the nodes have laws, a node's state says little
        // of them, and moves by stretch are tried from each minimum.
        if (!tried.insert(start).second &&
            (is_separable || kind != MoveKind::stretch))
          return false;

        ++result.trials;
        const MajoriseMinimiseResult minimum =
          minimise(start, kind == MoveKind::start, next);
        if (minimum.status != SolverStatus::success)
          {
            result.complete =
              result.complete && minimum.status != SolverStatus::interrupted;
            result.failures += minimum.status != SolverStatus::interrupted;
            return false;
          }
        // Starts go on from wherever they lead to, but not from a state that
        // was tried, unless it is lower: nodes do not tell on which pieces
        // the quadrature points between them are.
        const PieceState end        = problem.lumped.state(next);
        const bool       is_new     = end == start || tried.insert(end).second;
        const bool       is_start   = kind == MoveKind::start;
        const double     known_best = is_start ? result.functional : functional;
        if (minimum.functional >= known_best - rounding &&
            !(is_start && is_new))
          return false;
        // Moves go on from here, whether or not it is the best so far.
        point      = next;
        functional = minimum.functional;
        if (functional < result.functional - rounding)
          {
            ++result.improvements;
            result.functional = functional;
            s                 = point;
          }
        return true;
      }

      /// From @p next, which is in the state @p start and becomes the minimum.
      MajoriseMinimiseResult
      minimise(const PieceState &start,
               const bool        is_start,
               Eigen::VectorXd  &next)
      {
        // Most trials end above the best minimum, and their way there is what
        // takes the time: minimised roughly, with a guess of the active set for
        // starts.
        CondensedProblem trial(problem, next);
        trial.minimise_roughly();
        trial.factorise_by(factor);
        if (is_start)
          trial.guess_by(problem.guess);
        std::vector<PieceState> way = {start};
        std::size_t             end = ends.size();
        MajoriseMinimiseResult  minimum =
          minimise_trial(problem.method, trial, [&](const auto &iteration) {
            if (problem.work != nullptr)
              problem.work->add(iteration.operations);
            if (states_are_majorants)
              {
                // The state says what the majorant is, and so where the rest of
                // the way leads: to where the trial came to that has been in
                // it.
                way.push_back(problem.lumped.state(next));
                const auto known = end_of_way.find(way.back());
                if (known != end_of_way.end())
                  {
                    end = known->second;
                    return false;
                  }
              }
            return !problem.interruption.requested();
          });
        // The trial was ended by the monitor because another one had been in
        // this state; its end is that of the other one.
        if (end < ends.size())
          {
            minimum.status     = SolverStatus::success;
            minimum.functional = ends[end].functional;
            next               = ends[end].s;
          }
        if (minimum.status == SolverStatus::success && states_are_majorants &&
            end_of_way.size() * next.size() < most_pieces_on_ways)
          {
            if (end == ends.size())
              ends.push_back({minimum.functional, next});
            for (PieceState &state : way)
              end_of_way.emplace(std::move(state), end);
          }
        return minimum;
      }
    };
  } // namespace



  MajoriseMinimiseResult
  minimise_trial(const MajoriseMinimise          &method,
                 MajorantProblem                 &problem,
                 const MajoriseMinimise::Monitor &monitor)
  {
    const MajoriseMinimiseResult result = method.minimize(problem, monitor);
    if (result.status == SolverStatus::success ||
        result.status == SolverStatus::interrupted)
      return result;
    MajoriseMinimiseParameters parameters;
    parameters.tolerance = Tolerance::trial;
    return MajoriseMinimise(parameters).minimize(problem, monitor);
  }



  BranchSearchResult
  search_branches(const SearchProblem          &problem,
                  const BranchSearchParameters &parameters,
                  Eigen::VectorXd              &s)
  {
    return StateSearch(problem, parameters, s).run();
  }



  namespace
  {
    /// A node takes about n^3 operations, of which this is a few seconds'
    /// worth.
    constexpr double       most_operations = 4e8;
    constexpr unsigned int most_nodes      = 500;

    /// With more unknowns the first node takes longer than the first search.
    constexpr unsigned int largest_first_look = 100;

    /// Those of a look on so few, before any search and before the whole one: a
    /// proof of few nodes takes less time than these. The whole search takes up
    /// to a minute, so that a second is well spent on the second look.
    constexpr unsigned int nodes_of_first_look = 10, nodes_of_second_look = 300;
    constexpr double       operations_of_second_look = 1e9;

    /// Each is begun because the one before found a lower point.
    constexpr unsigned int most_proofs = 4;



    /// For one problem.
    struct GuidedSearch
    {
      const SearchProblem            &problem;
      const bool                      is_separable;
      const BranchAndBoundParameters &limits;
      GuidedSearchResult              result = {};

      GuidedSearchResult
      run(Eigen::VectorXd &s)
      {
        // The effort grows as long as there is no proof: nothing but a bound, a
        // quick search, the whole search with branch and bound.
        const double       n        = double(s.size());
        const bool         is_small = n <= largest_first_look;
        const unsigned int n_nodes  = static_cast<unsigned int>(std::ceil(
          std::min(double(most_nodes), most_operations / (n * n * n))));

        if (is_separable && is_proved(s, is_small ? nodes_of_first_look : 0))
          return result;
        BranchSearchParameters quick;
        quick.maximum_shift = 1;
        quick.flips         = false;
        search(quick, s);
        if (problem.interruption.requested() ||
            is_proved(s,
                      is_separable && is_small ?
                        static_cast<unsigned int>(
                          std::min(double(nodes_of_second_look),
                                   operations_of_second_look /
                                     (operations_of_node * n * n * n))) :
                        1))
          return result;
        // Search and proof help each other: a proof that finds a lower point
        // gives the search a start from which moves have not been tried, and a
        // lower minimum makes the proof's boxes smaller.
        for (unsigned int k = 0;
             k <= most_proofs && !problem.interruption.requested();
             ++k)
          {
            search({}, s);
            const Eigen::VectorXd searched = s;
            if (k == most_proofs || problem.interruption.requested() ||
                is_proved(s, n_nodes) || s == searched)
              break;
          }
        return result;
      }

      /// Adds what it did to the result.
      void
      search(const BranchSearchParameters &moves, Eigen::VectorXd &s)
      {
        // Counts are those of all searches, the functional that of the last,
        // which is the lowest.
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
      is_proved(Eigen::VectorXd &s, const unsigned int maximum_nodes)
      {
        // Envelopes are of quadratic pieces.
        if (!problem.lumped.is_piecewise_quadratic())
          return false;
        BranchAndBoundParameters parameters;
        // The limit of nodes depends on n alone, and there is none of time
        // here.
        parameters.tolerance     = limits.tolerance;
        parameters.n_threads     = limits.n_threads;
        parameters.maximum_nodes = maximum_nodes;
        const BranchAndBoundResult proof =
          branch_and_bound(parameters,
                           {problem.S,
                            problem.g,
                            problem.upper,
                            problem.lumped,
                            problem.interruption},
                           s);
        if (is_separable)
          result.proof = proof;
        if (problem.work != nullptr)
          problem.work->add(operations_of_node * proof.nodes *
                            std::pow(double(s.size()), 3.));
        // Where Phi is not separable the proof was for the lumped one, and its
        // point is only a start for Phi itself.
        Eigen::VectorXd  other = proof.s;
        CondensedProblem other_problem(problem, other);
        if (!is_separable &&
            minimise_trial(problem.method, other_problem).status !=
              SolverStatus::success)
          {
            ++result.search.failures;
            return false;
          }
        const MajorantProblem::State state = other_problem.evaluate();
        if (state.functional <
            CondensedProblem(problem, s).evaluate().functional -
              state.functional_rounding)
          s = other;
        return proof.status == ProofStatus::proved;
      }
    };
  } // namespace



  SeparableEnergy
  lumped_energy(const PiecewiseEnergy     &pieces,
                const Eigen::VectorXd     &weights,
                const std::vector<double> &lengths)
  {
    std::vector<PiecewiseEnergy> f;
    for (unsigned int i = 0; i < weights.size(); ++i)
      {
        // weights[i] is the factor of the second derivative, which is that of
        // the energy over the square of the length.
        const double length = lengths.empty() ? 1. : lengths[i];
        f.push_back(pieces.scaled(weights(i) * length * length, length));
      }
    return SeparableEnergy(f);
  }



  GuidedSearchResult
  guided_search(const SearchProblem            &problem,
                const bool                      is_separable,
                const BranchAndBoundParameters &limits,
                Eigen::VectorXd                &s)
  {
    return GuidedSearch{problem, is_separable, limits}.run(s);
  }
} // namespace Debond
