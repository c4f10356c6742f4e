// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>

#include <debond/elasticity/contact_nodes.h>
#include <debond/elasticity/problem_piece.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    constexpr unsigned int elsewhere = dealii::numbers::invalid_unsigned_int;



    template <int dim>
    SharedNodes
    share_nodes(const BodyPiece<dim>       &piece,
                const ElasticUnknowns<dim> &unknowns,
                const MPI_Comm              communicator)
    {
      const auto &mesh = unknowns.dof_handler().get_triangulation();
      const std::vector<unsigned int> slabs_of_mesh   = piece.slabs(mesh);
      const std::vector<unsigned int> numbers_of_mesh = piece.numbers(mesh);
      std::vector<unsigned int>       slabs;
      SharedNodes::Piece              nodes;
      nodes.communicator = communicator;
      for (const unsigned int vertex : node_vertices(unknowns))
        {
          slabs.push_back(slabs_of_mesh[vertex]);
          nodes.numbers.push_back(numbers_of_mesh[vertex]);
          nodes.is_own.push_back(piece.owns_slab(slabs.back()));
        }
      return SharedNodes(dim, slabs, piece.n_slabs(), nodes);
    }



    /// Of the box around the meshes of all ranks.
    template <int dim>
    double
    diameter_of_whole(const dealii::Triangulation<dim> &mesh,
                      const MPI_Comm                    communicator)
    {
      const auto corners =
        dealii::BoundingBox<dim>(mesh.get_vertices()).get_boundary_points();
      std::vector<double> lower(corners.first.begin_raw(),
                                corners.first.end_raw());
      std::vector<double> upper(corners.second.begin_raw(),
                                corners.second.end_raw());
      dealii::Utilities::MPI::min(lower, communicator, lower);
      dealii::Utilities::MPI::max(upper, communicator, upper);
      double square = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        square += (upper[d] - lower[d]) * (upper[d] - lower[d]);
      return std::sqrt(square);
    }



    /// For each contact face the cell that it is a side of, in whose order the
    /// faces are.
    template <int dim>
    std::vector<unsigned int>
    cells_of_faces(const ContactBoundary<dim>    &boundary,
                   const dealii::DoFHandler<dim> &dofs)
    {
      std::set<dealii::types::boundary_id> ids;
      for (const auto &face : boundary.faces)
        ids.insert(face.id);
      std::vector<unsigned int> result;
      for (const auto &cell : dofs.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && ids.count(face->boundary_id()) > 0)
            result.push_back(cell->active_cell_index());
      return result;
    }



    template <typename Entry>
    std::vector<Entry>
    gather_everywhere(const std::vector<Entry> &own,
                      const MPI_Comm            communicator)
    {
      std::vector<Entry> result;
      for (const auto &of_rank :
           dealii::Utilities::MPI::all_gather(communicator, own))
        result.insert(result.end(), of_rank.begin(), of_rank.end());
      return result;
    }



    template <int dim>
    void
    append(const dealii::Tensor<1, dim> &vector, std::vector<double> &numbers)
    {
      for (unsigned int d = 0; d < dim; ++d)
        numbers.push_back(vector[d]);
    }



    template <int dim>
    void
    read(const double *&numbers, dealii::Tensor<1, dim> &vector)
    {
      for (unsigned int d = 0; d < dim; ++d)
        vector[d] = *numbers++;
    }
  } // namespace



  template <int dim>
  std::vector<unsigned int>
  node_vertices(const ElasticUnknowns<dim> &unknowns)
  {
    std::vector<unsigned int> vertices(unknowns.n_dofs() / dim);
    for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          const unsigned int node = cell->vertex_dof_index(v, 0) / dim;
          for (unsigned int d = 0; d < dim; ++d)
            Assert(cell->vertex_dof_index(v, d) == node * dim + d,
                   dealii::ExcInternalError());
          vertices[node] = cell->vertex_index(v);
        }
    return vertices;
  }



  template <int dim>
  std::vector<unsigned int>
  node_order(const BodyPiece<dim>             &piece,
             const dealii::Triangulation<dim> &mesh)
  {
    const std::vector<unsigned int> numbers = piece.numbers(mesh);
    std::vector<unsigned int> order(numbers.size()), place(numbers.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(),
              order.end(),
              [&](const unsigned int a, const unsigned int b) {
                return numbers[a] < numbers[b];
              });
    for (unsigned int k = 0; k < order.size(); ++k)
      place[order[k]] = k;
    return place;
  }



  template <int dim>
  ProblemPiece<dim>::ProblemPiece(const BodyPiece<dim>       &body_piece,
                                  const ElasticUnknowns<dim> &unknowns,
                                  const MPI_Comm              communicator)
    : piece(body_piece)
    , shared_nodes(share_nodes(piece, unknowns, communicator))
  {
    prepare_gathering(unknowns.dof_handler());
    const ContactBoundary<dim> &local = unknowns.contact().boundary();
    const auto                 &dofs  = unknowns.contact().normals();
    if (unknowns.has_lifting() || !local.held_vertices.empty())
      throw std::logic_error("Ranks cannot share prescribed displacements.");

    const auto number_of = [&](const unsigned int dof) {
      return shared_nodes.number(dof / dim) * dim + dof % dim;
    };
    std::vector<unsigned int> numbers;
    std::vector<double>       of_nodes;
    for (unsigned int i = 0; i < local.nodes.size(); ++i)
      if (shared_nodes.is_own(static_cast<unsigned int>(dofs[i] / dim)))
        {
          const auto &node = local.nodes[i];
          numbers.push_back(number_of(static_cast<unsigned int>(dofs[i])));
          append<dim>(node.position, of_nodes);
          append<dim>(node.normal, of_nodes);
          of_nodes.push_back(node.measure);
        }
    numbers  = gather_everywhere(numbers, communicator);
    of_nodes = gather_everywhere(of_nodes, communicator);

    // In the order of their numbers, and then in that of one rank.
    std::vector<unsigned int> order(numbers.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(),
              order.end(),
              [&numbers](const unsigned int a, const unsigned int b) {
                return numbers[a] < numbers[b];
              });
    std::vector<typename ContactBoundary<dim>::Node> all_nodes;
    for (const unsigned int i : order)
      {
        const double *next = of_nodes.data() + std::size_t(i) * (2 * dim + 1);
        typename ContactBoundary<dim>::Node node;
        read<dim>(next, node.position);
        read<dim>(next, node.normal);
        node.measure = *next;
        all_nodes.push_back(node);
      }
    std::map<unsigned int, unsigned int> index_of;
    for (const unsigned int k : contact_order<dim>(
           all_nodes,
           diameter_of_whole(unknowns.dof_handler().get_triangulation(),
                             communicator)))
      {
        const unsigned int number = numbers[order[k]];
        index_of[number]          = static_cast<unsigned int>(index_of.size());
        numbers_of_normals.push_back(number);
        contact_boundary.nodes.push_back(all_nodes[k]);
      }
    local_normals.assign(numbers_of_normals.size(), elsewhere);
    for (const auto dof : dofs)
      local_normals[index_of.at(number_of(static_cast<unsigned int>(dof)))] =
        static_cast<unsigned int>(dof);
    shared_trace =
      std::make_unique<SharedTrace>(shared_nodes, dim, local_normals);

    // Faces are in the order of their cells.
    std::vector<std::size_t>        cells;
    std::vector<unsigned int>       nodes, ids;
    std::vector<double>             of_faces;
    const std::vector<unsigned int> cells_of_local =
      cells_of_faces(local, unknowns.dof_handler());
    auto cell_of_face = cells_of_local.begin();
    for (const auto &face : local.faces)
      {
        const unsigned int cell = *cell_of_face++;
        if (!piece.owns_cell(cell))
          continue;
        cells.push_back(piece.cell_number(cell));
        ids.push_back(face.id);
        for (const unsigned int node : face.nodes)
          nodes.push_back(
            node == elsewhere ?
              elsewhere :
              index_of.at(number_of(static_cast<unsigned int>(dofs[node]))));
        for (const dealii::Point<dim> &vertex : face.vertices)
          append<dim>(vertex, of_faces);
        append<dim>(face.normal, of_faces);
        of_faces.push_back(face.measure);
      }
    cells    = gather_everywhere(cells, communicator);
    nodes    = gather_everywhere(nodes, communicator);
    ids      = gather_everywhere(ids, communicator);
    of_faces = gather_everywhere(of_faces, communicator);
    std::vector<std::size_t> face_order(cells.size());
    std::iota(face_order.begin(), face_order.end(), std::size_t(0));
    std::stable_sort(face_order.begin(),
                     face_order.end(),
                     [&](const std::size_t a, const std::size_t b) {
                       return cells[a] < cells[b];
                     });
    for (const std::size_t f : face_order)
      {
        typename ContactBoundary<dim>::Face face;
        const double *next = of_faces.data() + f * (dim * (dim + 1) + 1);
        for (unsigned int v = 0; v < dim; ++v)
          {
            face.nodes[v] = nodes[f * dim + v];
            read<dim>(next, face.vertices[v]);
          }
        read<dim>(next, face.normal);
        face.measure = *next;
        face.id      = ids[f];
        contact_boundary.faces.push_back(face);
      }
  }



  template <int dim>
  template <typename Key>
  typename ProblemPiece<dim>::Gathering
  ProblemPiece<dim>::make_gathering(const std::vector<Key> &own_keys) const
  {
    Gathering        result;
    std::vector<Key> keys;
    for (const std::vector<Key> &of_rank :
         dealii::Utilities::MPI::gather(shared_nodes.communicator(), own_keys))
      {
        result.starts.push_back(static_cast<int>(keys.size()));
        result.counts.push_back(static_cast<int>(of_rank.size()));
        keys.insert(keys.end(), of_rank.begin(), of_rank.end());
      }
    std::vector<unsigned int> order(keys.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(),
                     order.end(),
                     [&keys](const unsigned int a, const unsigned int b) {
                       return keys[a] < keys[b];
                     });
    result.places.resize(keys.size());
    for (unsigned int place = 0; place < order.size(); ++place)
      result.places[order[place]] = place;
    return result;
  }



  template <int dim>
  void
  ProblemPiece<dim>::prepare_gathering(const dealii::DoFHandler<dim> &dofs)
  {
    std::vector<unsigned int> numbers;
    for (const auto &[begin, end] : shared_nodes.own_ranges())
      for (unsigned int i = begin; i < end; ++i)
        numbers.push_back(shared_nodes.number(i));
    all_nodes = make_gathering(numbers);

    std::vector<std::size_t> cells;
    for (const auto &cell : dofs.active_cell_iterators())
      if (piece.owns_cell(cell->active_cell_index()))
        {
          own_cells.push_back(cell->active_cell_index());
          cells.push_back(piece.cell_number(own_cells.back()));
        }
    all_cells = make_gathering(cells);
  }



  template <int dim>
  std::vector<double>
  ProblemPiece<dim>::gather(const Gathering           &gathering,
                            const unsigned int         n_components,
                            const std::vector<double> &own) const
  {
    // deal.II's gather() packs what it sends.
    MPI_Datatype entry;
    int          error =
      MPI_Type_contiguous(static_cast<int>(n_components), MPI_DOUBLE, &entry);
    AssertThrowMPI(error);
    error = MPI_Type_commit(&entry);
    AssertThrowMPI(error);
    std::vector<double> received(n_components * gathering.places.size());
    error = MPI_Gatherv(own.data(),
                        static_cast<int>(own.size() / n_components),
                        entry,
                        received.data(),
                        gathering.counts.data(),
                        gathering.starts.data(),
                        entry,
                        0,
                        shared_nodes.communicator());
    AssertThrowMPI(error);
    error = MPI_Type_free(&entry);
    AssertThrowMPI(error);

    std::vector<double> result(received.size());
    for (std::size_t i = 0; i < gathering.places.size(); ++i)
      for (std::size_t c = 0; c < n_components; ++c)
        result[std::size_t(gathering.places[i]) * n_components + c] =
          received[i * n_components + c];
    return result;
  }



  template <int dim>
  DofVector
  ProblemPiece<dim>::gather(const DofVector &v) const
  {
    std::vector<double> values;
    for (const auto &[begin, end] : shared_nodes.own_ranges())
      values.insert(values.end(),
                    v.begin() + std::size_t(begin) * dim,
                    v.begin() + std::size_t(end) * dim);
    const std::vector<double> whole = gather(all_nodes, dim, values);
    return DofVector(whole.begin(), whole.end());
  }



  template <int dim>
  std::vector<double>
  ProblemPiece<dim>::gather_cells(const std::vector<double> &values) const
  {
    std::vector<double> own;
    for (const unsigned int cell : own_cells)
      own.push_back(values[cell]);
    return gather(all_cells, 1, own);
  }



  template <int dim>
  double
  ProblemPiece<dim>::elastic_functional(const ElasticFields<dim> &fields,
                                        const DofVector          &u) const
  {
    auto terms         = fields.elastic_terms(u);
    terms.load         = gather(terms.load);
    terms.displacement = gather(terms.displacement);
    terms.energies     = gather_cells(terms.energies);
    return terms.energies.empty() ? 0. : terms.sum();
  }



  template decltype(node_vertices<2>) node_vertices<2>;
  template decltype(node_vertices<3>) node_vertices<3>;
  template decltype(node_order<2>)    node_order<2>;
  template decltype(node_order<3>)    node_order<3>;
  template class ProblemPiece<2>;
  template class ProblemPiece<3>;
} // namespace Debond
