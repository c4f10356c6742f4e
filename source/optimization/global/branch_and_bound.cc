// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/processes.h>
#include <debond/optimization/global/bond_bound.h>
#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <future>
#include <set>

namespace Debond
{
  namespace
  {
    /// Nodes that are bounded against the same best value, whatever the number
    /// of threads, so that this number changes no result.
    constexpr unsigned int batch_size = 8;

    /// A node's vectors.
    constexpr unsigned int vectors_per_node = 4;



    /// A node, and what came out of it.
    struct Job
    {
      ProofNode  node;
      NodeResult result;

      /// From the node's relaxation by majorise-minimise, unless its state had
      /// been tried.
      PieceState      state;
      Eigen::VectorXd s;
      double          value = infinity;
    };



    using Clock = std::chrono::steady_clock;



    /// @p Bound is NodeBound, or has its functions.
    template <typename Bound>
    class ProofTree
    {
    public:
      ProofTree(const BranchAndBoundParameters &parameters,
                const SeparableProblem         &problem,
                const VectorView               &start)
        : parameters(parameters)
        , problem(problem)
        , n(static_cast<unsigned int>(problem.g.size()))
        , node_bound(problem, parameters.rounds_of_root)
        , least_left_out(infinity)
      {
        result.upper = infinity;
        result.lower = -infinity;
        // There is a best value from the beginning, without which nothing could
        // be left out.
        Job job;
        minimise_from(start, job);
        take_if_better(job);
      }

      BranchAndBoundResult
      run()
      {
        // The cheapest proof first: most minima of well supported bodies are
        // proved by one factorisation at the minimum.
        const ProofRound at_point = node_bound.bound_at(result.s);
        const double     at_start = at_point.value;
        if (at_start >= result.upper - parameters.tolerance)
          {
            result.status  = ProofStatus::proved;
            least_left_out = at_start;
            result.nodes   = 1;
            // With bonds of several unknowns it is one in the box of the root.
            if (parameters.keeps_record && !problem.phi.bonds.empty())
              keep_root(*node_bound.root(result.upper));
            keep(0, {{at_point}});
          }
        else if (parameters.maximum_nodes > 0)
          {
            auto root = node_bound.root(result.upper);
            if (!root)
              return result;
            // Both are bounds for all points, of which the better one counts.
            root->bound = std::max(root->bound, at_start);
            if (parameters.keeps_record)
              keep_root(*root);
            open.insert(*root);
            result.status = ProofStatus::proved;
          }
        else
          {
            result.status  = ProofStatus::node_limit;
            least_left_out = at_start;
          }
        // Each point of the search space is in the box of an open node, or in
        // one that has been left out, whose bound least_left_out has. So the
        // least of these bounds is one for the minimum at any time, and the
        // loop may end after any batch.
        unsigned int next_record = 1;
        while (!open.empty() && result.status == ProofStatus::proved)
          {
            result.status = check_limits();
            if (result.status != ProofStatus::proved)
              break;
            // Nodes of a batch do not see what the others find, so that they
            // can be bounded at the same time. The results are taken in the
            // order of the batch, whatever the order in which threads end.
            std::vector<Job> batch = next_batch();
            work_on(batch);
            for (const Job &job : batch)
              {
                take_if_better(job);
                // A signal cuts jobs short, which are to be done again; a limit
                // of work lets them end.
                if (Interruption::by_signal().requested())
                  open.insert(job.node);
                else
                  branch(job);
              }
            // Only whole batches count, so that a limit of nodes ends at the
            // same node on all machines.
            result.nodes += static_cast<unsigned int>(batch.size());
            if ((problem.interruption.requested()) && !open.empty())
              result.status = ProofStatus::interrupted;
            if (result.nodes >= next_record)
              {
                result.history.push_back(progress());
                next_record = result.nodes + 1 + result.nodes / 10;
              }
          }
        // What has been left out has values above the tolerance or is counted
        // in least_left_out; if rounding left more than the tolerance between
        // the bounds, there is no proof.
        const ProofProgress end = progress();
        if (result.status == ProofStatus::proved &&
            result.upper - end.lower > parameters.tolerance)
          result.status = ProofStatus::rounding;
        result.lower   = end.lower;
        result.seconds = end.seconds;
        result.history.push_back(end);
        return result;
      }

    private:
      const BranchAndBoundParameters &parameters;
      const SeparableProblem         &problem;
      const unsigned int              n;
      const Bound                     node_bound;

      const Clock::time_point begin = Clock::now();
      BranchAndBoundResult    result;
      std::set<ProofNode>     open;
      std::set<PieceState>    tried; ///< states that were minimised
      double                  least_left_out;
      unsigned int            n_created = 0;
      std::size_t             n_rounds  = 0; ///< in the record

      void
      minimise_from(const Eigen::VectorXd &x, Job &job) const
      {
        // A lower point, if there is one near, improves the bounds of all nodes
        // to come. From a state that was minimised before nothing new comes.
        job.state = problem.phi.state(x);
        // Where bonds soften the state does not say where it leads to.
        if (!problem.phi.softens() && tried.count(job.state) > 0)
          return;
        Eigen::VectorXd  s = x.cwiseMin(problem.upper);
        CondensedProblem condensed(
          {problem.S, problem.g, problem.upper, problem.phi}, s);
        MajoriseMinimise({}).minimize(condensed);
        const double value = condensed.evaluate().functional;
        if (value < job.value)
          {
            job.s     = s;
            job.value = value;
          }
      }

      void
      take_if_better(const Job &job)
      {
        tried.insert(job.state);
        if (job.value < result.upper)
          {
            result.upper = job.value;
            result.s     = job.s;
          }
      }

      ProofStatus
      check_limits() const
      {
        // Nodes first, which is the same everywhere; time and memory depend on
        // the machine, and on ranks the slowest one decides.
        if (result.nodes >= parameters.maximum_nodes)
          return ProofStatus::node_limit;
        if (any_rank(seconds() > parameters.maximum_seconds))
          return ProofStatus::time_limit;
        if (double(open.size() + n_rounds) * vectors_per_node * n *
              sizeof(double) >
            parameters.maximum_bytes)
          return ProofStatus::memory_limit;
        return ProofStatus::proved;
      }

      /// Takes the open nodes with the lowest bounds.
      std::vector<Job>
      next_batch()
      {
        std::vector<Job> batch;
        while (!open.empty() && batch.size() < batch_size &&
               result.nodes + batch.size() < parameters.maximum_nodes)
          {
            batch.emplace_back();
            batch.back().node = open.extract(open.begin()).value();
            // No point in it is lower by more than the tolerance: it is left
            // out, and its bound counts for the answer.
            if (batch.back().node.bound >= result.upper - parameters.tolerance)
              {
                least_left_out =
                  std::min(least_left_out, batch.back().node.bound);
                batch.pop_back();
              }
          }
        return batch;
      }

      void
      work_on(std::vector<Job> &batch) const
      {
        // Each thread takes the next node that none has taken: nodes differ in
        // their number of relaxations.
        std::atomic<unsigned int> next(0);
        const auto                work = [&]() {
          for (unsigned int k = next++; k < batch.size(); k = next++)
            {
              Job &job = batch[k];
              // Bounds are made against the best value of the batch's
              // beginning, which no thread changes.
              job.result =
                node_bound.bound(job.node, result.upper, parameters.tolerance);
              if (job.node.bound < result.upper - parameters.tolerance)
                minimise_from(job.node.x, job);
            }
        };
        std::vector<std::future<void>> others;
        for (unsigned int t = 1;
             t < std::min<std::size_t>(parameters.n_threads, batch.size());
             ++t)
          others.push_back(std::async(std::launch::async, work));
        work();
        for (std::future<void> &other : others)
          other.get();
      }

      /// Adds to the record of a node, if there is to be one.
      void
      keep(const unsigned int number, const NodeRecord &found)
      {
        if (!parameters.keeps_record)
          return;
        NodeRecord &node = result.record[number];
        n_rounds += found.rounds.size();
        node.rounds.insert(node.rounds.end(),
                           found.rounds.begin(),
                           found.rounds.end());
        node.unknown     = found.unknown;
        node.split       = found.split;
        node.halves      = found.halves;
        node.half_bounds = found.half_bounds;
      }

      void
      keep_root(const ProofNode &root)
      {
        keep(0, {{node_bound.round_of_root(root)}});
      }

      void
      branch(const Job &job)
      {
        keep(job.node.number,
             {job.result.rounds,
              job.result.unknown,
              job.result.split,
              {{n_created + 1, n_created + 2}},
              job.result.half_bounds});
        if (!job.result.unknown)
          {
            least_left_out = std::min(least_left_out, job.result.least);
            return;
          }
        // Two boxes, one above the place to split and one below, with the
        // bounds that each half has beyond that of the whole.
        const unsigned int i     = *job.result.unknown;
        ProofNode          upper = job.node, lower = job.node;
        upper.number   = ++n_created;
        lower.number   = ++n_created;
        upper.lower(i) = job.result.split;
        lower.upper(i) = job.result.split;
        upper.bound    = std::max(job.node.bound, job.result.half_bounds[0]);
        lower.bound    = std::max(job.node.bound, job.result.half_bounds[1]);
        open.insert(upper);
        open.insert(lower);
      }

      double
      seconds() const
      {
        return std::chrono::duration<double>(Clock::now() - begin).count();
      }

      ProofProgress
      progress() const
      {
        // The least of what is open and of what was left out is below all
        // values.
        double lower = std::min(result.upper, least_left_out);
        if (!open.empty())
          lower = std::min(lower, open.begin()->bound);
        return {result.nodes,
                static_cast<unsigned int>(open.size()),
                lower,
                result.upper,
                seconds()};
      }
    };
  } // namespace



  std::string
  to_string(const ProofStatus status)
  {
    static const std::array<const char *, 7> words = {{"proved",
                                                       "node limit",
                                                       "time limit",
                                                       "memory limit",
                                                       "interrupted",
                                                       "tolerance too small",
                                                       "no bound"}};
    return words[static_cast<std::size_t>(status)];
  }



  BranchAndBoundResult
  branch_and_bound(const BranchAndBoundParameters &parameters,
                   const SeparableProblem         &problem,
                   const VectorView               &start)
  {
    if (!problem.phi.bonds.empty())
      return ProofTree<BondBound>(parameters, problem, start).run();
    return ProofTree<NodeBound>(parameters, problem, start).run();
  }
} // namespace Debond
