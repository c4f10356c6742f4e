// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_meshes_refinement_goal_h
#define debond_solve_meshes_refinement_goal_h

#include <debond/solve/minimum/solution.h>

namespace Debond
{
  /// The opinion of a RefinementGoal on the result on a mesh.
  struct GoalOnMesh
  {
    bool   is_reached = false;
    double width      = 0.; ///< of what is to become narrow, relative to J

    /// A number for each active cell: the next mesh is refined where they are
    /// large, by the estimated error if there are none.
    std::vector<double> parts;

    std::string shortfall; ///< what it is short of its goal by
    std::string failure;   ///< why there is nothing to be said; ends the loop
  };



  /// A goal, besides an estimated error, of a loop that refines meshes.
  template <int dim>
  class RefinementGoal
  {
  public:
    virtual ~RefinementGoal() = default;

    /// Looks at the @p result on the mesh of @p scene; called once more for the
    /// same one with @p is_last if there can be no finer mesh.
    virtual GoalOnMesh
    look(const std::shared_ptr<const Scene<dim>> &scene,
         const Solution                          &result,
         const bool                               is_last) = 0;

    /// Unknowns of a factorisation that it needs on a mesh with so many cells,
    /// about.
    virtual double
    n_unknowns(const double n_cells) const = 0;
  };
} // namespace Debond

#endif
