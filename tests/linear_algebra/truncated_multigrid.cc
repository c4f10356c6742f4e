// SPDX-License-Identifier: LGPL-2.1-or-later
// Truncated multigrid on 1 to 4 ranks: its Galerkin products by vectors, its
// steps, and that it depends on the last truncation only. The same output is
// expected of all numbers of ranks.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <debond/linear_algebra/aggregation.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>

#include "../check.h"

using namespace Debond;

namespace
{
  using Entry         = TruncatedMultigrid::Entry;
  using Prolongations = std::vector<Prolongation>;
  using Point         = dealii::Point<3>;

  const MPI_Comm communicator = MPI_COMM_WORLD;



  /// The elasticity of a cube whose top is clamped, of tetrahedra.
  struct Cube
  {
    explicit Cube(const unsigned int n_cells)
      : mesh(communicator)
      , dofs(mesh)
    {
      dealii::Triangulation<3> serial;
      dealii::GridGenerator::subdivided_hyper_cube_with_simplices(serial,
                                                                  n_cells);
      dealii::GridTools::partition_triangulation(
        dealii::Utilities::MPI::n_mpi_processes(communicator),
        serial,
        dealii::SparsityTools::Partitioner::metis);
      mesh.create_triangulation(
        dealii::TriangulationDescription::Utilities::
          create_description_from_triangulation(serial, communicator));
      const dealii::FESystem<3> fe(dealii::FE_SimplexP<3>(1), 3);
      dofs.distribute_dofs(fe);
      const dealii::MappingFE<3> mapping(dealii::FE_SimplexP<3>(1));
      dealii::DoFTools::map_dofs_to_support_points(mapping, dofs, points);
      dealii::AffineConstraints<double> constraints;
      for (const auto &[i, point] : points)
        if (is_constrained(i))
          constraints.add_line(i);
      constraints.close();
      const dealii::IndexSet owned = dofs.locally_owned_dofs();
      dealii::TrilinosWrappers::SparsityPattern pattern(owned, communicator);
      dealii::DoFTools::make_sparsity_pattern(
        dofs,
        pattern,
        constraints,
        false,
        dealii::Utilities::MPI::this_mpi_process(communicator));
      pattern.compress();
      dealii::TrilinosWrappers::SparseMatrix A;
      A.reinit(pattern);

      const dealii::QGaussSimplex<3>               rule(1);
      dealii::FEValues<3>                          values(mapping,
                                 fe,
                                 rule,
                                 dealii::update_gradients |
                                   dealii::update_JxW_values);
      const dealii::FEValuesExtractors::Vector     u(0);
      const unsigned int                           m = fe.n_dofs_per_cell();
      dealii::FullMatrix<double>                   K(m, m);
      std::vector<dealii::types::global_dof_index> index(m);
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            for (unsigned int i = 0; i < m; ++i)
              for (unsigned int j = 0; j < m; ++j)
                K(i, j) =
                  (2. * values[u].symmetric_gradient(i, 0) *
                     values[u].symmetric_gradient(j, 0) +
                   values[u].divergence(i, 0) * values[u].divergence(j, 0)) *
                  values.JxW(0);
            cell->get_dof_indices(index);
            constraints.distribute_local_to_global(K, index, A);
          }
      A.compress(dealii::VectorOperation::add);

      dealii::DynamicSparsityPattern own_pattern(A.m(), A.m(), owned);
      for (const auto i : owned)
        for (auto entry = A.begin(i); entry != A.end(i); ++entry)
          own_pattern.add(i, entry->column());
      sparsity.copy_from(own_pattern);
      matrix.reinit(sparsity);
      for (const auto i : owned)
        for (auto entry = A.begin(i); entry != A.end(i); ++entry)
          matrix.set(i, entry->column(), entry->value());
      distributed = std::make_unique<DistributedMatrix>(
        MatrixOnRanks(matrix, owned, communicator));
    }

    bool
    is_constrained(const unsigned int i) const
    {
      return points.at(i)[2] > 1. - 1e-6;
    }

    bool
    is_contact(const unsigned int i) const
    {
      return i % 3 == 2 && points.at(i)[2] < 1e-6;
    }

    /// The own ones among the free unknowns, by the condition.
    std::vector<unsigned int>
    unknowns(
      const std::function<bool(unsigned int, const Point &)> &is_meant) const
    {
      std::vector<unsigned int> result;
      for (const unsigned int i : dofs.locally_owned_dofs())
        if (!is_constrained(i) && is_meant(i, points.at(i)))
          result.push_back(i);
      return result;
    }

    /// Springs at contact unknowns where @p has_bond, coupled like in a mass
    /// matrix.
    std::vector<Entry>
    bonds(const double                              stiffness,
          const std::function<bool(const Point &)> &has_bond) const
    {
      std::vector<Entry> E;
      for (const unsigned int i : dofs.locally_owned_dofs())
        if (is_contact(i) && has_bond(points.at(i)))
          for (auto entry = matrix.begin(i); entry != matrix.end(i); ++entry)
            if (const unsigned int j = entry->column();
                is_contact(j) && has_bond(points.at(j)))
              E.push_back({i, j, i == j ? stiffness : stiffness / 10.});
      return E;
    }

    std::vector<DistributedVector>
    rigid_motions() const
    {
      std::vector<DistributedVector> modes(
        6, DistributedVector(dofs.locally_owned_dofs(), communicator));
      for (const unsigned int i :
           unknowns([](const unsigned int, const Point &) { return true; }))
        {
          const Point       &x = points.at(i);
          const unsigned int c = i % 3, next = (c + 1) % 3, last = (c + 2) % 3;
          modes[c](i)        = 1.;
          modes[3 + last](i) = -x[next];
          modes[3 + next](i) = x[last];
        }
      return modes;
    }

    dealii::parallel::fullydistributed::Triangulation<3> mesh;
    dealii::DoFHandler<3>                                dofs;
    std::map<dealii::types::global_dof_index, Point>     points;
    dealii::SparsityPattern                              sparsity;
    dealii::SparseMatrix<double>                         matrix; ///< own rows
    std::unique_ptr<DistributedMatrix>                   distributed;
  };



  /// What this rank has, if it has @p n and those of the ranks follow each
  /// other.
  dealii::IndexSet
  own_range(const unsigned int n)
  {
    return dealii::Utilities::MPI::create_ascending_partitioning(
      communicator, n)[dealii::Utilities::MPI::this_mpi_process(communicator)];
  }



  /// Sums of 8 successive nodes of a rank, with less weight also of 8 far away,
  /// which another rank may have.
  Prolongation
  sums(const dealii::IndexSet                  &finer,
       const std::function<bool(unsigned int)> &is_constrained)
  {
    const unsigned int     n_nodes = finer.n_elements() / 3;
    Prolongation           P{(n_nodes + 7) / 8, {}};
    const dealii::IndexSet own = own_range(P.n_own_columns);
    P.rows.height = P.rows.width = 3;
    for (unsigned int node = 0; node < n_nodes; ++node)
      {
        const unsigned int column = own.nth_index_in_set(node / 8);
        for (const auto &[j, value] :
             {std::pair{column, 1.f},
              std::pair{(column + own.size() / 2) % own.size(), 0.3f}})
          {
            P.rows.columns.push_back(j);
            for (unsigned int k = 0; k < 9; ++k)
              P.rows.values.push_back(
                k % 4 == 0 &&
                    !is_constrained(finer.nth_index_in_set(3 * node + k / 4)) ?
                  value :
                  0.f);
          }
        P.rows.end_row();
      }
    return P;
  }



  /// Any numbers between -1 and 1.
  template <typename Vector>
  Vector
  some_numbers(Vector v, const unsigned int seed)
  {
    for (const auto i : v.locally_owned_elements())
      v(i) = std::sin(seed + 1e3 * std::sin(1. + i));
    return v;
  }



  DistributedVector
  some_vector(const TruncatedMultigrid &multigrid, const unsigned int seed)
  {
    const DistributedMatrix &A = multigrid.matrix().A;
    return some_numbers(DistributedVector(A.own_rows, A.ranks), seed);
  }



  template <typename Vector>
  double
  relative_difference(Vector a, const Vector &b)
  {
    a -= b;
    return a.l2_norm() / b.l2_norm();
  }



  /// Of the matrix of the level l + 1 from P'BP, by a vector, where that is not
  /// zero.
  double
  product_error(const TruncatedMultigrid        &multigrid,
                const unsigned int               l,
                const std::vector<unsigned int> &held)
  {
    const MultigridLevel &fine    = multigrid.level(l),
                         &coarse  = multigrid.level(l + 1);
    const SinglePrecisionVector x = some_numbers(coarse.nodes.vector(), 7);
    SinglePrecisionVector v(fine.nodes.vector()), B_v(v), expected(x), found(x);
    fine.prolongate(v, x);
    if (l == 0)
      for (const unsigned int i : held)
        v(i) = 0.f;
    fine.matrix.vmult(B_v, v);
    fine.restrict_to_coarser(expected, B_v);
    coarse.matrix.vmult(found, x);
    const float largest = expected.linfty_norm();
    for (const auto i : found.locally_owned_elements())
      if (std::abs(expected(i)) < 1e-6f * largest)
        found(i) = expected(i);
    return relative_difference(found, expected);
  }



  /// Conjugate gradients; the error of what they find.
  unsigned int
  n_steps(const TruncatedMultigrid        &multigrid,
          const std::vector<unsigned int> &held)
  {
    DistributedVector r = some_vector(multigrid, 3), u(r);
    for (const unsigned int i : held)
      r(i) = 0.;
    u = 0.;
    dealii::ReductionControl            control(200, 0., 1e-10, false, false);
    dealii::SolverCG<DistributedVector> cg(control);
    try
      {
        cg.solve(multigrid.matrix(), u, r, multigrid);
      }
    catch (const dealii::SolverControl::NoConvergence &)
      {}
    return control.last_step();
  }



  double
  asymmetry(const TruncatedMultigrid &multigrid)
  {
    const DistributedVector r = some_vector(multigrid, 1),
                            s = some_vector(multigrid, 2);
    DistributedVector M_r(r), M_s(s);
    multigrid.vmult(M_r, r);
    multigrid.vmult(M_s, s);
    return std::abs((M_r * s) - (r * M_s)) / std::abs(M_r * s);
  }



  DistributedVector
  cycle(const TruncatedMultigrid &multigrid)
  {
    const DistributedVector r = some_vector(multigrid, 5);
    DistributedVector       z(r);
    multigrid.vmult(z, r);
    return z;
  }



  using MakeMultigrid = std::function<std::unique_ptr<TruncatedMultigrid>()>;

  /// One truncation after the other, those of the last ones forgotten.
  void
  test(const std::string   &name,
       const Cube          &cube,
       const MakeMultigrid &make,
       const unsigned int   most_steps)
  {
    struct Truncation
    {
      std::string               name;
      std::vector<Entry>        E;
      std::vector<unsigned int> held;
    };
    const std::vector<Truncation> truncations{
      {"springs, half of the contact held",
       cube.bonds(0.5, [](const Point &x) { return x[0] > 0.5; }),
       cube.unknowns([&](const unsigned int i, const Point &x) {
         return cube.is_contact(i) && x[0] < 0.6;
       })},
      {"one spring, few held",
       cube.bonds(0.1, [](const Point &x) { return x.norm() < 1e-6; }),
       cube.unknowns([&](const unsigned int i, const Point &x) {
         return cube.is_contact(i) && x[0] + x[1] > 1.8;
       })},
      {"a fixed half",
       {},
       cube.unknowns(
         [](const unsigned int, const Point &x) { return x[1] < 0.55; })},
      {"nothing", {}, {}}};

    const auto multigrid = make();
    section(name);
    check("steps", n_steps(*multigrid, {}), most_steps);
    check("symmetric", asymmetry(*multigrid), 1e-6);
    for (unsigned int l = 0; l + 1 < multigrid->n_levels(); ++l)
      check("product", product_error(*multigrid, l, {}), 1e-6);
    const DistributedVector as_made = cycle(*multigrid);
    for (const Truncation &truncation : truncations)
      {
        section(name, ", ", truncation.name);
        multigrid->truncate(truncation.E, truncation.held);
        // Below emptied unknowns products leave out their entries.
        const unsigned int n_products =
          truncation.name == "a fixed half" ?
            std::min(1U, multigrid->n_levels() - 1) :
            multigrid->n_levels() - 1;
        for (unsigned int l = 0; l < n_products; ++l)
          check("product", product_error(*multigrid, l, truncation.held), 1e-6);
        check("steps", n_steps(*multigrid, truncation.held), most_steps);
        check("symmetric", asymmetry(*multigrid), 1e-6);
        const DistributedVector z       = cycle(*multigrid);
        double                  largest = 0.;
        for (const unsigned int i : truncation.held)
          raise(largest, std::abs(z(i)));
        check("zero where held",
              dealii::Utilities::MPI::max(largest, communicator),
              0.);
        const auto other = make();
        other->truncate(truncation.E, truncation.held);
        check("as if it were the first truncation",
              relative_difference(z, cycle(*other)),
              1e-6);
      }
    section(name);
    check("as made", relative_difference(cycle(*multigrid), as_made), 1e-6);
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_figures = argc > 1;
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
    std::cout.setstate(std::ios::failbit);

  const Cube small(6), large(16);
  const auto direct = [&] {
    return std::make_unique<TruncatedMultigrid>(*small.distributed,
                                                3,
                                                Prolongations());
  };
  test("direct", small, direct, 3);
  const auto with_sums = [&] {
    const auto first =
      sums(small.dofs.locally_owned_dofs(),
           [&](const unsigned int i) { return small.is_constrained(i); });
    const dealii::IndexSet coarse = own_range(3 * first.n_own_columns);
    const auto second = sums(coarse, [](const unsigned int) { return false; });
    return std::make_unique<TruncatedMultigrid>(*small.distributed,
                                                3,
                                                Prolongations{first, second});
  };
  test("sums of nodes", small, with_sums, 40);
  const auto with_aggregates = [&] {
    return std::make_unique<TruncatedMultigrid>(
      *large.distributed,
      3,
      aggregated_prolongations(*large.distributed, 3, large.rigid_motions()));
  };
  test("aggregates", large, with_aggregates, 20);

  // An entry outside of the pattern.
  TruncatedMultigrid multigrid(*small.distributed, 3, Prolongations());
  const unsigned int first      = *small.dofs.locally_owned_dofs().begin();
  bool               is_refused = false;
  try
    {
      multigrid.truncate({{first, small.matrix.m() - 1 - first, 1.}}, {});
    }
  catch (const dealii::ExceptionBase &)
    {
      is_refused = true;
    }
  check("an entry outside of the pattern is refused", is_refused);
}
