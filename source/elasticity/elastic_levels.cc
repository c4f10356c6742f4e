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
    const std::vector<unsigned int> vertices =
      node_vertices(problem.unknowns());
    const auto &mesh = problem.unknowns().dof_handler().get_triangulation();
    std::vector<CoarseLevel<dim>> coarse = body.coarse_levels(mesh, vertices);
    if (coarse.empty())
      return nullptr;
    const std::vector<unsigned int> slabs_of_mesh = body.slabs(mesh);
    std::vector<unsigned int>       slabs;
    for (const unsigned int vertex : vertices)
      slabs.push_back(slabs_of_mesh[vertex]);
    std::vector<Level>         levels(1 + coarse.size());
    std::vector<Interpolation> interpolations;
    levels[0].own_nodes = std::make_unique<SharedNodes>(dim, std::move(slabs));
    for (std::size_t l = 1; l < levels.size(); ++l)
      {
        levels[l].vertices = std::move(coarse[l - 1].vertices);
        levels[l].own_nodes =
          std::make_unique<SharedNodes>(dim, std::move(coarse[l - 1].slabs));
        interpolations.push_back(std::move(coarse[l - 1].to_finer));
      }
    for (Level &level : levels)
      {
        level.nodes            = level.own_nodes.get();
        level.n_whole_unknowns = level.nodes->size() * dim;
      }
    return std::unique_ptr<ElasticLevels>(new ElasticLevels(
      problem, nullptr, nullptr, std::move(levels), std::move(interpolations)));
  }



  template <int dim>
  std::unique_ptr<ElasticLevels<dim>>
  ElasticLevels<dim>::make(const ProblemPiece<dim>   &piece,
                           const ElasticProblem<dim> &problem,
                           const unsigned int         end_shared)
  {
    const BodyPiece<dim> &body  = piece.body();
    const MPI_Comm        ranks = piece.nodes().communicator();
    const unsigned int n_shared = std::min(body.n_shared_levels(), end_shared);
    auto               pieces =
      body.coarse_pieces(problem.unknowns().dof_handler().get_triangulation(),
                         node_vertices(problem.unknowns()),
                         n_shared);

    std::vector<Level>         levels(n_shared);
    std::vector<Interpolation> interpolations;
    levels[0].nodes = &piece.nodes();
    levels[0].n_whole_unknowns =
      static_cast<unsigned int>(body.n_vertices()) * dim;
    for (auto &of_level : pieces)
      interpolations.push_back(std::move(of_level.level.to_finer));
    for (unsigned int l = 1; l < n_shared; ++l)
      {
        auto &own           = pieces[l - 1];
        levels[l].vertices  = std::move(own.level.vertices);
        levels[l].own_nodes = std::make_unique<SharedNodes>(
          dim,
          std::move(own.level.slabs),
          body.n_slabs(),
          SharedNodes::Piece{std::move(own.numbers),
                             std::move(own.is_own),
                             ranks});
        levels[l].nodes            = levels[l].own_nodes.get();
        levels[l].n_whole_unknowns = own.n_whole * dim;
      }
    if (dealii::Utilities::MPI::this_mpi_process(ranks) == 0)
      {
        auto whole = body.coarse_whole(n_shared);
        whole.coarser.insert(whole.coarser.begin(),
                             CoarseLevel<dim>{std::move(whole.vertices),
                                              {},
                                              std::move(whole.slabs)});
        for (CoarseLevel<dim> &coarse : whole.coarser)
          {
            Level &level   = levels.emplace_back();
            level.vertices = std::move(coarse.vertices);
            level.own_nodes =
              std::make_unique<SharedNodes>(dim, std::move(coarse.slabs));
            level.nodes            = level.own_nodes.get();
            level.n_whole_unknowns = level.nodes->size() * dim;
            if (levels.size() > n_shared + 1)
              interpolations.push_back(std::move(coarse.to_finer));
          }
      }
    auto &of_root = pieces.back();
    auto  root    = std::make_unique<RootLevel<dim>>(
      typename RootLevel<dim>::Piece{std::move(of_root.numbers),
                                     std::move(of_root.is_own),
                                     of_root.n_whole},
      ranks);
    return std::unique_ptr<ElasticLevels>(
      new ElasticLevels(problem,
                        &piece,
                        std::move(root),
                        std::move(levels),
                        std::move(interpolations)));
  }



  template <int dim>
  ElasticLevels<dim>::ElasticLevels(const ElasticProblem<dim> &elastic_problem,
                                    const ProblemPiece<dim>   *problem_piece,
                                    std::unique_ptr<RootLevel<dim>> root_level,
                                    std::vector<Level> &&levels_with_nodes,
                                    std::vector<Interpolation> &&interpolations)
    : problem(elastic_problem)
    , piece(problem_piece)
    , root(std::move(root_level))
    , levels(std::move(levels_with_nodes))
  {
    std::vector<const SharedNodes *> nodes;
    for (const Level &level : levels)
      nodes.push_back(level.nodes);
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
        update_ghosts(0, levels[0].load);
      }
    for (unsigned int l = 0; l < levels.size(); ++l)
      {
        if (l + 1 == levels.size() && !is_shared(l))
          break;
        const Transfer<dim> &transfer = truncated_cycle->transfer(l);
        DofVector            coarse_load(transfer.n_coarse_nodes() * dim);
        transfer.restrict_to(coarse_load.begin(), load(l).begin());
        if (is_shared(l) && !is_shared(l + 1))
          {
            std::vector<double> whole(
              is_root() ? std::size_t(levels[l + 1].n_whole_unknowns) : 0);
            root->gather(std::vector<double>(coarse_load.begin(),
                                             coarse_load.end()),
                         whole);
            coarse_load.reinit(static_cast<unsigned int>(whole.size()));
            std::copy(whole.begin(), whole.end(), coarse_load.begin());
          }
        if (l + 1 == levels.size())
          break;
        levels[l + 1].load = coarse_load;
        update_ghosts(l + 1, levels[l + 1].load);
      }

    std::vector<unsigned int> numbers =
      piece != nullptr ? piece->normal_numbers() : levels[0].normals;
    const unsigned int n_with_trace =
      root ? n_shared_levels() + 1 : static_cast<unsigned int>(levels.size());
    for (unsigned int l = 1;
         l < std::max<std::size_t>(levels.size(), n_with_trace);
         ++l)
      numbers = add_trace(l, numbers);
  }



  template <int dim>
  std::vector<unsigned int>
  ElasticLevels<dim>::add_trace(const unsigned int               l,
                                const std::vector<unsigned int> &fine_numbers)
  {
    constexpr unsigned int elsewhere = dealii::numbers::invalid_unsigned_int;

    // A coarse unknown is a normal displacement if it is one at the node that
    // it is like.
    std::map<unsigned int, unsigned int> fine_index_of;
    for (unsigned int i = 0; i < fine_numbers.size(); ++i)
      fine_index_of[fine_numbers[i]] = i;
    std::vector<unsigned int> numbers;
    for (const auto &node : truncated_cycle->framed_nodes(l))
      for (unsigned int c = 0; c < dim; ++c)
        if (fine_index_of.count(node.origin * dim + c) > 0)
          numbers.push_back(node.number * dim + c);

    // Entries of P between normal displacements, from those who own the coarse
    // one.
    const Transfer<dim>      &transfer   = truncated_cycle->transfer(l - 1);
    const bool                is_of_root = is_shared(l - 1) && !is_shared(l);
    std::vector<unsigned int> places;
    std::vector<double>       values;
    for (unsigned int j = 0; j < numbers.size(); ++j)
      {
        const unsigned int number = numbers[j] / dim;
        const unsigned int node   = is_of_root ? root->local_node(number) :
                                                 levels[l].nodes->node_of(number);
        if (node == elsewhere ||
            !(is_of_root ? root->is_own(node) : levels[l].nodes->is_own(node)))
          continue;
        transfer.visit_column(node * dim + numbers[j] % dim,
                              [&](const unsigned int i, const double entry) {
                                const auto found = fine_index_of.find(
                                  levels[l - 1].nodes->number(i / dim) * dim +
                                  i % dim);
                                if (found == fine_index_of.end() || entry == 0.)
                                  return;
                                places.push_back(found->second);
                                places.push_back(j);
                                values.push_back(entry);
                              });
      }
    const Eigen::SparseMatrix<double> step =
      gathered_matrix(l - 1,
                      places,
                      values,
                      static_cast<unsigned int>(fine_numbers.size()),
                      static_cast<unsigned int>(numbers.size()));
    if (l == levels.size())
      return numbers;

    Level &level             = levels[l];
    level.trace_prolongation = levels[l - 1].trace_prolongation * step;
    for (const unsigned int number : numbers)
      {
        const unsigned int node = level.nodes->node_of(number / dim);
        level.normals.push_back(node == elsewhere ? elsewhere :
                                                    node * dim + number % dim);
      }
    if (is_shared(l))
      level.trace =
        std::make_unique<SharedTrace>(*level.nodes, dim, level.normals);
    return numbers;
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  ElasticLevels<dim>::gathered_matrix(const unsigned int               l,
                                      const std::vector<unsigned int> &places,
                                      const std::vector<double>       &values,
                                      const unsigned int               n_rows,
                                      const unsigned int n_columns) const
  {
    std::vector<std::vector<unsigned int>> all_places = {places};
    std::vector<std::vector<double>>       all_values = {values};
    if (is_shared(l))
      {
        const MPI_Comm ranks = levels[l].nodes->communicator();
        all_places = dealii::Utilities::MPI::all_gather(ranks, places);
        all_values = dealii::Utilities::MPI::all_gather(ranks, values);
      }
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t rank = 0; rank < all_values.size(); ++rank)
      for (std::size_t k = 0; k < all_values[rank].size(); ++k)
        entries.emplace_back(all_places[rank][2 * k],
                             all_places[rank][2 * k + 1],
                             all_values[rank][k]);
    Eigen::SparseMatrix<double> result(n_rows, n_columns);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
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
  void
  ElasticLevels<dim>::vmult(const unsigned int l,
                            DofVector         &dst,
                            const DofVector   &src) const
  {
    if (l == 0)
      problem.matrix().vmult(dst, src);
    else
      {
        const BlockMatrix<dim, double> &A = truncated_cycle->matrix(l);
        for (const auto &[begin, end] : levels[l].nodes->own_ranges())
          for (unsigned int i = begin; i < end; ++i)
            {
              const auto product = A.times(i, src.begin());
              std::copy(product.begin(), product.end(), dst.begin() + i * dim);
            }
      }
    update_ghosts(l, dst);
  }



  template <int dim>
  Eigen::VectorXd
  ElasticLevels<dim>::trace(const unsigned int l, const DofVector &v) const
  {
    if (l == 0 && piece != nullptr)
      return piece->trace(v);
    if (is_shared(l))
      return (*levels[l].trace)(v);
    Eigen::VectorXd s(levels[l].normals.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      s(i) = v(levels[l].normals[i]);
    return s;
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
    // C++17 has no capture of a structured binding by reference.
    for (const auto &[unknown, row] : index_of)
      if (levels[l].nodes->is_own(unknown / dim))
        visit_row(l,
                  unknown,
                  [&, i = row](const unsigned int column, const double entry) {
                    const auto found = index_of.find(column);
                    if (found == index_of.end())
                      return;
                    places.push_back(found->second);
                    places.push_back(i);
                    values.push_back(entry);
                  });

    const unsigned int n = static_cast<unsigned int>(normals.size());
    return gathered_matrix(l, places, values, n, n);
  }



  template <int dim>
  void
  ElasticLevels<dim>::add_column(const unsigned int l,
                                 const unsigned int column,
                                 const double       factor,
                                 DofVector         &v) const
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
  DofVector
  ElasticLevels<dim>::from_vertex_displacements(
    const unsigned int                         l,
    const std::vector<dealii::Tensor<1, dim>> &displacements) const
  {
    DofVector result(n_unknowns(l));
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
  DofVector
  ElasticLevels<dim>::prolongate(const unsigned int l, const DofVector &u) const
  {
    DofVector result(n_unknowns(l - 1)), coarse(u);
    if (is_shared(l - 1) && !is_shared(l))
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
