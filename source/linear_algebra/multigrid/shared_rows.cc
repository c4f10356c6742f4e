// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <debond/linear_algebra/multigrid/shared_rows.h>

#include <algorithm>

namespace Debond
{
  SharedRows::SharedRows(const SharedNodes &shared_nodes)
    : nodes(shared_nodes)
  {
    const unsigned int n       = nodes.size();
    unsigned int       n_whole = n == 0 ? 0 : nodes.number(n - 1) + 1;
    n_whole = dealii::Utilities::MPI::max(n_whole, nodes.communicator());
    dealii::IndexSet own(n_whole), ghosts(n_whole);
    for (unsigned int i = 0; i < n; ++i)
      if (!nodes.is_own(i))
        ghosts.add_index(nodes.number(i));
    for (const auto &[begin, end] : nodes.own_ranges())
      for (unsigned int i = begin; i < end; ++i)
        own.add_index(nodes.number(i));
    own.compress();
    ghosts.compress();

    const std::vector<unsigned int> owners =
      dealii::Utilities::MPI::compute_index_owner(own,
                                                  ghosts,
                                                  nodes.communicator());
    std::map<unsigned int, std::vector<unsigned int>> requests;
    auto                                              owner = owners.begin();
    for (const auto number : ghosts)
      requests[*owner++].push_back(static_cast<unsigned int>(number));
    wanted =
      dealii::Utilities::MPI::some_to_some(nodes.communicator(), requests);
    for (auto &[rank, numbers] : wanted)
      for (unsigned int &number : numbers)
        number = nodes.node_of(number);
  }



  template <int dim>
  BlockMatrix<dim, double>
  SharedRows::complete(const BlockMatrix<dim, double> &matrix) const
  {
    // Of each row its number and how many blocks it has, then their columns.
    std::map<unsigned int, std::vector<unsigned int>> shapes;
    std::map<unsigned int, std::vector<double>>       values;
    for (const auto &[rank, rows] : wanted)
      for (const unsigned int i : rows)
        {
          const std::size_t begin = matrix.starts[i],
                            end   = matrix.starts[i + 1];
          if (begin == end)
            continue;
          std::vector<unsigned int> &shape = shapes[rank];
          shape.push_back(nodes.number(i));
          shape.push_back(static_cast<unsigned int>(end - begin));
          for (std::size_t k = begin; k < end; ++k)
            shape.push_back(nodes.number(matrix.columns[k]));
          std::vector<double> &blocks = values[rank];
          blocks.insert(blocks.end(),
                        matrix.values.begin() + begin * dim * dim,
                        matrix.values.begin() + end * dim * dim);
        }
    shapes = dealii::Utilities::MPI::some_to_some(nodes.communicator(), shapes);
    values = dealii::Utilities::MPI::some_to_some(nodes.communicator(), values);

    struct Row
    {
      const unsigned int *shape;
      const double       *values;
    };
    std::vector<Row> of_ghosts(nodes.size(), {nullptr, nullptr});
    for (const auto &[rank, shape] : shapes)
      {
        const double *value = values.at(rank).data();
        for (std::size_t k = 0; k < shape.size();)
          {
            const unsigned int *const row    = shape.data() + k;
            of_ghosts[nodes.node_of(row[0])] = {row, value};
            value += std::size_t(row[1]) * dim * dim;
            k += 2 + row[1];
          }
      }

    BlockMatrix<dim, double> result;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        if (const auto &[shape, blocks] = of_ghosts[i]; shape != nullptr)
          for (unsigned int k = 0; k < shape[1]; ++k)
            {
              const unsigned int column = nodes.node_of(shape[2 + k]);
              if (column == dealii::numbers::invalid_unsigned_int)
                continue;
              const double *const block =
                blocks + static_cast<std::size_t>(k) * dim * dim;
              result.columns.push_back(column);
              result.values.insert(result.values.end(),
                                   block,
                                   block + dim * dim);
            }
        else if (nodes.is_own(i))
          {
            result.columns.insert(result.columns.end(),
                                  matrix.columns.begin() + matrix.starts[i],
                                  matrix.columns.begin() +
                                    matrix.starts[i + 1]);
            result.values.insert(result.values.end(),
                                 matrix.values.begin() +
                                   matrix.starts[i] * dim * dim,
                                 matrix.values.begin() +
                                   matrix.starts[i + 1] * dim * dim);
          }
        result.end_row();
      }
    result.columns.shrink_to_fit();
    result.values.shrink_to_fit();
    return result;
  }



  template BlockMatrix<2, double>
  SharedRows::complete(const BlockMatrix<2, double> &) const;
  template BlockMatrix<3, double>
  SharedRows::complete(const BlockMatrix<3, double> &) const;
} // namespace Debond
