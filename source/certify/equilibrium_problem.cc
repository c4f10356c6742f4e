// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/certify/equilibrium_problem.h>
#include <debond/certify/side_moments.h>

#include <deque>

namespace Debond
{
  namespace
  {
    template <int dim>
    constexpr unsigned int unknowns_of_a_side =
      EquilibriumElement<dim>::unknowns_of_a_side;

    /// Says whether both are the same simplex at different places, but for the
    /// rounding of coordinates.
    template <int dim>
    bool
    is_moved(const SimplexCorners<dim> &one, const SimplexCorners<dim> &other)
    {
      // Only translations leave the matrices of an element as they are.
      const double size = (one[1] - one[0]).norm();
      for (unsigned int i = 1; i <= dim; ++i)
        if (((one[i] - one[0]) - (other[i] - other[0])).norm() >
            Tolerance::same_cell * size)
          return false;
      return true;
    }



    /// The sum over the parts of a cell of the complementary energy of a
    /// stress, which is an EquilibriumElement's.
    template <int dim>
    double
    energy_of_parts(const Eigen::VectorXd &stress,
                    const double           measure_of_cell,
                    const Material        &material)
    {
      // The parts between the centroid and the sides are of the same size.
      double sum = 0.;
      for (unsigned int i = 0; i <= dim; ++i)
        sum += complementary_energy<dim>(stress.segment<n_of_part<dim>>(
                                           n_of_part<dim> * i),
                                         measure_of_cell / (dim + 1.),
                                         material);
      return sum;
    }



    /// Adds @p pressure to all normal stresses of such a stress.
    template <int dim>
    void
    add_pressure(const double pressure, Eigen::VectorXd &stress)
    {
      // Normal stresses come first among the components at each corner.
      for (unsigned int k = 0; k < stress.size(); k += n_stress_components<dim>)
        stress.segment<dim>(k).array() += pressure;
    }



    Eigen::VectorXd
    of_cell(const DofVector &vector, const std::vector<unsigned int> &unknowns)
    {
      Eigen::VectorXd result(unknowns.size());
      for (unsigned int i = 0; i < unknowns.size(); ++i)
        result(i) = vector(unknowns[i]);
      return result;
    }
  } // namespace



  template <int dim>
  std::vector<double>
  strain_energies(const ElasticFields<dim> &fields, const DofVector &u)
  {
    // The rule is exact: strains are constant in a cell, or linear with
    // quadratic displacements.
    CellStresses<dim>   stresses(fields,
                               u,
                               1.,
                               strain_rule<dim>(fields.unknowns().degree()));
    const auto         &values = stresses.values();
    std::vector<double> result;
    for (const auto &cell :
         fields.unknowns().dof_handler().active_cell_iterators())
      {
        stresses.reinit(cell);
        result.push_back(0.);
        for (const unsigned int q : values.quadrature_point_indices())
          result.back() +=
            values.JxW(q) * (stresses.strain(q) * stresses.elastic_stress(q));
      }
    return result;
  }



  MeansAndSlopes::MeansAndSlopes(const Condensation &condensed)
    : A(condensed.schur_complement())
    , b(condensed.load())
  {
    // The unknowns w_1 = m - k/3 and w_2 = m + k/3 become m and k by a
    // congruence: columns first, then rows. With w = T x the quadratic form of
    // x has T'AT and T'b.
    const Eigen::Index n      = b.size() / 2;
    const auto         change = [n](auto first, auto second) {
      const Eigen::MatrixXd sum = first + second;
      second                    = ((second - first) / 3.).eval();
      first                     = sum;
    };
    change(A.leftCols(n), A.rightCols(n));
    change(A.topRows(n), A.bottomRows(n));
    change(b.head(n), b.tail(n));
  }



  Eigen::VectorXd
  MeansAndSlopes::unknowns(const Eigen::VectorXd &x)
  {
    const Eigen::Index n = x.size() / 2;
    Eigen::VectorXd    result(2 * n);
    result << x.head(n) - x.tail(n) / 3., x.head(n) + x.tail(n) / 3.;
    return result;
  }



  template <int dim>
  EquilibriumProblem<dim>::EquilibriumProblem(
    const dealii::Triangulation<dim> &triangulation,
    const BoundaryConditions         &conditions,
    const Supports<dim>              &supports,
    const ByRegion<Material>         &materials,
    const Loads<dim>                 &loads,
    const std::vector<double>        &thermal_stresses)
    : mesh(triangulation, conditions, supports, loads, thermal_stresses)
    , materials(materials)
  {
    make_elements();
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::make_elements()
  {
    struct Known
    {
      SimplexCorners<dim>            corners;
      const Material                *material;
      std::shared_ptr<const Element> element;
    };
    // Most cells of a crossed or refined mesh are translations of a few others,
    // and an element takes dense factorisations. The last ones that were new
    // are kept, few enough for the search to be short.
    constexpr unsigned int most_known = 64;
    std::deque<Known>      known;
    for (const auto &cell : mesh.triangulation.active_cell_iterators())
      {
        const SimplexCorners<dim> corners  = corners_of<dim>(cell);
        const Material           &material = materials(cell->material_id());
        auto                      same =
          std::find_if(known.begin(), known.end(), [&](const Known &other) {
            return other.material == &material &&
                   is_moved<dim>(other.corners, corners);
          });
        if (same == known.end())
          {
            if (known.size() == most_known)
              known.pop_back();
            known.push_front(
              {corners,
               &material,
               std::make_shared<const Element>(corners, material)});
            same = known.begin();
          }
        elements.push_back(same->element);
      }
  }



  template <int dim>
  std::unique_ptr<Condensation>
  EquilibriumProblem<dim>::condense(const std::vector<double> &weights) const
  {
    // The hybridised system: the displacements of the sides make the tractions
    // continuous. Its matrix is a sum over cells, as in displacement methods.
    const auto             cells = mesh.triangulation.active_cell_iterators();
    const Eigen::VectorXd &loads = mesh.loads_on_sides;
    DofVector              f(static_cast<unsigned int>(loads.size()));
    dealii::DynamicSparsityPattern pattern(f.size());
    std::copy(loads.begin(), loads.end(), f.begin());
    for (const auto &cell : cells)
      {
        const std::vector<unsigned int> unknowns = mesh.unknowns_of(cell);
        // The sides of a cell couple to each other with all their unknowns.
        for (const unsigned int row : unknowns)
          pattern.add_entries(row, unknowns.begin(), unknowns.end());
      }
    dealii::SparsityPattern sparsity;
    sparsity.copy_from(pattern);

    // What is prescribed is a lifting: its energy is a constant, its forces are
    // a load.
    const Eigen::VectorXd       &lifting = mesh.lifting;
    dealii::SparseMatrix<double> A(sparsity);
    double                       constant = -loads.dot(lifting);
    for (const auto &cell : cells)
      {
        const unsigned int    number   = cell->active_cell_index();
        const Element        &element  = *elements[number];
        const auto           &load     = mesh.loads_of_cells[number];
        const auto            unknowns = mesh.unknowns_of(cell);
        const double          weight   = weights.empty() ? 1. : weights[number];
        const Eigen::MatrixXd R        = mesh.rotation(cell);
        // In the frame of the sides at contact. A weight of 1 - theta makes the
        // cell softer, which is what Theorem 1 asks for; the energy of the
        // loads alone grows by its inverse.
        const Eigen::MatrixXd K     = weight * R.transpose() * element.K * R;
        Eigen::VectorXd       force = R.transpose() * element.F(load);
        const Eigen::VectorXd own_lifting = lifting(unknowns);
        const Eigen::VectorXd of_lifting  = K * own_lifting;
        constant += element.constant(load) / weight +
                    own_lifting.dot(0.5 * of_lifting - force);
        force -= of_lifting;
        for (unsigned int i = 0; i < unknowns.size(); ++i)
          {
            for (unsigned int j = 0; j < unknowns.size(); ++j)
              A.add(unknowns[i], unknowns[j], K(i, j));
            f(unknowns[i]) += force(i);
          }
      }

    // The moments of the contact sides are kept, corner by corner. Rigid
    // motions of a body that only contact holds are left in S. A is definite if
    // s is zero, which is what "semidefinite" asks for.
    std::vector<unsigned int> kept;
    for (unsigned int k = 0; k < dim; ++k)
      for (const auto &side : mesh.contact_sides)
        kept.push_back(side.unknown(k));
    try
      {
        return std::make_unique<Condensation>(
          A,
          f,
          kept,
          [this](const unsigned int i) { return mesh.is_fixed[i] != 0; },
          constant,
          /*is_semidefinite=*/true);
      }
    catch (const IndefiniteMatrix &)
      {
        // It is semidefinite for any body.
        throw StressRoundingError(
          "to rounding the matrix of the equilibrated stresses is not positive "
          "definite; try cells that are less flat, a Poisson ratio farther from "
          "its limit, or parts that differ less in stiffness");
      }
  }



  template <int dim>
  std::vector<Eigen::VectorXd>
  EquilibriumProblem<dim>::stresses(const DofVector &unknowns) const
  {
    // An unknown is a displacement less the lifting, so that the lifting is
    // added before cells turn the displacements of their sides into a stress.
    // Tractions are continuous between cells only to the accuracy of the
    // solution; rounding_of() says what that may cost.
    std::vector<Eigen::VectorXd> result;
    for (const auto &cell : mesh.triangulation.active_cell_iterators())
      {
        const unsigned int number = cell->active_cell_index();
        const auto         own    = mesh.unknowns_of(cell);
        result.push_back(elements[number]->stress(
          mesh.rotation(cell) *
            (of_cell(unknowns, own) + Eigen::VectorXd(mesh.lifting(own))),
          mesh.loads_of_cells[number]));
      }
    return result;
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::elastic_functional(const ElasticFields<dim> &fields,
                                              const DofVector          &u) const
  {
    CellStresses<dim>      stresses(fields,
                               u,
                               1.,
                               strain_rule<dim>(fields.unknowns().degree()));
    const auto            &values = stresses.values();
    const Eigen::VectorXd &loads  = mesh.loads_on_sides;
    double                 sum    = 0.;
    for (const auto &cell :
         fields.unknowns().dof_handler().active_cell_iterators())
      {
        stresses.reinit(cell);
        const auto &load = mesh.loads_of_cells[cell->active_cell_index()];
        // This J has the loads of the equilibrated stresses, with body force
        // and temperature constant in a cell, so that it is exactly the one
        // that the stresses bound.
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const dealii::SymmetricTensor<2, 3> epsilon = stresses.strain(q);
            sum += values.JxW(q) * (0.5 * epsilon * stresses.elastic_stress(q) -
                                    load(dim) * trace(epsilon));
            for (unsigned int d = 0; d < dim; ++d)
              sum -= values.JxW(q) * load(d) * stresses.displacement(q)[d];
          }
        // Only sides of the boundary have loads.
        for (unsigned int corner = 0; corner <= dim; ++corner)
          {
            const unsigned int    first = mesh.first_unknown(cell, corner);
            const Eigen::VectorXd own =
              loads.segment<unknowns_of_a_side<dim>>(first);
            if (own.isZero(0.))
              continue;
            auto vertices = mesh.vertices_of_side(cell, corner);
            std::sort(vertices.begin(), vertices.end());
            // Work on the means w_k: loads are the moments of linear tractions.
            const auto l = side_unknowns(
              SideDisplacement<dim>(fields.unknowns(), u, cell, vertices));
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int d = 0; d < dim; ++d)
                sum -= own(dim * k + d) * (l[k] * mesh.directions(first)[d]);
          }
      }
    return sum;
  }



  template <int dim>
  std::vector<double>
  EquilibriumProblem<dim>::load_rests(const ElasticFields<dim> &fields,
                                      const DofVector          &u) const
  {
    if (mesh.load_rests.empty())
      return {};
    // The work of what is not linear in a traction is at most (int r^2 a_Q(u,u)
    // / Lambda)^{1/2}.
    const std::vector<double> energies = strain_energies(fields, u);
    std::vector<double>       result(energies.size(), 0.);
    for (const auto &rest : mesh.load_rests)
      {
        // 2 mu / Lambda of a rectangle of width pi w and height h, see
        // doc/reference/certificate.md, where the least of epsilon : E(epsilon)
        // stands for 2 mu.
        const Material &material = materials(rest.cell->material_id());
        const double    w = rest.width / dealii::numbers::PI, h = rest.height;
        const double    bound =
          64. / std::pow(h, 6) *
          (w * w * std::pow(h, 5) / 24. + std::pow(w, 4) * std::pow(h, 3) / 4. +
           std::pow(h, 7) / 64.);
        const double       stiffness = material.least_stiffness<2>();
        const unsigned int cell      = rest.cell->active_cell_index();
        result[cell] +=
          std::sqrt(rest.square * energies[cell] * bound / stiffness);
      }
    return result;
  }



  template <int dim>
  std::vector<double>
  EquilibriumProblem<dim>::constitutive_gaps(
    const ElasticFields<dim>           &fields,
    const DofVector                    &u,
    const std::vector<Eigen::VectorXd> &stresses) const
  {
    // All points at which a part has its linear stress: the corners of the
    // cell, the centroid.
    std::vector<dealii::Point<dim>> points;
    const auto reference_cell = dealii::ReferenceCells::get_simplex<dim>();
    for (const unsigned int v : reference_cell.vertex_indices())
      points.push_back(reference_cell.template vertex<dim>(v));
    points.push_back(dealii::QGaussSimplex<dim>(1).point(0));
    CellStresses<dim>   of_u(fields, u, 1., points);
    std::vector<double> gaps;
    for (const auto &cell :
         fields.unknowns().dof_handler().active_cell_iterators())
      {
        // 1/2 |C^{1/2} epsilon(u) - C^{-1/2} sigma|^2, exactly, since both
        // stresses are linear on each part of the cell and known at its
        // corners.
        of_u.reinit(cell);
        const unsigned int number     = cell->active_cell_index();
        Eigen::VectorXd    difference = stresses[number];
        add_pressure<dim>(mesh.loads_of_cells[number](dim), difference);
        for (unsigned int part = 0; part <= dim; ++part)
          for (unsigned int corner = 0; corner <= dim; ++corner)
            {
              const auto stress =
                of_u.elastic_stress(corner < part ? corner : corner + 1);
              for (unsigned int k = 0; k < n_stress_components<dim>; ++k)
                difference(n_of_part<dim> * part +
                           n_stress_components<dim> * corner + k) -=
                  stress[dealii::SymmetricTensor<2, dim>::
                           unrolled_to_component_indices(k)];
            }
        // C epsilon - (sigma + p 1) measured by C^{-1} is C^{1/2} epsilon -
        // C^{-1/2} (sigma + p 1) squared.
        gaps.push_back(0.5 *
                       energy_of_parts<dim>(difference,
                                            cell->measure(),
                                            materials(cell->material_id())));
      }
    return gaps;
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::rounding_of(const Condensation        &condensed,
                                       const Eigen::VectorXd     &kept,
                                       const std::vector<double> &weights) const
  {
    // One energy is computed twice at one displacement: by the eliminated
    // system, and by the stresses, summed up cell by cell. The difference
    // measures what the factorisation has lost. The tractions' moments K l - F
    // give the work along what is prescribed. Both energies are equal in exact
    // arithmetic at any displacement that is at equilibrium for the kept
    // unknowns.
    const DofVector        unknowns = condensed.expand(kept);
    const Eigen::VectorXd &lifting  = mesh.lifting;
    double                 energy   = mesh.loads_on_sides.dot(lifting);
    for (const auto &cell : mesh.triangulation.active_cell_iterators())
      {
        const unsigned int    number  = cell->active_cell_index();
        const Element        &element = *elements[number];
        const auto           &load    = mesh.loads_of_cells[number];
        const double          weight  = weights.empty() ? 1. : weights[number];
        const auto            own     = mesh.unknowns_of(cell);
        const Eigen::MatrixXd R       = mesh.rotation(cell);
        const Eigen::VectorXd own_lifting = R * lifting(own);
        const Eigen::VectorXd l      = R * of_cell(unknowns, own) + own_lifting;
        Eigen::VectorXd       stress = element.stress(l, load, weight);
        add_pressure<dim>(load(dim), stress);
        energy += 0.5 / weight *
                    energy_of_parts<dim>(stress,
                                         cell->measure(),
                                         materials(cell->material_id())) -
                  own_lifting.dot(weight * (element.K * l) - element.F(load));
      }
    const MatrixView S = condensed.schur_complement();
    // It may be more at other displacements.
    return 4. * std::abs(condensed.energy_at_zero() - 0.5 * kept.dot(S * kept) +
                         energy);
  }



  template <int dim>
  std::vector<dealii::SymmetricTensor<2, dim>>
  EquilibriumProblem<dim>::mean_stresses(
    const std::vector<Eigen::VectorXd> &stresses) const
  {
    std::vector<dealii::SymmetricTensor<2, dim>> result(stresses.size());
    for (unsigned int cell = 0; cell < stresses.size(); ++cell)
      // The parts have the same size, and the mean of a linear function is that
      // of its values at the dim + 1 corners.
      for (unsigned int k = 0; k < stresses[cell].size(); ++k)
        result[cell].access_raw_entry(k % n_stress_components<dim>) +=
          stresses[cell](k) / ((dim + 1.) * (dim + 1.));
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(EquilibriumProblem);
  DEBOND_INSTANTIATE(strain_energies);
} // namespace Debond
