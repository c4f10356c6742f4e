// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <debond/certify/equilibrium_problem.h>
#include <debond/certify/side_moments.h>
#include <debond/certify/trace_constant.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace Debond
{
  namespace
  {
    template <int dim>
    constexpr unsigned int unknowns_of_a_side =
      EquilibriumElement<dim>::unknowns_of_a_side;



    /// Of a LinearStress, and at one of its corners.
    template <int dim>
    constexpr unsigned int n_of_part = LinearStress<dim>::RowsAtCompileTime;

    template <int dim>
    constexpr unsigned int n_at_corner =
      dealii::SymmetricTensor<2, dim>::n_independent_components;



    /// Whether both are the same polygon or tetrahedron at different places,
    /// but for the rounding of coordinates.
    template <int dim>
    bool
    is_moved(const std::vector<dealii::Point<dim>> &one,
             const std::vector<dealii::Point<dim>> &other)
    {
      constexpr double rounding = 1e-12;
      if (one.size() != other.size())
        return false;
      const double size =
        std::min((one[1] - one[0]).norm(), (one.back() - one[0]).norm());
      for (unsigned int i = 1; i < one.size(); ++i)
        if (((one[i] - one[0]) - (other[i] - other[0])).norm() >
            rounding * size)
          return false;
      return true;
    }



    /// Of each active cell int epsilon(u) : C epsilon(u).
    template <int dim>
    std::vector<double>
    strain_energies(const ElasticFields<dim> &fields, const DofVector &u)
    {
      CellStresses<dim>   stresses(fields,
                                 u,
                                 1.,
                                 strain_rule<dim>(fields.unknowns().degree()),
                                 dealii::update_JxW_values);
      const auto         &values = stresses.values();
      std::vector<double> result;
      for (const auto &cell :
           fields.unknowns().dof_handler().active_cell_iterators())
        {
          stresses.reinit(cell);
          result.push_back(0.);
          for (const unsigned int q : values.quadrature_point_indices())
            result.back() += values.JxW(q) * (symmetrize(stresses.gradient(q)) *
                                              stresses.elastic_stress(q));
        }
      return result;
    }
  } // namespace



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
      std::vector<dealii::Point<dim>>                                corners;
      const Material                                                *material;
      std::shared_ptr<const typename EquilibriumElement<dim>::Shape> shape;
    };
    // The last ones that were new.
    constexpr unsigned int most_known = 64;
    std::deque<Known>      known;
    for (const Place &place : mesh.places())
      {
        std::vector<dealii::Point<dim>> corners;
        for (const unsigned int vertex : place.vertices)
          corners.push_back(vertices()[vertex]);
        const Material &material = materials(place.cells[0]->material_id());
        auto            same =
          std::find_if(known.begin(), known.end(), [&](const Known &other) {
            return is_moved(other.corners, corners) &&
                   other.material == &material;
          });
        if (same == known.end())
          {
            if (known.size() == most_known)
              known.pop_back();
            known.push_front(
              {corners,
               &material,
               EquilibriumElement<dim>::make_shape(corners, material)});
            same = known.begin();
          }
        all_elements.emplace_back(corners,
                                  same->shape,
                                  place.body_force,
                                  mesh.thermal_stress(place.cells[0]));
      }
  }



  template <int dim>
  template <typename Add>
  void
  EquilibriumProblem<dim>::for_each_coefficient(const Place &place,
                                                const Add   &add) const
  {
    constexpr unsigned int n = unknowns_of_a_side<dim>;
    for (unsigned int i = 0; i < place.sides.size(); ++i)
      for (unsigned int k = 0; k < dim; ++k)
        {
          // In 2D the mean is that of the side, and the slope may have the
          // other sign.
          const unsigned int position = place.positions[i][k];
          const unsigned int own      = dim == 2 ? k : position;
          const double sign = dim == 2 && k != position && k == 1 ? -1. : 1.;
          const dealii::Tensor<2, dim> &directions =
            mesh.sides()[place.sides[i]].directions;
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int j = 0; j < dim; ++j)
              if (directions[j][d] != 0.)
                add(n * i + dim * k + d,
                    n * i + dim * own + j,
                    sign * directions[j][d]);
        }
  }



  template <int dim>
  Eigen::MatrixXd
  EquilibriumProblem<dim>::matrix_of(const unsigned int element) const
  {
    const Eigen::MatrixXd &K     = all_elements[element].K();
    Eigen::MatrixXd        half  = Eigen::MatrixXd::Zero(K.rows(), K.cols());
    Eigen::MatrixXd        whole = half;
    const auto             turn_columns = [&](const Eigen::MatrixXd &matrix,
                                  Eigen::MatrixXd       &result) {
      for_each_coefficient(mesh.places()[element],
                           [&](const unsigned int row,
                               const unsigned int column,
                               const double       c) {
                             result.col(column) += c * matrix.col(row);
                           });
    };
    turn_columns(K, half);
    turn_columns(half.transpose(), whole);
    return whole;
  }



  template <int dim>
  std::unique_ptr<Condensation>
  EquilibriumProblem<dim>::condense(const std::vector<double> &weights) const
  {
    const Eigen::VectorXd &loads = mesh.loads_on_sides();
    DofVector              f(static_cast<unsigned int>(loads.size()));
    std::copy(loads.begin(), loads.end(), f.begin());
    dealii::DynamicSparsityPattern pattern(f.size());
    for (const Place &place : mesh.places())
      {
        const std::vector<unsigned int> unknowns = mesh.unknowns_of(place);
        for (const unsigned int row : unknowns)
          pattern.add_entries(row, unknowns.begin(), unknowns.end());
      }
    dealii::SparsityPattern sparsity;
    sparsity.copy_from(pattern);

    const Eigen::VectorXd       &lifting = mesh.lifting();
    dealii::SparseMatrix<double> A(sparsity);
    double                       constant = -loads.dot(lifting);
    for (unsigned int element = 0; element < all_elements.size(); ++element)
      {
        const EquilibriumElement<dim>  &own      = all_elements[element];
        const Place                    &place    = mesh.places()[element];
        const std::vector<unsigned int> unknowns = mesh.unknowns_of(place);
        const double          weight = weights.empty() ? 1. : weights[element];
        const Eigen::MatrixXd matrix = matrix_of(element);
        const Eigen::VectorXd F      = own.F();
        constant += own.constant() / weight;
        for (unsigned int i = 0; i < unknowns.size(); ++i)
          for (unsigned int j = 0; j < unknowns.size(); ++j)
            A.add(unknowns[i], unknowns[j], weight * matrix(i, j));
        Eigen::VectorXd force = Eigen::VectorXd::Zero(unknowns.size());
        for_each_coefficient(place,
                             [&](const unsigned int row,
                                 const unsigned int column,
                                 const double       c) {
                               force(column) += c * F(row);
                             });
        const Eigen::VectorXd own_lifting = lifting(unknowns);
        if (!own_lifting.isZero(0.))
          {
            const Eigen::VectorXd of_lifting = weight * matrix * own_lifting;
            constant += own_lifting.dot(0.5 * of_lifting - force);
            force -= of_lifting;
          }
        for (unsigned int i = 0; i < unknowns.size(); ++i)
          f(unknowns[i]) += force(i);
      }

    std::vector<unsigned int> kept;
    for (unsigned int k = 0; k < dim; ++k)
      for (const ContactSide &side : mesh.contact_sides())
        kept.push_back(side.unknowns[k]);
    try
      {
        return std::make_unique<Condensation>(
          A,
          f,
          kept,
          [this](const unsigned int i) { return mesh.is_fixed(i); },
          constant,
          /*is_semidefinite=*/true);
      }
    catch (const std::runtime_error &)
      {
        // It is semidefinite for any body. No fault of the scene's.
        throw std::runtime_error(
          "to rounding the matrix of the equilibrated stresses is not positive "
          "definite; try cells that are less flat, a Poisson ratio farther from "
          "its limit, or parts that differ less in stiffness");
      }
  }



  template <int dim>
  std::vector<Eigen::VectorXd>
  EquilibriumProblem<dim>::stresses(const DofVector           &unknowns,
                                    const std::vector<double> &weights) const
  {
    std::vector<Eigen::VectorXd> result;
    result.reserve(all_elements.size());
    for (unsigned int element = 0; element < all_elements.size(); ++element)
      {
        const Place                    &place   = mesh.places()[element];
        const std::vector<unsigned int> numbers = mesh.unknowns_of(place);
        Eigen::VectorXd own = Eigen::VectorXd::Zero(numbers.size());
        for_each_coefficient(place,
                             [&](const unsigned int row,
                                 const unsigned int column,
                                 const double       c) {
                               own(row) +=
                                 c * (unknowns(numbers[column]) +
                                      mesh.lifting()(numbers[column]));
                             });
        result.push_back(all_elements[element].stress(
          own, weights.empty() ? 1. : weights[element]));
      }
    return result;
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::elastic_functional(const ElasticFields<dim> &fields,
                                              const DofVector          &u) const
  {
    CellStresses<dim>                   stresses(fields,
                               u,
                               1.,
                               strain_rule<dim>(fields.unknowns().degree()),
                               dealii::update_values |
                                 dealii::update_JxW_values);
    const auto                         &values = stresses.values();
    double                              sum    = 0.;
    std::vector<dealii::Tensor<1, dim>> integrals; // of u over active cells
    for (const auto &cell :
         fields.unknowns().dof_handler().active_cell_iterators())
      {
        stresses.reinit(cell);
        integrals.emplace_back();
        const double p = mesh.thermal_stress(Cell(cell));
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const dealii::SymmetricTensor<2, dim> epsilon =
              symmetrize(stresses.gradient(q));
            sum += values.JxW(q) * (0.5 * epsilon * stresses.elastic_stress(q) -
                                    p * trace(epsilon));
            integrals.back() += values.JxW(q) * stresses.displacement(q);
          }
      }
    const Eigen::VectorXd &loads = mesh.loads_on_sides();
    for (const Place &place : mesh.places())
      for (unsigned int i = 0; i < place.sides.size(); ++i)
        {
          const Cell &cell = place.cells[i];
          sum -= place.body_force * integrals[cell->active_cell_index()] /
                 place.parts_of_a_cell();

          // Only sides of the boundary have loads.
          const unsigned int first = unknowns_of_a_side<dim> * place.sides[i];
          if (loads.segment<unknowns_of_a_side<dim>>(first).isZero(0.))
            continue;
          const Side &side = mesh.sides()[place.sides[i]];
          const auto  l    = side_unknowns(
            SideDisplacement<dim>(fields.unknowns(), u, cell, side.vertices));
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int d = 0; d < dim; ++d)
              sum -= loads(first + dim * k + d) * (l[k] * side.directions[d]);
        }
    return sum;
  }



  template <int dim>
  std::vector<double>
  EquilibriumProblem<dim>::element_energies(const ElasticFields<dim> &fields,
                                            const DofVector          &u) const
  {
    const std::vector<double> of_cells = strain_energies(fields, u);
    std::vector<double>       result;
    for (const Place &place : mesh.places())
      {
        // All of a simplex are the same one.
        const bool is_simplex = place.vertices.size() == dim + 1;
        double     sum        = 0.;
        for (unsigned int i = 0; i < (is_simplex ? 1 : place.cells.size()); ++i)
          sum += of_cells[place.cells[i]->active_cell_index()];
        result.push_back(sum);
      }
    return result;
  }



  template <int dim>
  std::vector<double>
  EquilibriumProblem<dim>::load_rests(const ElasticFields<dim> &fields,
                                      const DofVector          &u) const
  {
    if (mesh.load_rests().empty())
      return {};
    const std::vector<double> energies = strain_energies(fields, u);
    std::vector<double>       result(energies.size(), 0.);
    for (const auto &rest : mesh.load_rests())
      {
        const unsigned int cell = rest.cell->active_cell_index();
        result[cell] += std::sqrt(
          rest.square * energies[cell] /
          elementary_trace_constant(RectangleAboveSide{rest.width, rest.height},
                                    materials(rest.cell->material_id()),
                                    false));
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
    // The middle of a cell is the centre of an element, or its vertices are
    // corners and centre.
    std::vector<dealii::Point<dim>> points =
      dealii::QGaussSimplex<dim>(1).get_points();
    const auto reference_cell = dealii::ReferenceCells::get_simplex<dim>();
    for (const unsigned int v : reference_cell.vertex_indices())
      points.push_back(reference_cell.template vertex<dim>(v));
    CellStresses<dim>   elastic(fields, u, 1., points);
    const auto         &dofs = fields.unknowns().dof_handler();
    std::vector<double> gaps(mesh.triangulation().n_active_cells(), 0.);
    for (unsigned int element = 0; element < mesh.places().size(); ++element)
      {
        const Place           &place  = mesh.places()[element];
        const Eigen::VectorXd &stress = stresses[element];
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          {
            const Cell     &cell     = place.cells[i];
            const Material &material = materials(cell->material_id());
            const auto      local    = corners_of_side<dim>(
              static_cast<unsigned int>(place.vertices.size()), i);
            elastic.reinit(typename ElasticFields<dim>::Cell(
              &dofs.get_triangulation(), cell->level(), cell->index(), &dofs));
            // Of points; what is no corner of the side is the centre.
            std::array<unsigned int, dim + 1> numbers;
            numbers[dim] =
              place.vertices.size() == dim + 1 ? 0 : 1 + dim * (dim + 1) / 2;
            for (unsigned int k = 0; k < dim; ++k)
              {
                unsigned int v = 0;
                while (cell->vertex_index(v) != place.vertices[local[k]])
                  ++v;
                numbers[k] = 1 + v;
                if (numbers[dim] != 0)
                  numbers[dim] -= v;
              }
            // Linear, as both stresses are.
            LinearStress<dim> difference =
              stress.segment<n_of_part<dim>>(n_of_part<dim> * i);
            for (unsigned int corner = 0; corner <= dim; ++corner)
              {
                const dealii::SymmetricTensor<2, dim> of_u =
                  elastic.elastic_stress(numbers[corner]);
                for (unsigned int k = 0; k < n_at_corner<dim>; ++k)
                  difference(n_at_corner<dim> * corner + k) -=
                    of_u.access_raw_entry(k) -
                    (k < dim ? mesh.thermal_stress(cell) : 0.);
              }
            // A cell's parts have the same measure.
            gaps[cell->active_cell_index()] +=
              0.5 * complementary_energy<dim>(difference,
                                              cell->measure() /
                                                place.parts_of_a_cell(),
                                              material);
          }
      }
    return gaps;
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::work_of_lifting(
    const DofVector           &unknowns,
    const std::vector<double> &weights) const
  {
    const Eigen::VectorXd &lifting = mesh.lifting();
    double                 work    = -mesh.loads_on_sides().dot(lifting);
    for (unsigned int element = 0; element < all_elements.size(); ++element)
      {
        const std::vector<unsigned int> numbers =
          mesh.unknowns_of(mesh.places()[element]);
        const Eigen::VectorXd own_lifting = lifting(numbers);
        if (own_lifting.isZero(0.))
          continue;
        Eigen::VectorXd own = own_lifting;
        for (unsigned int i = 0; i < numbers.size(); ++i)
          own(i) += unknowns(numbers[i]);
        work += (weights.empty() ? 1. : weights[element]) *
                own_lifting.dot(matrix_of(element) * own);
        const Eigen::VectorXd F = all_elements[element].F();
        for_each_coefficient(mesh.places()[element],
                             [&](const unsigned int row,
                                 const unsigned int column,
                                 const double       c) {
                               work -= own_lifting(column) * c * F(row);
                             });
      }
    return work;
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::rounding_of(const Condensation        &condensed,
                                       const Eigen::VectorXd     &kept,
                                       const std::vector<double> &weights) const
  {
    const DofVector                    unknowns = condensed.expand(kept);
    const std::vector<Eigen::VectorXd> stresses =
      this->stresses(unknowns, weights);
    double energy = -work_of_lifting(unknowns, weights);
    for (unsigned int element = 0; element < mesh.places().size(); ++element)
      {
        const Place           &place  = mesh.places()[element];
        const double           weight = weights.empty() ? 1. : weights[element];
        const Eigen::VectorXd &stress = stresses[element];
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          {
            const Cell       &cell = place.cells[i];
            LinearStress<dim> total =
              stress.segment<n_of_part<dim>>(n_of_part<dim> * i);
            for (unsigned int corner = 0; corner <= dim; ++corner)
              total.template segment<dim>(n_at_corner<dim> * corner).array() +=
                mesh.thermal_stress(cell);
            energy += 0.5 / weight *
                      complementary_energy<dim>(total,
                                                cell->measure() /
                                                  place.parts_of_a_cell(),
                                                materials(cell->material_id()));
          }
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
    std::vector<dealii::SymmetricTensor<2, dim>> result(
      mesh.triangulation().n_active_cells());
    for (unsigned int element = 0; element < mesh.places().size(); ++element)
      {
        const Place           &place  = mesh.places()[element];
        const Eigen::VectorXd &stress = stresses[element];
        const double           share  = (dim + 1.) * place.parts_of_a_cell();
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          for (unsigned int corner = 0; corner <= dim; ++corner)
            for (unsigned int k = 0; k < n_at_corner<dim>; ++k)
              result[place.cells[i]->active_cell_index()].access_raw_entry(k) +=
                stress(n_of_part<dim> * i + n_at_corner<dim> * corner + k) /
                share;
      }
    return result;
  }



  template class EquilibriumProblem<2>;
  template class EquilibriumProblem<3>;
} // namespace Debond
