// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/certify/equilibrium_mesh.h>
#include <debond/certify/side_moments.h>
#include <debond/elasticity/contact_frame.h>
#include <debond/mesh/field_value.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    using CellOf = typename dealii::Triangulation<dim>::cell_iterator;

    /// The points of a rule for quadratics in a cell, all of the same weight.
    template <int dim>
    std::vector<dealii::Point<dim>>
    points_in(const CellOf<dim> &cell)
    {
      // Loads that are constant on the cell are represented as they are;
      // whether they are constant is judged at these points, inside of the
      // cell, where a load that jumps at a side has one value.
      static const dealii::QGaussSimplex<dim> rule(2);
      std::vector<dealii::Point<dim>>         points;
      for (const dealii::Point<dim> &reference : rule.get_points())
        {
          points.push_back(cell->vertex(0));
          for (unsigned int d = 0; d < dim; ++d)
            points.back() +=
              reference[d] * (cell->vertex(d + 1) - cell->vertex(0));
        }
      return points;
    }



    /// The value of a function. Throws EquilibriumError with the place if there
    /// is none.
    template <int dim>
    double
    value_at(const dealii::Function<dim> &function,
             const dealii::Point<dim>    &point,
             const unsigned int           component = 0)
    {
      try
        {
          return field_value(function, point, component);
        }
      catch (const std::invalid_argument &error)
        {
          throw EquilibriumError(error.what());
        }
    }



    /// deal.II's number of the face opposite to a corner.
    template <int dim>
    unsigned int
    face_opposite(const unsigned int corner)
    {
      static const std::array<unsigned int, dim + 1> faces = [] {
        std::array<unsigned int, dim + 1> result;
        const auto cell = dealii::ReferenceCells::get_simplex<dim>();
        for (const unsigned int face : cell.face_indices())
          {
            // The sum of all vertices' numbers less those of the face.
            unsigned int missing = dim * (dim + 1) / 2;
            for (unsigned int k = 0; k < dim; ++k)
              missing -= cell.face_to_cell_vertices(face, k, 1);
            result[missing] = face;
          }
        return result;
      }();
      return faces[corner];
    }
  } // namespace



  template <int dim>
  void
  check_supports(const BoundaryConditions &conditions,
                 const Supports<dim>      &supports)
  {
    std::set<dealii::types::boundary_id> supported;
    for (const PrescribedDisplacement<dim> &support : supports.displacements)
      for (const dealii::types::boundary_id id : support.boundaries)
        {
          if (!supported.insert(id).second)
            throw EquilibriumError("a piece of the boundary with several "
                                   "supports is not done");
          if (conditions.contact.count(id) > 0)
            throw EquilibriumError("a contact boundary with supports is not "
                                   "done");
        }
  }



  template <int dim>
  EquilibriumMesh<dim>::EquilibriumMesh(
    const dealii::Triangulation<dim> &mesh,
    const BoundaryConditions         &conditions,
    const Supports<dim>              &supports,
    const Loads<dim>                 &given_loads,
    const std::vector<double>        &thermal_stresses)
    : triangulation(mesh)
    , is_fixed(unknowns_of_a_side * mesh.n_raw_faces(), 0)
    , loads_on_sides(Eigen::VectorXd::Zero(is_fixed.size()))
    , lifting(loads_on_sides)
    , all_directions(mesh.n_raw_faces(), dealii::unit_symmetric_tensor<dim>())
  {
    find_loads_of_cells(given_loads, thermal_stresses);
    for (const auto &cell : mesh.active_cell_iterators())
      for (unsigned int corner = 0; corner <= dim; ++corner)
        {
          // Sides inside of the body need nothing but their unknowns. Those of
          // the boundary get supports, the law's directions, and loads, as work
          // on the means w_k. Unknowns are numbered by faces, so that both
          // cells at a face find the same ones.
          const auto face = cell->face(face_opposite<dim>(corner));
          if (!face->at_boundary())
            continue;
          Side side = {
            cell,
            first_unknown(cell, corner),
            vertices_of_side(cell, corner),
            {},
            face->boundary_id(),
            SimplexGeometry<dim>(corners_of<dim>(cell)).normals[corner],
            0.,
            face->diameter()};
          side.measure = side.normal.norm();
          side.normal /= side.measure;
          std::sort(side.vertices.begin(), side.vertices.end());
          for (unsigned int k = 0; k < dim; ++k)
            side.corners[k] = mesh.get_vertices()[side.vertices[k]];
          set_supports(side, conditions, supports);
          if (conditions.contact.count(side.id) > 0)
            set_contact(side, conditions, supports);
          if (given_loads.tractions.count(side.id) > 0)
            set_traction(side, given_loads);
        }
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::find_loads_of_cells(
    const Loads<dim>          &given,
    const std::vector<double> &thermal_stresses)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        const auto points = points_in<dim>(cell);
        Load       load   = Load::Zero();
        if (!thermal_stresses.empty())
          load(dim) = thermal_stresses[cell->active_cell_index()];
        if (given.body_force)
          {
            // The mean, all points having the same weight, and how far the
            // values are from it.
            std::vector<dealii::Tensor<1, dim>> forces;
            dealii::Tensor<1, dim>              mean;
            double                              largest = 0.;
            for (const dealii::Point<dim> &point : points)
              {
                forces.push_back(given.force_at(point));
                largest = std::max(largest, forces.back().norm());
                mean += forces.back() / static_cast<double>(points.size());
              }
            for (unsigned int d = 0; d < dim; ++d)
              load(d) = mean[d];
            for (const dealii::Tensor<1, dim> &force : forces)
              loads_are_exact &=
                (force - mean).norm() <= Tolerance::linear_data * largest;
          }
        // A temperature that varies in a cell is taken as its mean, which makes
        // the loads inexact.
        if (given.temperature_change)
          {
            std::vector<double> values;
            for (const dealii::Point<dim> &point : points)
              values.push_back(value_at(*given.temperature_change, point));
            const auto [least, largest] =
              std::minmax_element(values.begin(), values.end());
            loads_are_exact &= *largest - *least <=
                               Tolerance::linear_data *
                                 std::max(std::abs(*largest), std::abs(*least));
          }
        loads_of_cells.push_back(load);
      }
  }



  template <int dim>
  std::array<unsigned int, dim>
  EquilibriumMesh<dim>::vertices_of_side(const Cell        &cell,
                                         const unsigned int corner)
  {
    // The order of corners is that of EquilibriumElement.
    std::array<unsigned int, dim> result;
    for (unsigned int k = 0; k < dim; ++k)
      result[k] = cell->vertex_index(k < corner ? k : k + 1);
    return result;
  }



  template <int dim>
  unsigned int
  EquilibriumMesh<dim>::first_unknown(const Cell        &cell,
                                      const unsigned int corner)
  {
    return unknowns_of_a_side * cell->face_index(face_opposite<dim>(corner));
  }



  template <int dim>
  std::vector<unsigned int>
  EquilibriumMesh<dim>::unknowns_of(const Cell &cell)
  {
    std::vector<unsigned int> result;
    for (unsigned int corner = 0; corner <= dim; ++corner)
      for (unsigned int k = 0; k < unknowns_of_a_side; ++k)
        result.push_back(first_unknown(cell, corner) + k);
    return result;
  }



  template <int dim>
  Eigen::MatrixXd
  EquilibriumMesh<dim>::rotation(const Cell &cell) const
  {
    constexpr unsigned int n      = EquilibriumElement<dim>::n_unknowns;
    Eigen::MatrixXd        result = Eigen::MatrixXd::Zero(n, n);
    for (unsigned int corner = 0; corner <= dim; ++corner)
      {
        // Cells see Cartesian unknowns in the order of their own corners; the
        // mesh has them in the frame of the side, in the order of the vertices'
        // numbers, which both neighbours share.
        const auto &rows  = directions(first_unknown(cell, corner));
        const auto  own   = vertices_of_side(cell, corner);
        const auto  first = unknowns_of_a_side * corner;
        for (unsigned int k = 0; k < dim; ++k)
          {
            // The place of the corner in the order of the vertices' numbers.
            const auto place = std::count_if(own.begin(),
                                             own.end(),
                                             [&](const unsigned int vertex) {
                                               return vertex < own[k];
                                             });
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int e = 0; e < dim; ++e)
                result(first + dim * k + d, first + dim * place + e) =
                  rows[e][d];
          }
      }
    return result;
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::use_normal(const Side &side)
  {
    all_directions[side.first_unknown / unknowns_of_a_side] =
      contact_frame<dim>({side.normal});
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::fix(const Side &side, const unsigned int direction)
  {
    for (unsigned int k = 0; k < dim; ++k)
      is_fixed[side.first_unknown + dim * k + direction] = 1;
  }



  template <int dim>
  std::array<double, dim>
  EquilibriumMesh<dim>::prescribe(const Side                  &side,
                                  const unsigned int           direction,
                                  const dealii::Function<dim> &function,
                                  const unsigned int           component)
  {
    // The lifting has the means w_k of the prescribed function, which is exact
    // if that is linear on the side.
    std::array<double, dim> values;
    double                  largest = 0., sum = 0.;
    for (unsigned int k = 0; k < dim; ++k)
      {
        values[k] = value_at(function, side.corners[k], component);
        largest   = std::max(largest, std::abs(values[k]));
        sum += values[k];
      }
    // Linear if it is so in the middle of each edge.
    for (unsigned int k = 0; k < dim; ++k)
      for (unsigned int l = 0; l < k; ++l)
        {
          const dealii::Point<dim> middle(0.5 *
                                          (side.corners[k] + side.corners[l]));
          loads_are_exact &= std::abs(value_at(function, middle, component) -
                                      0.5 * (values[k] + values[l])) <=
                             Tolerance::linear_data * largest;
        }
    // dim times the mean of lambda_k lambda_l is (1 + delta_kl) / (dim + 1).
    for (unsigned int k = 0; k < dim; ++k)
      lifting(side.first_unknown + dim * k + direction) =
        (sum + values[k]) / (dim + 1.);
    return values;
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::set_supports(const Side               &side,
                                     const BoundaryConditions &conditions,
                                     const Supports<dim>      &supports)
  {
    for (const PrescribedDisplacement<dim> &support : supports.displacements)
      {
        if (support.boundaries.count(side.id) == 0)
          continue;
        // A roller fixes the normal displacement and leaves the others free,
        // whose tractions are then zero. Components are Cartesian, and the side
        // keeps its directions for them.
        if (support.is_roller)
          {
            use_normal(side);
            fix(side, 0);
          }
        for (unsigned int d = 0; d < dim; ++d)
          if (support.components[d])
            {
              fix(side, d);
              prescribe(side, d, *support.values, d);
            }
      }
    if (conditions.clamped.count(side.id) > 0)
      for (unsigned int d = 0; d < dim; ++d)
        fix(side, d);
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::set_contact(Side                     &side,
                                    const BoundaryConditions &conditions,
                                    const Supports<dim>      &supports)
  {
    // Contact sides have the moments of s along their normal and those of v_tau
    // beside it. If v_tau is free, its unknowns make sigma_tau zero; if it is
    // fixed, sigma_tau may be anything. A gap is a lifting of s.
    use_normal(side);
    if (conditions.fixes_tangential(side.id))
      for (unsigned int d = 1; d < dim; ++d)
        fix(side, d);
    if (const auto gap = supports.gaps.find(side.id);
        gap != supports.gaps.end())
      side.gap = prescribe(side, 0, *gap->second.value, 0);
    contact_sides.push_back(side);
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::set_traction(const Side &side, const Loads<dim> &given)
  {
    // Tractions have to be linear on a side for the stresses to balance them,
    // so each is replaced by the linear one with the same moments.
    const SideTraction<dim> traction = side_traction<dim>(
      [&](const dealii::Point<dim> &point) {
        return given.traction(side.id, point, side.normal);
      },
      side.corners);
    // What that leaves out is estimated apart, by Lambda of a rectangle as wide
    // as the side and as high as the cell: dim |Q| / |I| is the height of a
    // simplex.
    if (traction.rest > 0.)
      {
        loads_are_exact = false;
        load_rests.push_back({side.cell,
                              side.measure * traction.rest,
                              side.diameter,
                              dim * side.cell->measure() / side.measure});
      }
    for (unsigned int k = 0; k < dim; ++k)
      for (unsigned int d = 0; d < dim; ++d)
        loads_on_sides(side.first_unknown + dim * k + d) +=
          side.measure / dim *
          (traction.at_corners[k] * directions(side.first_unknown)[d]);
  }



  DEBOND_INSTANTIATE(check_supports);
  DEBOND_INSTANTIATE_CLASS(EquilibriumMesh);
} // namespace Debond
