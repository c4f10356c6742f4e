// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_equilibrium_problem_h
#define debond_certify_equilibrium_problem_h

#include <debond/certify/equilibrium_mesh.h>
#include <debond/elasticity/fields.h>
#include <debond/linear_algebra/condensation.h>

namespace Debond
{
  /**
   * The best equilibrated stress of a body for given normal displacements of
   * its contact boundary, by an EquilibriumElement for each active cell. The
   * tractions between cells are made continuous by the displacements of the
   * sides (hybridisation), which are the unknowns. The matrix is symmetric and
   * positive definite.
   */
  template <int dim>
  class EquilibriumProblem
  {
  public:
    /// Is of an EquilibriumMesh with these arguments; throws as that does.
    EquilibriumProblem(const dealii::Triangulation<dim> &mesh,
                       const BoundaryConditions         &conditions,
                       const Supports<dim>              &supports,
                       const ByRegion<Material>         &materials,
                       const Loads<dim>                 &loads,
                       const std::vector<double>        &thermal_stresses = {});

    /// The problem condensed onto the first unknowns of the contact sides in
    /// their order, then the second ones (and the third ones):
    ///     max_sigma -1/2 int (sigma + p 1) : C^{-1} (sigma + p 1)
    ///               + int_{Gamma_C} sigma_nu (p + gap)
    ///               + the work of sigma along prescribed displacements
    ///         = c_0 + 1/2 s'S s - g's,
    /// p + gap the linear normal displacement, s the unknowns of p. Each cell
    /// is @p weights times as stiff (all as they are if empty).
    ///
    /// Throws StressRoundingError if the matrix of the other unknowns is not
    /// positive definite.
    std::unique_ptr<Condensation>
    condense(const std::vector<double> &weights = {}) const;

    /// The stress of each cell, see EquilibriumElement::stress(), for all
    /// unknowns, those of a condensation without weights.
    std::vector<Eigen::VectorXd>
    stresses(const DofVector &unknowns) const;

    /// 1/2 a(u,u) - L(u) of the displacement @p u, the Cartesian values at the
    /// nodes of @p fields on this mesh, for the loads as represented here.
    double
    elastic_functional(const ElasticFields<dim> &fields,
                       const DofVector          &u) const;

    /// Returns of each active cell how much work tractions on its sides may do
    /// that is not in the loads here, nothing if all are linear: by Cauchy's
    /// inequality for the strain energy of u and the trace constant of a
    /// rectangle above the side, so that it is an estimate.
    std::vector<double>
    load_rests(const ElasticFields<dim> &fields, const DofVector &u) const;

    /// Returns of each active cell
    ///     1/2 int |C^{1/2} epsilon(u) - C^{-1/2} (sigma + p 1)|^2
    /// of u as above and of @p stresses.
    std::vector<double>
    constitutive_gaps(const ElasticFields<dim>           &fields,
                      const DofVector                    &u,
                      const std::vector<Eigen::VectorXd> &stresses) const;

    /// Returns how much elimination may have lost of
    ///     c_0 - 1/2 s'S s = -1/2 int (sigma + p 1) : C^{-1} (sigma + p 1)
    ///                       + the work of sigma along what is prescribed
    /// of a condensation with @p weights to rounding: four times by how much
    /// this fails at @p kept for the stresses that belong to it.
    double
    rounding_of(const Condensation        &condensed,
                const Eigen::VectorXd     &kept,
                const std::vector<double> &weights = {}) const;

    /// Returns the mean of a stress without p in each active cell.
    std::vector<dealii::SymmetricTensor<2, dim>>
    mean_stresses(const std::vector<Eigen::VectorXd> &stresses) const;

    /// An unknown of it can be fixed before anything is condensed.
    EquilibriumMesh<dim> mesh;

  private:
    using Element = EquilibriumElement<dim>;

    void
    make_elements();

    const ByRegion<Material> materials;

    /// The elements of the active cells; those that are the same share one.
    std::vector<std::shared_ptr<const Element>> elements;
  };



  /// The condensed problem of a plane body in the means m and the slopes k of
  /// the displacements m + k xi of its contact sides, xi from -1 at the first
  /// to 1 at the second corner: c_0 + 1/2 x'A x - b'x, x = (m, k).
  struct MeansAndSlopes
  {
    explicit MeansAndSlopes(const Condensation &condensed);

    Eigen::MatrixXd A;
    Eigen::VectorXd b;

    /// The kept unknowns of the condensation.
    static Eigen::VectorXd
    unknowns(const Eigen::VectorXd &x);
  };



  /// Returns int epsilon(u) : C epsilon(u) of each active cell, u being the
  /// Cartesian values at the nodes.
  template <int dim>
  std::vector<double>
  strain_energies(const ElasticFields<dim> &fields, const DofVector &u);
} // namespace Debond

#endif
