// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/elastic_levels.h>

#include <algorithm>
#include <map>
#include <utility>

namespace Debond
{
  namespace
  {
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
    const std::vector<dealii::Point<dim>> points =
      node_points(problem.unknowns());
    std::vector<CoarseLevel<dim>> coarse = body.coarse_levels(points);
    if (coarse.empty())
      return nullptr;
    return std::unique_ptr<ElasticLevels>(
      new ElasticLevels(problem,
                        std::make_unique<SharedNodes>(dim, body.slabs(points)),
                        nullptr,
                        nullptr,
                        std::move(coarse)));
  }



  template <int dim>
  std::unique_ptr<ElasticLevels<dim>>
  ElasticLevels<dim>::make(const ProblemPiece<dim>   &piece,
                           const ElasticProblem<dim> &problem)
  {
    auto own = piece.body().coarse_piece(node_points(problem.unknowns()));
    const MPI_Comm                ranks = piece.nodes().communicator();
    std::vector<CoarseLevel<dim>> coarse;
    std::vector<unsigned int>     ids;
    coarse.push_back(std::move(own.level));
    if (dealii::Utilities::MPI::this_mpi_process(ranks) == 0)
      {
        auto whole         = piece.body().coarse_whole();
        coarse[0].vertices = std::move(whole.vertices);
        ids                = std::move(whole.ids);
        for (CoarseLevel<dim> &level : whole.coarser)
          coarse.push_back(std::move(level));
      }
    auto root = std::make_unique<RootLevel<dim>>(
      typename RootLevel<dim>::Piece{std::move(own.ids), std::move(own.is_own)},
      std::move(ids),
      ranks);
    return std::unique_ptr<ElasticLevels>(new ElasticLevels(
      problem, nullptr, &piece, std::move(root), std::move(coarse)));
  }



  template <int dim>
  ElasticLevels<dim>::ElasticLevels(const ElasticProblem<dim> &elastic_problem,
                                    std::unique_ptr<SharedNodes> all_nodes,
                                    const ProblemPiece<dim>     *problem_piece,
                                    std::unique_ptr<RootLevel<dim>> root_level,
                                    std::vector<CoarseLevel<dim>> &&coarse)
    : problem(elastic_problem)
    , whole(std::move(all_nodes))
    , piece(problem_piece)
    , root(std::move(root_level))
    , nodes(whole ? *whole : piece->nodes())
    , levels(is_root() ? coarse.size() + 1 : 1)
  {
    std::vector<Interpolation> interpolations;
    for (std::size_t l = 0; l < coarse.size(); ++l)
      {
        if (is_root())
          levels[l + 1].vertices = std::move(coarse[l].vertices);
        interpolations.push_back(std::move(coarse[l].to_finer));
      }
    truncated_cycle =
      std::make_unique<TruncatedCycle<dim>>(problem.matrix(),
                                            node_frames(problem.unknowns()),
                                            std::move(interpolations),
                                            nodes,
                                            root.get());

    if (piece != nullptr)
      levels[0].normals = piece->normals();
    else
      levels[0].normals.assign(problem.unknowns().contact().normals().begin(),
                               problem.unknowns().contact().normals().end());
    levels[0].trace_prolongation.resize(levels[0].normals.size(),
                                        levels[0].normals.size());
    levels[0].trace_prolongation.setIdentity();
    if (root)
      {
        levels[0].load = problem.load();
        nodes.update_ghosts(levels[0].load.begin());
        add_shared_level();
      }
    for (unsigned int l = root ? 1 : 0; l + 1 < levels.size(); ++l)
      {
        const Transfer<dim> &transfer = truncated_cycle->transfer(l);
        Level               &coarser  = levels[l + 1];
        coarser.load.reinit(transfer.n_coarse_nodes() * dim);
        transfer.restrict_to(coarser.load.begin(), load(l).begin());
        const auto index_of = add_normals(l + 1, levels[l].normals);

        std::vector<Eigen::Triplet<double>> entries;
        for (unsigned int j = 0; j < coarser.normals.size(); ++j)
          transfer.visit_column(
            coarser.normals[j], [&](const unsigned int i, const double entry) {
              const auto found = index_of.find(i);
              if (found != index_of.end() && entry != 0.)
                entries.emplace_back(found->second, j, entry);
            });
        add_trace(l + 1, entries);
      }
  }



  template <int dim>
  void
  ElasticLevels<dim>::add_shared_level()
  {
    const Transfer<dim> &transfer = truncated_cycle->transfer(0);
    std::vector<double>  own_load(transfer.n_coarse_nodes() * dim), all_load;
    transfer.restrict_to(own_load.data(), load(0).begin());
    if (is_root())
      {
        levels[1].load.reinit(
          static_cast<unsigned int>(levels[1].vertices.size()) * dim);
        all_load.resize(levels[1].load.size());
      }
    root->gather(own_load, all_load);
    if (is_root())
      std::copy(all_load.begin(), all_load.end(), levels[1].load.begin());

    // Entries of P by contact node and the id of the coarse unknown.
    std::map<unsigned int, unsigned int> index_of;
    for (unsigned int i = 0; i < piece->normals().size(); ++i)
      if (piece->normals()[i] != dealii::numbers::invalid_unsigned_int)
        index_of[piece->normals()[i]] = i;
    std::vector<unsigned int> places;
    std::vector<double>       entries;
    for (const NodeFrame<dim> &frame : transfer.coarse_frames())
      for (unsigned int c = 0; c < dim && root->is_own(frame.node); ++c)
        transfer.visit_column(frame.node * dim + c,
                              [&](const unsigned int i, const double entry) {
                                const auto found = index_of.find(i);
                                if (found == index_of.end() || entry == 0.)
                                  return;
                                places.push_back(found->second);
                                places.push_back(root->id(frame.node) * dim +
                                                 c);
                                entries.push_back(entry);
                              });
    const auto all_places =
      dealii::Utilities::MPI::gather(root->communicator(), places);
    const auto all_entries =
      dealii::Utilities::MPI::gather(root->communicator(), entries);
    if (!is_root())
      return;

    add_normals(1, piece->normal_numbers());
    std::map<unsigned int, unsigned int> coarse_index_of;
    for (unsigned int j = 0; j < levels[1].normals.size(); ++j)
      coarse_index_of[levels[1].normals[j]] = j;
    std::vector<Eigen::Triplet<double>> triplets;
    for (std::size_t rank = 0; rank < all_entries.size(); ++rank)
      for (std::size_t k = 0; k < all_entries[rank].size(); ++k)
        {
          const unsigned int column = all_places[rank][2 * k + 1];
          const auto         found  = coarse_index_of.find(
            root->node_of(column / dim) * dim + column % dim);
          if (found != coarse_index_of.end())
            triplets.emplace_back(all_places[rank][2 * k],
                                  found->second,
                                  all_entries[rank][k]);
        }
    add_trace(1, triplets);
  }



  template <int dim>
  std::map<unsigned int, unsigned int>
  ElasticLevels<dim>::add_normals(const unsigned int               l,
                                  const std::vector<unsigned int> &fine_normals)
  {
    // A coarse unknown is a normal displacement if it is one at the node that
    // it is like.
    std::map<unsigned int, unsigned int> index_of;
    for (unsigned int i = 0; i < fine_normals.size(); ++i)
      index_of[fine_normals[i]] = i;
    const NodeFrames<dim> &coarse_frames = truncated_cycle->frames(l);
    for (std::size_t k = 0; k < coarse_frames.size(); ++k)
      for (unsigned int c = 0; c < dim; ++c)
        if (index_of.count(truncated_cycle->origins(l)[k] * dim + c) > 0)
          levels[l].normals.push_back(coarse_frames[k].node * dim + c);
    return index_of;
  }



  template <int dim>
  void
  ElasticLevels<dim>::add_trace(
    const unsigned int                         l,
    const std::vector<Eigen::Triplet<double>> &entries)
  {
    Eigen::SparseMatrix<double> step(levels[l - 1].normals.size(),
                                     levels[l].normals.size());
    step.setFromTriplets(entries.begin(), entries.end());
    levels[l].trace_prolongation = levels[l - 1].trace_prolongation * step;
  }



  template <int dim>
  bool
  ElasticLevels<dim>::is_root() const
  {
    return !root || root->is_root();
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
    return l == 0 && !root ? problem.load() : levels[l].load;
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
        nodes.update_ghosts(dst.begin());
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
  dealii::Vector<double>
  ElasticLevels<dim>::trace(const unsigned int            l,
                            const dealii::Vector<double> &v) const
  {
    if (l == 0 && piece != nullptr)
      return piece->trace(v);
    dealii::Vector<double> s(
      static_cast<unsigned int>(levels[l].normals.size()));
    for (unsigned int i = 0; i < s.size(); ++i)
      s(i) = v(levels[l].normals[i]);
    return s;
  }



  template <int dim>
  double
  ElasticLevels<dim>::product(const unsigned int            l,
                              const dealii::Vector<double> &a,
                              const dealii::Vector<double> &b) const
  {
    return l == 0 ? nodes.product(a.begin(), b.begin()) : a * b;
  }



  template <int dim>
  void
  ElasticLevels<dim>::update_ghosts(const unsigned int      l,
                                    dealii::Vector<double> &v) const
  {
    if (l == 0)
      nodes.update_ghosts(v.begin());
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  ElasticLevels<dim>::contact_rows(const unsigned int l) const
  {
    constexpr unsigned int elsewhere = dealii::numbers::invalid_unsigned_int;
    const std::vector<unsigned int>     &normals = levels[l].normals;
    std::map<unsigned int, unsigned int> index_of;
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (normals[i] != elsewhere)
        index_of[normals[i]] = i;
    std::vector<unsigned int> places;
    std::vector<double>       values;
    for (const auto &[unknown, i] : index_of)
      if (l > 0 || nodes.is_own(unknown / dim))
        visit_row(l,
                  unknown,
                  [&](const unsigned int column, const double entry) {
                    const auto found = index_of.find(column);
                    if (found == index_of.end())
                      return;
                    places.push_back(found->second);
                    places.push_back(i);
                    values.push_back(entry);
                  });

    std::vector<std::vector<unsigned int>> all_places = {places};
    std::vector<std::vector<double>>       all_values = {values};
    if (l == 0 && piece != nullptr)
      {
        all_places =
          dealii::Utilities::MPI::all_gather(nodes.communicator(), places);
        all_values =
          dealii::Utilities::MPI::all_gather(nodes.communicator(), values);
      }
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t rank = 0; rank < all_values.size(); ++rank)
      for (std::size_t k = 0; k < all_values[rank].size(); ++k)
        entries.emplace_back(all_places[rank][2 * k],
                             all_places[rank][2 * k + 1],
                             all_values[rank][k]);
    Eigen::SparseMatrix<double> result(normals.size(), normals.size());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }



  template <int dim>
  void
  ElasticLevels<dim>::add_column(const unsigned int      l,
                                 const unsigned int      column,
                                 const double            factor,
                                 dealii::Vector<double> &v) const
  {
    visit_row(l, column, [&](const unsigned int i, const double entry) {
      v(i) += factor * entry;
    });
  }



  template <int dim>
  template <typename Visitor>
  void
  ElasticLevels<dim>::visit_row(const unsigned int l,
                                const unsigned int row,
                                const Visitor     &visit) const
  {
    if (l == 0)
      {
        for (auto entry = problem.matrix().begin(row);
             entry != problem.matrix().end(row);
             ++entry)
          visit(static_cast<unsigned int>(entry->column()), entry->value());
        return;
      }
    truncated_cycle->matrix(l).visit_row(
      row / dim, [&](const unsigned int k, const Block<dim> &block) {
        for (unsigned int d = 0; d < dim; ++d)
          visit(k * dim + d, block[row % dim * dim + d]);
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
    for (const NodeFrame<dim> &frame : truncated_cycle->frames(l))
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
    if (l == 1 && root)
      {
        std::vector<double> local(std::size_t(root->n_local_nodes()) * dim);
        root->scatter(std::vector<double>(u.begin(), u.end()), local);
        coarse.reinit(static_cast<unsigned int>(local.size()));
        std::copy(local.begin(), local.end(), coarse.begin());
      }
    truncated_cycle->transfer(l - 1).prolongate_add(result.begin(),
                                                    coarse.begin());
    return result;
  }



  template class ElasticLevels<2>;
  template class ElasticLevels<3>;
} // namespace Debond
