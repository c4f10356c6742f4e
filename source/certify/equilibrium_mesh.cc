// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/certify/equilibrium_mesh.h>
#include <debond/certify/side_moments.h>
#include <debond/contact/field_value.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

namespace Debond
{
  namespace
  {
    template <int dim>
    using CellOf = typename dealii::Triangulation<dim>::cell_iterator;

    using Triangle = CellOf<2>;

    /// Of parallelograms, relative.
    constexpr double shape_rounding = 1e-10;

    /// Of body forces and temperatures in an element, relative.
    constexpr double load_rounding = 1e-10;



    /// The corner after @p vertex, counterclockwise, and the one after that.
    std::array<unsigned int, 2>
    others(const Triangle &cell, const unsigned int vertex)
    {
      unsigned int k = 0;
      while (cell->vertex_index(k) != vertex)
        ++k;
      const std::array<unsigned int, 2> next = {
        {cell->vertex_index((k + 1) % 3), cell->vertex_index((k + 2) % 3)}};
      const dealii::Tensor<1, 2> one   = cell->vertex(1) - cell->vertex(0);
      const dealii::Tensor<1, 2> other = cell->vertex(2) - cell->vertex(0);
      if (one[0] * other[1] < one[1] * other[0])
        return {{next[1], next[0]}};
      return next;
    }



    /// The corners around a vertex if its cells are the four triangles of a
    /// parallelogram, and the cells in their order; empty if they are not.
    std::vector<std::pair<unsigned int, Triangle>>
    parallelogram(const dealii::Triangulation<2> &mesh,
                  const unsigned int              vertex,
                  const std::vector<Triangle>    &cells)
    {
      std::vector<std::pair<unsigned int, Triangle>> result;
      if (cells.size() != 4)
        return result;
      std::array<std::array<unsigned int, 2>, 4> pairs;
      for (unsigned int i = 0; i < 4; ++i)
        pairs[i] = others(cells[i], vertex);
      unsigned int corner = pairs[0][0];
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int k = 0; k < 4; ++k)
          if (pairs[k][0] == corner && result.size() == i)
            {
              result.emplace_back(corner, cells[k]);
              corner = pairs[k][1];
            }
      if (result.size() != 4 || corner != result[0].first)
        return {};

      const std::vector<dealii::Point<2>> &points = mesh.get_vertices();
      const dealii::Point<2>              &centre = points[vertex];
      const auto is_centre = [&](const unsigned int a, const unsigned int b) {
        const dealii::Tensor<1, 2> from = points[result[a].first] - centre;
        const dealii::Tensor<1, 2> to   = centre - points[result[b].first];
        return (from - to).norm() <= shape_rounding * from.norm();
      };
      if (!is_centre(0, 2) || !is_centre(1, 3))
        return {};
      return result;
    }



    /// Of a point of the reference simplex.
    template <int dim>
    dealii::Point<dim>
    point_of(const CellOf<dim> &cell, const dealii::Point<dim> &reference)
    {
      dealii::Point<dim> point = cell->vertex(0);
      for (unsigned int d = 0; d < dim; ++d)
        point += reference[d] * (cell->vertex(d + 1) - cell->vertex(0));
      return point;
    }



    /// The face of the cell with these vertices, which are sorted.
    template <int dim>
    unsigned int
    face_with(const CellOf<dim>                   &cell,
              const std::array<unsigned int, dim> &vertices)
    {
      for (const unsigned int face : cell->face_indices())
        {
          std::array<unsigned int, dim> own;
          for (unsigned int k = 0; k < dim; ++k)
            own[k] = cell->face(face)->vertex_index(k);
          std::sort(own.begin(), own.end());
          if (own == vertices)
            return face;
        }
      throw std::logic_error("The cell has no such face.");
    }



    /// The unknowns of a side, see EquilibriumElement, of a linear function
    /// with these values at the corners.
    std::array<double, 2>
    unknowns_of_linear(const std::array<double, 2> &values)
    {
      return {{0.5 * (values[0] + values[1]), 0.5 * (values[1] - values[0])}};
    }



    std::array<double, 3>
    unknowns_of_linear(const std::array<double, 3> &values)
    {
      const double          sum = values[0] + values[1] + values[2];
      std::array<double, 3> result;
      for (unsigned int k = 0; k < 3; ++k)
        result[k] = 0.25 * (sum + values[k]);
      return result;
    }



    /// The unit vectors of a side with this normal: the normal first.
    dealii::Tensor<2, 2>
    normal_frame(const dealii::Tensor<1, 2> &normal)
    {
      dealii::Tensor<2, 2> rows;
      rows[0] = normal;
      rows[1] = dealii::Tensor<1, 2>({-normal[1], normal[0]});
      return rows;
    }



    dealii::Tensor<2, 3>
    normal_frame(const dealii::Tensor<1, 3> &normal)
    {
      // Across the axis that the normal is farthest from.
      unsigned int axis = 0;
      for (unsigned int d = 1; d < 3; ++d)
        if (std::abs(normal[d]) < std::abs(normal[axis]))
          axis = d;
      dealii::Tensor<1, 3> unit;
      unit[axis] = 1.;
      dealii::Tensor<2, 3> rows;
      rows[0] = normal;
      rows[1] = dealii::cross_product_3d(normal, unit);
      rows[1] /= rows[1].norm();
      rows[2] = dealii::cross_product_3d(normal, rows[1]);
      return rows;
    }
  } // namespace



  template <int dim>
  EquilibriumMesh<dim>::EquilibriumMesh(
    const dealii::Triangulation<dim> &mesh,
    const BoundaryConditions         &conditions,
    const Supports<dim>              &supports,
    const Loads<dim>                 &given_loads,
    const std::vector<double>        &thermal_stresses)
    : mesh(mesh)
    , thermal_stresses(thermal_stresses)
  {
    find_elements();
    if (given_loads.body_force)
      find_body_forces(given_loads);
    exact_loads = exact_loads && is_temperature_exact(given_loads);
    make_sides();
    fix_sides(conditions, supports, given_loads);
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::find_parallelograms(
    [[maybe_unused]] std::vector<char> &is_taken)
  {
    if constexpr (dim == 2)
      {
        std::vector<std::vector<Triangle>> cells_at(mesh.n_vertices());
        for (const auto &cell : mesh.active_cell_iterators())
          for (unsigned int v = 0; v < 3; ++v)
            cells_at[cell->vertex_index(v)].push_back(cell);

        for (unsigned int vertex = 0; vertex < mesh.n_vertices(); ++vertex)
          {
            const auto corners = parallelogram(mesh, vertex, cells_at[vertex]);
            const bool is_free =
              !corners.empty() &&
              std::all_of(corners.begin(),
                          corners.end(),
                          [&](const auto &corner) {
                            const Triangle &cell = corner.second;
                            return is_taken[cell->active_cell_index()] == 0 &&
                                   cell->material_id() ==
                                     corners[0].second->material_id() &&
                                   thermal_stress(cell) ==
                                     thermal_stress(corners[0].second);
                          });
            if (!is_free)
              continue;
            all_places.emplace_back();
            for (const auto &[corner, cell] : corners)
              {
                all_places.back().vertices.push_back(corner);
                all_places.back().cells.push_back(cell);
                is_taken[cell->active_cell_index()] = 1;
              }
          }
      }
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::find_elements()
  {
    std::vector<char> is_taken(mesh.n_active_cells(), 0);
    find_parallelograms(is_taken);
    for (const auto &cell : mesh.active_cell_iterators())
      if (is_taken[cell->active_cell_index()] == 0)
        {
          all_places.emplace_back();
          for (unsigned int v = 0; v <= dim; ++v)
            all_places.back().vertices.push_back(cell->vertex_index(v));
          all_places.back().cells.assign(dim + 1, cell);
        }
  }


  template <int dim>
  void
  EquilibriumMesh<dim>::find_body_forces(const Loads<dim> &given)
  {
    const dealii::QGaussSimplex<dim> rule(2);
    for (Place &place : all_places)
      {
        // The mean, and how far the values are from it.
        std::vector<dealii::Tensor<1, dim>> forces;
        double                              largest = 0.;
        const unsigned int n_cells = place.parts_of_a_cell() > 1. ? 1 : 4;
        for (unsigned int i = 0; i < n_cells; ++i)
          for (unsigned int q = 0; q < rule.size(); ++q)
            {
              forces.push_back(
                given.force_at(point_of<dim>(place.cells[i], rule.point(q))));
              largest = std::max(largest, forces.back().norm());
            }
        // All points have the same weight, in all parts of the element.
        for (const dealii::Tensor<1, dim> &value : forces)
          place.body_force += value / static_cast<double>(forces.size());
        for (const dealii::Tensor<1, dim> &value : forces)
          exact_loads = exact_loads && (value - place.body_force).norm() <=
                                         load_rounding * largest;
      }
  }



  template <int dim>
  bool
  EquilibriumMesh<dim>::is_temperature_exact(const Loads<dim> &loads) const
  {
    if (!loads.temperature_change)
      return true;
    const dealii::QGaussSimplex<dim> rule(2);
    for (const auto &cell : mesh.active_cell_iterators())
      {
        double least   = std::numeric_limits<double>::infinity();
        double largest = -least;
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double value =
              field_value(*loads.temperature_change,
                          point_of<dim>(cell, rule.point(q)));
            least   = std::min(least, value);
            largest = std::max(largest, value);
          }
        if (largest - least >
            load_rounding * std::max(std::abs(largest), std::abs(least)))
          return false;
      }
    return true;
  }


  template <int dim>
  void
  EquilibriumMesh<dim>::make_sides()
  {
    struct Hash
    {
      std::size_t
      operator()(const std::array<unsigned int, dim> &key) const
      {
        std::size_t hash = 0;
        for (const unsigned int entry : key)
          hash = (hash ^ entry) * 0x9e3779b97f4a7c15;
        return hash;
      }
    };
    std::unordered_map<std::array<unsigned int, dim>, unsigned int, Hash>
      numbers;
    for (Place &place : all_places)
      for (unsigned int i = 0; i < place.vertices.size(); ++i)
        {
          const std::array<unsigned int, dim> own    = place.side(i);
          std::array<unsigned int, dim>       sorted = own;
          std::sort(sorted.begin(), sorted.end());
          place.positions.emplace_back();
          for (unsigned int k = 0; k < dim; ++k)
            place.positions.back()[k] = static_cast<unsigned int>(
              std::find(sorted.begin(), sorted.end(), own[k]) - sorted.begin());
          const auto [entry, is_new] =
            numbers.emplace(sorted,
                            static_cast<unsigned int>(all_sides.size()));
          if (is_new)
            all_sides.push_back({sorted, dealii::unit_symmetric_tensor<dim>()});
          place.sides.push_back(entry->second);
        }
    fixed.assign(unknowns_of_a_side * all_sides.size(), 0);
    loads = prescribed = Eigen::VectorXd::Zero(fixed.size());
  }



  template <int dim>
  std::array<double, dim>
  EquilibriumMesh<dim>::linear_values(
    const dealii::Function<dim>         &function,
    const unsigned int                   component,
    const std::array<unsigned int, dim> &side_vertices)
  {
    const std::array<dealii::Point<dim>, dim> points = corners(side_vertices);
    std::array<double, dim>                   values;
    double                                    largest = 0.;
    for (unsigned int k = 0; k < dim; ++k)
      {
        values[k] = field_value(function, points[k], component);
        largest   = std::max(largest, std::abs(values[k]));
      }
    for (unsigned int k = 0; k < dim; ++k)
      for (unsigned int l = 0; l < k; ++l)
        {
          const double middle =
            field_value(function,
                        dealii::Point<dim>(0.5 * (points[k] + points[l])),
                        component);
          exact_loads =
            exact_loads && std::abs(middle - 0.5 * (values[k] + values[l])) <=
                             load_rounding * largest;
        }
    return values;
  }



  template <int dim>
  std::array<dealii::Point<dim>, dim>
  EquilibriumMesh<dim>::corners(
    const std::array<unsigned int, dim> &side_vertices) const
  {
    std::array<dealii::Point<dim>, dim> result;
    for (unsigned int k = 0; k < dim; ++k)
      result[k] = mesh.get_vertices()[side_vertices[k]];
    return result;
  }



  template <int dim>
  void
  EquilibriumMesh<dim>::fix_sides(const BoundaryConditions &conditions,
                                  const Supports<dim>      &supports,
                                  const Loads<dim>         &given)
  {
    for (unsigned int element = 0; element < all_places.size(); ++element)
      for (unsigned int i = 0; i < all_places[element].sides.size(); ++i)
        {
          const Cell        &cell   = all_places[element].cells[i];
          const unsigned int number = all_places[element].sides[i];
          Side              &side   = all_sides[number];
          const unsigned int face   = face_with<dim>(cell, side.vertices);
          if (!cell->face(face)->at_boundary())
            continue;

          const dealii::types::boundary_id id = cell->face(face)->boundary_id();
          const dealii::Tensor<1, dim>     outward =
            scaled_normal<dim>(corners(all_places[element].side(i)));
          const double                 measure = outward.norm();
          const dealii::Tensor<1, dim> normal  = outward / measure;

          const auto fix = [&](const unsigned int direction) {
            for (unsigned int k = 0; k < dim; ++k)
              fixed[unknowns_of_a_side * number + dim * k + direction] = 1;
          };
          const auto prescribe = [&](const unsigned int             direction,
                                     const std::array<double, dim> &values) {
            const std::array<double, dim> own = unknowns_of_linear(values);
            for (unsigned int k = 0; k < dim; ++k)
              prescribed(unknowns_of_a_side * number + dim * k + direction) =
                own[k];
          };
          const auto use_normal = [&]() {
            side.directions = normal_frame(normal);
          };
          bool is_supported = false;
          for (const PrescribedDisplacement<dim> &support :
               supports.displacements)
            if (support.boundaries.count(id) > 0)
              {
                if (is_supported)
                  throw EquilibriumError("a piece of the boundary with several "
                                         "supports is not done");
                is_supported = true;
                if (support.is_roller)
                  {
                    use_normal();
                    fix(0);
                  }
                for (unsigned int d = 0; d < dim; ++d)
                  if (!support.is_roller && support.components[d])
                    {
                      fix(d);
                      prescribe(
                        d, linear_values(*support.values, d, side.vertices));
                    }
              }
          if (conditions.clamped.count(id) > 0)
            for (unsigned int d = 0; d < dim; ++d)
              fix(d);
          if (conditions.contact.count(id) > 0)
            {
              if (is_supported)
                throw EquilibriumError(
                  "a contact boundary with supports is not done");
              use_normal();
              if (conditions.fixes_tangential(id))
                for (unsigned int d = 1; d < dim; ++d)
                  fix(d);
              ContactSide contact = {corners(side.vertices),
                                     side.vertices,
                                     normal,
                                     measure,
                                     element,
                                     cell,
                                     cell->material_id(),
                                     id,
                                     {},
                                     {}};
              if (const auto gap = supports.gaps.find(id);
                  gap != supports.gaps.end())
                contact.gap =
                  linear_values(*gap->second.value, 0, side.vertices);
              prescribe(0, contact.gap);
              for (unsigned int k = 0; k < dim; ++k)
                contact.unknowns[k] = unknowns_of_a_side * number + dim * k;
              sides_in_contact.push_back(contact);
            }
          if (given.tractions.count(id) > 0)
            {
              const SideTraction<dim> own = side_traction<dim>(
                [&](const dealii::Point<dim> &point) {
                  return given.traction(id, point, normal);
                },
                corners(side.vertices));
              exact_loads = exact_loads && own.rest == 0.;
              if (own.rest > 0.)
                all_rests.push_back({cell,
                                     measure * own.rest,
                                     cell->face(face)->diameter(),
                                     dim * cell->measure() / measure});
              for (unsigned int k = 0; k < dim; ++k)
                for (unsigned int d = 0; d < dim; ++d)
                  loads(unknowns_of_a_side * number + dim * k + d) +=
                    measure * (own.conjugates[k] * side.directions[d]);
            }
        }
  }



  template <int dim>
  std::vector<unsigned int>
  EquilibriumMesh<dim>::unknowns_of(const Place &place) const
  {
    std::vector<unsigned int> result;
    for (const unsigned int side : place.sides)
      for (unsigned int k = 0; k < unknowns_of_a_side; ++k)
        result.push_back(unknowns_of_a_side * side + k);
    return result;
  }



  template <int dim>
  unsigned int
  EquilibriumMesh<dim>::n_free_unknowns() const
  {
    return static_cast<unsigned int>(std::count(fixed.begin(), fixed.end(), 0));
  }



  template class EquilibriumMesh<2>;
  template class EquilibriumMesh<3>;
} // namespace Debond
