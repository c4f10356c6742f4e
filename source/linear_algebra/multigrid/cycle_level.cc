// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid/cycle_level.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <random>

namespace Debond
{
  namespace
  {
    /// Of the interval that smoothers damp: largest eigenvalue over smallest.
    constexpr float smoothing_range = 20.f;

    /// Lanczos' eigenvalues come from below.
    constexpr float       eigenvalue_margin = 1.1f;
    constexpr std::size_t lanczos_steps     = 8;

    /// What changes leave at most of the diagonal entry of an unknown that is
    /// not free, relative.
    constexpr float vanishing = 1e-5f;


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
  template <typename Matrix>
  CycleLevel<dim>::CycleLevel(const SharedNodes &shared_nodes,
                              const Matrix      &matrix,
                              const std::size_t  n_blocks)
    : nodes(&shared_nodes)
  {
    A.columns.reserve(n_blocks);
    A.values.reserve(n_blocks * dim * dim);
    std::vector<std::pair<unsigned int, Block<dim>>> row;
    for (unsigned int i = 0; i < matrix.n_rows(); ++i)
      {
        row.clear();
        matrix.visit_row(i, [&](const unsigned int k, const Block<dim> &block) {
          row.emplace_back(k, block);
        });
        std::sort(row.begin(), row.end(), [](const auto &a, const auto &b) {
          return a.first < b.first;
        });
        for (const auto &[k, block] : row)
          A.append(k, block);
        A.end_row();
      }
    prepare_smoother();
  }



  template <int dim>
  const BlockMatrix<dim, float> &
  CycleLevel<dim>::matrix() const
  {
    return A;
  }



  template <int dim>
  void
  CycleLevel<dim>::prepare_smoother()
  {
    const unsigned int n = A.n_rows();
    for (auto *vector : {&x, &b, &r, &p, &zero_entries})
      vector->resize(std::size_t(n) * dim);
    for (unsigned int i = 0; i < n * dim; ++i)
      zero_entries[i] = vanishing * diagonal_entry(i);
    inverse_diagonal.resize(std::size_t(n) * dim * dim);
    for (unsigned int i = 0; i < n; ++i)
      invert_diagonal(i);

    // Lanczos' method in the form of conjugate gradients with D (Saad,
    // Iterative Methods for Sparse Linear Systems, 2nd ed., Section 6.7.3),
    // from a force in which all frequencies are present.
    std::minstd_rand random;
    unsigned int     next_number = 0;
    for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int number = nodes->number(i);
        random.discard((number - next_number) * std::size_t(dim));
        next_number = number + 1;
        for (int c = 0; c < dim; ++c)
          r[std::size_t(i) * dim + c] =
            static_cast<float>(random()) / static_cast<float>(random.max()) -
            0.5f;
      }
    std::vector<double> steps, ratios;
    double              force_times_shift = 0.;
    while (steps.size() < lanczos_steps)
      {
        for (unsigned int i = 0; i < n; ++i)
          {
            std::array<float, dim> z;
            std::copy_n(r.begin() + std::size_t(i) * dim, dim, z.begin());
            z = times<dim>(inverse_diagonal.data() + std::size_t(i) * dim * dim,
                           z);
            std::copy_n(z.begin(), dim, x.begin() + std::size_t(i) * dim);
          }
        const double previous = force_times_shift;
        force_times_shift     = nodes->product(x.data(), r.data());
        if (!(force_times_shift > 0.))
          break;
        if (!steps.empty())
          ratios.push_back(force_times_shift / previous);
        const float ratio =
          ratios.empty() ? 0.f : static_cast<float>(ratios.back());
        for (std::size_t i = 0; i < p.size(); ++i)
          p[i] = x[i] + ratio * p[i];
        for (const auto &[begin, end] : nodes->own_ranges())
          for (unsigned int i = begin; i < end; ++i)
            {
              const auto force = A.times(i, p.data());
              std::copy_n(force.begin(), dim, b.begin() + std::size_t(i) * dim);
            }
        nodes->update_ghosts(b.data());
        const double curvature = nodes->product(b.data(), p.data());
        if (!(curvature > 0.))
          break;
        steps.push_back(force_times_shift / curvature);
        for (std::size_t i = 0; i < r.size(); ++i)
          r[i] -= static_cast<float>(steps.back()) * b[i];
      }
    float largest = 1.f;
    if (!steps.empty())
      {
        Eigen::VectorXd diagonal(steps.size()), next(steps.size() - 1);
        for (std::size_t k = 0; k < steps.size(); ++k)
          {
            diagonal(k) =
              1. / steps[k] + (k == 0 ? 0. : ratios[k - 1] / steps[k - 1]);
            if (k + 1 < steps.size())
              next(k) = std::sqrt(ratios[k]) / steps[k];
          }
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigenvalues;
        eigenvalues.computeFromTridiagonal(diagonal,
                                           next,
                                           Eigen::EigenvaluesOnly);
        largest = eigenvalue_margin *
                  static_cast<float>(eigenvalues.eigenvalues().maxCoeff());
      }

    // On [largest / range, largest].
    theta             = 0.5f * (largest + largest / smoothing_range);
    const float delta = 0.5f * (largest - largest / smoothing_range);
    const float sigma = theta / delta, rho = 1.f / sigma;
    const float next_rho = 1.f / (2.f * sigma - rho);
    momentum             = next_rho * rho;
    step                 = 2.f * next_rho / delta;
  }



  template <int dim>
  const std::vector<float> &
  CycleLevel<dim>::zero() const
  {
    return zero_entries;
  }



  template <int dim>
  float &
  CycleLevel<dim>::diagonal_entry(const unsigned int unknown)
  {
    const unsigned int node = unknown / dim;
    return A.values[A.find(node, node) * dim * dim + unknown % dim * (dim + 1)];
  }



  template <int dim>
  void
  CycleLevel<dim>::invert_diagonal(const unsigned int node)
  {
    const std::size_t k = A.find(node, node);
    Block<dim>        block;
    std::copy_n(A.values.begin() + k * dim * dim, dim * dim, block.begin());
    std::array<double, dim> zero;
    std::copy_n(zero_entries.begin() + std::size_t(node) * dim,
                dim,
                zero.begin());
    block = inverse<dim>(block, zero);
    std::copy(block.begin(),
              block.end(),
              inverse_diagonal.begin() + std::size_t(node) * dim * dim);
  }



  template <int dim>
  void
  CycleLevel<dim>::change(const BlockMatrix<dim, double> &changes)
  {
    for (unsigned int i = 0; i < changes.n_rows(); ++i)
      {
        if (changes.starts[i] == changes.starts[i + 1])
          continue;
        changed_rows.push_back(i);
        changes.visit_row(
          i, [&](const unsigned int k, const Block<dim> &difference) {
            const std::size_t position = A.find(i, k);
            auto &[where, before]      = changed.emplace_back();
            where                      = position;
            float *const block         = A.values.data() + position * dim * dim;
            std::copy_n(block, dim * dim, before.begin());
            for (int e = 0; e < dim * dim; ++e)
              block[e] = static_cast<float>(block[e] + difference[e]);
          });
      }
  }



  template <int dim>
  void
  CycleLevel<dim>::update_smoother()
  {
    for (const unsigned int row : changed_rows)
      invert_diagonal(row);
  }



  template <int dim>
  void
  CycleLevel<dim>::undo_changes()
  {
    for (auto change = changed.rbegin(); change != changed.rend(); ++change)
      std::copy(change->second.begin(),
                change->second.end(),
                A.values.begin() + change->first * dim * dim);
    update_smoother();
    changed.clear();
    changed_rows.clear();
  }



  template <int dim>
  void
  CycleLevel<dim>::move(const float by_last, const float by_residual) const
  {
    for (const auto &[begin, end] : nodes->own_ranges())
      for (unsigned int i = begin; i < end; ++i)
        {
          std::array<float, dim> residual    = A.times(i, x.data());
          const std::size_t      first_entry = std::size_t(i) * dim;
          for (int c = 0; c < dim; ++c)
            residual[c] = b[first_entry + c] - residual[c];
          residual =
            times<dim>(inverse_diagonal.data() + first_entry * dim, residual);
          for (int c = 0; c < dim; ++c)
            {
              float &shift       = p[first_entry + c];
              shift              = by_last * shift + by_residual * residual[c];
              r[first_entry + c] = x[first_entry + c] + shift;
            }
        }
    std::swap(x, r);
    nodes->update_ghosts(x.data());
  }



  template <int dim>
  void
  CycleLevel<dim>::smooth_from_zero() const
  {
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      {
        std::array<float, dim> force;
        std::copy_n(b.begin() + std::size_t(i) * dim, dim, force.begin());
        force = times<dim>(inverse_diagonal.data() + std::size_t(i) * dim * dim,
                           force);
        for (int c = 0; c < dim; ++c)
          x[std::size_t(i) * dim + c] = p[std::size_t(i) * dim + c] =
            force[c] / theta;
      }
    move(momentum, step);
  }



  template <int dim>
  void
  CycleLevel<dim>::smooth() const
  {
    move(0.f, 1.f / theta);
    move(momentum, step);
  }



  template <int dim>
  void
  CycleLevel<dim>::compute_residual() const
  {
    for (const auto &[begin, end] : nodes->own_ranges())
      for (unsigned int i = begin; i < end; ++i)
        {
          const auto force = A.times(i, x.data());
          for (int c = 0; c < dim; ++c)
            r[std::size_t(i) * dim + c] =
              b[std::size_t(i) * dim + c] - force[c];
        }
    nodes->update_ghosts(r.data());
  }



  template <int dim>
  std::size_t
  CycleLevel<dim>::memory_consumption() const
  {
    const auto bytes = [](const auto &vector) {
      return vector.capacity() * sizeof(vector[0]);
    };
    std::size_t result = bytes(A.starts) + bytes(A.columns) + bytes(A.values) +
                         bytes(inverse_diagonal) + bytes(zero_entries);
    for (const auto *vector : {&x, &b, &r, &p})
      result += bytes(*vector);
    return result;
  }



  template class CycleLevel<2>;
  template class CycleLevel<3>;
  template CycleLevel<2>::CycleLevel(const SharedNodes &,
                                     const BlockView<2> &,
                                     const std::size_t);
  template CycleLevel<3>::CycleLevel(const SharedNodes &,
                                     const BlockView<3> &,
                                     const std::size_t);
  template CycleLevel<2>::CycleLevel(const SharedNodes &,
                                     const BlockMatrix<2, double> &,
                                     const std::size_t);
  template CycleLevel<3>::CycleLevel(const SharedNodes &,
                                     const BlockMatrix<3, double> &,
                                     const std::size_t);
} // namespace Debond
