// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_scene_scene_h
#define debond_solve_scene_scene_h

#include <debond/check/error_estimate.h>
#include <debond/elasticity/probes.h>
#include <debond/input/problem_parameters.h>
#include <debond/optimization/bundle/functional.h>
#include <debond/optimization/majorise/majorise_minimise.h>

namespace Debond
{
  /**
   * The discrete problem of a scene, ready to be solved.
   *
   * The constructor throws BadInput where the scene, though
   * readable, makes no problem: a free rigid motion, a load that is not finite
   * somewhere, a quadrature that does not exist in dim dimensions.
   */
  template <int dim>
  class Scene
  {
  public:
    /// On the mesh of @p body, which has the boundaries that the problem names,
    /// shared by @p ranks, all of which call it. @p start: a file with start(),
    /// empty for the body at rest.
    Scene(const ProblemParameters         &given,
          std::shared_ptr<const Body<dim>> body,
          const std::string               &start = "",
          const MPI_Comm                   ranks = MPI_COMM_SELF);

    /// On that of the problem's own body.
    explicit Scene(const ProblemParameters &given,
                   const std::string       &start = "",
                   const MPI_Comm           ranks = MPI_COMM_SELF)
      : Scene(given,
              std::dynamic_pointer_cast<const Body<dim>>(given.body),
              start,
              ranks)
    {}

    Scene(const Scene &) = delete;

    /// The parameters that the scene was made of, on whatever mesh.
    const ProblemParameters &
    parameters() const
    {
      return given;
    }

    const Body<dim> &
    body() const
    {
      return *elastic_body;
    }

    /// The ranks that share the scene.
    MPI_Comm
    ranks() const
    {
      return elastic_problem->unknowns().communicator();
    }

    const ContactBoundary<dim> &
    contact_boundary() const
    {
      return elastic_problem->unknowns().contact().boundary();
    }

    Eigen::VectorXd
    contact_trace(const DofVector &u) const
    {
      return elastic_problem->unknowns().contact().trace(u);
    }

    const ElasticProblem<dim> &
    problem() const
    {
      return *elastic_problem;
    }

    /// The boundaries and regions of the mesh, and what acts on them.
    const BoundaryConditions &
    conditions() const
    {
      return boundary_conditions;
    }

    const Supports<dim> &
    supports() const
    {
      return body_supports;
    }

    const ByRegion<Material> &
    materials() const
    {
      return body_materials;
    }

    const Loads<dim> &
    loads() const
    {
      return body_loads;
    }

    /// The loads that do not grow with the load factor.
    const Loads<dim> &
    dead_loads() const
    {
      return body_dead_loads;
    }

    const AdhesiveLaw &
    law() const
    {
      return *adhesive_law;
    }

    const AdhesionIntegral<dim> &
    adhesion() const
    {
      return *adhesion_integral;
    }

    /// Returns the problem whose error is estimated, with bonds that a load
    /// path has left.
    EstimatedProblem<dim>
    estimated(const AdhesionIntegral<dim> &bonds) const
    {
      return {*elastic_problem,
              bonds,
              boundary_conditions,
              body_supports,
              body_loads,
              body_dead_loads};
    }

    /// J, on vectors of problem().unknowns().n_dofs() entries.
    const Functional &
    functional() const
    {
      return *energy;
    }

    /// The first iterate for methods on all degrees of freedom.
    const DofVector &
    start() const
    {
      return first_iterate;
    }

    /// The numbers that the scene asks for by name.
    const Probes<dim> &
    probes() const
    {
      return named_probes;
    }

    /// The means of the displacement over all pieces with a name.
    const Probes<dim> &
    means() const
    {
      return piece_means;
    }

    /// The notes on the body's pieces for the user.
    const std::vector<std::string> &
    notes() const
    {
      return body_notes;
    }

    /// The least force that is resolved beside the loads and what is
    /// prescribed, each where it is largest on the load path. Where nothing
    /// acts, or all has come off, forces are rounding, and are compared with
    /// this.
    double
    least_force() const
    {
      return resolved_force;
    }

    /// A minimisation that takes for zero what verifications do.
    MajoriseMinimiseParameters
    minimisation(MajoriseMinimiseParameters parameters) const
    {
      parameters.zero_force = Tolerance::contact_law * resolved_force;
      return parameters;
    }

    /// Triangles or tetrahedra, and free unknowns, of the whole scene.
    unsigned int
    n_cells() const
    {
      return static_cast<unsigned int>(triangulation->n_global_active_cells());
    }

    unsigned int
    n_unknowns() const
    {
      return elastic_problem->unknowns().n_free_dofs();
    }

    /// Wall seconds that the constructor took for the mesh.
    double
    mesh_seconds() const
    {
      return seconds_for_mesh;
    }

    /// Wall seconds that the constructor took for the rest.
    double
    assembly_seconds() const
    {
      return seconds_for_assembly;
    }

  private:
    /// All but what belongs to the contact boundary; @p entry is that of
    /// errors.
    void
    add_problem(const MPI_Comm ranks, std::string &entry);

    void
    add_start(const std::string &file);

    void
    add_contact();

    /// Adds notes on what is unusual about the contact boundary and its
    /// unknowns.
    void
    add_notes();

    const ProblemParameters                     given;
    std::shared_ptr<const Body<dim>>            elastic_body;
    std::unique_ptr<dealii::Triangulation<dim>> triangulation;
    std::vector<std::string>                    body_notes;
    double                                      resolved_force = 0.;
    Probes<dim>                                 named_probes;
    Probes<dim>                                 piece_means;
    BoundaryConditions                          boundary_conditions;
    Supports<dim>                               body_supports;
    Loads<dim>                                  body_loads;
    Loads<dim>                                  body_dead_loads;
    ByRegion<Material>                          body_materials;
    std::unique_ptr<ElasticProblem<dim>>        elastic_problem;
    std::unique_ptr<AdhesiveLaw>                adhesive_law;
    std::unique_ptr<ContactQuadrature<dim>>     quadrature;
    std::unique_ptr<BondField<dim>>             bond_field;
    std::unique_ptr<AdhesionIntegral<dim>>      adhesion_integral;
    std::unique_ptr<Functional>                 energy;
    DofVector                                   first_iterate;
    double                                      seconds_for_mesh;
    double                                      seconds_for_assembly;
  };
} // namespace Debond

#endif
