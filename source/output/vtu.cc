// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/numerics/data_out.h>

#include <debond/output/atomic_file.h>
#include <debond/output/vtu.h>

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



    /// The fields on the contact boundary, the displacement first.
    const std::vector<std::string> contact_scalars = {"u_nu",
                                                      "gap",
                                                      "normal_force_density",
                                                      "bond_state",
                                                      "law_violation"};



    /// The Cartesian displacement of each contact node.
    template <int dim>
    std::vector<dealii::Tensor<1, dim>>
    contact_displacements(const ElasticProblem<dim>    &problem,
                          const dealii::Vector<double> &u)
    {
      const auto                  &nodes = problem.contact_boundary().nodes;
      const dealii::Vector<double> cartesian =
        problem.cartesian_displacement(u);

      std::vector<unsigned int> node_of_dof(
        problem.n_dofs(), dealii::numbers::invalid_unsigned_int);
      for (unsigned int i = 0; i < nodes.size(); ++i)
        node_of_dof[nodes[i].dof] = i;

      std::vector<dealii::Tensor<1, dim>> displacements(nodes.size());
      for (const auto &cell : problem.dof_handler().active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            {
              const unsigned int node =
                node_of_dof[cell->vertex_dof_index(v, d)];
              if (node != dealii::numbers::invalid_unsigned_int)
                for (unsigned int e = 0; e < dim; ++e)
                  displacements[node][e] =
                    cartesian(cell->vertex_dof_index(v, e));
            }
      return displacements;
    }
  } // namespace



  template <int dim>
  void
  write_body_vtu(const ElasticProblem<dim>    &problem,
                 const dealii::Vector<double> &u,
                 const std::string            &file_name)
  {
    using dealii::DataComponentInterpretation::component_is_part_of_vector;

    const std::string            axes = "xyz";
    const dealii::Vector<double> displacement =
      problem.cartesian_displacement(u);

    dealii::DataOut<dim> data_out;
    data_out.set_flags(vtk_flags());
    data_out.attach_dof_handler(problem.dof_handler());
    data_out.add_data_vector(
      displacement,
      std::vector<std::string>(dim, "displacement"),
      dealii::DataOut<dim>::type_dof_data,
      std::vector<
        dealii::DataComponentInterpretation::DataComponentInterpretation>(
        dim, component_is_part_of_vector));

    const unsigned int n_cells =
      problem.dof_handler().get_triangulation().n_active_cells();
    std::vector<dealii::Vector<float>> stresses(
      dealii::SymmetricTensor<2, dim>::n_independent_components,
      dealii::Vector<float>(n_cells));
    dealii::Vector<float> von_mises(n_cells);
    dealii::Vector<float> energy_density(n_cells);

    const dealii::SymmetricTensor<4, dim> compliance =
      dealii::invert(problem.material().template elasticity_tensor<dim>());
    for (const auto &cell : problem.dof_handler().active_cell_iterators())
      {
        const unsigned int                    index = cell->active_cell_index();
        const dealii::SymmetricTensor<2, dim> stress =
          problem.stress(cell, displacement);
        for (unsigned int c = 0; c < stresses.size(); ++c)
          stresses[c](index) = static_cast<float>(stress.access_raw_entry(c));
        von_mises(index) = static_cast<float>(
          problem.material().template von_mises<dim>(stress));
        energy_density(index) =
          static_cast<float>(0.5 * (stress * (compliance * stress)));
      }

    for (unsigned int c = 0; c < stresses.size(); ++c)
      {
        const auto ij =
          dealii::SymmetricTensor<2, dim>::unrolled_to_component_indices(c);
        data_out.add_data_vector(stresses[c],
                                 std::string("stress_") + axes[ij[0]] +
                                   axes[ij[1]],
                                 dealii::DataOut<dim>::type_cell_data);
      }
    data_out.add_data_vector(von_mises,
                             "von_mises",
                             dealii::DataOut<dim>::type_cell_data);
    data_out.add_data_vector(energy_density,
                             "strain_energy_density",
                             dealii::DataOut<dim>::type_cell_data);
    data_out.build_patches(problem.mapping());

    write_atomically(file_name,
                     [&](std::ostream &out) { data_out.write_vtu(out); });
  }



  template <int dim>
  void
  write_contact_vtu(const ElasticProblem<dim>    &problem,
                    const dealii::Vector<double> &u,
                    const Verification<dim>      &verification,
                    const std::string            &file_name)
  {
    const ContactBoundary<dim> &boundary = problem.contact_boundary();
    const std::vector<dealii::Tensor<1, dim>> displacements =
      contact_displacements(problem, u);

    std::vector<dealii::DataOutBase::Patch<dim - 1, dim>> patches(
      boundary.faces.size());
    for (unsigned int f = 0; f < patches.size(); ++f)
      {
        const auto &face  = boundary.faces[f];
        auto       &patch = patches[f];

        patch.patch_index    = f;
        patch.reference_cell = dim == 2 ? dealii::ReferenceCells::Line :
                                          dealii::ReferenceCells::Triangle;
        patch.data.reinit(dim + contact_scalars.size(), dim);
        for (unsigned int k = 0; k < dim; ++k)
          {
            patch.vertices[k]       = face.vertices[k];
            const unsigned int node = face.nodes[k];
            if (node == dealii::numbers::invalid_unsigned_int)
              continue;

            const ContactNodeState &state = verification.nodes[node];
            for (unsigned int d = 0; d < dim; ++d)
              patch.data(d, k) = static_cast<float>(displacements[node][d]);
            patch.data(dim, k)     = static_cast<float>(state.u_nu);
            patch.data(dim + 1, k) = static_cast<float>(-state.u_nu);
            patch.data(dim + 2, k) = static_cast<float>(
              state.normal_force / boundary.nodes[node].measure);
            patch.data(dim + 3, k) = static_cast<float>(state.state);
            patch.data(dim + 4, k) = static_cast<float>(state.violation);
          }
      }

    std::vector<std::string> names(dim, "displacement");
    names.insert(names.end(), contact_scalars.begin(), contact_scalars.end());
    write_atomically(file_name, [&](std::ostream &out) {
      dealii::DataOutBase::write_vtu(
        patches,
        names,
        {std::make_tuple(
          0U,
          static_cast<unsigned int>(dim - 1),
          std::string("displacement"),
          dealii::DataComponentInterpretation::component_is_part_of_vector)},
        vtk_flags(),
        out);
    });
  }



  template void
  write_body_vtu(const ElasticProblem<2> &,
                 const dealii::Vector<double> &,
                 const std::string &);
  template void
  write_body_vtu(const ElasticProblem<3> &,
                 const dealii::Vector<double> &,
                 const std::string &);
  template void
  write_contact_vtu(const ElasticProblem<2> &,
                    const dealii::Vector<double> &,
                    const Verification<2> &,
                    const std::string &);
  template void
  write_contact_vtu(const ElasticProblem<3> &,
                    const dealii::Vector<double> &,
                    const Verification<3> &,
                    const std::string &);
} // namespace Debond
