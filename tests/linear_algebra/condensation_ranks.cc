// SPDX-License-Identifier: LGPL-2.1-or-later
// The condensation of a matrix whose rows ranks share against dense
// elimination, for elastic triangles whose nodes and kept unknowns come in
// random order. The same output is expected of 1, 2, 3 and 4 ranks.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <debond/linear_algebra/cholmod_factor.h>
#include <debond/linear_algebra/condensation.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <numeric>
#include <random>

#include "../check.h"

using namespace Debond;

namespace
{
  using Indices = std::vector<unsigned int>;

  const MPI_Comm communicator = MPI_COMM_WORLD;

  std::mt19937 generator(1);



  double
  random_number(const double from, const double to)
  {
    return std::uniform_real_distribution<double>(from, to)(generator);
  }



  /// Checks what has to hold on all ranks.
  void
  check_on_all(const std::string &name, const double value, const double bound)
  {
    // What is not a number would get lost in a maximum.
    check(name,
          dealii::Utilities::MPI::max(
            std::isnan(value) ? std::numeric_limits<double>::infinity() : value,
            communicator),
          bound);
  }



  /// 0 if the first rank has the same numbers, to the last bit.
  template <typename Numbers>
  double
  difference_from_first(const Numbers &numbers)
  {
    std::vector<double> first(numbers.data(), numbers.data() + numbers.size());
    first = dealii::Utilities::MPI::broadcast(communicator, first);
    return first.size() == static_cast<std::size_t>(numbers.size()) &&
               (first.empty() ||
                std::memcmp(first.data(), numbers.data(), 8 * first.size()) ==
                  0) ?
             0. :
             1.;
  }



  double
  relative(const Eigen::MatrixXd &value, const Eigen::MatrixXd &expected)
  {
    const double norm = expected.norm();
    return (value - expected).norm() / (norm > 0. ? norm : 1.);
  }



  DofVector
  dof_vector(const Eigen::VectorXd &values)
  {
    return DofVector(values.begin(), values.end());
  }



  /// The stiffness of elastic triangles between the nodes of a grid that are
  /// moved a little and numbered at random, with random moduli. Also the
  /// positions of the nodes.
  std::pair<Eigen::MatrixXd, std::vector<Eigen::Vector2d>>
  elastic_matrix(const unsigned int n_x, const unsigned int n_y)
  {
    Indices numbers((n_x + 1) * (n_y + 1));
    std::iota(numbers.begin(), numbers.end(), 0);
    std::shuffle(numbers.begin(), numbers.end(), generator);
    const auto node = [&](const unsigned int i, const unsigned int j) {
      return numbers[i * (n_y + 1) + j];
    };
    std::vector<Eigen::Vector2d> positions(numbers.size());
    for (unsigned int i = 0; i <= n_x; ++i)
      for (unsigned int j = 0; j <= n_y; ++j)
        positions[node(i, j)] = {i + random_number(-0.2, 0.2),
                                 j + random_number(-0.2, 0.2)};

    Eigen::MatrixXd A =
      Eigen::MatrixXd::Zero(2 * numbers.size(), 2 * numbers.size());
    const auto add = [&](const std::array<unsigned int, 3> &corners) {
      Eigen::Matrix3d coordinates;
      for (unsigned int c = 0; c < 3; ++c)
        coordinates.row(c) << 1., positions[corners[c]].transpose();
      const Eigen::Matrix3d slopes = coordinates.inverse();
      Eigen::Matrix3d       material;
      material << 3., 1., 0., 1., 3., 0., 0., 0., 1.;
      Eigen::Matrix<double, 3, 6> strain = Eigen::Matrix<double, 3, 6>::Zero();
      for (unsigned int c = 0; c < 3; ++c)
        {
          strain(0, 2 * c) = strain(2, 2 * c + 1) = slopes(1, c);
          strain(1, 2 * c + 1) = strain(2, 2 * c) = slopes(2, c);
        }
      const Eigen::Matrix<double, 6, 6> own =
        random_number(1., 10.) * strain.transpose() * material * strain;
      for (unsigned int k = 0; k < 6; ++k)
        for (unsigned int l = 0; l < 6; ++l)
          A(2 * corners[k / 2] + k % 2, 2 * corners[l / 2] + l % 2) +=
            own(k, l);
    };
    for (unsigned int i = 0; i < n_x; ++i)
      for (unsigned int j = 0; j < n_y; ++j)
        {
          add({{node(i, j), node(i + 1, j), node(i, j + 1)}});
          add({{node(i + 1, j + 1), node(i + 1, j), node(i, j + 1)}});
        }
    return {A, positions};
  }



  /// Nodes begin to end of rank r with all, or all nodes for the last rank.
  dealii::IndexSet
  own_rows(const unsigned int n, const bool last_has_all)
  {
    const unsigned int rank =
      dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n_ranks =
      dealii::Utilities::MPI::n_mpi_processes(communicator);
    const auto first = [&](const unsigned int r) {
      return last_has_all ? 0 : n / 2 * r / n_ranks * 2;
    };
    dealii::IndexSet result(n);
    result.add_range(first(rank), rank + 1 == n_ranks ? n : first(rank + 1));
    return result;
  }



  /// The own rows of a matrix; what is in the others is not a number.
  class Rows
  {
  public:
    Rows(const Eigen::MatrixXd &values, const bool last_has_all = false)
      : own(own_rows(values.rows(), last_has_all))
    {
      dealii::DynamicSparsityPattern entries(values.rows(), values.cols());
      for (const auto row : own)
        for (unsigned int column = 0; column < values.cols(); ++column)
          if (values(row, column) != 0.)
            entries.add(row, column);
      pattern.copy_from(entries);
      A.reinit(pattern);
      for (unsigned int row = 0; row < A.m(); ++row)
        if (own.is_element(row))
          for (auto entry = A.begin(row); entry != A.end(row); ++entry)
            entry->value() = values(row, entry->column());
        else
          A.diag_element(row) = std::numeric_limits<double>::quiet_NaN();
    }

    operator MatrixOnRanks() const
    {
      return {A, own, communicator};
    }

  private:
    dealii::IndexSet             own;
    dealii::SparsityPattern      pattern;
    dealii::SparseMatrix<double> A;
  };



  /// By dense matrices.
  struct Reference
  {
    Reference(const Eigen::MatrixXd &A,
              const Indices         &eliminated,
              const Indices         &kept)
      : inside(eliminated)
      , kept(kept)
      , n(A.rows())
      , A_ii(A(eliminated, eliminated).llt())
      , A_is(A(eliminated, kept))
      , S(A(kept, kept))
      , definite(S)
    {
      if (!eliminated.empty())
        S -= A_is.transpose() * A_ii.solve(A_is);
      definite = S;
    }

    Eigen::VectorXd
    load(const Eigen::VectorXd &f) const
    {
      Eigen::VectorXd g = f(kept);
      if (!inside.empty())
        g -= A_is.transpose() * A_ii.solve(f(inside));
      return g;
    }

    double
    energy_at_zero(const Eigen::VectorXd &f) const
    {
      return inside.empty() ? 0. : -0.5 * f(inside).dot(A_ii.solve(f(inside)));
    }

    double
    energy_of_kept(const Eigen::VectorXd &f) const
    {
      return kept.empty() ? 0. :
                            0.5 * load(f).dot(definite.llt().solve(load(f)));
    }

    Eigen::VectorXd
    expand(const Eigen::VectorXd &f, const Eigen::VectorXd &s) const
    {
      Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
      if (!inside.empty())
        u(inside) = A_ii.solve(f(inside) - A_is * s).eval();
      u(kept) = s;
      return u;
    }

    double
    condition() const
    {
      const auto norm = [](const Eigen::MatrixXd &M) {
        return M.cwiseAbs().colwise().sum().maxCoeff();
      };
      return kept.empty() ? 1. : norm(S) * norm(definite.inverse());
    }

    Indices                     inside, kept;
    Eigen::Index                n;
    Eigen::LLT<Eigen::MatrixXd> A_ii;
    Eigen::MatrixXd             A_is, S;
    Eigen::MatrixXd             definite; ///< S or S_+
  };



  /// Of the load @p f.
  void
  compare(const Condensation    &condensed,
          const Reference       &reference,
          const Eigen::VectorXd &f,
          const double           other_energy)
  {
    const Eigen::VectorXd g       = reference.load(f);
    const double          c_0     = reference.energy_at_zero(f);
    const double          of_kept = reference.energy_of_kept(f);
    const Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(g.size(), -1., 2.);
    const DofVector       u = condensed.expand(s);

    const auto error = [](const double value, const double expected) {
      return std::abs(value - expected) / std::max(1e-10, std::abs(expected));
    };
    check_on_all("g", relative(condensed.load(), g), 1e-10);
    check_on_all("c_0",
                 error(condensed.energy_at_zero(), c_0 + other_energy),
                 1e-10);
    check_on_all("energy of kept",
                 error(condensed.energy_of_kept(), of_kept),
                 1e-10);
    check_on_all("energy without contact",
                 error(condensed.energy_without_contact(), of_kept - c_0),
                 1e-10);
    check_on_all("u", relative(eigen_view(u), reference.expand(f, s)), 1e-10);
    const Eigen::Vector3d energies(condensed.energy_at_zero(),
                                   condensed.energy_of_kept(),
                                   condensed.energy_without_contact());
    check_on_all("the same on all ranks",
                 difference_from_first(condensed.load()) +
                   difference_from_first(eigen_view(u)) +
                   difference_from_first(energies),
                 0.);
  }



  /// Each unknown is in one of the three sets at most; those in none are left
  /// out.
  void
  test(const Eigen::MatrixXd &A,
       const Indices         &eliminated,
       const Indices         &kept,
       const bool             is_semidefinite = false,
       const bool             last_has_all    = false)
  {
    Reference reference(A, eliminated, kept);
    if (is_semidefinite)
      reference.definite.diagonal() += A.diagonal()(kept);

    const auto random_load = [&]() {
      Eigen::VectorXd result(A.rows());
      for (double &entry : result)
        entry = random_number(-1., 1.);
      return result;
    };
    const Eigen::VectorXd f = random_load(), second = random_load(),
                          other = random_load();
    std::vector<char> is_excluded(A.rows(), 1);
    for (const Indices &part : {eliminated, kept})
      for (const unsigned int i : part)
        is_excluded[i] = 0;
    const Condensation condensed(
      Rows(A, last_has_all),
      dof_vector(f),
      kept,
      [&](const unsigned int i) { return is_excluded[i] != 0; },
      8.,
      is_semidefinite);

    const Eigen::MatrixXd S = condensed.schur_complement();
    check_on_all("S", relative(S, reference.S), 1e-10);
    check_on_all("S is symmetric", relative(S, S.transpose()), 1e-14);
    check_on_all("S is the same on all ranks", difference_from_first(S), 0.);
    const double ratio = condensed.condition_estimate() / reference.condition();
    check_on_all("condition, from above", ratio, 1. + 1e-8);
    check_on_all("condition, from below", 1. / ratio, 3.);

    compare(condensed, reference, f, 8.);
    compare(condensed.with_load(dof_vector(second), 3.), reference, second, 3.);
    compare(condensed, reference, f, 8.);

    Eigen::VectorXd s;
    const DofVector u =
      condensed.solve(dof_vector(other), [&](const Eigen::VectorXd &g) {
        s = 0.1 * g;
        return s;
      });
    check_on_all("s under another load",
                 relative(s, 0.1 * reference.load(other)),
                 1e-10);
    check_on_all("u under another load",
                 relative(eigen_view(u), reference.expand(other, s)),
                 1e-10);
  }



  /// The first @p n_kept of the candidates in random order, and the others.
  std::pair<Indices, Indices>
  split(Indices candidates, const unsigned int n_kept)
  {
    std::shuffle(candidates.begin(), candidates.end(), generator);
    return {{candidates.begin(), candidates.begin() + n_kept},
            {candidates.begin() + n_kept, candidates.end()}};
  }



  void
  test_elastic()
  {
    const auto [A, positions] = elastic_matrix(11, 6);
    Indices free, all_but_motion;
    for (unsigned int i = 0; i < A.rows(); ++i)
      {
        if (positions[i / 2](0) > 0.5)
          free.push_back(i);
        all_but_motion.push_back(i);
      }
    for (const bool last_has_all : {false, true})
      for (const unsigned int n_kept : {25, 1, 0})
        {
          section(n_kept,
                  " kept",
                  last_has_all ? ", one rank has all rows" : "");
          const auto [kept, eliminated] = split(free, n_kept);
          test(A, eliminated, kept, false, last_has_all);
        }
    section("all kept");
    test(A, {}, split(free, free.size()).first);
    section("all left out");
    test(A, {}, {});

    // Two nodes that cannot move upwards leave the translation sideways.
    for (const unsigned int node : {5, 40})
      all_but_motion.erase(
        std::find(all_but_motion.begin(), all_but_motion.end(), 2 * node + 1));
    section("a rigid motion is free");
    const auto [kept, eliminated] = split(all_but_motion, 30);
    test(A, eliminated, kept, true);
    Eigen::VectorXd motion(kept.size());
    for (unsigned int k = 0; k < kept.size(); ++k)
      motion(k) = kept[k] % 2 == 0 ? 1. : 0.;
    const Eigen::MatrixXd S = Reference(A, eliminated, kept).S;
    check("it is", (S * motion).norm() / S.norm(), 1e-13);
  }



  /// All ranks throw; the number of those that do not.
  double
  ranks_that_do_not_throw(const std::function<void()> &action)
  {
    double result = 1.;
    try
      {
        action();
      }
    catch (const std::runtime_error &error)
      {
        result = std::string(error.what()).find("is not positive definite") ==
                     std::string::npos ?
                   1. :
                   0.;
      }
    return dealii::Utilities::MPI::sum(result, communicator);
  }



  void
  test_errors()
  {
    const unsigned int    n       = 40;
    const Eigen::MatrixXd one     = Eigen::MatrixXd::Identity(n, n);
    const auto            refused = [](const Eigen::MatrixXd &A) {
      const Rows rows(A);
      return ranks_that_do_not_throw([&]() {
        Condensation(rows, DofVector(A.rows()), {6, 3}, [](unsigned int) {
          return false;
        });
      });
    };
    section("matrices that are not positive definite");
    for (const unsigned int i : {3, 20, 39})
      for (const double value : {0., -1.})
        {
          Eigen::MatrixXd A = one;
          A(i, i)           = value;
          check("diagonal entry", refused(A), 0.);
        }
    Eigen::MatrixXd A = one;
    A(3, 7) = A(7, 3) = 2.;
    check("between kept and eliminated", refused(A), 0.);
    A        = one;
    A(30, 7) = A(7, 30) = 2.;
    check("among eliminated ones", refused(A), 0.);
  }



  /// On all ranks it is that of the whole matrix on one.
  void
  test_cost()
  {
    section("cost");
    const auto [A, positions] = elastic_matrix(30, 20);
    const Indices kept        = {100, 102, 3, 7};

    dealii::SparsityPattern        pattern;
    dealii::DynamicSparsityPattern entries(A.rows(), A.cols());
    for (unsigned int i = 0; i < A.rows(); ++i)
      for (unsigned int j = 0; j < A.cols(); ++j)
        if (A(i, j) != 0.)
          entries.add(i, j);
    pattern.copy_from(entries);
    const FactorisationCost whole =
      factorisation_cost(dealii::SparseMatrix<double>(pattern), kept, 2);
    check("something", whole.operations > 1e5 && whole.entries > 1e4);
    for (const bool last_has_all : {false, true})
      {
        const FactorisationCost cost =
          factorisation_cost(Rows(A, last_has_all), kept, 2);
        check_on_all("operations",
                     std::abs(cost.operations - whole.operations),
                     0.);
        check_on_all("entries", std::abs(cost.entries - whole.entries), 0.);
      }
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_figures = argc > 1;
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
    std::cout.setstate(std::ios::failbit);
  test_elastic();
  test_errors();
  test_cost();
}
