// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid/truncated_cycle.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

namespace Debond
{
  namespace
  {
    /// Of the interval that smoothers damp: largest eigenvalue over smallest.
    constexpr float smoothing_range = 20.f;

    /// Lanczos' eigenvalues come from below.
    constexpr float       eigenvalue_margin = 1.1f;
    constexpr std::size_t lanczos_steps     = 8;

    /// A diagonal entry of which truncation leaves less than this part, or one
    /// that is zero anyway, is that of an unknown that is not free.
    constexpr float vanishing = 1e-5f;

    /// Of the diagonal of the coarsest matrix, relative. What truncation takes
    /// from it is known in single precision.
    constexpr double largest_shift = 1e-5;



    /// The inverse of a symmetric positive definite block; rows and columns
    /// with a pivot of at most @p zero[c] are zero.
    template <int dim>
    Block<dim>
    inverse(const Block<dim> &block, const std::array<double, dim> &zero)
    {
      Block<dim> M = block, inverse = {};
      for (int c = 0; c < dim; ++c)
        inverse[c * dim + c] = 1.;
      std::array<bool, dim> is_free;
      for (int p = 0; p < dim; ++p)
        {
          const double pivot = M[p * dim + p];
          is_free[p]         = pivot > zero[p];
          if (!is_free[p])
            continue;
          for (int d = 0; d < dim; ++d)
            {
              M[p * dim + d] /= pivot;
              inverse[p * dim + d] /= pivot;
            }
          for (int c = 0; c < dim; ++c)
            if (c != p)
              {
                const double factor = M[c * dim + p];
                for (int d = 0; d < dim; ++d)
                  {
                    M[c * dim + d] -= factor * M[p * dim + d];
                    inverse[c * dim + d] -= factor * inverse[p * dim + d];
                  }
              }
        }
      for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d)
          if (!is_free[c] || !is_free[d])
            inverse[c * dim + d] = 0.;
      return inverse;
    }



    /// y = M x of the blocks of a diagonal.
    template <int dim>
    inline DEAL_II_ALWAYS_INLINE std::array<float, dim>
    times(const float *const block, const std::array<float, dim> &x)
    {
      std::array<float, dim> y = {};
      for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d)
          y[c] += block[c * dim + d] * x[d];
      return y;
    }
  } // namespace



  template <int dim>
  struct TruncatedCycle<dim>::Level
  {
    const SharedNodes          *nodes = nullptr;
    std::unique_ptr<SharedRows> shared_rows; ///< if ranks share the level
    BlockMatrix<dim, float>     A;           ///< of the cycle
    std::vector<float>          inverse_diagonal;
    float                       largest_eigenvalue = 1.f;
    std::vector<float>          zero; ///< where a diagonal entry counts as it
    Transfer<dim>               transfer; ///< from the next coarser level
    BlockMatrix<dim, double>    original; ///< nothing truncated

    /// What truncation changed: rows, and blocks as they were.
    std::vector<unsigned int> changed_rows;
    std::vector<std::pair<std::size_t, std::array<float, dim * dim>>> changed;

    mutable std::vector<float> x, b, r, p;
  };



  /// A x = b with the coarsest matrix, by CHOLMOD.
  template <int dim>
  class TruncatedCycle<dim>::CoarseSolver
  {
  public:
    /// Factorises A + changes. Unknowns whose diagonal entries are at most @p
    /// zero are left out.
    void
    set(const BlockMatrix<dim, double> &A,
        const BlockMatrix<dim, double> &changes,
        const std::vector<float>       &zero)
    {
      const unsigned int                  n = A.n_rows() * dim;
      std::vector<Eigen::Triplet<double>> entries;
      const auto add = [&](const BlockMatrix<dim, double> &terms) {
        for (unsigned int i = 0; i < terms.n_rows(); ++i)
          terms.visit_row(i,
                          [&](const unsigned int k, const Block<dim> &block) {
                            for (int c = 0; c < dim; ++c)
                              for (int d = 0; d < dim; ++d)
                                if (i * dim + c >= k * dim + d)
                                  entries.emplace_back(i * dim + c,
                                                       k * dim + d,
                                                       block[c * dim + d]);
                          });
      };
      add(A);
      add(changes);
      Eigen::SparseMatrix<double> matrix(n, n);
      matrix.setFromTriplets(entries.begin(), entries.end());
      for (unsigned int i = 0; i < n; ++i)
        if (double &entry = matrix.coeffRef(i, i); entry <= zero[i])
          entry = 1.;

      // Of very slender bodies rounding can make it indefinite; for a
      // preconditioner a little more on the diagonal will do.
      factor.compute(matrix);
      for (double more = 1e-14; factor.info() != Eigen::Success; more *= 10.)
        {
          if (more > largest_shift)
            throw std::runtime_error(
              "multigrid: the coarsest matrix is not positive definite.");
          for (unsigned int i = 0; i < n; ++i)
            matrix.coeffRef(i, i) *= 1. + more;
          factor.compute(matrix);
        }
    }

    void
    solve(const std::vector<float> &b, std::vector<float> &x) const
    {
      const Eigen::VectorXd solution =
        factor.solve(Eigen::Map<const Eigen::VectorXf>(b.data(), b.size())
                       .template cast<double>());
      Eigen::Map<Eigen::VectorXf>(x.data(), x.size()) =
        solution.template cast<float>();
    }

  private:
    mutable Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> factor;
  };



  template <int dim>
  TruncatedCycle<dim>::TruncatedCycle(
    const dealii::SparseMatrix<double>     &fine_matrix,
    const NodeFrames<dim>                  &fine_frames,
    std::vector<Interpolation>              interpolations,
    const std::vector<const SharedNodes *> &nodes,
    const RootLevel<dim>                   *root_level)
    : A(fine_matrix)
    , root(root_level)
    , levels(nodes.size())
    , coarse_solver(std::make_unique<CoarseSolver>())
    , framed(interpolations.size() + 1)
  {
    for (unsigned int l = 0; l < levels.size(); ++l)
      {
        levels[l].nodes = nodes[l];
        if (is_shared(l))
          levels[l].shared_rows = std::make_unique<SharedRows>(*nodes[l]);
      }
    const BlockView<dim> blocks(A);
    const auto           copy = [](const auto              &matrix,
                         const std::size_t        n_blocks,
                         BlockMatrix<dim, float> &result) {
      result.columns.reserve(n_blocks);
      result.values.reserve(n_blocks * dim * dim);
      std::vector<std::pair<unsigned int, Block<dim>>> row;
      for (unsigned int i = 0; i < matrix.n_rows(); ++i)
        {
          row.clear();
          matrix.visit_row(i,
                           [&](const unsigned int k, const Block<dim> &block) {
                             row.emplace_back(k, block);
                           });
          std::sort(row.begin(), row.end(), [](const auto &a, const auto &b) {
            return a.first < b.first;
          });
          for (const auto &[k, block] : row)
            result.append(k, block);
          result.end_row();
        }
    };
    // Rows of fixed unknowns have less than whole blocks.
    copy(blocks,
         static_cast<std::size_t>(
           1.02 * static_cast<double>(A.n_nonzero_elements()) / (dim * dim)),
         levels[0].A);
    for (unsigned int l = 0; l < interpolations.size(); ++l)
      {
        Transfer<dim> &transfer = levels[l].transfer;
        transfer                = Transfer<dim>(std::move(interpolations[l]),
                                 l == 0 ? fine_frames : frames(l));
        if (is_shared(l))
          share_frames(l + 1,
                       is_shared(l + 1) ? nodes[l + 1]->own_ranges() :
                                          root->own_ranges());
        else
          for (std::size_t k = 0; k < transfer.coarse_frames().size(); ++k)
            framed[l + 1].push_back(
              {transfer.coarse_frames()[k].node, transfer.origins()[k]});
        BlockMatrix<dim, double> product =
          l == 0 ? coarser_matrix(l, blocks) :
                   coarser_matrix(l, levels[l].original);
        if (l + 1 == levels.size())
          break;
        levels[l + 1].original = std::move(product);
        copy(levels[l + 1].original,
             levels[l + 1].original.columns.size(),
             levels[l + 1].A);
      }
    if (root != nullptr)
      {
        local_b.resize(std::size_t(root->n_local_nodes()) * dim);
        local_x.resize(local_b.size());
      }
    for (unsigned int l = 0; l < levels.size(); ++l)
      {
        Level &level = levels[l];
        for (auto *vector : {&level.x, &level.b, &level.r, &level.p})
          vector->resize(std::size_t(level.A.n_rows()) * dim);
        prepare_smoother(l);
      }
    if (root == nullptr || root->is_root())
      coarse_solver->set(levels.back().original, {}, levels.back().zero);
  }



  template <int dim>
  bool
  TruncatedCycle<dim>::is_shared(const unsigned int l) const
  {
    return l < levels.size() && !levels[l].nodes->is_whole();
  }



  template <int dim>
  void
  TruncatedCycle<dim>::share_frames(
    const unsigned int                                        l,
    const std::vector<std::pair<unsigned int, unsigned int>> &own_ranges)
  {
    const SharedNodes &finer    = *levels[l - 1].nodes;
    Transfer<dim>     &transfer = levels[l - 1].transfer;
    const auto         number   = [&](const unsigned int node) {
      return is_shared(l) ? levels[l].nodes->number(node) : root->number(node);
    };
    std::vector<unsigned int> numbers;
    std::vector<double>       entries;
    auto                      range = own_ranges.begin();
    for (std::size_t k = 0; k < transfer.coarse_frames().size(); ++k)
      {
        const NodeFrame<dim> &frame = transfer.coarse_frames()[k];
        while (range != own_ranges.end() && range->second <= frame.node)
          ++range;
        if (range == own_ranges.end() || frame.node < range->first)
          continue;
        numbers.push_back(number(frame.node));
        numbers.push_back(finer.number(transfer.origins()[k]));
        for (const auto *block : {&frame.to_unknowns, &frame.to_cartesian})
          entries.insert(entries.end(), block->begin(), block->end());
      }
    const auto all_numbers =
      dealii::Utilities::MPI::all_gather(finer.communicator(), numbers);
    const auto all_entries =
      dealii::Utilities::MPI::all_gather(finer.communicator(), entries);

    struct Frame
    {
      FramedNode    node;
      const double *entries;
    };
    std::vector<Frame> all;
    for (std::size_t rank = 0; rank < all_numbers.size(); ++rank)
      for (std::size_t k = 0; k < all_numbers[rank].size() / 2; ++k)
        all.push_back({{all_numbers[rank][2 * k], all_numbers[rank][2 * k + 1]},
                       all_entries[rank].data() + 2 * dim * dim * k});
    std::sort(all.begin(), all.end(), [](const Frame &a, const Frame &b) {
      return a.node.number < b.node.number;
    });
    NodeFrames<dim> local;
    for (const Frame &frame : all)
      {
        framed[l].push_back(frame.node);
        NodeFrame<dim> result;
        std::copy_n(frame.entries, dim * dim, result.to_unknowns.begin());
        std::copy_n(frame.entries + dim * dim,
                    dim * dim,
                    result.to_cartesian.begin());
        result.node = frame.node.number;
        if (!is_shared(l) && root->is_root())
          root_frames.push_back(result);
        result.node = is_shared(l) ?
                        levels[l].nodes->node_of(frame.node.number) :
                        root->local_node(frame.node.number);
        if (result.node != dealii::numbers::invalid_unsigned_int)
          local.push_back(result);
      }
    transfer.set_coarse_frames(local);
  }



  template <int dim>
  template <typename Matrix>
  BlockMatrix<dim, double>
  TruncatedCycle<dim>::coarser_matrix(const unsigned int l,
                                      const Matrix      &B) const
  {
    const Transfer<dim> &transfer = levels[l].transfer;
    if (is_shared(l + 1))
      return levels[l + 1].shared_rows->complete(
        transfer.galerkin_product(B, levels[l + 1].nodes->own_ranges()));
    if (is_shared(l))
      return root->gather_rows(
        transfer.galerkin_product(B, root->own_ranges()));
    return transfer.galerkin_product(B, {{0u, transfer.n_coarse_nodes()}});
  }



  template <int dim>
  TruncatedCycle<dim>::~TruncatedCycle() = default;



  template <int dim>
  unsigned int
  TruncatedCycle<dim>::n_levels() const
  {
    return static_cast<unsigned int>(levels.size());
  }



  template <int dim>
  const Transfer<dim> &
  TruncatedCycle<dim>::transfer(const unsigned int l) const
  {
    return levels[l].transfer;
  }



  template <int dim>
  unsigned int
  TruncatedCycle<dim>::n_shared_levels() const
  {
    unsigned int result = 0;
    while (is_shared(result))
      ++result;
    return result;
  }



  template <int dim>
  const NodeFrames<dim> &
  TruncatedCycle<dim>::frames(const unsigned int l) const
  {
    return is_shared(l - 1) && !is_shared(l) ?
             root_frames :
             levels[l - 1].transfer.coarse_frames();
  }



  template <int dim>
  const std::vector<typename TruncatedCycle<dim>::FramedNode> &
  TruncatedCycle<dim>::framed_nodes(const unsigned int l) const
  {
    return framed[l];
  }



  template <int dim>
  const BlockMatrix<dim, double> &
  TruncatedCycle<dim>::matrix(const unsigned int l) const
  {
    return levels[l].original;
  }



  template <int dim>
  void
  TruncatedCycle<dim>::invert_diagonal(Level &level, const unsigned int node)
  {
    const std::size_t k = level.A.find(node, node);
    Block<dim>        block;
    std::copy_n(level.A.values.begin() + k * dim * dim,
                dim * dim,
                block.begin());
    std::array<double, dim> zero;
    std::copy_n(level.zero.begin() + std::size_t(node) * dim,
                dim,
                zero.begin());
    block = inverse<dim>(block, zero);
    std::copy(block.begin(),
              block.end(),
              level.inverse_diagonal.begin() + std::size_t(node) * dim * dim);
  }



  template <int dim>
  void
  TruncatedCycle<dim>::prepare_smoother(const unsigned int l)
  {
    Level             &level = levels[l];
    const unsigned int n     = level.A.n_rows();
    level.zero.resize(std::size_t(n) * dim);
    for (unsigned int i = 0; i < n; ++i)
      {
        const std::size_t k = level.A.find(i, i);
        for (int c = 0; c < dim; ++c)
          level.zero[std::size_t(i) * dim + c] =
            vanishing * level.A.values[(k * dim + c) * dim + c];
      }
    level.inverse_diagonal.resize(std::size_t(n) * dim * dim);
    for (unsigned int i = 0; i < n; ++i)
      invert_diagonal(level, i);

    // Lanczos' method in the form of conjugate gradients with D (Saad,
    // Iterative Methods for Sparse Linear Systems, 2nd ed., Section 6.7.3),
    // from a force in which all frequencies are present.
    std::minstd_rand random;
    unsigned int     next_number = 0;
    for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int number = level.nodes->number(i);
        random.discard((number - next_number) * std::size_t(dim));
        next_number = number + 1;
        for (int c = 0; c < dim; ++c)
          level.r[std::size_t(i) * dim + c] =
            static_cast<float>(random()) / static_cast<float>(random.max()) -
            0.5f;
      }
    std::fill(level.p.begin(), level.p.end(), 0.f);
    std::vector<double> steps, ratios;
    double              force_times_shift = 0.;
    while (steps.size() < lanczos_steps)
      {
        for (unsigned int i = 0; i < n; ++i)
          {
            std::array<float, dim> z;
            std::copy_n(level.r.begin() + std::size_t(i) * dim, dim, z.begin());
            z = times<dim>(level.inverse_diagonal.data() +
                             std::size_t(i) * dim * dim,
                           z);
            std::copy_n(z.begin(), dim, level.x.begin() + std::size_t(i) * dim);
          }
        const double previous = force_times_shift;
        force_times_shift =
          level.nodes->product(level.x.data(), level.r.data());
        if (!(force_times_shift > 0.))
          break;
        if (!steps.empty())
          ratios.push_back(force_times_shift / previous);
        const float ratio =
          ratios.empty() ? 0.f : static_cast<float>(ratios.back());
        for (std::size_t i = 0; i < level.p.size(); ++i)
          level.p[i] = level.x[i] + ratio * level.p[i];
        for (const auto &[begin, end] : level.nodes->own_ranges())
          for (unsigned int i = begin; i < end; ++i)
            {
              const auto force = level.A.times(i, level.p.data());
              std::copy_n(force.begin(),
                          dim,
                          level.b.begin() + std::size_t(i) * dim);
            }
        level.nodes->update_ghosts(level.b.data());
        const double curvature =
          level.nodes->product(level.b.data(), level.p.data());
        if (!(curvature > 0.))
          break;
        steps.push_back(force_times_shift / curvature);
        for (std::size_t i = 0; i < level.r.size(); ++i)
          level.r[i] -= static_cast<float>(steps.back()) * level.b[i];
      }
    if (steps.empty())
      return;
    Eigen::VectorXd diagonal(steps.size()), next(steps.size() - 1);
    for (std::size_t k = 0; k < steps.size(); ++k)
      {
        diagonal(k) =
          1. / steps[k] + (k == 0 ? 0. : ratios[k - 1] / steps[k - 1]);
        if (k + 1 < steps.size())
          next(k) = std::sqrt(ratios[k]) / steps[k];
      }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigenvalues;
    eigenvalues.computeFromTridiagonal(diagonal, next, Eigen::EigenvaluesOnly);
    level.largest_eigenvalue =
      eigenvalue_margin *
      static_cast<float>(eigenvalues.eigenvalues().maxCoeff());
  }



  template <int dim>
  void
  TruncatedCycle<dim>::change(Level                          &level,
                              const BlockMatrix<dim, double> &changes)
  {
    for (unsigned int i = 0; i < changes.n_rows(); ++i)
      {
        if (changes.starts[i] == changes.starts[i + 1])
          continue;
        level.changed_rows.push_back(i);
        changes.visit_row(
          i, [&](const unsigned int k, const Block<dim> &difference) {
            const std::size_t position = level.A.find(i, k);
            auto &[where, before]      = level.changed.emplace_back();
            where                      = position;
            float *const block = level.A.values.data() + position * dim * dim;
            std::copy_n(block, dim * dim, before.begin());
            for (int e = 0; e < dim * dim; ++e)
              block[e] = static_cast<float>(block[e] + difference[e]);
          });
      }
  }



  template <int dim>
  void
  TruncatedCycle<dim>::truncate(const unsigned int                 level_index,
                                const std::vector<unsigned int>   &held,
                                const std::vector<unsigned int>   &coupled,
                                const Eigen::SparseMatrix<double> &E)
  {
    for (Level &level : levels)
      {
        for (auto change = level.changed.rbegin();
             change != level.changed.rend();
             ++change)
          std::copy(change->second.begin(),
                    change->second.end(),
                    level.A.values.begin() + change->first * dim * dim);
        for (const unsigned int row : level.changed_rows)
          invert_diagonal(level, row);
        level.changed.clear();
        level.changed_rows.clear();
      }
    first              = level_index;
    const auto is_here = [](const unsigned int i) {
      return i != dealii::numbers::invalid_unsigned_int;
    };
    held_unknowns.clear();
    std::copy_if(held.begin(),
                 held.end(),
                 std::back_inserter(held_unknowns),
                 is_here);

    // Q (A + E) Q - A, Q without the held unknowns, by rows.
    Level &finest = levels[first];
    std::map<unsigned int, std::map<unsigned int, Block<dim>>> differences;
    std::map<unsigned int, std::array<bool, dim>>              held_at;
    for (const unsigned int i : held_unknowns)
      held_at.try_emplace(i / dim).first->second[i % dim] = true;
    for (int j = 0; j < E.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(E, j); entry;
           ++entry)
        {
          const unsigned int i = coupled[entry.row()], k = coupled[j];
          if (!is_here(i) || !is_here(k))
            continue;
          differences[i / dim]
            .try_emplace(k / dim)
            .first->second[i % dim * dim + k % dim] += entry.value();
        }
    const auto is_held = [&](const unsigned int node, const int c) {
      const auto found = held_at.find(node);
      return found != held_at.end() && found->second[c];
    };
    for (const auto &[i, components] : held_at)
      {
        // The columns of a symmetric matrix.
        std::vector<unsigned int> neighbours;
        for (std::size_t k = finest.A.starts[i]; k < finest.A.starts[i + 1];
             ++k)
          neighbours.push_back(finest.A.columns[k]);
        for (const unsigned int k : neighbours)
          {
            differences[i].try_emplace(k);
            differences[k].try_emplace(i);
          }
      }
    BlockMatrix<dim, double>                                          changes;
    std::vector<std::pair<std::size_t, std::array<float, dim * dim>>> diagonals;
    {
      unsigned int row = 0;
      for (auto &[i, blocks] : differences)
        {
          for (; row < i; ++row)
            changes.end_row();
          for (auto &[k, block] : blocks)
            {
              const std::size_t position = finest.A.find(i, k);
              if (position == finest.A.columns.size())
                continue;
              for (int c = 0; c < dim; ++c)
                for (int d = 0; d < dim; ++d)
                  if (is_held(i, c) || is_held(k, d))
                    block[c * dim + d] =
                      -finest.A.values[position * dim * dim + c * dim + d];
              changes.append(k, block);
            }
          changes.end_row();
          ++row;
        }
      for (; row < finest.A.n_rows(); ++row)
        changes.end_row();
    }

    // Held unknowns keep their diagonal entries.
    std::vector<float> entries;
    for (const unsigned int i : held_unknowns)
      entries.push_back(
        finest.A.values[finest.A.find(i / dim, i / dim) * dim * dim +
                        i % dim * (dim + 1)]);
    change(finest, changes);
    for (std::size_t h = 0; h < held_unknowns.size(); ++h)
      {
        const unsigned int i                 = held_unknowns[h];
        finest.A.values[finest.A.find(i / dim, i / dim) * dim * dim +
                        i % dim * (dim + 1)] = entries[h];
      }
    for (unsigned int l = first; l < levels.size(); ++l)
      {
        for (const unsigned int row : levels[l].changed_rows)
          invert_diagonal(levels[l], row);
        if (l + 1 < levels.size() || is_shared(l))
          changes = coarser_matrix(l, changes);
        if (l + 1 < levels.size())
          change(levels[l + 1], changes);
      }
    if (root == nullptr || root->is_root())
      coarse_solver->set(levels.back().original, changes, levels.back().zero);
  }



  template <int dim>
  void
  TruncatedCycle<dim>::cycle(const unsigned int l) const
  {
    const Level &level = levels[l];
    if (l + 1 == levels.size() && !is_shared(l))
      {
        coarse_solver->solve(level.b, level.x);
        return;
      }

    // Chebyshev polynomials on [largest / range, largest], see Saad, Iterative
    // Methods for Sparse Linear Systems, 2nd ed., Alg. 12.1.
    const unsigned int n       = level.A.n_rows();
    const float        largest = level.largest_eigenvalue;
    const float        theta   = 0.5f * (largest + largest / smoothing_range);
    const float        delta   = 0.5f * (largest - largest / smoothing_range);
    const float        sigma = theta / delta, rho = 1.f / sigma;
    const float        next_rho = 1.f / (2.f * sigma - rho);

    // p = momentum p + step D^{-1} (b - A x), x += p
    const auto &ranges = level.nodes->own_ranges();
    const auto  move   = [&](const float momentum, const float step) {
      for (const auto &[begin, end] : ranges)
        for (unsigned int i = begin; i < end; ++i)
          {
            std::array<float, dim> residual = level.A.times(i, level.x.data());
            const std::size_t      first_entry = std::size_t(i) * dim;
            for (int c = 0; c < dim; ++c)
              residual[c] = level.b[first_entry + c] - residual[c];
            residual =
              times<dim>(level.inverse_diagonal.data() + first_entry * dim,
                         residual);
            for (int c = 0; c < dim; ++c)
              {
                float &p                 = level.p[first_entry + c];
                p                        = momentum * p + step * residual[c];
                level.r[first_entry + c] = level.x[first_entry + c] + p;
              }
          }
      std::swap(level.x, level.r);
      level.nodes->update_ghosts(level.x.data());
    };
    const float momentum = next_rho * rho, step = 2.f * next_rho / delta;

    for (unsigned int i = 0; i < n; ++i)
      {
        std::array<float, dim> b;
        std::copy_n(level.b.begin() + std::size_t(i) * dim, dim, b.begin());
        b =
          times<dim>(level.inverse_diagonal.data() + std::size_t(i) * dim * dim,
                     b);
        for (int c = 0; c < dim; ++c)
          level.x[std::size_t(i) * dim + c] =
            level.p[std::size_t(i) * dim + c] = b[c] / theta;
      }
    move(momentum, step);

    for (const auto &[begin, end] : ranges)
      for (unsigned int i = begin; i < end; ++i)
        {
          const auto force = level.A.times(i, level.x.data());
          for (int c = 0; c < dim; ++c)
            level.r[std::size_t(i) * dim + c] =
              level.b[std::size_t(i) * dim + c] - force[c];
        }
    // The matrix does not couple held unknowns to others.
    level.nodes->update_ghosts(level.r.data());
    if (is_shared(l) && !is_shared(l + 1))
      {
        level.transfer.restrict_to(local_b.data(), level.r.data());
        std::vector<float> none;
        root->gather(local_b, root->is_root() ? levels[l + 1].b : none);
        if (root->is_root())
          cycle(l + 1);
        root->scatter(root->is_root() ? levels[l + 1].x : none, local_x);
        level.transfer.prolongate_add(level.x.data(), local_x.data());
      }
    else
      {
        const Level &coarser = levels[l + 1];
        level.transfer.restrict_to(coarser.b.data(), level.r.data());
        coarser.nodes->update_ghosts(coarser.b.data());
        cycle(l + 1);
        level.transfer.prolongate_add(level.x.data(), coarser.x.data());
      }

    move(0.f, 1.f / theta);
    move(momentum, step);
  }



  template <int dim>
  void
  TruncatedCycle<dim>::vmult(DofVector &dst, const DofVector &src) const
  {
    const Level &level = levels[first];
    // Single precision has a smaller range, too.
    const double size = level.nodes->largest(src.begin());
    if (size == 0. || !std::isfinite(size))
      {
        dst = size;
        return;
      }
    for (unsigned int i = 0; i < level.b.size(); ++i)
      level.b[i] = static_cast<float>(src(i) / size);
    for (const unsigned int i : held_unknowns)
      level.b[i] = 0.f;
    cycle(first);
    for (unsigned int i = 0; i < level.x.size(); ++i)
      dst(i) = size * level.x[i];
    for (const unsigned int i : held_unknowns)
      dst(i) = 0.;
  }



  template <int dim>
  std::size_t
  TruncatedCycle<dim>::memory_consumption() const
  {
    const auto bytes = [](const auto &vector) {
      return vector.capacity() * sizeof(vector[0]);
    };
    std::size_t result = 0;
    for (const Level &level : levels)
      {
        result += bytes(level.A.starts) + bytes(level.A.columns) +
                  bytes(level.A.values) + bytes(level.original.starts) +
                  bytes(level.original.columns) + bytes(level.original.values) +
                  bytes(level.inverse_diagonal) + bytes(level.zero);
        for (const auto *vector : {&level.x, &level.b, &level.r, &level.p})
          result += bytes(*vector);
      }
    return result;
  }



  template class TruncatedCycle<2>;
  template class TruncatedCycle<3>;
} // namespace Debond
