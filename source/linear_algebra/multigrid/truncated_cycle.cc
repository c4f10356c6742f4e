// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid/truncated_cycle.h>

#include <Eigen/CholmodSupport>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

namespace Debond
{
  namespace
  {
    /// Of the diagonal of the coarsest matrix, relative. What truncation takes
    /// from it is known in single precision.
    constexpr double largest_shift = 1e-5;
  } // namespace



  template <int dim>
  struct TruncatedCycle<dim>::Level
  {
    const SharedNodes          *nodes = nullptr;
    std::unique_ptr<SharedRows> shared_rows; ///< if ranks share the level
    Transfer<dim>               transfer;    ///< from the next coarser level
    BlockMatrix<dim, double>    original;    ///< nothing truncated
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
    truncated.reserve(levels.size());
    // Rows of fixed unknowns have less than whole blocks.
    truncated.emplace_back(
      *nodes[0],
      blocks,
      static_cast<std::size_t>(
        1.02 * static_cast<double>(A.n_nonzero_elements()) / (dim * dim)));
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
        truncated.emplace_back(*nodes[l + 1],
                               levels[l + 1].original,
                               levels[l + 1].original.columns.size());
      }
    if (root != nullptr)
      {
        local_b.resize(std::size_t(root->n_local_nodes()) * dim);
        local_x.resize(local_b.size());
      }
    if (root == nullptr || root->is_root())
      coarse_solver->set(levels.back().original, {}, truncated.back().zero());
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
  TruncatedCycle<dim>::truncate(const unsigned int                 level_index,
                                const std::vector<unsigned int>   &held,
                                const std::vector<unsigned int>   &coupled,
                                const Eigen::SparseMatrix<double> &E)
  {
    for (CycleLevel<dim> &level : truncated)
      level.undo_changes();
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
    CycleLevel<dim>               &finest = truncated[first];
    const BlockMatrix<dim, float> &matrix = finest.matrix();
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
        for (std::size_t k = matrix.starts[i]; k < matrix.starts[i + 1]; ++k)
          neighbours.push_back(matrix.columns[k]);
        for (const unsigned int k : neighbours)
          {
            differences[i].try_emplace(k);
            differences[k].try_emplace(i);
          }
      }
    BlockMatrix<dim, double> changes;
    {
      unsigned int row = 0;
      for (auto &[i, blocks] : differences)
        {
          for (; row < i; ++row)
            changes.end_row();
          for (auto &[k, block] : blocks)
            {
              const std::size_t position = matrix.find(i, k);
              if (position == matrix.columns.size())
                continue;
              for (int c = 0; c < dim; ++c)
                for (int d = 0; d < dim; ++d)
                  if (is_held(i, c) || is_held(k, d))
                    block[c * dim + d] =
                      -matrix.values[position * dim * dim + c * dim + d];
              changes.append(k, block);
            }
          changes.end_row();
          ++row;
        }
      for (; row < matrix.n_rows(); ++row)
        changes.end_row();
    }

    // Held unknowns keep their diagonal entries.
    std::vector<float> entries;
    for (const unsigned int i : held_unknowns)
      entries.push_back(finest.diagonal_entry(i));
    finest.change(changes);
    for (std::size_t h = 0; h < held_unknowns.size(); ++h)
      finest.diagonal_entry(held_unknowns[h]) = entries[h];
    for (unsigned int l = first; l < levels.size(); ++l)
      {
        truncated[l].update_smoother();
        if (l + 1 < levels.size() || is_shared(l))
          changes = coarser_matrix(l, changes);
        if (l + 1 < levels.size())
          truncated[l + 1].change(changes);
      }
    if (root == nullptr || root->is_root())
      coarse_solver->set(levels.back().original,
                         changes,
                         truncated.back().zero());
  }



  template <int dim>
  void
  TruncatedCycle<dim>::cycle(const unsigned int l) const
  {
    const CycleLevel<dim> &level    = truncated[l];
    const Transfer<dim>   &transfer = levels[l].transfer;
    if (l + 1 == levels.size() && !is_shared(l))
      {
        coarse_solver->solve(level.b, level.x);
        return;
      }

    level.smooth_from_zero();
    // The matrix does not couple held unknowns to others.
    level.compute_residual();
    if (is_shared(l) && !is_shared(l + 1))
      {
        transfer.restrict_to(local_b.data(), level.r.data());
        std::vector<float> none;
        root->gather(local_b, root->is_root() ? truncated[l + 1].b : none);
        if (root->is_root())
          cycle(l + 1);
        root->scatter(root->is_root() ? truncated[l + 1].x : none, local_x);
        transfer.prolongate_add(level.x.data(), local_x.data());
      }
    else
      {
        const CycleLevel<dim> &coarser = truncated[l + 1];
        transfer.restrict_to(coarser.b.data(), level.r.data());
        levels[l + 1].nodes->update_ghosts(coarser.b.data());
        cycle(l + 1);
        transfer.prolongate_add(level.x.data(), coarser.x.data());
      }

    level.smooth();
  }



  template <int dim>
  void
  TruncatedCycle<dim>::vmult(DofVector &dst, const DofVector &src) const
  {
    const CycleLevel<dim> &level = truncated[first];
    // Single precision has a smaller range, too.
    const double size = levels[first].nodes->largest(src.begin());
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
        result += bytes(level.original.starts) + bytes(level.original.columns) +
                  bytes(level.original.values);
      }
    for (const CycleLevel<dim> &level : truncated)
      result += level.memory_consumption();
    return result;
  }



  template class TruncatedCycle<2>;
  template class TruncatedCycle<3>;
} // namespace Debond
