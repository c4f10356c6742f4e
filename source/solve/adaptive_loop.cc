// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/interrupt.h>
#include <debond/base/memory.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/input/bad_input.h>
#include <debond/mesh/bisected_body.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/adaptive_loop.h>
#include <debond/solve/load_path.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <queue>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// The next mesh has at most, and unless it would be too large at least, so
    /// many times the cells, without those that have to be cut for others. The
    /// error of a mesh with so many cells does not depend on how many meshes
    /// led to it with linear displacements; with quadratic ones it does
    /// (doc/notes/speed.md).
    constexpr double
    largest_growth(const unsigned int degree)
    {
      return degree == 1 ? 4. : 1.4;
    }

    constexpr double
    least_growth(const unsigned int degree)
    {
      return degree == 1 ? 1.25 : 1.1;
    }

    /// The same if parts of a certificate's gap are to become smaller.
    constexpr double growth_for_gaps = 1.7;

    /// Of branch and bound for certificates that only later ones use.
    constexpr unsigned int n_nodes_on_the_way = 100;

    /// The part of Accuracy/Target that a mesh is made for.
    constexpr double aim = 0.9;

    /// Cells that are cut for others.
    constexpr double closure = 1.1;



    /// How the estimate falls from mesh to mesh.
    class MeshGrowth
    {
    public:
      MeshGrowth(const AccuracyParameters &accuracy,
                 const unsigned int        dim,
                 const unsigned int        degree)
        : accuracy(accuracy)
        , least(least_growth(degree))
        , largest(largest_growth(degree))
        , smooth_rate(2. * degree / dim)
        , rate(smooth_rate)
      {}

      /// A mesh has been estimated.
      void
      add(const double n_unknowns, const double relative_error)
      {
        if (unknowns > 0. && error > 0. && relative_error > 0.)
          rate = std::clamp(std::log(error / relative_error) /
                              std::log(n_unknowns / unknowns),
                            0.5 * smooth_rate,
                            1.5 * smooth_rate);
        unknowns = n_unknowns;
        error    = relative_error;
      }

      /// That of the next mesh: equal steps to the mesh that meets the target,
      /// or to the largest one that is allowed.
      double
      next() const
      {
        double whole = std::numeric_limits<double>::infinity();
        if (accuracy.target > 0.)
          whole = std::pow(error / (aim * accuracy.target), 1. / rate);
        if (accuracy.maximum_unknowns > 0)
          whole =
            std::min(whole, accuracy.maximum_unknowns / (closure * unknowns));
        if (!std::isfinite(whole))
          return largest;
        const double steps =
          std::max(1., std::ceil(std::log(whole) / std::log(largest)));
        return std::max(least, std::pow(whole, 1. / steps));
      }

    private:
      const AccuracyParameters &accuracy;
      const double              least;
      const double              largest;
      const double              smooth_rate;
      double                    rate; ///< error ~ unknowns^-rate
      double                    unknowns = 0.;
      double                    error    = 0.;
    };



    /// How often each cell is to be cut. The cell with the largest part of the
    /// estimate is next until there are enough; where the solution is smooth, a
    /// half has 2^(-(2 + dim) / dim) of its part, and at corners more: with
    /// less for quadratic displacements those are cut too little where a mesh
    /// may grow but once.
    std::vector<unsigned int>
    divisions(const std::vector<double> &parts,
              const unsigned int         dim,
              const double               growth)
    {
      struct Piece
      {
        double       part;
        unsigned int cell;

        bool
        operator<(const Piece &other) const
        {
          return part != other.part ? part < other.part : cell > other.cell;
        }
      };
      std::priority_queue<Piece> pieces;
      for (unsigned int cell = 0; cell < parts.size(); ++cell)
        pieces.push({parts[cell], cell});

      const double              of_a_half = std::pow(2., -(2. + dim) / dim);
      std::vector<unsigned int> times(parts.size(), 0);
      double                    n    = static_cast<double>(parts.size());
      const double              goal = growth * n;
      while (n < goal && pieces.top().part > 0.)
        {
          const Piece largest = pieces.top();
          pieces.pop();
          n += std::ldexp(1., static_cast<int>(times[largest.cell]++));
          pieces.push({largest.part * of_a_half, largest.cell});
        }
      return times;
    }



    template <int dim>
    const BisectedBody<dim> &
    bisected(const Scene<dim> &scene)
    {
      return dynamic_cast<const BisectedBody<dim> &>(scene.body());
    }



    /// Estimate in bytes of what factorising @p n unknowns takes: mesh, A and
    /// the fill of minimum degree orderings, about n log n in 2D and n^(4/3) in
    /// 3D.
    double
    memory_of_factorisation(const double n, const int dim)
    {
      return dim == 2 ? (900. + 29. * std::log2(n)) * n :
                        600. * n + 125. * std::pow(n, 4. / 3.);
    }



    /// Why there can be no mesh as large as that of @p body; empty if there
    /// can. @p memory_limit: 0 for what is there.
    template <int dim>
    std::string
    too_large(const ProblemParameters  &problem,
              const AccuracyParameters &accuracy,
              const double              memory_limit,
              const Body<dim>          &body)
    {
      // Of degree 2 edges have unknowns as well, their number by Euler's
      // formula for bodies without holes, in 3D about.
      const double n_nodes    = problem.degree == 1 ?
                                  body.n_vertices() :
                                  2. * body.n_vertices() + body.n_cells() - 1.;
      const double n_unknowns = dim * n_nodes;
      // Four unknowns on each of 3/2 sides a triangle, or nine on each of two
      // faces a tetrahedron, for stresses.
      const double n =
        accuracy.certified_width > 0. ?
          std::max(n_unknowns, (dim == 2 ? 6. : 18.) * body.n_cells()) :
          n_unknowns;
      const double       memory = memory_of_factorisation(n, dim);
      std::ostringstream text;
      text << "the next mesh would have " << std::fixed << std::setprecision(0)
           << n_unknowns << " unknowns, ";
      const double limit = memory_left(memory_limit);
      if (accuracy.maximum_unknowns > 0 &&
          n_unknowns > accuracy.maximum_unknowns)
        text << "Accuracy/Maximum unknowns is " << accuracy.maximum_unknowns;
      else if (memory > limit)
        text << "which need about " << std::setprecision(2)
             << memory / (1 << 30) << " GiB of memory, the limit is "
             << limit / (1 << 30) << " GiB";
      else
        return "";
      return text.str();
    }



    /// Of numbers for the cells that a rank has those of all cells, by their
    /// places in the whole mesh.
    template <int dim>
    std::vector<double>
    of_whole_mesh(const Scene<dim> &scene, const std::vector<double> &of_cells)
    {
      std::vector<double> result(scene.n_cells(), 0.);
      for (const auto &cell :
           owned_cells(scene.problem().unknowns().dof_handler()))
        result[cell->id().get_coarse_cell_id()] =
          of_cells[cell->active_cell_index()];
      dealii::Utilities::MPI::sum(result, scene.ranks(), result);
      return result;
    }



    template <int dim>
    ErrorEstimate
    estimate_of(const Scene<dim>            &scene,
                const AdhesionIntegral<dim> &bonds,
                const DofVector             &u,
                const double                 functional,
                const LoadFactors            factors)
    {
      return estimate_error(scene.problem(),
                            bonds,
                            scene.conditions(),
                            scene.supports(),
                            scene.loads(),
                            u,
                            functional,
                            factors,
                            &scene.dead_loads());
    }



    /// The states that the load path leads to; @p largest becomes the estimate
    /// of the one that has the largest error relative to its J, @p functional.
    template <int dim>
    SolveResult
    follow(const SolverParameters &solver,
           const double            tolerance,
           const Scene<dim>       &scene,
           ErrorEstimate          &largest,
           double                 &functional,
           FollowedPath<dim>      &path)
    {
      LoadPathParameters followed = scene.parameters().load_path;
      followed.global_branch      = GlobalBranch::none;
      followed.arc                = false;
      std::vector<LoadPathStep<dim>> arc;
      return follow_load_path<dim>(
        followed,
        solver,
        tolerance,
        scene,
        [&](const LoadPathStep<dim> &step,
            const DofVector         &u,
            const Verification<dim> &,
            const AdhesionIntegral<dim> &bonds) {
          path.bonds = std::make_shared<const AdhesionIntegral<dim>>(bonds);
          ErrorEstimate own =
            estimate_of(scene, bonds, u, step.state.functional, step.factors());
          if (largest.cells.empty() || own.relative() > largest.relative())
            {
              largest    = std::move(own);
              functional = step.state.functional;
            }
        },
        nullptr,
        path.steps,
        arc);
    }



    /// The certificate of a level; of one that Certificate/Target is for
    /// bonds that may break, which takes longer, that for their branches as
    /// they are as long as that is not narrow enough and @p is_last is false.
    /// @p global is the latest one for bonds that may break, for which the next
    /// one is narrower. Throws EquilibriumError if there is none.
    template <int dim>
    Certificate
    certify_level(const CertificateKind                    kind,
                  const double                             target,
                  const BranchAndBoundParameters          &proof,
                  const std::shared_ptr<const Scene<dim>> &scene,
                  const DofVector                         &u,
                  const bool                               is_last,
                  std::optional<Certificate>              &global,
                  const std::function<bool()>             &may_go_on)
    {
      const auto certify = [&](const CertificateKind           kind_of_this,
                               const BranchAndBoundParameters &limits) {
        Certificate certificate = Certifier<dim>(kind_of_this, scene)
                                    .certify(*scene,
                                             u,
                                             limits,
                                             may_go_on,
                                             global ? &*global : nullptr,
                                             !is_last);
        if (certificate.minimum == CertifiedMinimum::global)
          global = certificate;
        return certificate;
      };
      if (kind == CertificateKind::global && !is_last)
        try
          {
            const Certificate first =
              certify(CertificateKind::fixed_state, proof);
            if (first.minimum == CertifiedMinimum::global)
              return first;
            if (first.width() > target)
              {
                BranchAndBoundParameters limits = proof;
                limits.maximum_nodes =
                  std::min(limits.maximum_nodes, n_nodes_on_the_way);
                certify(kind, limits);
                return first;
              }
          }
        catch (const std::exception &)
          {
            // Such as a body that only bonds hold.
          }
      return certify(kind, proof);
    }



    std::string
    too_wide(const Certificate &certificate, const double target)
    {
      std::ostringstream text;
      text << "The interval is " << std::setprecision(2) << certificate.width()
           << " of |J| wide, Certificate/Target is " << target;
      if (!certificate.loads_are_exact)
        text << " (a vertex where a load jumps or bends makes it narrower)";
      return text.str();
    }



    /// What is left of a loop that a signal ends on the way to the next mesh.
    void
    interrupt(SolveResult &solve)
    {
      solve.status  = SolverStatus::interrupted;
      solve.message = "The result is that of the last mesh that was finished.";
    }
  } // namespace



  template <int dim>
  std::shared_ptr<const Scene<dim>>
  make_first_scene(const ProblemParameters  &problem,
                   const AccuracyParameters &accuracy,
                   const std::string        &start)
  {
    if (!accuracy.is_adaptive())
      return std::make_shared<const Scene<dim>>(problem, start, MPI_COMM_WORLD);
    std::shared_ptr<const Body<dim>> body;
    try
      {
        body = std::make_shared<const BisectedBody<dim>>(
          std::dynamic_pointer_cast<const Body<dim>>(problem.body));
      }
    catch (const PartError &)
      {
        // The scene without refinement says which entry that is.
        return std::make_shared<const Scene<dim>>(problem,
                                                  start,
                                                  MPI_COMM_WORLD);
      }
    catch (const std::invalid_argument &error)
      {
        throw BadInput({problem.scene + ": Accuracy: " + error.what()});
      }
    return std::make_shared<const Scene<dim>>(problem,
                                              body,
                                              start,
                                              MPI_COMM_WORLD);
  }



  template <int dim>
  AdaptiveResult
  solve_adaptively(const MethodChoice       &choice,
                   const SolverParameters   &solver,
                   const AccuracyParameters &accuracy,
                   const CertificateKind     certificate,
                   const double              tolerance,
                   const std::function<void(const AdaptiveLevel &)> &report,
                   std::shared_ptr<const Scene<dim>>                &scene,
                   FollowedPath<dim>                                *path)
  {
    // Of all meshes.
    const ProblemParameters           problem = scene->parameters();
    const MPI_Comm                    ranks   = scene->ranks();
    AdaptiveResult                    result;
    const InterruptGuard              guard;
    dealii::Timer                     timer;
    std::shared_ptr<const Scene<dim>> next;
    std::shared_ptr<const Body<dim>>  finished, latest;
    std::unique_ptr<const DofVector>  start;
    MeshGrowth                        growth(accuracy, dim, problem.degree);
    std::optional<Certificate>        narrowest;
    while (true)
      {
        const bool        is_first = !next;
        const Scene<dim> &here     = is_first ? *scene : *next;
        ErrorEstimate     estimate;
        FollowedPath<dim> path_here;
        SolveResult       solution;
        double            functional = 0.;
        try
          {
            if (problem.load_path.factors.empty())
              {
                solution =
                  solve(choice, solver, here, nullptr, false, start.get());
                functional = solution.functional;
                if (can_be_verified(solution.status) &&
                    !solution.minimum.interrupted)
                  estimate = estimate_of(
                    here, here.adhesion(), solution.u, solution.functional, 1.);
              }
            else
              solution = follow(
                solver, tolerance, here, estimate, functional, path_here);
          }
        catch (const std::invalid_argument &error)
          {
            result.shortfall =
              std::string("The error of the mesh is not known, ") +
              error.what() + '.';
          }
        if (!is_first && solution.status == SolverStatus::interrupted)
          {
            if (!scene)
              scene = std::make_shared<const Scene<dim>>(problem,
                                                         finished,
                                                         "",
                                                         ranks);
            interrupt(result.solve);
            return result;
          }
        result.solve = std::move(solution);
        if (!is_first)
          scene = std::move(next);
        const bool comes_off_later =
          result.solve.status == SolverStatus::comes_off &&
          !path_here.steps.empty();
        if (path != nullptr)
          *path = std::move(path_here);
        if (!(can_be_verified(result.solve.status) || comes_off_later) ||
            result.solve.minimum.interrupted)
          return result;

        if (!result.shortfall.empty())
          return result;
        const double target  = accuracy.certified_width;
        const auto   certify = [&](const bool is_last) {
          result.certificate.reset();
          try
            {
              result.certificate =
                certify_level<dim>(certificate,
                                   target,
                                   solver.proof,
                                   scene,
                                   result.solve.u,
                                   is_last,
                                   narrowest,
                                   [&]() { return !guard.requested(); });
              result.certificate->include(result.solve.functional);
            }
          catch (const std::exception &error)
            {
              result.shortfall = no_certificate(error);
            }
        };
        if (target > 0.)
          certify(false);
        if (!result.shortfall.empty())
          return result;
        const double width =
          result.certificate ? result.certificate->width() : 0.;
        const ElasticUnknowns<dim> &unknowns = scene->problem().unknowns();
        report({scene->n_cells(),
                unknowns.n_free_dofs(),
                unknowns.contact().size(),
                result.solve.iterations,
                functional,
                estimate.relative(),
                width,
                timer.wall_time() + (is_first ? scene->mesh_seconds() +
                                                  scene->assembly_seconds() :
                                                0.)});
        const bool is_accurate = estimate.relative() <= accuracy.target;
        if (target > 0. && guard.requested())
          {
            interrupt(result.solve);
            return result;
          }
        if (target > 0. ?
              width <= target && (is_accurate || accuracy.target == 0.) :
              is_accurate)
          return result;

        timer.restart();
        const bool by_gaps =
          width > target && !result.certificate->gaps.empty();
        growth.add(unknowns.n_free_dofs(), estimate.relative());
        double times = by_gaps || target > 0. ? growth_for_gaps : growth.next();
        std::shared_ptr<const BisectedBody<dim>> body;
        std::string                              limit;
        while (true)
          {
            body = bisected(*scene).refined(
              divisions(by_gaps ? result.certificate->gaps :
                                  of_whole_mesh(*scene, estimate.cells),
                        dim,
                        times));
            limit =
              too_large<dim>(problem, accuracy, solver.memory_limit, *body);
            if (limit.empty() || times <= least_growth(problem.degree))
              break;
            times = std::max(least_growth(problem.degree), 0.75 * times);
          }
        if (!limit.empty() || estimate.functional == 0.)
          {
            if (target > 0.)
              {
                if (certificate == CertificateKind::global &&
                    result.certificate->minimum != CertifiedMinimum::global)
                  certify(true);
                if (!result.shortfall.empty())
                  return result;
                if (result.certificate->width() > target)
                  result.shortfall =
                    too_wide(*result.certificate, target) + ": " + limit + '.';
              }
            if (!is_accurate && accuracy.target > 0.)
              {
                std::ostringstream text;
                text << (result.shortfall.empty() ? "" : " ")
                     << "The estimated error of " << std::setprecision(2)
                     << estimate.relative()
                     << " is above Accuracy/Target = " << accuracy.target
                     << ": " << limit << '.';
                result.shortfall += text.str();
              }
            return result;
          }
        next = std::make_shared<const Scene<dim>>(problem, body, "", ranks);
        if (guard.requested())
          {
            interrupt(result.solve);
            return result;
          }
        start = std::make_unique<const DofVector>(
          divided_displacement(scene->problem(),
                               result.solve.u,
                               body->ancestors(),
                               next->problem()));
        // Its memory is for the next mesh; the state of a path knows it.
        finished = latest;
        latest   = body;
        if (finished && (path == nullptr || path->steps.empty()))
          scene.reset();
      }
  }



  template decltype(make_first_scene<2>) make_first_scene<2>;
  template decltype(make_first_scene<3>) make_first_scene<3>;
  template decltype(solve_adaptively<2>) solve_adaptively<2>;
  template decltype(solve_adaptively<3>) solve_adaptively<3>;
} // namespace Debond
