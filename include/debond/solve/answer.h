// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_answer_h
#define debond_solve_answer_h

#include <debond/solve/meshes/mesh_growth.h>
#include <debond/solve/minimum/method_choice.h>
#include <debond/solve/minimum/solution.h>
#include <debond/solve/path/load_path_steps.h>

namespace Debond
{
  /// A state that a load path has led to, and what the next step needs of it.
  template <int dim>
  struct PathEnd
  {
    LoadPathStep<dim> step;  ///< number 0 for rest
    Eigen::VectorXd   point; ///< s of the contact nodes
    MinimumKind       kind;
    DofVector         u;
    BondMemory        memory;
  };



  /// The largest force of a load path that moves supports, see largest_force.h.
  template <int dim>
  struct LoadPathPeak
  {
    /// Where it is, at a step of the path or inside of one.
    LoadPathStep<dim> step;

    /// No force is larger on the path, between its steps either; nothing if
    /// there is no such bound.
    std::optional<double> bound;

    /// Whatever the sign of the displacement.
    double
    force() const
    {
      return std::abs(step.state.unit_displacement_work);
    }
  };



  /// The states that a load path has led to.
  template <int dim>
  struct PathProgress
  {
    std::vector<LoadPathStep<dim>> steps;

    /// By step.
    std::vector<Eigen::VectorXd> points; ///< s of the contact nodes
    std::vector<MinimumKind>     kinds;

    /// After the last step.
    DofVector  u;
    BondMemory memory;

    /// Of each contact node, so far.
    std::vector<BondBreak> breaks;

    /// There is one if supports move and the loads stay, unless the scene does
    /// not want it (Load path/Resolve).
    std::optional<LoadPathPeak<dim>> peak;
  };



  /// The meshes that an adaptive loop has done.
  struct MeshProgress
  {
    std::vector<AdaptiveLevel> levels;

    /// How often the cells of each mesh are cut for the next one, see
    /// BisectedBody::refined().
    std::vector<std::vector<unsigned int>> divisions;

    /// The start on the next mesh; empty for rest.
    DofVector start;

    /// True if no finer mesh follows; then `shortfall` is why the last one does
    /// not meet its target, empty if it does.
    bool        is_last = false;
    std::string shortfall;
  };



  /**
   * What is found of a scene, or before the end what there is to continue from.
   * The solution is that of the last mesh and of the last factor of a load
   * path.
   */
  template <int dim>
  struct Answer
  {
    std::shared_ptr<const Scene<dim>> scene;  ///< on the mesh of the solution
    MethodChoice                      choice; ///< on this mesh
    Solution                          solution;

    MeshProgress                   meshes; ///< without levels on a given mesh
    PathProgress<dim>              path;   ///< of a single load without steps
    std::vector<LoadPathStep<dim>> arc;

    /// The bonds as the path has left them, with references to the scene; null
    /// without steps.
    std::shared_ptr<const AdhesionIntegral<dim>> path_bonds;

    const AdhesionIntegral<dim> &
    bonds() const
    {
      return path_bonds ? *path_bonds : scene->adhesion();
    }
  };
} // namespace Debond

#endif
