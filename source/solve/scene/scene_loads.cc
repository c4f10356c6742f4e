// SPDX-License-Identifier: LGPL-2.1-or-later

#include <debond/base/instantiate.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/scene/scene_loads.h>

namespace Debond
{
  template <int dim>
  Loads<dim>
  make_loads(const LoadParameters             &parameters,
             const std::set<std::string>      &dead_loads,
             const bool                        wants_dead,
             const Symmetry                    symmetry,
             const BoundaryNames              &boundaries,
             const dealii::Triangulation<dim> &mesh)
  {
    // Dead loads and those that grow with the factor are assembled apart, f =
    // f_0 + t f_1, and each entry belongs to one of them.
    const auto is_wanted = [&](const std::string &name) {
      return wants_dead == (dead_loads.count(name) > 0);
    };
    Loads<dim> loads;
    if (!parameters.body_force.empty() && is_wanted("body force"))
      loads.body_force =
        make_function<dim>(parameters.body_force, parameters.constants);
    if (!parameters.temperature_change.empty() &&
        is_wanted("temperature change"))
      loads.temperature_change =
        make_function<dim>(parameters.temperature_change,
                           parameters.constants,
                           1);
    // Several loads may act on one face; all of them are kept with their
    // entries, which errors and notes name.
    for (const SurfaceLoad &load : parameters.on_boundaries())
      {
        if (!is_wanted(load.boundary))
          continue;
        const auto &ids = boundaries.at(load.boundary);
        std::shared_ptr<const dealii::Function<dim>> value =
          make_function<dim>(load.expression,
                             parameters.constants,
                             load.n_components(dim));
        // The measure of the faces that bear the load, on all ranks: a total
        // force is divided by it. Around an axis it is asked for all loads, as
        // faces on the axis itself have none.
        double measure = 0.;
        if (load.kind == "Force" || symmetry == Symmetry::axis)
          {
            for (const auto &cell : owned_cells(mesh))
              for (const auto &face : cell->face_iterators())
                if (face->at_boundary() && ids.count(face->boundary_id()) > 0)
                  measure +=
                    face->measure() * circumference(symmetry, face->center());
            measure =
              dealii::Utilities::MPI::sum(measure, mesh.get_communicator());
            if (measure == 0.)
              throw EntryError(load.entry(),
                               "the axis has no area that could bear a load");
          }
        if (load.kind == "Force")
          {
            // A total force is spread evenly over the faces that this mesh has,
            // so that its resultant is the same on all meshes, also of a curved
            // boundary.
            std::vector<double> density(dim);
            for (unsigned int d = 0; d < dim; ++d)
              density[d] = value->value(dealii::Point<dim>(), d) / measure;
            value = std::make_shared<dealii::Functions::ConstantFunction<dim>>(
              density);
          }
        for (const dealii::types::boundary_id id : ids)
          loads.tractions[id].push_back({value, load.entry()});
      }
    return loads;
  }



  DEBOND_INSTANTIATE(make_loads);
} // namespace Debond
