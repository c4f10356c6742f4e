// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid/transfer.h>

#include <algorithm>
#include <array>
#include <utility>

namespace Debond
{
  namespace
  {
    /// Of a node that takes over the frame of a finer one.
    constexpr float least_dependence = 0.5f;



    Interpolation
    transpose(const Interpolation &rows)
    {
      Interpolation result;
      result.n_nodes = rows.n_points();
      result.starts.assign(rows.n_nodes + 1, 0);
      for (const unsigned int node : rows.nodes)
        ++result.starts[node + 1];
      for (unsigned int j = 0; j < rows.n_nodes; ++j)
        result.starts[j + 1] += result.starts[j];
      result.nodes.resize(rows.nodes.size());
      result.weights.resize(rows.nodes.size());
      std::vector<std::size_t> next(result.starts.begin(),
                                    result.starts.end() - 1);
      for (unsigned int i = 0; i < rows.n_points(); ++i)
        for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k)
          {
            const std::size_t position = next[rows.nodes[k]]++;
            result.nodes[position]     = i;
            result.weights[position]   = rows.weights[k];
          }
      return result;
    }



    /// x -> M x or M'x.
    template <int dim, typename Number>
    void
    multiply(const Block<dim> &M, const bool transposed, Number *const x)
    {
      std::array<double, dim> result = {};
      for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d)
          result[c] += M[transposed ? d * dim + c : c * dim + d] * x[d];
      for (int c = 0; c < dim; ++c)
        x[c] = static_cast<Number>(result[c]);
    }



    /// The frame of each node, null where there is none.
    template <int dim>
    std::vector<const NodeFrame<dim> *>
    by_node(const NodeFrames<dim> &frames, const unsigned int n_nodes)
    {
      std::vector<const NodeFrame<dim> *> result(n_nodes, nullptr);
      for (const NodeFrame<dim> &frame : frames)
        result[frame.node] = &frame;
      return result;
    }
  } // namespace



  template <int dim>
  Transfer<dim>::Transfer(Interpolation          interpolation,
                          const NodeFrames<dim> &frames)
    : rows(std::move(interpolation))
    , fine(frames)
    , columns(transpose(rows))
  {
    std::vector<float>        largest(rows.n_nodes, least_dependence);
    std::vector<unsigned int> like(rows.n_nodes, rows.n_points());
    for (const NodeFrame<dim> &frame : fine)
      for (std::size_t k = rows.starts[frame.node];
           k < rows.starts[frame.node + 1];
           ++k)
        {
          const unsigned int j = rows.nodes[k];
          if (rows.weights[k] > largest[j] ||
              (rows.weights[k] == largest[j] && like[j] == rows.n_points()))
            {
              largest[j] = rows.weights[k];
              like[j]    = frame.node;
            }
        }
    const auto frame_of = by_node(fine, rows.n_points());
    for (unsigned int j = 0; j < rows.n_nodes; ++j)
      if (like[j] < rows.n_points())
        {
          coarse.push_back(*frame_of[like[j]]);
          coarse.back().node = j;
          origin_nodes.push_back(like[j]);
        }
  }



  template <int dim>
  unsigned int
  Transfer<dim>::n_fine_nodes() const
  {
    return rows.n_points();
  }



  template <int dim>
  unsigned int
  Transfer<dim>::n_coarse_nodes() const
  {
    return rows.n_nodes;
  }



  template <int dim>
  const NodeFrames<dim> &
  Transfer<dim>::coarse_frames() const
  {
    return coarse;
  }



  template <int dim>
  const std::vector<unsigned int> &
  Transfer<dim>::origins() const
  {
    return origin_nodes;
  }



  template <int dim>
  void
  Transfer<dim>::set_coarse_frames(const NodeFrames<dim> &frames)
  {
    coarse = frames;
    origin_nodes.clear();
  }



  template <int dim>
  template <typename Number>
  void
  Transfer<dim>::prolongate_add(Number *const fine_values,
                                Number *const coarse_values) const
  {
    for (const NodeFrame<dim> &frame : coarse)
      multiply<dim>(frame.to_cartesian,
                    false,
                    coarse_values + frame.node * dim);

    const auto add_row = [&](const unsigned int i, Number *const values) {
      for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k)
        for (int c = 0; c < dim; ++c)
          values[c] += rows.weights[k] *
                       coarse_values[std::size_t(rows.nodes[k]) * dim + c];
    };
    unsigned int i = 0;
    for (const NodeFrame<dim> &frame : fine)
      {
        for (; i < frame.node; ++i)
          add_row(i, fine_values + std::size_t(i) * dim);
        std::array<Number, dim> value = {};
        add_row(i, value.data());
        multiply<dim>(frame.to_unknowns, false, value.data());
        for (int c = 0; c < dim; ++c)
          fine_values[std::size_t(i) * dim + c] += value[c];
        ++i;
      }
    for (; i < rows.n_points(); ++i)
      add_row(i, fine_values + std::size_t(i) * dim);
  }



  template <int dim>
  template <typename Number>
  void
  Transfer<dim>::restrict_to(Number *const       coarse_values,
                             const Number *const fine_values) const
  {
    std::fill_n(coarse_values, std::size_t(rows.n_nodes) * dim, Number());
    const auto add_row = [&](const unsigned int i, const Number *const values) {
      for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k)
        for (int c = 0; c < dim; ++c)
          coarse_values[std::size_t(rows.nodes[k]) * dim + c] +=
            rows.weights[k] * values[c];
    };
    unsigned int i = 0;
    for (const NodeFrame<dim> &frame : fine)
      {
        for (; i < frame.node; ++i)
          add_row(i, fine_values + std::size_t(i) * dim);
        std::array<Number, dim> value;
        std::copy_n(fine_values + std::size_t(i) * dim, dim, value.begin());
        multiply<dim>(frame.to_unknowns, true, value.data());
        add_row(i, value.data());
        ++i;
      }
    for (; i < rows.n_points(); ++i)
      add_row(i, fine_values + std::size_t(i) * dim);

    for (const NodeFrame<dim> &frame : coarse)
      multiply<dim>(frame.to_cartesian, true, coarse_values + frame.node * dim);
  }



  template <int dim>
  template <typename Matrix>
  BlockMatrix<dim, double>
  Transfer<dim>::galerkin_product(
    const Matrix                                             &A,
    const std::vector<std::pair<unsigned int, unsigned int>> &ranges) const
  {
    const auto fine_frame   = by_node(fine, rows.n_points());
    const auto coarse_frame = by_node(coarse, rows.n_nodes);

    // M B or M'B, and B M.
    const auto product = [](const Block<dim> &M, const Block<dim> &B) {
      Block<dim> result = {};
      for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            result[c * dim + d] += M[c * dim + e] * B[e * dim + d];
      return result;
    };
    const auto transposed_product = [](const Block<dim> &M,
                                       const Block<dim> &B) {
      Block<dim> result = {};
      for (int c = 0; c < dim; ++c)
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            result[c * dim + d] += M[e * dim + c] * B[e * dim + d];
      return result;
    };

    BlockMatrix<dim, double>  result;
    std::vector<unsigned int> position(rows.n_nodes, rows.n_nodes), row_columns;
    std::vector<Block<dim>>   blocks;
    std::vector<std::pair<unsigned int, unsigned int>> order;
    const auto add_row = [&](const unsigned int j) {
      row_columns.clear();
      blocks.clear();
      for (std::size_t m = columns.starts[j]; m < columns.starts[j + 1]; ++m)
        {
          const unsigned int i      = columns.nodes[m];
          const double       weight = columns.weights[m];
          A.visit_row(i, [&](const unsigned int k, Block<dim> B) {
            if (fine_frame[i] != nullptr)
              B = transposed_product(fine_frame[i]->to_unknowns, B);
            if (fine_frame[k] != nullptr)
              B = product(B, fine_frame[k]->to_unknowns);
            for (double &entry : B)
              entry *= weight;
            for (std::size_t n = rows.starts[k]; n < rows.starts[k + 1]; ++n)
              {
                const unsigned int l = rows.nodes[n];
                if (position[l] == rows.n_nodes)
                  {
                    position[l] = static_cast<unsigned int>(row_columns.size());
                    row_columns.push_back(l);
                    blocks.push_back({});
                  }
                Block<dim>  &sum = blocks[position[l]];
                const double w   = rows.weights[n];
                for (int e = 0; e < dim * dim; ++e)
                  sum[e] += w * B[e];
              }
          });
        }

      order.clear();
      for (const unsigned int l : row_columns)
        {
          order.emplace_back(l, position[l]);
          position[l] = rows.n_nodes;
        }
      std::sort(order.begin(), order.end());
      for (const auto &[l, n] : order)
        {
          Block<dim> B = blocks[n];
          if (coarse_frame[j] != nullptr)
            B = transposed_product(coarse_frame[j]->to_cartesian, B);
          if (coarse_frame[l] != nullptr)
            B = product(B, coarse_frame[l]->to_cartesian);
          result.append(l, B);
        }
    };
    unsigned int j = 0;
    for (const auto &[begin, end] : ranges)
      {
        for (; j < begin; ++j)
          result.end_row();
        for (; j < end; ++j)
          {
            add_row(j);
            result.end_row();
          }
      }
    for (; j < rows.n_nodes; ++j)
      result.end_row();
    result.columns.shrink_to_fit();
    result.values.shrink_to_fit();
    return result;
  }



  template class Transfer<2>;
  template class Transfer<3>;
  template BlockMatrix<2, double>
  Transfer<2>::galerkin_product(
    const BlockView<2> &,
    const std::vector<std::pair<unsigned int, unsigned int>> &) const;
  template BlockMatrix<3, double>
  Transfer<3>::galerkin_product(
    const BlockView<3> &,
    const std::vector<std::pair<unsigned int, unsigned int>> &) const;
  template BlockMatrix<2, double>
  Transfer<2>::galerkin_product(
    const BlockMatrix<2, double> &,
    const std::vector<std::pair<unsigned int, unsigned int>> &) const;
  template BlockMatrix<3, double>
  Transfer<3>::galerkin_product(
    const BlockMatrix<3, double> &,
    const std::vector<std::pair<unsigned int, unsigned int>> &) const;
  template void
  Transfer<2>::prolongate_add(float *const, float *const) const;
  template void
  Transfer<3>::prolongate_add(float *const, float *const) const;
  template void
  Transfer<2>::prolongate_add(double *const, double *const) const;
  template void
  Transfer<3>::prolongate_add(double *const, double *const) const;
  template void
  Transfer<2>::restrict_to(float *const, const float *const) const;
  template void
  Transfer<3>::restrict_to(float *const, const float *const) const;
  template void
  Transfer<2>::restrict_to(double *const, const double *const) const;
  template void
  Transfer<3>::restrict_to(double *const, const double *const) const;
} // namespace Debond
