// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_elastic_problem_h
#define debond_elasticity_elastic_problem_h

#include <deal.II/lac/sparsity_pattern.h>

#include <debond/elasticity/fields.h>
#include <debond/elasticity/load_vector.h>
#include <debond/linear_algebra/distributed_matrix.h>

namespace Debond
{
  /**
   * Linear elasticity on simplices of degree 1 or 2: the operator A and the
   * load f on the unknowns of ElasticUnknowns.
   *
   * At constrained degrees of freedom A has only a diagonal entry: a positive
   * number of the size of the cells' own diagonal entries, without a meaning.
   *
   * Of A each rank has the rows of its own degrees of freedom, vectors are
   * whole on all ranks. What computes is to be called by all of them.
   */
  template <int dim>
  class ElasticProblem
  {
  public:
    /// Throws as ElasticUnknowns does.
    ElasticProblem(const dealii::Triangulation<dim> &triangulation,
                   const BoundaryConditions         &conditions,
                   const Supports<dim>              &supports = {},
                   const unsigned int                degree   = 1)
      : elastic_unknowns(triangulation, conditions, supports, degree)
    {}

    /// Computes A and f. Throws std::invalid_argument if a material is not
    /// valid or a load is not, see load_vector() and
    /// thermal_stresses(). May be called again. @p dead_loads are applied
    /// besides, whatever the load factor.
    void
    assemble(const ByRegion<Material> &materials,
             const Loads<dim>         &loads,
             const Loads<dim>         &dead_loads = {});

    const ElasticUnknowns<dim> &
    unknowns() const
    {
      return elastic_unknowns;
    }

    /// The notes of load_vector() on loads that jump, at the last assemble().
    const std::vector<std::string> &
    load_notes() const
    {
      return notes;
    }

    /// The fields of the last assemble().
    const ElasticFields<dim> &
    fields() const;

    /// The rows of A that this rank has; the others are zero.
    const dealii::SparseMatrix<double> &
    matrix() const
    {
      return system_matrix;
    }

    /// dst = A src.
    void
    vmult(DofVector &dst, const DofVector &src) const
    {
      system_matrix.vmult(dst, src);
      add_over_ranks(dst, elastic_unknowns.communicator());
    }

    /// The diagonal of A.
    DofVector
    diagonal() const;

    /// A on vectors that ranks share, made when it is asked for first. Needs
    /// MPI.
    const DistributedMatrix &
    distributed_matrix() const;

    /// f - A G, what is applied together with what the lifting makes of it, at
    /// the free degrees of freedom, for @p factors times what is applied and
    /// prescribed: f_0 + t f_1 + d f_2, f_0 being that of gaps and dead loads.
    DofVector
    load(const LoadFactors factors = 1.) const;

    /// J of w = 0 without bonds, 1/2 <A G, G> - <f, G>: what J is
    /// more than 1/2 <A w, w> - <load, w>.
    double
    lifting_energy(const LoadFactors factors = 1.) const;

  private:
    void
    add_cell_matrices();

    const ElasticUnknowns<dim>                elastic_unknowns;
    std::unique_ptr<const ElasticFields<dim>> elastic_fields;

    dealii::SparsityPattern      sparsity;
    dealii::SparseMatrix<double> system_matrix;
    // That needs MPI already.
    mutable std::unique_ptr<const DistributedMatrix> distributed;
    std::vector<std::string>                         notes;
    DofVector whole_load; ///< that for the factors 1
    DofVector f_0, f_2;   ///< empty for none
  };
} // namespace Debond

#endif
