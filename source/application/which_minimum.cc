// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/application/method_choice.h>
#include <debond/application/which_minimum.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/contact/boundary_graph.h>
#include <debond/optimization/bond_search.h>
#include <debond/optimization/coarse_start.h>
#include <debond/optimization/condensed_problem.h>

#include <cmath>

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



    BondSearchParameters
    search_parameters(const Parameters &parameters)
    {
      if (parameters.search == BondSearchChoice::full)
        return parameters.full_search;
      BondSearchParameters quick;
      quick.maximum_shift = 1;
      quick.flips         = false;
      quick.splits        = false;
      return quick;
    }



    bool
    wants_search(const Parameters &parameters)
    {
      return parameters.search == BondSearchChoice::automatic ?
               parameters.method == SolverMethod::automatic :
               parameters.search != BondSearchChoice::none;
    }



    void
    add_search(const BondSearchResult &search,
               const unsigned int      n_nodes,
               WhichMinimum           &result)
    {
      for (const unsigned int trials : search.trials)
        result.search_trials += trials;
      for (const unsigned int improvements : search.improvements)
        result.search_improvements += improvements;
      result.search_nodes = n_nodes;
      result.kind =
        search.complete ? MinimumKind::best_known : MinimumKind::stationary;
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



    /// A search on a coarser contact mesh. The best of it is minimised on the
    /// finer ones, and taken if it is lower there; then the edges of patches
    /// move by a node.
    template <int dim>
    void
    search_on_coarse_mesh(const Parameters            &parameters,
                          const ContactBoundary<dim>  &boundary,
                          const AdhesiveLaw           &law,
                          const AdhesionIntegral<dim> &adhesion,
                          const Condensation          &condensed,
                          const std::function<bool()> &may_go_on,
                          dealii::Vector<double>      &s,
                          WhichMinimum                &result)
    {
      const MajoriseMinimise method(parameters.majorise_minimise);
      const auto prolongations = coarsen(boundary, largest_automatic_search);
      const auto monitor       = [&](const auto &) { return may_go_on(); };

      std::vector<std::string> failures;
      dealii::Vector<double>   point = coarse_start(
        condensed.schur_complement(),
        condensed.load(),
        adhesion,
        prolongations,
        method,
        failures,
        monitor,
        [&](const dealii::FullMatrix<double> &S,
            const dealii::Vector<double>     &g,
            const PiecewiseQuadratic         &phi,
            dealii::Vector<double>           &coarse_s) {
          add_search(search_bonds(S,
                                  g,
                                  phi,
                                  law.bond_threshold(),
                                  coarse_neighbours(prolongations.back()),
                                  method,
                                  search_parameters(parameters),
                                  coarse_s,
                                  may_go_on),
                     coarse_s.size(),
                     result);
        });
      CondensedProblem             problem(condensed.schur_complement(),
                               condensed.load(),
                               adhesion,
                               point);
      const MajoriseMinimiseResult minimum = method.minimize(problem, monitor);
      const auto given = CondensedProblem(condensed.schur_complement(),
                                          condensed.load(),
                                          adhesion,
                                          s)
                           .evaluate();
      result.search_improvements = 0;
      if (minimum.status == SolverStatus::success &&
          minimum.functional < given.functional - given.functional_rounding)
        {
          s                          = point;
          result.search_improvements = 1;
        }

      BondSearchParameters edges;
      edges.starts        = false;
      edges.flips         = false;
      edges.splits        = false;
      edges.maximum_shift = 1;
      add_search(search_bonds(condensed.schur_complement(),
                              condensed.load(),
                              adhesion,
                              law.bond_threshold(),
                              neighbours(boundary),
                              method,
                              edges,
                              s,
                              may_go_on),
                 result.search_nodes,
                 result);
    }



    template <int dim>
    void
    prove(const Parameters            &parameters,
          const AdhesiveLaw           &law,
          const AdhesionIntegral<dim> &adhesion,
          const Condensation          &condensed,
          const std::function<bool()> &may_go_on,
          dealii::Vector<double>      &s,
          WhichMinimum                &result)
    {
      const dealii::FullMatrix<double> &S   = condensed.schur_complement();
      const double                      c_0 = condensed.energy_at_zero();
      const SeparableBonds              bonds(
        Eigen::VectorXd(
          adhesion.curvature(dealii::Vector<double>(s.size())).diagonal()),
        law.bond_threshold());

      const double J =
        CondensedProblem(S, condensed.load(), bonds, s).evaluate().functional +
        c_0;
      BranchAndBoundParameters proof_parameters = parameters.proof;
      proof_parameters.tolerance *= std::abs(J);
      proof_parameters.maximum_bytes = memory_left(parameters);
      const BranchAndBoundResult proof =
        BranchAndBound(proof_parameters)
          .minimize(S, condensed.load(), bonds, s, [&](const ProofProgress &) {
            return may_go_on();
          });

      result.proof_attempted = true;
      result.proof_status    = proof.status;
      result.proof_nodes     = proof.nodes;
      result.lower_bound     = proof.lower + c_0;
      result.relative_gap =
        (proof.upper - proof.lower) / std::abs(proof.upper + c_0);
      result.proof_history = proof.history;
      for (ProofProgress &progress : result.proof_history)
        {
          progress.lower += c_0;
          progress.upper += c_0;
        }
      // A rounding in J is no better minimum.
      if (proof.upper + c_0 < J - proof_parameters.tolerance)
        s = proof.s;
      if (proof.status == ProofStatus::proved)
        result.kind = MinimumKind::global;
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



  template <int dim>
  MinimumKind
  kind_without_search(const AdhesiveLaw            &law,
                      const AdhesionIntegral<dim>  &adhesion,
                      const dealii::Vector<double> &s)
  {
    // Without bonds J is convex.
    if (law.bond_threshold() == 0. || s.size() == 0)
      return MinimumKind::global;

    // No quadrature point is so close to the kink that it changes its branch.
    dealii::Vector<double> more = s, less = s;
    more *= 1. + kink_width;
    less *= 1. - kink_width;
    const Eigen::SparseMatrix<double> difference =
      adhesion.curvature(more) - adhesion.curvature(less);
    return difference.norm() == 0. ? MinimumKind::local_minimum :
                                     MinimumKind::stationary;
  }



  template <int dim>
  WhichMinimum
  find_better_minimum(const Parameters            &parameters,
                      const ContactBoundary<dim>  &boundary,
                      const AdhesiveLaw           &law,
                      const AdhesionIntegral<dim> &adhesion,
                      const Condensation          &condensed,
                      const std::function<bool()> &may_go_on,
                      dealii::Vector<double>      &s)
  {
    WhichMinimum result;
    result.kind = kind_without_search(law, adhesion, s);
    if (result.kind == MinimumKind::global)
      return result;

    if (wants_search(parameters))
      {
        if (parameters.search == BondSearchChoice::automatic &&
            s.size() > largest_automatic_search)
          search_on_coarse_mesh(parameters,
                                boundary,
                                law,
                                adhesion,
                                condensed,
                                may_go_on,
                                s,
                                result);
        else
          add_search(search_bonds(condensed.schur_complement(),
                                  condensed.load(),
                                  adhesion,
                                  law.bond_threshold(),
                                  neighbours(boundary),
                                  MajoriseMinimise(
                                    parameters.majorise_minimise),
                                  search_parameters(parameters),
                                  s,
                                  may_go_on),
                     s.size(),
                     result);
        if (result.kind != MinimumKind::best_known)
          result.kind = kind_without_search(law, adhesion, s);
      }
    if (parameters.prove)
      prove(parameters, law, adhesion, condensed, may_go_on, s, result);
    result.interrupted = !may_go_on();
    return result;
  }



  template MinimumKind
  kind_without_search(const AdhesiveLaw &,
                      const AdhesionIntegral<2> &,
                      const dealii::Vector<double> &);
  template MinimumKind
  kind_without_search(const AdhesiveLaw &,
                      const AdhesionIntegral<3> &,
                      const dealii::Vector<double> &);
  template WhichMinimum
  find_better_minimum(const Parameters &,
                      const ContactBoundary<2> &,
                      const AdhesiveLaw &,
                      const AdhesionIntegral<2> &,
                      const Condensation &,
                      const std::function<bool()> &,
                      dealii::Vector<double> &);
  template WhichMinimum
  find_better_minimum(const Parameters &,
                      const ContactBoundary<3> &,
                      const AdhesiveLaw &,
                      const AdhesionIntegral<3> &,
                      const Condensation &,
                      const std::function<bool()> &,
                      dealii::Vector<double> &);
} // namespace Debond
