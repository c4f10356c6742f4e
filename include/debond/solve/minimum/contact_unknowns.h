// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_contact_unknowns_h
#define debond_solve_minimum_contact_unknowns_h

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/truncated_multigrid.h>
#include <debond/optimization/majorise/bound_qp.h>

#include <Eigen/SparseCore>

namespace Debond
{
  /// The unknowns s of ContactSpace, which all ranks have, and which of them
  /// are held.
  class ContactUnknowns
  {
  public:
    template <int dim>
    explicit ContactUnknowns(const ElasticProblem<dim> &problem)
      : dofs(problem.unknowns().contact().dofs())
      , bounds(problem.unknowns().contact().boundary().upper_bounds())
      , own(problem.unknowns().dof_handler().locally_owned_dofs())
      , ranks(problem.unknowns().communicator())
    {}

    unsigned int
    size() const
    {
      return static_cast<unsigned int>(dofs.size());
    }

    /// Returns the upper bounds of s.
    const Eigen::VectorXd &
    upper() const
    {
      return bounds;
    }

    /// The entries of v, on all ranks.
    Eigen::VectorXd
    trace(const DistributedVector &v) const;

    /// v += the entries s.
    void
    add(const VectorView &s, DistributedVector &v) const;

    /// Makes the entries those of s.
    void
    set(const VectorView &s, DistributedVector &v) const;

    /// Makes the entries of held nodes zero.
    void
    set_zero(const ActiveSet &held, DistributedVector &v) const;

    /// The rows and columns of A, of which each rank has its own rows.
    Eigen::SparseMatrix<double>
    block_of(const dealii::SparseMatrix<double> &A) const;

    /// Prepares a cycle for A + E where nodes are held.
    void
    truncate(const Eigen::SparseMatrix<double> &E,
             const ActiveSet                   &held,
             TruncatedMultigrid                &cycle) const;

  private:
    const std::vector<dealii::types::global_dof_index> dofs;
    const Eigen::VectorXd                              bounds;
    const dealii::IndexSet                             own;
    const MPI_Comm                                     ranks;
  };
} // namespace Debond

#endif
