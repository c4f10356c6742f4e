// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/multigrid.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

#include <algorithm>
#include <vector>

namespace Debond
{
  template <int dim>
  Multigrid::Multigrid(const ElasticProblem<dim> &problem,
                       const std::vector<dealii::types::global_dof_index> &held)
  {
    // ML reads the modes one after the other from a plain array, during the
    // initialisation only.
    std::vector<DofVector> modes = problem.unknowns().rigid_body_modes();
    for (DofVector &mode : modes)
      for (const dealii::types::global_dof_index i : held)
        mode(i) = 0.;
    std::vector<double> near_null_space;
    near_null_space.reserve(modes.size() * problem.unknowns().n_dofs());
    for (const DofVector &mode : modes)
      near_null_space.insert(near_null_space.end(), mode.begin(), mode.end());

    Teuchos::ParameterList parameters;
    ML_Epetra::SetDefaults("SA", parameters);
    parameters.set("ML output", 0);
    parameters.set("PDE equations", dim);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", static_cast<int>(modes.size()));
    parameters.set("null space: vectors", near_null_space.data());
    parameters.set("aggregation: type", "Uncoupled");
    parameters.set("smoother: type", "Chebyshev");
    parameters.set("smoother: sweeps", 2);
    parameters.set("coarse: type", "Amesos-KLU");
    parameters.set("coarse: max size", 2000);
    cycle.initialize(problem.trilinos_matrix(), parameters);
  }



  void
  Multigrid::vmult(DofVector &dst, const DofVector &src) const
  {
    cycle.vmult(dst, src);
  }



  template Multigrid::Multigrid(
    const ElasticProblem<2> &,
    const std::vector<dealii::types::global_dof_index> &);
  template Multigrid::Multigrid(
    const ElasticProblem<3> &,
    const std::vector<dealii::types::global_dof_index> &);
} // namespace Debond
