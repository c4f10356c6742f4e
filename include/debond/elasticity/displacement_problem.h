// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_displacement_problem_h
#define debond_elasticity_displacement_problem_h

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/distributed_vector.h>
#include <debond/linear_algebra/truncated_multigrid.h>
#include <debond/linear_algebra/views.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <Eigen/SparseCore>

#include <functional>
#include <vector>

namespace Debond
{
  /// The unknowns of the contact nodes' normal displacements s, which all ranks
  /// have, and which of them are held.
  class ContactUnknowns
  {
  public:
    template <int dim>
    explicit ContactUnknowns(const ElasticProblem<dim> &problem)
      : normals(problem.unknowns().contact().normals())
      , own(problem.unknowns().dof_handler().locally_owned_dofs())
      , ranks(problem.unknowns().communicator())
    {}

    unsigned int
    size() const
    {
      return static_cast<unsigned int>(normals.size());
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
    const std::vector<dealii::types::global_dof_index> normals;
    const dealii::IndexSet                             own;
    const MPI_Comm                                     ranks;
  };



  /**
   * J = 1/2 <A u, u> - <f, u> + Phi(s), s <= 0, on all unknowns u, of which
   * some are the normal displacements s. Majorants are minimised by truncated
   * nonsmooth Newton multigrid (Graeser, Sack, Sander, 2009): one Gauss-Seidel
   * step on the contact normals, on all ranks the same; conjugate gradients
   * with a multigrid cycle for all unknowns that are not in contact, to a tenth
   * of the residual as long as the contact set changes; projection onto s <= 0
   * and an exact line search.
   *
   * Residuals are Euclidean norms of forces, relative to the largest of the
   * load, the internal forces and the forces of the foundation. All functions
   * are to be called by all ranks.
   */
  class DisplacementProblem : public MajorantProblem
  {
  public:
    /// Keeps references; @p start is the current point, of which the normal
    /// displacements have to be <= 0, @p cycle that of A.
    template <int dim>
    DisplacementProblem(const ElasticProblem<dim> &problem,
                        const PiecewiseQuadratic  &nonsmooth,
                        TruncatedMultigrid        &cycle,
                        DistributedVector         &start);

    /// Each linear iteration asks it whether it may go on, on all ranks alike.
    /// If not, minimise() ends and leaves u as it was before.
    std::function<bool()> may_go_on = []() { return true; };

    State
    evaluate() override;

    bool
    majorise() override;

    Minimisation
    minimise(const double tolerance) override;

  private:
    using Vector = DistributedVector;

    /// Minus the majorant's gradient at u: a force for each unknown.
    void
    majorant_force(Vector &force) const;

    /// Minimises the majorant in one normal displacement after the other.
    void
    smooth_contact(Vector &force);

    /// Conjugate gradients to @p tolerance, an absolute one, with the nodes of
    /// the active set held. Returns false if they did not get there.
    bool
    solve_majorant(const Vector &force,
                   const double  tolerance,
                   Vector       &correction,
                   unsigned int &n_iterations) const;

    const dealii::TrilinosWrappers::SparseMatrix &A;
    const Vector                                  f;
    const Vector                                  diagonal; ///< of A
    const PiecewiseQuadratic                     &phi;
    const ContactUnknowns                         contact;
    const Eigen::SparseMatrix<double>             contact_block; ///< of A
    TruncatedMultigrid                           &cycle;
    Vector                                       &u;

    /// As of the last evaluate().
    double largest_force  = 0.; ///< what residuals are relative to
    double force_rounding = 0.; ///< what rounding leaves in A u

    /// The majorant 1/2 <A v, v> - <f, v> + 1/2 s'E s - b_c's + const.
    Eigen::SparseMatrix<double> E;
    Eigen::VectorXd             b_c;
    ActiveSet                   active;

    /// What the cycle is prepared for.
    bool                        is_prepared = false;
    Eigen::SparseMatrix<double> cycle_E;
    ActiveSet                   cycle_active;
  };
} // namespace Debond

#endif
