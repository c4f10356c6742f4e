// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>
#include <deal.II/numerics/data_out.h>

#include <debond/base/atomic_file.h>
#include <debond/elasticity/cell_nodes.h>
#include <debond/output/vtu.h>

#include <zlib.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace Debond
{
  namespace
  {
    dealii::DataOutBase::VtkFlags
    vtk_flags()
    {
      // deal.II's default compression takes 15 times longer for files that
      // are 3 % smaller; without a date equal runs write equal files.
      dealii::DataOutBase::VtkFlags flags;
      flags.print_date_and_time = false;
      flags.compression_level   = dealii::DataOutBase::VtkFlags::best_speed;
      return flags;
    }



    using Field = std::pair<std::string, std::vector<float>>;



    std::string
    as_base64(const void *const data, const std::size_t n_bytes)
    {
      const auto *const bytes = static_cast<const unsigned char *>(data);
      return dealii::Utilities::encode_base64({bytes, bytes + n_bytes});
    }



    /// The numbers as one compressed block, as VTK reads them.
    std::string
    compressed(const std::vector<float> &numbers)
    {
      const auto n_bytes = static_cast<uLong>(numbers.size() * sizeof(float));
      std::vector<unsigned char> block(compressBound(n_bytes));
      uLongf                     n_compressed = block.size();
      if (compress2(block.data(),
                    &n_compressed,
                    reinterpret_cast<const Bytef *>(numbers.data()),
                    n_bytes,
                    Z_BEST_SPEED) != Z_OK)
        throw std::runtime_error("zlib cannot compress a field of cells");

      const std::array<std::uint32_t, 4> header = {
        {1,
         static_cast<std::uint32_t>(n_bytes),
         static_cast<std::uint32_t>(n_bytes),
         static_cast<std::uint32_t>(n_compressed)}};
      return as_base64(header.data(), sizeof(header)) +
             as_base64(block.data(), n_compressed);
    }



    /// deal.II has no cell data in VTU files but numbers at the points of each
    /// cell: so they are added to its text, a number for each cell.
    void
    write_with_cell_data(const std::string        &vtu,
                         const std::vector<Field> &fields,
                         std::ostream             &out)
    {
      const std::size_t end = vtu.rfind("</Piece>");
      AssertThrow(end != std::string::npos, dealii::ExcInternalError());
      out.write(vtu.data(), static_cast<std::streamsize>(end));
      out << "<CellData>\n";
      for (const auto &[name, numbers] : fields)
        out << "<DataArray type=\"Float32\" Name=\"" << name
            << "\" format=\"binary\">\n"
            << compressed(numbers) << "\n</DataArray>\n";
      out << "</CellData>\n";
      out.write(vtu.data() + end,
                static_cast<std::streamsize>(vtu.size() - end));
    }



    /// The fields at points of the contact boundary, after two vectors.
    const std::vector<std::string> contact_scalars = {"u_nu",
                                                      "gap",
                                                      "normal_force_density",
                                                      "law_violation",
                                                      "bond_stiffness",
                                                      "bond_threshold",
                                                      "initial_gap"};

    template <int dim>
    using ContactValues = std::array<double, 2 * dim + 7>;



    /// Between points, without those at which a value is not known.
    template <int dim>
    ContactValues<dim>
    mean(const ContactValues<dim>              &own,
         const std::vector<ContactValues<dim>> &others)
    {
      ContactValues<dim> result;
      for (unsigned int c = 0; c < own.size(); ++c)
        {
          double       sum = own[c];
          unsigned int n   = 1;
          for (const ContactValues<dim> &other : others)
            if (!std::isnan(other[c]))
              {
                sum += other[c];
                ++n;
              }
          result[c] = sum / n;
        }
      return result;
    }



    /// The Cartesian displacement of each contact node.
    template <int dim>
    std::vector<dealii::Tensor<1, dim>>
    contact_displacements(const ElasticProblem<dim>    &problem,
                          const dealii::Vector<double> &u,
                          const LoadFactors             factors)
    {
      const auto &normals = problem.unknowns().contact().normals();
      const dealii::Vector<double> cartesian =
        problem.unknowns().cartesian_displacement(u, factors);

      std::vector<unsigned int> node_of_dof(
        problem.unknowns().n_dofs(), dealii::numbers::invalid_unsigned_int);
      for (unsigned int i = 0; i < normals.size(); ++i)
        node_of_dof[normals[i]] = i;

      std::vector<dealii::Tensor<1, dim>> displacements(normals.size());
      for (const auto &cell :
           problem.unknowns().dof_handler().active_cell_iterators())
        {
          const CellNodes<dim> nodes(cell);
          for (unsigned int n = 0; n < nodes.size; ++n)
            for (unsigned int d = 0; d < dim; ++d)
              {
                const unsigned int node = node_of_dof[nodes.dofs[n][d]];
                if (node != dealii::numbers::invalid_unsigned_int)
                  for (unsigned int e = 0; e < dim; ++e)
                    displacements[node][e] = cartesian(nodes.dofs[n][e]);
              }
        }
      return displacements;
    }



    /// The parts of a face with a node at each corner and none between.
    template <int dim>
    std::vector<std::array<unsigned int, dim>>
    parts_of_face(const unsigned int degree)
    {
      if constexpr (dim == 2)
        return degree == 1 ?
                 std::vector<std::array<unsigned int, 2>>{{{0, 1}}} :
                 std::vector<std::array<unsigned int, 2>>{{{0, 2}}, {{2, 1}}};
      else
        return degree == 1 ?
                 std::vector<std::array<unsigned int, 3>>{{{0, 1, 2}}} :
                 std::vector<std::array<unsigned int, 3>>{{{0, 3, 5}},
                                                          {{3, 1, 4}},
                                                          {{5, 4, 2}},
                                                          {{3, 4, 5}}};
    }
  } // namespace



  template <int dim>
  void
  write_body_vtu(const ElasticProblem<dim>    &problem,
                 const dealii::Vector<double> &u,
                 const std::string            &file_name,
                 const LoadFactors             factors,
                 const ErrorEstimate          *estimate,
                 const std::vector<CellField> &more)
  {
    using dealii::DataComponentInterpretation::component_is_part_of_vector;

    const std::string            axes = "xyz";
    const dealii::Vector<double> displacement =
      problem.unknowns().cartesian_displacement(u, factors);
    const dealii::Vector<double> at_nodes =
      problem.unknowns().nodal_values(displacement);

    dealii::DataOut<dim> data_out;
    data_out.set_flags(vtk_flags());
    data_out.attach_dof_handler(problem.unknowns().dof_handler());
    data_out.add_data_vector(
      at_nodes,
      std::vector<std::string>(dim, "displacement"),
      dealii::DataOut<dim>::type_dof_data,
      std::vector<
        dealii::DataComponentInterpretation::DataComponentInterpretation>(
        dim, component_is_part_of_vector));

    const std::size_t n_cells =
      problem.unknowns().dof_handler().get_triangulation().n_active_cells();
    std::vector<Field> fields;
    const auto         add_field = [&](const std::string &name) {
      fields.emplace_back(name, std::vector<float>());
      fields.back().second.reserve(n_cells);
    };
    constexpr unsigned int n_components =
      dealii::SymmetricTensor<2, dim>::n_independent_components;
    for (unsigned int c = 0; c < n_components; ++c)
      {
        const auto ij =
          dealii::SymmetricTensor<2, dim>::unrolled_to_component_indices(c);
        add_field(std::string("stress_") + axes[ij[0]] + axes[ij[1]]);
      }
    bool has_regions = false;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      has_regions |=
        cell->material_id() !=
        problem.unknowns().dof_handler().begin_active()->material_id();
    const bool plane_strain =
      dim == 2 && problem.fields()
                      .material(problem.unknowns().dof_handler().begin_active())
                      .hypothesis == Material::Hypothesis::plane_strain;
    if (plane_strain)
      add_field("stress_zz");
    if (has_regions)
      add_field("region");
    add_field("von_mises");
    add_field("strain_energy_density");
    if (estimate != nullptr)
      add_field("error_density");
    for (const auto &[name, unused] : more)
      add_field(name);

    // In the order of deal.II's patches.
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        const dealii::SymmetricTensor<2, 3> stress =
          problem.fields().solid_stress(cell, displacement, factors);
        auto       field = fields.begin();
        const auto add   = [&field](const double number) {
          (field++)->second.push_back(static_cast<float>(number));
        };
        for (unsigned int c = 0; c < n_components; ++c)
          add(stress[dealii::SymmetricTensor<2, dim>::
                       unrolled_to_component_indices(c)]);
        if (plane_strain)
          add(stress[2][2]);
        if (has_regions)
          add(cell->material_id());
        add(von_mises(stress));
        add(problem.fields().material(cell).energy_density(stress));
        if (estimate != nullptr)
          add(estimate->cells[cell->active_cell_index()] / cell->measure());
        for (const auto &[unused, numbers] : more)
          add(numbers[cell->active_cell_index()]);
      }

    // Two subdivisions make a quadratic cell each.
    data_out.build_patches(problem.unknowns().mapping(),
                           problem.unknowns().degree());
    std::ostringstream vtu;
    data_out.write_vtu(vtu);
    write_atomically(file_name, [&](std::ostream &out) {
      write_with_cell_data(vtu.str(), fields, out);
    });
  }



  template <int dim>
  std::vector<std::string>
  write_body_pieces(const ElasticProblem<dim>    &problem,
                    const ProblemPiece<dim>      &piece,
                    const dealii::Vector<double> &u,
                    const std::string            &directory)
  {
    using dealii::DataComponentInterpretation::component_is_part_of_vector;
    using CellIterator = typename dealii::DataOut<dim>::cell_iterator;

    const dealii::Vector<double> displacement =
      problem.unknowns().cartesian_displacement(u);
    dealii::DataOut<dim> data_out;
    data_out.set_flags(vtk_flags());
    data_out.attach_dof_handler(problem.unknowns().dof_handler());
    data_out.add_data_vector(
      displacement,
      std::vector<std::string>(dim, "displacement"),
      dealii::DataOut<dim>::type_dof_data,
      std::vector<
        dealii::DataComponentInterpretation::DataComponentInterpretation>(
        dim, component_is_part_of_vector));
    const auto own_from = [&piece](CellIterator cell, const CellIterator &end) {
      while (cell != end && !piece.body().owns_cell_at(cell->center()))
        ++cell;
      return cell;
    };
    data_out.set_cell_selection(
      [&](const dealii::Triangulation<dim> &mesh) {
        return own_from(mesh.begin(), mesh.end());
      },
      [&](const dealii::Triangulation<dim> &mesh, const CellIterator &cell) {
        return own_from(std::next(cell), mesh.end());
      });
    data_out.build_patches(problem.unknowns().mapping());

    const MPI_Comm ranks = piece.nodes().communicator();
    const auto     name  = [](const unsigned int rank) {
      return "body.rank" + std::to_string(rank) + ".vtu";
    };
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(ranks);
    std::vector<std::string> written = {directory + "/" + name(rank)};
    write_atomically(written[0],
                     [&](std::ostream &out) { data_out.write_vtu(out); });
    if (rank == 0)
      {
        std::vector<std::string> names;
        for (unsigned int k = 0;
             k < dealii::Utilities::MPI::n_mpi_processes(ranks);
             ++k)
          names.push_back(name(k));
        written.push_back(directory + "/body.pvtu");
        write_atomically(written[1], [&](std::ostream &out) {
          data_out.write_pvtu_record(out, names);
        });
      }
    return written;
  }



  template <int dim>
  void
  write_contact_vtu(const ElasticProblem<dim>    &problem,
                    const dealii::Vector<double> &u,
                    const Verification<dim>      &verification,
                    const std::string            &file_name,
                    const LoadFactors             factors,
                    const std::vector<CellField> &more)
  {
    constexpr double            nan = std::numeric_limits<double>::quiet_NaN();
    const ContactBoundary<dim> &boundary =
      problem.unknowns().contact().boundary();
    const std::vector<dealii::Tensor<1, dim>> displacements =
      contact_displacements(problem, u, factors);

    const auto values_of = [&](const unsigned int node) {
      ContactValues<dim> values = {};
      if (node == dealii::numbers::invalid_unsigned_int)
        {
          // What a clamp bears there is not the foundation's.
          std::fill(values.begin() + dim, values.begin() + 2 * dim, nan);
          std::fill(values.begin() + 2 * dim + 2, values.end(), nan);
          return values;
        }
      const ContactNodeState &state   = verification.nodes[node];
      const double            measure = boundary.nodes[node].measure;
      for (unsigned int d = 0; d < dim; ++d)
        {
          values[d]       = displacements[node][d];
          values[dim + d] = verification.tangential_forces[node][d] / measure;
        }
      values[2 * dim]     = state.u_nu;
      values[2 * dim + 1] = -state.s;
      values[2 * dim + 2] = state.normal_force / measure;
      values[2 * dim + 3] = state.violation;
      values[2 * dim + 4] = state.bond_stiffness;
      values[2 * dim + 5] = state.bond_threshold;
      values[2 * dim + 6] = state.u_nu - state.s;
      return values;
    };

    // In the middle of an edge displacements are not its coefficients.
    const auto values_at = [&](const auto &face, const unsigned int k) {
      ContactValues<dim> values = values_of(face.node(k));
      if (k < dim)
        return values;
      const ContactValues<dim> a =
        values_of(face.node(simplex_edges[k - dim][0]));
      const ContactValues<dim> b =
        values_of(face.node(simplex_edges[k - dim][1]));
      const auto interpolate = [&](const unsigned int c) {
        values[c] = 0.5 * values[c] + 0.25 * (a[c] + b[c]);
      };
      for (unsigned int d = 0; d < dim; ++d)
        interpolate(d);
      interpolate(2 * dim);
      interpolate(2 * dim + 1);
      return values;
    };

    // Each vertex has its share of the face, so that its state can be shown
    // without a transition to that of its neighbours.
    std::vector<dealii::DataOutBase::Patch<dim - 1, dim>> patches;
    std::vector<Field> fields = {{"bond_state", {}}};
    for (const auto &[name, unused] : more)
      fields.emplace_back(name, std::vector<float>());
    for (unsigned int f = 0; f < boundary.faces.size(); ++f)
      for (const auto &part : parts_of_face<dim>(boundary.degree))
        {
          const auto                         &face = boundary.faces[f];
          std::array<ContactValues<dim>, dim> values;
          std::array<dealii::Point<dim>, dim> corners;
          for (unsigned int k = 0; k < dim; ++k)
            {
              values[k] = values_at(face, part[k]);
              corners[k] =
                part[k] < dim ?
                  face.vertices[part[k]] :
                  face.vertices[simplex_edges[part[k] - dim][0]] +
                    0.5 * (face.vertices[simplex_edges[part[k] - dim][1]] -
                           face.vertices[simplex_edges[part[k] - dim][0]]);
            }

          for (unsigned int k = 0; k < dim; ++k)
            {
              const unsigned int next = (k + 1) % dim,
                                 last = (k + dim - 1) % dim;
              dealii::DataOutBase::Patch<dim - 1, dim> patch;
              patch.patch_index    = static_cast<unsigned int>(patches.size());
              patch.reference_cell = dim == 2 ?
                                       dealii::ReferenceCells::Line :
                                       dealii::ReferenceCells::Quadrilateral;
              patch.data.reinit(2 * dim + contact_scalars.size(),
                                2 * (dim - 1));
              const auto set_point = [&](const unsigned int        point,
                                         const dealii::Point<dim> &position,
                                         const ContactValues<dim> &at_point) {
                patch.vertices[point] = position;
                for (unsigned int c = 0; c < at_point.size(); ++c)
                  patch.data(c, point) = static_cast<float>(at_point[c]);
              };
              const auto middle = [&corners, k](const unsigned int other) {
                return corners[k] + 0.5 * (corners[other] - corners[k]);
              };
              set_point(0, corners[k], values[k]);
              set_point(1, middle(next), mean<dim>(values[k], {values[next]}));
              if constexpr (dim == 3)
                {
                  set_point(2,
                            middle(last),
                            mean<dim>(values[k], {values[last]}));
                  set_point(3,
                            corners[0] + (corners[1] - corners[0]) / 3. +
                              (corners[2] - corners[0]) / 3.,
                            mean<dim>(values[k], {values[next], values[last]}));
                }
              patches.push_back(patch);

              const unsigned int node = face.node(part[k]);
              fields[0].second.push_back(
                node == dealii::numbers::invalid_unsigned_int ?
                  static_cast<float>(BondState::held) :
                  static_cast<float>(verification.nodes[node].state));
              for (unsigned int m = 0; m < more.size(); ++m)
                fields[m + 1].second.push_back(
                  static_cast<float>(more[m].second[f]));
            }
        }

    std::vector<std::string> names(dim, "displacement");
    names.insert(names.end(), dim, "tangential_force_density");
    names.insert(names.end(), contact_scalars.begin(), contact_scalars.end());
    const auto vector_at = [](const unsigned int first, const char *name) {
      return std::make_tuple(
        first,
        first + dim - 1,
        std::string(name),
        dealii::DataComponentInterpretation::component_is_part_of_vector);
    };
    std::ostringstream vtu;
    dealii::DataOutBase::write_vtu(patches,
                                   names,
                                   {vector_at(0, "displacement"),
                                    vector_at(dim, "tangential_force_density")},
                                   vtk_flags(),
                                   vtu);
    write_atomically(file_name, [&](std::ostream &out) {
      write_with_cell_data(vtu.str(), fields, out);
    });
  }



  template void
  write_body_vtu(const ElasticProblem<2> &,
                 const dealii::Vector<double> &,
                 const std::string &,
                 const LoadFactors,
                 const ErrorEstimate *,
                 const std::vector<CellField> &);
  template void
  write_body_vtu(const ElasticProblem<3> &,
                 const dealii::Vector<double> &,
                 const std::string &,
                 const LoadFactors,
                 const ErrorEstimate *,
                 const std::vector<CellField> &);
  template std::vector<std::string>
  write_body_pieces(const ElasticProblem<2> &,
                    const ProblemPiece<2> &,
                    const dealii::Vector<double> &,
                    const std::string &);
  template std::vector<std::string>
  write_body_pieces(const ElasticProblem<3> &,
                    const ProblemPiece<3> &,
                    const dealii::Vector<double> &,
                    const std::string &);
  template void
  write_contact_vtu(const ElasticProblem<2> &,
                    const dealii::Vector<double> &,
                    const Verification<2> &,
                    const std::string &,
                    const LoadFactors,
                    const std::vector<CellField> &);
  template void
  write_contact_vtu(const ElasticProblem<3> &,
                    const dealii::Vector<double> &,
                    const Verification<3> &,
                    const std::string &,
                    const LoadFactors,
                    const std::vector<CellField> &);
} // namespace Debond
