// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/data_out_base.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/numerics/data_out.h>

#include <debond/base/atomic_file.h>
#include <debond/base/bernstein.h>
#include <debond/base/owned_cells.h>
#include <debond/base/processes.h>
#include <debond/base/ranks.h>
#include <debond/output/vtu.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

namespace Debond
{
  namespace
  {
    /// More effort takes several times longer for files that are a few per cent
    /// smaller; the same results give the same file.
    dealii::DataOutBase::VtkFlags
    vtk_flags()
    {
      dealii::DataOutBase::VtkFlags flags;
      flags.compression_level   = dealii::DataOutBase::VtkFlags::best_speed;
      flags.print_date_and_time = false;
      return flags;
    }



    /// The numbers of the cells with their names.
    template <int dim>
    std::vector<std::pair<std::string, dealii::Vector<double>>>
    cell_fields(const ElasticProblem<dim>    &problem,
                const DofVector              &displacement,
                const LoadFactors             factors,
                const ErrorEstimate          *estimate,
                const std::vector<CellField> &more)
    {
      std::vector<std::pair<std::string, dealii::Vector<double>>> all;
      const auto &dofs   = problem.unknowns().dof_handler();
      const auto &first  = *dofs.begin_active();
      const auto &fields = problem.fields();
      std::vector<dealii::SymmetricTensor<2, 3>> stresses;
      bool                                       has_regions = false;
      CellStresses<dim> means(fields, displacement, factors);
      for (const auto &cell : dofs.active_cell_iterators())
        {
          means.reinit(cell);
          stresses.push_back(means.solid_stress(0));
          has_regions |= cell->material_id() != first.material_id();
        }
      has_regions    = any_rank(has_regions);
      const auto add = [&](const std::string &name, const auto &value) {
        all.emplace_back(name, stresses.size());
        for (const auto &cell : dofs.active_cell_iterators())
          all.back().second(cell->active_cell_index()) =
            value(cell, stresses[cell->active_cell_index()]);
      };

      const std::string axes = "xyz";
      for (unsigned int c = 0;
           c < dealii::SymmetricTensor<2, dim>::n_independent_components;
           ++c)
        {
          const auto ij =
            dealii::SymmetricTensor<2, dim>::unrolled_to_component_indices(c);
          add(std::string("stress_") + axes[ij[0]] + axes[ij[1]],
              [&](const auto &, const auto &stress) { return stress[ij]; });
        }
      if (dim == 2 && fields.material(dofs.begin_active()).hypothesis ==
                        Material::Hypothesis::plane_strain)
        add("stress_zz",
            [](const auto &, const auto &stress) { return stress[2][2]; });
      if (has_regions)
        add("region",
            [](const auto &cell, const auto &) { return cell->material_id(); });
      add("von_mises",
          [](const auto &, const auto &stress) { return von_mises(stress); });
      add("strain_energy_density", [&](const auto &cell, const auto &stress) {
        return fields.material(cell).energy_density(stress);
      });
      if (estimate != nullptr)
        add("error_density", [&](const auto &cell, const auto &) {
          return estimate->cells[cell->active_cell_index()] / cell->measure();
        });
      for (const auto &[name, numbers] : more)
        add(name, [&numbers = numbers](const auto &cell, const auto &) {
          return numbers[cell->active_cell_index()];
        });
      return all;
    }



    template <int dim>
    class BodyOut : public dealii::DataOut<dim>
    {
    public:
      /// Writes a file of cells one part after the other: patches of a million
      /// cells take a GiB.
      void
      write_in_parts(std::ostream                                       &file,
                     const std::vector<typename BodyOut::cell_iterator> &cells,
                     const unsigned int                                  degree)
      {
        constexpr std::size_t        cells_of_part = 1 << 18;
        const dealii::MappingFE<dim> mapping(dealii::FE_SimplexP<dim>(1));
        dealii::DataOutBase::write_vtu_header(file, vtk_flags());
        for (std::size_t first = 0; first < cells.size();
             first += cells_of_part)
          {
            std::size_t       next = first;
            const std::size_t end =
              std::min(first + cells_of_part, cells.size());
            this->set_cell_selection(
              [&](const auto &) { return cells[next = first]; },
              [&](const auto &mesh, const auto &) {
                return ++next < end ? cells[next] : mesh.end();
              });
            this->build_patches(mapping, degree);
            dealii::DataOutBase::write_vtu_main(
              this->get_patches(),
              this->get_dataset_names(),
              this->get_nonscalar_data_ranges(),
              vtk_flags(),
              file);
          }
        dealii::DataOutBase::write_vtu_footer(file);
      }
    };



    /// A number at the nodes of the contact boundary.
    struct ContactScalar
    {
      std::string name;

      /// Of a node and its measure.
      std::function<double(const ContactNodeState &, double)> value;

      /// As the displacement, of which edges have coefficients of degree 2.
      /// Held nodes do not move; what a clamp bears there is not the
      /// foundation's.
      bool is_displacement = false;
    };

    const std::vector<ContactScalar> contact_scalars = {
      {"u_nu", [](const auto &node, const double) { return node.u_nu; }, true},
      {"gap", [](const auto &node, const double) { return -node.s; }, true},
      {"normal_force_density",
       [](const auto &node, const double measure) {
         return node.normal_force / measure;
       }},
      {"law_violation",
       [](const auto &node, const double) { return node.violation; }},
      {"bond_stiffness",
       [](const auto &node, const double) { return node.bond_stiffness; }},
      {"bond_threshold",
       [](const auto &node, const double) { return node.bond_threshold; }},
      {"initial_gap",
       [](const auto &node, const double) { return node.u_nu - node.s; }}};

    /// Displacement, tangential force density and the numbers above.
    using ContactValues = std::vector<double>;



    /// Between points, without those at which a value is not known.
    ContactValues
    mean(const ContactValues &own, const std::vector<ContactValues> &others)
    {
      ContactValues result;
      for (unsigned int c = 0; c < own.size(); ++c)
        {
          double       sum = own[c];
          unsigned int n   = 1;
          for (const ContactValues &other : others)
            if (!std::isnan(other[c]))
              {
                sum += other[c];
                ++n;
              }
          result.push_back(sum / n);
        }
      return result;
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
                 const DofVector              &u,
                 const std::string            &file_name,
                 const LoadFactors             factors,
                 const ErrorEstimate          *estimate,
                 const std::vector<CellField> &more)
  {
    namespace Interpretation             = dealii::DataComponentInterpretation;
    const ElasticUnknowns<dim> &unknowns = problem.unknowns();
    const DofVector displacement = unknowns.cartesian_displacement(u, factors);

    BodyOut<dim> out;
    out.set_flags(vtk_flags());
    out.attach_dof_handler(unknowns.dof_handler());
    out.add_data_vector(
      displacement,
      std::vector<std::string>(dim, "displacement"),
      dealii::DataOut<dim>::type_dof_data,
      std::vector<Interpretation::DataComponentInterpretation>(
        dim, Interpretation::component_is_part_of_vector));
    const auto fields =
      cell_fields(problem, displacement, factors, estimate, more);
    for (const auto &[name, numbers] : fields)
      out.add_data_vector(numbers, name, dealii::DataOut<dim>::type_cell_data);
    std::vector<typename BodyOut<dim>::cell_iterator> cells;
    for (const auto &cell :
         owned_cells(unknowns.dof_handler().get_triangulation()))
      cells.push_back(cell);
    const auto write = [&](std::ostream &file) {
      out.write_in_parts(file, cells, unknowns.degree());
    };

    const MPI_Comm     ranks   = unknowns.communicator();
    const unsigned int n_ranks = number_of_ranks(ranks);
    if (n_ranks == 1)
      {
        write_atomically(file_name, write);
        return;
      }
    const std::filesystem::path path(file_name);
    const auto                  of_rank = [&path](const unsigned int rank) {
      return path.stem().string() + ".rank" + std::to_string(rank) + ".vtu";
    };
    std::vector<std::string> names;
    for (unsigned int rank = 0; rank < n_ranks; ++rank)
      names.push_back(of_rank(rank));
    on_all_ranks(ranks, [&]() {
      write_own_file(
        (path.parent_path() / of_rank(rank_of_this(ranks))).string(), write);
    });
    write_atomically(joined_file(file_name, ranks), [&](std::ostream &file) {
      out.write_pvtu_record(file, names);
    });
  }



  std::string
  joined_file(const std::string &file_name, const MPI_Comm ranks)
  {
    return number_of_ranks(ranks) == 1 ? file_name :
                                         std::filesystem::path(file_name)
                                           .replace_extension(".pvtu")
                                           .string();
  }



  template <int dim>
  void
  write_contact_vtu(const ContactBoundary<dim>   &boundary,
                    const Verification<dim>      &verification,
                    const std::string            &file_name,
                    const std::vector<CellField> &more)
  {
    constexpr double nan       = std::numeric_limits<double>::quiet_NaN();
    const auto       values_of = [&](const unsigned int node) {
      const bool    is_held = node == dealii::numbers::invalid_unsigned_int;
      const double  measure = is_held ? 1. : boundary.nodes[node].measure;
      ContactValues values;
      for (unsigned int d = 0; d < dim; ++d)
        values.push_back(is_held ? 0. : verification.displacements[node][d]);
      for (unsigned int d = 0; d < dim; ++d)
        values.push_back(
          is_held ? nan : verification.tangential_forces[node][d] / measure);
      for (const ContactScalar &scalar : contact_scalars)
        values.push_back(is_held ?
                           (scalar.is_displacement ? 0. : nan) :
                           scalar.value(verification.nodes[node], measure));
      return values;
    };

    // In the middle of an edge displacements are not its coefficients.
    const auto values_at = [&](const auto &face, const unsigned int k) {
      ContactValues values = values_of(face.node(k));
      if (k < dim)
        return values;
      const ContactValues a = values_of(face.node(simplex_edges[k - dim][0]));
      const ContactValues b = values_of(face.node(simplex_edges[k - dim][1]));
      for (unsigned int c = 0; c < values.size(); ++c)
        if (c < dim ||
            (c >= 2 * dim && contact_scalars[c - 2 * dim].is_displacement))
          values[c] = 0.5 * values[c] + 0.25 * (a[c] + b[c]);
      return values;
    };

    // Each vertex has its share of the face, so that its state can be shown
    // without a transition to that of its neighbours.
    using Patch = dealii::DataOutBase::Patch<dim - 1, dim>;
    std::vector<Patch> patches;
    for (unsigned int f = 0; f < boundary.faces.size(); ++f)
      for (const auto &part : parts_of_face<dim>(boundary.degree))
        {
          const auto                         &face = boundary.faces[f];
          std::array<ContactValues, dim>      values;
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
              ContactValues of_share = {static_cast<double>(
                face.is_held(part[k]) ?
                  BondState::held :
                  verification.nodes[face.node(part[k])].state)};
              for (const auto &[unused, numbers] : more)
                of_share.push_back(numbers[f]);

              Patch patch;
              patch.n_subdivisions = 1;
              // Without it cells have no type in the file.
              patch.reference_cell =
                dealii::ReferenceCells::get_hypercube<dim - 1>();
              patch.patch_index = static_cast<unsigned int>(patches.size());
              patch.data.reinit(
                values[k].size() + of_share.size(),
                dealii::GeometryInfo<dim - 1>::vertices_per_cell);
              unsigned int n         = 0;
              const auto   add_point = [&](const dealii::Point<dim> &position,
                                         const ContactValues      &at_point) {
                patch.vertices[n] = position;
                for (unsigned int c = 0; c < patch.data.size(0); ++c)
                  patch.data(c, n) = static_cast<float>(
                    c < at_point.size() ? at_point[c] :
                                            of_share[c - at_point.size()]);
                ++n;
              };
              const auto add_middle = [&](const unsigned int other) {
                add_point(corners[k] + 0.5 * (corners[other] - corners[k]),
                          mean(values[k], {values[other]}));
              };
              const unsigned int next = (k + 1) % dim,
                                 last = (k + dim - 1) % dim;
              add_point(corners[k], values[k]);
              add_middle(next);
              if constexpr (dim == 3)
                {
                  add_middle(last);
                  add_point(corners[0] + (corners[1] - corners[0]) / 3. +
                              (corners[2] - corners[0]) / 3.,
                            mean(values[k], {values[next], values[last]}));
                }
              patches.push_back(patch);
            }
        }

    std::vector<std::string> names;
    std::vector<std::tuple<
      unsigned int,
      unsigned int,
      std::string,
      dealii::DataComponentInterpretation::DataComponentInterpretation>>
      vectors;
    for (const char *const name : {"displacement", "tangential_force_density"})
      {
        vectors.emplace_back(
          names.size(),
          names.size() + dim - 1,
          name,
          dealii::DataComponentInterpretation::component_is_part_of_vector);
        names.insert(names.end(), dim, name);
      }
    for (const ContactScalar &scalar : contact_scalars)
      names.push_back(scalar.name);
    names.emplace_back("bond_state");
    for (const auto &[name, unused] : more)
      names.push_back(name);
    write_atomically(file_name, [&](std::ostream &out) {
      dealii::DataOutBase::write_vtu(patches, names, vectors, vtk_flags(), out);
    });
  }



  template decltype(write_body_vtu<2>)    write_body_vtu<2>;
  template decltype(write_body_vtu<3>)    write_body_vtu<3>;
  template decltype(write_contact_vtu<2>) write_contact_vtu<2>;
  template decltype(write_contact_vtu<3>) write_contact_vtu<3>;
} // namespace Debond
