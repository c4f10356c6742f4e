// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/input/bad_input.h>
#include <debond/mesh/bisected_body.h>
#include <debond/solve/meshes/first_scene.h>

namespace Debond
{
  template <int dim>
  std::shared_ptr<const Scene<dim>>
  make_first_scene(const ProblemParameters                      &problem,
                   const AccuracyParameters                     &accuracy,
                   const std::string                            &start,
                   const std::vector<std::vector<unsigned int>> &divisions)
  {
    // A mesh that is not refined is that of the body itself, which keeps its
    // coarser levels for multigrid.
    if (!accuracy.is_adaptive())
      return std::make_shared<const Scene<dim>>(problem, start, MPI_COMM_WORLD);
    std::shared_ptr<const BisectedBody<dim>> body;
    try
      {
        // The first mesh becomes one that bisection can refine, which most
        // tetrahedra from files cannot.
        body = std::make_shared<const BisectedBody<dim>>(
          std::dynamic_pointer_cast<const Body<dim>>(problem.body));
        for (const std::vector<unsigned int> &times : divisions)
          {
            // Divisions of an earlier run are replayed cell by cell, so that
            // the mesh and the numbers of its cells are those of that run.
            if (static_cast<double>(times.size()) != body->n_cells())
              throw std::invalid_argument("the mesh is not that of the run "
                                          "before; run without --restart");
            body = body->refined(times);
          }
      }
    catch (const EntryError &)
      {
        // The scene without refinement says which entry that is.
        return std::make_shared<const Scene<dim>>(problem,
                                                  start,
                                                  MPI_COMM_WORLD);
      }
    catch (const std::invalid_argument &error)
      {
        throw BadInput({problem.scene + ": Accuracy: " + error.what()});
      }
    return std::make_shared<const Scene<dim>>(problem,
                                              body,
                                              start,
                                              MPI_COMM_WORLD);
  }



  DEBOND_INSTANTIATE(make_first_scene);
} // namespace Debond
