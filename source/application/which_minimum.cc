// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/application/method_choice.h>
#include <debond/application/which_minimum.h>
#include <debond/contact/boundary_graph.h>
#include <debond/optimization/bond_search.h>
#include <debond/optimization/condensed_problem.h>

#include <cmath>

namespace Debond
{
  namespace
  {
    /// Displacements this close to the kink, relative, count as on it.
    constexpr double kink_width = 1e-6;



    /// On contact boundaries with more nodes a search takes more than a fifth
    /// of the solve, so that it has to be asked for.
    constexpr unsigned int largest_automatic_search = 200;



    BondSearchParameters
    search_parameters(const Parameters &parameters)
    {
      BondSearchParameters search;
      if (parameters.search != BondSearchChoice::full)
        {
          search.maximum_shift = 1;
          search.flips         = false;
          search.splits        = false;
        }
      return search;
    }



    bool
    wants_search(const Parameters &parameters, const unsigned int n_nodes)
    {
      return parameters.search == BondSearchChoice::automatic ?
               parameters.method == SolverMethod::automatic &&
                 n_nodes <= largest_automatic_search :
               parameters.search != BondSearchChoice::none;
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

    if (wants_search(parameters, s.size()))
      {
        const BondSearchResult search =
          search_bonds(condensed.schur_complement(),
                       condensed.load(),
                       adhesion,
                       law.bond_threshold(),
                       neighbours(boundary),
                       MajoriseMinimise(parameters.majorise_minimise),
                       search_parameters(parameters),
                       s,
                       may_go_on);
        for (const unsigned int trials : search.trials)
          result.search_trials += trials;
        for (const unsigned int improvements : search.improvements)
          result.search_improvements += improvements;
        result.kind = search.complete ? MinimumKind::best_known :
                                        kind_without_search(law, adhesion, s);
      }
    if (parameters.prove)
      prove(parameters, law, adhesion, condensed, may_go_on, s, result);
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
