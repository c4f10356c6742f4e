// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/elastic_levels.h>

#include <algorithm>
#include <map>
#include <utility>

namespace Debond
{
  namespace
  {
    /// The points of the nodes, by number.
    template <int dim>
    std::vector<dealii::Point<dim>>
    node_points(const ElasticUnknowns<dim> &unknowns)
    {
      std::vector<dealii::Point<dim>> points(unknowns.n_dofs() / dim);
      for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int node = cell->vertex_dof_index(v, 0) / dim;
            for (unsigned int d = 0; d < dim; ++d)
              Assert(cell->vertex_dof_index(v, d) == node * dim + d,
                     dealii::ExcInternalError());
            points[node] = cell->vertex(v);
          }
      return points;
    }



    template <int dim>
    NodeFrames<dim>
    node_frames(const ElasticUnknowns<dim> &unknowns)
    {
      std::map<unsigned int, NodeFrame<dim>> frames;
      for (const auto &frame : unknowns.frames())
        {
          NodeFrame<dim> &result =
            frames[static_cast<unsigned int>(frame.dofs[0] / dim)];
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = 0; d < dim; ++d)
              {
                result.to_unknowns[c * dim + d]  = frame.to_frame[c][d];
                result.to_cartesian[c * dim + d] = frame.to_cartesian[c][d];
              }
        }
      for (unsigned int i = 0; i < unknowns.n_dofs(); ++i)
        if (unknowns.is_constrained(i))
          {
            const unsigned int c         = i % dim;
            const auto [found, is_plain] = frames.try_emplace(i / dim);
            NodeFrame<dim> &result       = found->second;
            if (is_plain)
              for (unsigned int d = 0; d < dim; ++d)
                result.to_unknowns[d * (dim + 1)] =
                  result.to_cartesian[d * (dim + 1)] = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              result.to_unknowns[c * dim + d] =
                result.to_cartesian[d * dim + c] = 0.;
          }
      NodeFrames<dim> result;
      for (auto &[node, frame] : frames)
        {
          frame.node = node;
          result.push_back(frame);
        }
      return result;
    }
  } // namespace



  template <int dim>
  std::unique_ptr<ElasticLevels<dim>>
  ElasticLevels<dim>::make(const Body<dim>           &body,
                           const ElasticProblem<dim> &problem)
  {
    std::vector<CoarseLevel<dim>> coarse =
      body.coarse_levels(node_points(problem.unknowns()));
    if (coarse.empty())
      return nullptr;
    return std::unique_ptr<ElasticLevels>(new ElasticLevels(
      problem, node_frames(problem.unknowns()), std::move(coarse)));
  }



  template <int dim>
  ElasticLevels<dim>::ElasticLevels(const ElasticProblem<dim> &elastic_problem,
                                    const NodeFrames<dim>     &frames,
                                    std::vector<CoarseLevel<dim>> &&coarse)
    : problem(elastic_problem)
    , levels(coarse.size() + 1)
  {
    std::vector<Interpolation> interpolations;
    for (std::size_t l = 0; l < coarse.size(); ++l)
      {
        levels[l + 1].vertices = std::move(coarse[l].vertices);
        interpolations.push_back(std::move(coarse[l].to_finer));
      }
    truncated_cycle =
      std::make_unique<TruncatedCycle<dim>>(problem.matrix(),
                                            frames,
                                            std::move(interpolations));

    const auto &normals = problem.unknowns().contact().normals();
    levels[0].normals.assign(normals.begin(), normals.end());
    levels[0].trace_prolongation.resize(normals.size(), normals.size());
    levels[0].trace_prolongation.setIdentity();
    for (unsigned int l = 0; l + 1 < levels.size(); ++l)
      {
        const Transfer<dim> &transfer = truncated_cycle->transfer(l);
        Level               &coarser  = levels[l + 1];
        coarser.load.reinit(transfer.n_coarse_nodes() * dim);
        transfer.restrict_to(coarser.load.begin(), load(l).begin());

        // A coarse unknown is a normal displacement if it is one at the node
        // that it is like.
        const std::vector<unsigned int>     &fine_normals = levels[l].normals;
        std::map<unsigned int, unsigned int> index_of;
        for (unsigned int i = 0; i < fine_normals.size(); ++i)
          index_of[fine_normals[i]] = i;
        const NodeFrames<dim> &coarse_frames = transfer.coarse_frames();
        for (std::size_t k = 0; k < coarse_frames.size(); ++k)
          for (unsigned int c = 0; c < dim; ++c)
            if (index_of.count(transfer.origins()[k] * dim + c) > 0)
              coarser.normals.push_back(coarse_frames[k].node * dim + c);

        Eigen::SparseMatrix<double>         step(fine_normals.size(),
                                         coarser.normals.size());
        std::vector<Eigen::Triplet<double>> entries;
        for (unsigned int j = 0; j < coarser.normals.size(); ++j)
          transfer.visit_column(
            coarser.normals[j], [&](const unsigned int i, const double entry) {
              const auto found = index_of.find(i);
              if (found != index_of.end() && entry != 0.)
                entries.emplace_back(found->second, j, entry);
            });
        step.setFromTriplets(entries.begin(), entries.end());
        coarser.trace_prolongation = levels[l].trace_prolongation * step;
      }
  }



  template <int dim>
  unsigned int
  ElasticLevels<dim>::n_levels() const
  {
    return static_cast<unsigned int>(levels.size());
  }



  template <int dim>
  unsigned int
  ElasticLevels<dim>::n_unknowns(const unsigned int l) const
  {
    return static_cast<unsigned int>(load(l).size());
  }



  template <int dim>
  TruncatedCycle<dim> &
  ElasticLevels<dim>::cycle()
  {
    return *truncated_cycle;
  }



  template <int dim>
  const std::vector<unsigned int> &
  ElasticLevels<dim>::normals(const unsigned int l) const
  {
    return levels[l].normals;
  }



  template <int dim>
  const Eigen::SparseMatrix<double> &
  ElasticLevels<dim>::trace_prolongation(const unsigned int l) const
  {
    return levels[l].trace_prolongation;
  }



  template <int dim>
  const dealii::Vector<double> &
  ElasticLevels<dim>::load(const unsigned int l) const
  {
    return l == 0 ? problem.load() : levels[l].load;
  }



  template <int dim>
  void
  ElasticLevels<dim>::vmult(const unsigned int            l,
                            dealii::Vector<double>       &dst,
                            const dealii::Vector<double> &src) const
  {
    if (l == 0)
      {
        problem.matrix().vmult(dst, src);
        return;
      }
    const BlockMatrix<dim, double> &A = truncated_cycle->matrix(l);
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      {
        const auto product = A.times(i, src.begin());
        std::copy(product.begin(), product.end(), dst.begin() + i * dim);
      }
  }



  template <int dim>
  void
  ElasticLevels<dim>::add_column(const unsigned int      l,
                                 const unsigned int      column,
                                 const double            factor,
                                 dealii::Vector<double> &v) const
  {
    if (l == 0)
      {
        for (auto entry = problem.matrix().begin(column);
             entry != problem.matrix().end(column);
             ++entry)
          v(entry->column()) += factor * entry->value();
        return;
      }
    truncated_cycle->matrix(l).visit_row(
      column / dim, [&](const unsigned int k, const Block<dim> &block) {
        for (unsigned int d = 0; d < dim; ++d)
          v(k * dim + d) += factor * block[column % dim * dim + d];
      });
  }



  template <int dim>
  double
  ElasticLevels<dim>::diagonal_entry(const unsigned int l,
                                     const unsigned int i) const
  {
    if (l == 0)
      return problem.matrix().diag_element(i);
    const BlockMatrix<dim, double> &A = truncated_cycle->matrix(l);
    return A.values[A.find(i / dim, i / dim) * dim * dim + i % dim * (dim + 1)];
  }



  template <int dim>
  const std::vector<dealii::Point<dim>> &
  ElasticLevels<dim>::vertices(const unsigned int l) const
  {
    return levels[l].vertices;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticLevels<dim>::from_vertex_displacements(
    const unsigned int                         l,
    const std::vector<dealii::Tensor<1, dim>> &displacements) const
  {
    dealii::Vector<double> result(n_unknowns(l));
    for (unsigned int i = 0; i < displacements.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        result(i * dim + d) = displacements[i][d];
    for (const NodeFrame<dim> &frame :
         truncated_cycle->transfer(l - 1).coarse_frames())
      for (unsigned int c = 0; c < dim; ++c)
        {
          result(frame.node * dim + c) = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result(frame.node * dim + c) +=
              frame.to_unknowns[c * dim + d] * displacements[frame.node][d];
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticLevels<dim>::prolongate(const unsigned int            l,
                                 const dealii::Vector<double> &u) const
  {
    dealii::Vector<double> result(n_unknowns(l - 1)), coarse(u);
    truncated_cycle->transfer(l - 1).prolongate_add(result.begin(),
                                                    coarse.begin());
    return result;
  }



  template class ElasticLevels<2>;
  template class ElasticLevels<3>;
} // namespace Debond
