// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <debond/contact/field_value.h>
#include <debond/elasticity/equilibrium_problem.h>
#include <debond/elasticity/linear_simplex.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <type_traits>

namespace Debond
{
  namespace
  {
    template <int dim>
    using CellOf = typename dealii::Triangulation<dim>::cell_iterator;

    using Triangle = CellOf<2>;

    /// Of geometry and loads, relative.
    constexpr double equilibrium_rounding = 1e-10;

    template <int dim>
    constexpr unsigned int unknowns_of_a_side =
      EquilibriumElement<dim>::unknowns_of_a_side;



    /// Of a LinearStress, and at one of its corners.
    template <int dim>
    constexpr unsigned int n_of_part = LinearStress<dim>::RowsAtCompileTime;

    template <int dim>
    constexpr unsigned int n_at_corner =
      dealii::SymmetricTensor<2, dim>::n_independent_components;



    /// The corner after @p vertex, counterclockwise, and the one after that.
    std::array<unsigned int, 2>
    others(const Triangle &cell, const unsigned int vertex)
    {
      unsigned int k = 0;
      while (cell->vertex_index(k) != vertex)
        ++k;
      const std::array<unsigned int, 2> next = {
        {cell->vertex_index((k + 1) % 3), cell->vertex_index((k + 2) % 3)}};
      if (LinearSimplex<2>(cell).volume < 0.)
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
      unsigned int corner = others(cells[0], vertex)[0];
      for (unsigned int i = 0; i < 4; ++i)
        for (const Triangle &cell : cells)
          if (const auto pair = others(cell, vertex);
              pair[0] == corner && result.size() == i)
            {
              result.emplace_back(corner, cell);
              corner = pair[1];
            }
      if (result.size() != 4 || corner != result[0].first)
        return {};

      const std::vector<dealii::Point<2>> &points = mesh.get_vertices();
      const dealii::Point<2>              &centre = points[vertex];
      const auto is_centre = [&](const unsigned int a, const unsigned int b) {
        const dealii::Tensor<1, 2> from = points[result[a].first] - centre;
        const dealii::Tensor<1, 2> to   = centre - points[result[b].first];
        return (from - to).norm() <= equilibrium_rounding * from.norm();
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



    template <int dim>
    dealii::Tensor<1, dim>
    values(const dealii::Function<dim> &function,
           const dealii::Point<dim>    &point)
    {
      dealii::Tensor<1, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = field_value(function, point, d);
      return result;
    }



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



    /// Of a point of the cell.
    template <int dim>
    std::array<double, dim + 1>
    barycentric_of(const LinearSimplex<dim> &simplex,
                   const CellOf<dim>        &cell,
                   const dealii::Point<dim> &point)
    {
      std::array<double, dim + 1> result;
      for (unsigned int v = 0; v <= dim; ++v)
        result[v] = 1. + simplex.gradients[v] * (point - cell->vertex(v));
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



    /// A point of a side with the part of it that belongs to it.
    template <int dim>
    struct SidePoint
    {
      std::array<double, dim> barycentric;
      double                  weight;
    };



    /// Many of them, in which no load can hide that is not linear.
    std::vector<SidePoint<2>>
    points_of_side(std::integral_constant<int, 2>)
    {
      constexpr unsigned int    parts = 16;
      const dealii::QGauss<1>   rule(3);
      std::vector<SidePoint<2>> result;
      for (unsigned int part = 0; part < parts; ++part)
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double t = (part + rule.point(q)[0]) / parts;
            result.push_back({{{1. - t, t}}, rule.weight(q) / parts});
          }
      return result;
    }



    std::vector<SidePoint<3>>
    points_of_side(std::integral_constant<int, 3>)
    {
      constexpr unsigned int         parts = 4;
      const dealii::QGaussSimplex<2> rule(3);
      std::vector<SidePoint<3>>      result;
      const auto add = [&](const double x, const double y, const double size) {
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double a = x + size * rule.point(q)[0];
            const double b = y + size * rule.point(q)[1];
            result.push_back(
              {{{1. - a - b, a, b}}, 2. * size * size * rule.weight(q)});
          }
      };
      for (unsigned int i = 0; i < parts; ++i)
        for (unsigned int j = 0; j < parts - i; ++j)
          {
            add(1. * i / parts, 1. * j / parts, 1. / parts);
            if (i + j + 1 < parts)
              add((i + 1.) / parts, (j + 1.) / parts, -1. / parts);
          }
      return result;
    }



    /// The values at the corners of the linear function that has the same
    /// moments.
    template <int dim>
    std::array<dealii::Tensor<1, dim>, dim>
    linear_part(const std::vector<SidePoint<dim>>         &points,
                const std::vector<dealii::Tensor<1, dim>> &values)
    {
      std::array<dealii::Tensor<1, dim>, dim> result;
      for (unsigned int q = 0; q < points.size(); ++q)
        for (unsigned int k = 0; k < dim; ++k)
          // The function that is orthogonal to the other coordinates.
          result[k] += points[q].weight * dim *
                       ((dim + 1) * points[q].barycentric[k] - 1.) * values[q];
      return result;
    }



    /// The work-conjugates of a side's unknowns, relative to its length or
    /// area, of a linear traction with these values at the corners: vector by
    /// vector, see EquilibriumElement.
    std::array<dealii::Tensor<1, 2>, 2>
    conjugates(const std::array<dealii::Tensor<1, 2>, 2> &at_corners)
    {
      return {{0.5 * (at_corners[0] + at_corners[1]),
               (at_corners[1] - at_corners[0]) / 6.}};
    }



    std::array<dealii::Tensor<1, 3>, 3>
    conjugates(const std::array<dealii::Tensor<1, 3>, 3> &at_corners)
    {
      return {{at_corners[0] / 3., at_corners[1] / 3., at_corners[2] / 3.}};
    }



    /// The unknowns of a side of a displacement, vector by vector.
    std::array<dealii::Tensor<1, 2>, 2>
    side_unknowns(const CellDisplacement<2>::OnSide &u)
    {
      return {{1. / 3. * (u[0] + u[1] + u[2]), 0.5 * (u[1] - u[0])}};
    }



    std::array<dealii::Tensor<1, 3>, 3>
    side_unknowns(const CellDisplacement<3>::OnSide &u)
    {
      dealii::Tensor<1, 3> sum;
      for (const dealii::Tensor<1, 3> &coefficient : u)
        sum += coefficient;
      std::array<dealii::Tensor<1, 3>, 3> result;
      // 3 int lambda_k of the basis is 3/10 of the corner, 1/5 of the edges
      // that meet there, and 1/10 of the others.
      for (unsigned int k = 0; k < 3; ++k)
        {
          result[k] = sum + 2. * u[k];
          for (unsigned int e = 0; e < 3; ++e)
            if (simplex_edges[e][0] == k || simplex_edges[e][1] == k)
              result[k] += u[3 + e];
          result[k] *= 0.1;
        }
      return result;
    }
  } // namespace



  template <int dim>
  EquilibriumProblem<dim>::EquilibriumProblem(
    const dealii::Triangulation<dim> &mesh,
    const BoundaryConditions         &conditions,
    const Supports<dim>              &supports,
    const ByRegion<Material>         &materials,
    const Loads<dim>                 &loads,
    const std::vector<double>        &thermal_stresses)
    : mesh(mesh)
    , materials(materials)
    , thermal_stresses(thermal_stresses)
  {
    if (!supports.gaps.empty())
      throw EquilibriumError("an initial gap is not done");
    find_elements();
    make_elements(loads);
    exact_loads = exact_loads && is_temperature_exact(loads);
    make_sides();
    fix_sides(conditions, supports, loads);
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::find_parallelograms(
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
            places.emplace_back();
            for (const auto &[corner, cell] : corners)
              {
                places.back().vertices.push_back(corner);
                places.back().cells.push_back(cell);
                is_taken[cell->active_cell_index()] = 1;
              }
          }
      }
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::find_elements()
  {
    std::vector<char> is_taken(mesh.n_active_cells(), 0);
    find_parallelograms(is_taken);
    for (const auto &cell : mesh.active_cell_iterators())
      if (is_taken[cell->active_cell_index()] == 0)
        {
          places.emplace_back();
          for (unsigned int v = 0; v <= dim; ++v)
            places.back().vertices.push_back(cell->vertex_index(v));
          if (LinearSimplex<dim>(cell).volume < 0.)
            std::swap(places.back().vertices[dim - 1],
                      places.back().vertices[dim]);
          places.back().cells.assign(dim + 1, cell);
        }
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::make_elements(const Loads<dim> &loads)
  {
    const dealii::QGaussSimplex<dim> rule(2);
    // The last ones that were no copies.
    constexpr unsigned int   most_distinct = 64;
    std::deque<unsigned int> distinct;
    for (Place &place : places)
      {
        std::vector<dealii::Point<dim>> corners;
        for (const unsigned int vertex : place.vertices)
          corners.push_back(mesh.get_vertices()[vertex]);
        if (loads.body_force)
          {
            // The mean, and how far the values are from it.
            std::vector<dealii::Tensor<1, dim>> forces;
            double                              largest = 0.;
            const unsigned int n_cells = place.parts_of_a_cell() > 1. ? 1 : 4;
            for (unsigned int i = 0; i < n_cells; ++i)
              for (unsigned int q = 0; q < rule.size(); ++q)
                {
                  forces.push_back(
                    values(*loads.body_force,
                           point_of<dim>(place.cells[i], rule.point(q))));
                  largest = std::max(largest, forces.back().norm());
                }
            // All points have the same weight, in all parts of the element.
            for (const dealii::Tensor<1, dim> &force : forces)
              place.body_force += force / static_cast<double>(forces.size());
            for (const dealii::Tensor<1, dim> &force : forces)
              exact_loads = exact_loads && (force - place.body_force).norm() <=
                                             equilibrium_rounding * largest;
          }
        const Material &material = materials(place.cells[0]->material_id());
        const double    p        = thermal_stress(place.cells[0]);
        const auto      same     = std::find_if(
          distinct.begin(), distinct.end(), [&](const unsigned int other) {
            return is_moved(all_elements[other].corners, corners) &&
                   &materials(places[other].cells[0]->material_id()) ==
                     &material &&
                   places[other].body_force == place.body_force &&
                   thermal_stress(places[other].cells[0]) == p;
          });
        if (same != distinct.end())
          all_elements.push_back(all_elements[*same].moved_to(corners));
        else
          {
            distinct.push_back(static_cast<unsigned int>(all_elements.size()));
            if (distinct.size() > most_distinct)
              distinct.pop_front();
            all_elements.emplace_back(corners, material, place.body_force, p);
          }
      }
  }



  template <int dim>
  bool
  EquilibriumProblem<dim>::is_temperature_exact(const Loads<dim> &loads) const
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
            equilibrium_rounding * std::max(std::abs(largest), std::abs(least)))
          return false;
      }
    return true;
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::make_sides()
  {
    std::map<std::array<unsigned int, dim>, unsigned int> numbers;
    for (Place &place : places)
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
            numbers.emplace(sorted, static_cast<unsigned int>(sides.size()));
          if (is_new)
            sides.push_back({sorted, dealii::unit_symmetric_tensor<dim>()});
          place.sides.push_back(entry->second);
        }
    is_fixed.assign(unknowns_of_a_side<dim> * sides.size(), 0);
    loads_on_sides = Eigen::VectorXd::Zero(is_fixed.size());
  }



  template <int dim>
  std::array<dealii::Point<dim>, dim>
  EquilibriumProblem<dim>::corners(
    const std::array<unsigned int, dim> &side_vertices) const
  {
    std::array<dealii::Point<dim>, dim> result;
    for (unsigned int k = 0; k < dim; ++k)
      result[k] = mesh.get_vertices()[side_vertices[k]];
    return result;
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::fix_sides(const BoundaryConditions &conditions,
                                     const Supports<dim>      &supports,
                                     const Loads<dim>         &loads)
  {
    for (unsigned int element = 0; element < places.size(); ++element)
      for (unsigned int i = 0; i < places[element].sides.size(); ++i)
        {
          const Cell        &cell   = places[element].cells[i];
          const unsigned int number = places[element].sides[i];
          Side              &side   = sides[number];
          const unsigned int face   = face_with<dim>(cell, side.vertices);
          if (!cell->face(face)->at_boundary())
            continue;

          const dealii::types::boundary_id id = cell->face(face)->boundary_id();
          const dealii::Tensor<1, dim>     outward =
            scaled_normal<dim>(corners(places[element].side(i)));
          const double                 measure = outward.norm();
          const dealii::Tensor<1, dim> normal  = outward / measure;

          const auto fix = [&](const unsigned int direction) {
            for (unsigned int k = 0; k < dim; ++k)
              is_fixed[unknowns_of_a_side<dim> * number + dim * k + direction] =
                1;
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
                      for (const unsigned int vertex : side.vertices)
                        if (field_value(*support.values,
                                        mesh.get_vertices()[vertex],
                                        d) != 0.)
                          throw EquilibriumError(
                            "a prescribed displacement "
                            "that is not zero is not done");
                      fix(d);
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
                                     static_cast<unsigned int>(
                                       cell->active_cell_index()),
                                     cell->material_id(),
                                     {}};
              for (unsigned int k = 0; k < dim; ++k)
                contact.unknowns[k] =
                  unknowns_of_a_side<dim> * number + dim * k;
              sides_in_contact.push_back(contact);
            }
          const auto traction = loads.tractions.find(id);
          if (traction != loads.tractions.end())
            add_tractions(number, *traction->second);
        }
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::add_tractions(const unsigned int           number,
                                         const dealii::Function<dim> &traction)
  {
    static const std::vector<SidePoint<dim>> points =
      points_of_side(std::integral_constant<int, dim>());
    const Side                         &side = sides[number];
    const auto                          at   = corners(side.vertices);
    std::vector<dealii::Tensor<1, dim>> tractions;
    double                              largest = 0.;
    for (const SidePoint<dim> &point : points)
      {
        dealii::Point<dim> place;
        for (unsigned int k = 0; k < dim; ++k)
          place += point.barycentric[k] * at[k];
        tractions.push_back(values(traction, place));
        largest = std::max(largest, tractions.back().norm());
      }
    const auto linear = linear_part<dim>(points, tractions);
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        dealii::Tensor<1, dim> rest = tractions[q];
        for (unsigned int k = 0; k < dim; ++k)
          rest -= points[q].barycentric[k] * linear[k];
        exact_loads =
          exact_loads && rest.norm() <= equilibrium_rounding * largest;
      }
    const double measure = scaled_normal<dim>(at).norm();
    const auto   moments = conjugates(linear);
    for (unsigned int k = 0; k < dim; ++k)
      for (unsigned int d = 0; d < dim; ++d)
        loads_on_sides(unknowns_of_a_side<dim> * number + dim * k + d) +=
          measure * (moments[k] * side.directions[d]);
  }



  template <int dim>
  const std::vector<EquilibriumElement<dim>> &
  EquilibriumProblem<dim>::elements() const
  {
    return all_elements;
  }



  template <int dim>
  const std::vector<typename EquilibriumProblem<dim>::ContactSide> &
  EquilibriumProblem<dim>::contact_sides() const
  {
    return sides_in_contact;
  }



  template <int dim>
  const std::vector<dealii::Point<dim>> &
  EquilibriumProblem<dim>::vertices() const
  {
    return mesh.get_vertices();
  }



  template <int dim>
  void
  EquilibriumProblem<dim>::fix(const unsigned int unknown)
  {
    is_fixed[unknown] = 1;
  }



  template <int dim>
  unsigned int
  EquilibriumProblem<dim>::n_unknowns() const
  {
    return static_cast<unsigned int>(
      std::count(is_fixed.begin(), is_fixed.end(), 0));
  }



  template <int dim>
  bool
  EquilibriumProblem<dim>::loads_are_exact() const
  {
    return exact_loads;
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::thermal_stress(const Cell &cell) const
  {
    return thermal_stresses.empty() ?
             0. :
             thermal_stresses[cell->active_cell_index()];
  }



  template <int dim>
  std::vector<unsigned int>
  EquilibriumProblem<dim>::unknowns_of(const unsigned int element) const
  {
    std::vector<unsigned int> result;
    for (const unsigned int side : places[element].sides)
      for (unsigned int k = 0; k < unknowns_of_a_side<dim>; ++k)
        result.push_back(unknowns_of_a_side<dim> * side + k);
    return result;
  }



  template <int dim>
  Eigen::MatrixXd
  EquilibriumProblem<dim>::to_element(const unsigned int element) const
  {
    constexpr unsigned int n     = unknowns_of_a_side<dim>;
    const Place           &place = places[element];
    Eigen::MatrixXd        result =
      Eigen::MatrixXd::Zero(n * place.sides.size(), n * place.sides.size());
    for (unsigned int i = 0; i < place.sides.size(); ++i)
      for (unsigned int k = 0; k < dim; ++k)
        {
          // In 2D the mean is that of the side, and the slope may have the
          // other sign.
          const unsigned int position = place.positions[i][k];
          const unsigned int own      = dim == 2 ? k : position;
          const double sign = dim == 2 && k != position && k == 1 ? -1. : 1.;
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int j = 0; j < dim; ++j)
              result(n * i + dim * k + d, n * i + dim * own + j) =
                sign * sides[place.sides[i]].directions[j][d];
        }
    return result;
  }



  template <int dim>
  std::unique_ptr<Condensation>
  EquilibriumProblem<dim>::condense(
    const bool                                          keep_all,
    const std::vector<double>                          &weights,
    const std::vector<std::pair<unsigned int, double>> &added) const
  {
    const unsigned int n = static_cast<unsigned int>(is_fixed.size());
    dealii::DynamicSparsityPattern entries(n);
    for (unsigned int element = 0; element < places.size(); ++element)
      {
        const std::vector<unsigned int> unknowns = unknowns_of(element);
        for (const unsigned int row : unknowns)
          entries.add_entries(row, unknowns.begin(), unknowns.end());
      }
    dealii::SparsityPattern pattern;
    pattern.copy_from(entries);
    dealii::SparseMatrix<double> K(pattern);
    DofVector                    f(n);
    double                       constant = 0.;
    for (unsigned int element = 0; element < places.size(); ++element)
      {
        const EquilibriumElement<dim> &own = all_elements[element];
        const double          weight = weights.empty() ? 1. : weights[element];
        const Eigen::MatrixXd turn   = to_element(element);
        const Eigen::MatrixXd matrix =
          weight * (turn.transpose() * own.K * turn);
        const Eigen::VectorXd           load     = turn.transpose() * own.F;
        const std::vector<unsigned int> unknowns = unknowns_of(element);
        for (unsigned int i = 0; i < unknowns.size(); ++i)
          {
            f(unknowns[i]) += load(i);
            for (unsigned int j = 0; j < unknowns.size(); ++j)
              K.add(unknowns[i],
                    unknowns[j],
                    0.5 * (matrix(i, j) + matrix(j, i)));
          }
        constant += own.constant / weight;
      }
    for (unsigned int i = 0; i < n; ++i)
      f(i) += loads_on_sides(i);

    std::vector<unsigned int> kept;
    for (unsigned int k = 0; k < (keep_all ? dim : 1); ++k)
      for (const ContactSide &side : sides_in_contact)
        kept.push_back(side.unknowns[k]);
    for (const auto &[unknown, value] : added)
      K.add(unknown, unknown, value);
    return std::make_unique<Condensation>(
      K,
      f,
      kept,
      [this](const unsigned int i) { return is_fixed[i] != 0; },
      OtherParts{{}, {}, [constant](const double, const double) {
                   return constant;
                 }});
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::elastic_functional(
    const std::vector<CellDisplacement<dim>> &u) const
  {
    double sum = 0.;
    for (const double energy : strain_energies(u))
      sum += 0.5 * energy;
    for (const auto &cell : mesh.active_cell_iterators())
      if (const double p = thermal_stress(cell); p != 0.)
        {
          const CellDisplacement<dim> &own = u[cell->active_cell_index()];
          const BernsteinSimplex<dim>  simplex(cell, own.degree);
          for (unsigned int q = 0; q < simplex.n_points; ++q)
            sum -= std::abs(simplex.weight) * p *
                   trace(own.strain(simplex, simplex.point(q)));
        }
    for (const Place &place : places)
      for (unsigned int i = 0; i < place.sides.size(); ++i)
        {
          const CellDisplacement<dim> &own =
            u[place.cells[i]->active_cell_index()];
          const double volume =
            std::abs(LinearSimplex<dim>(place.cells[i]).volume) /
            place.parts_of_a_cell();
          sum -= volume * (place.body_force * own.mean());

          // Only sides of the boundary have loads.
          const Side &side = sides[place.sides[i]];
          const auto  l    = side_unknowns(own.on_side(side.vertices));
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int d = 0; d < dim; ++d)
              sum -= loads_on_sides(unknowns_of_a_side<dim> * place.sides[i] +
                                    dim * k + d) *
                     (l[k] * side.directions[d]);
        }
    return sum;
  }



  template <int dim>
  std::vector<double>
  EquilibriumProblem<dim>::strain_energies(
    const std::vector<CellDisplacement<dim>> &u) const
  {
    std::vector<double> result;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        const CellDisplacement<dim> &own = u[cell->active_cell_index()];
        const BernsteinSimplex<dim>  simplex(cell, own.degree);
        const auto                   C =
          materials(cell->material_id()).template elasticity_tensor<dim>();
        result.push_back(0.);
        for (unsigned int q = 0; q < simplex.n_points; ++q)
          {
            const dealii::SymmetricTensor<2, dim> epsilon =
              own.strain(simplex, simplex.point(q));
            result.back() +=
              std::abs(simplex.weight) * (epsilon * (C * epsilon));
          }
      }
    return result;
  }



  template <int dim>
  std::vector<double>
  EquilibriumProblem<dim>::element_energies(
    const std::vector<CellDisplacement<dim>> &u) const
  {
    const std::vector<double> of_cells = strain_energies(u);
    std::vector<double>       result;
    for (const Place &place : places)
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
  Eigen::VectorXd
  EquilibriumProblem<dim>::stress_of(const unsigned int element,
                                     const DofVector   &unknowns,
                                     const double       weight) const
  {
    const std::vector<unsigned int> numbers = unknowns_of(element);
    Eigen::VectorXd                 own(numbers.size());
    for (unsigned int i = 0; i < numbers.size(); ++i)
      own(i) = unknowns(numbers[i]);
    return all_elements[element].stress(to_element(element) * own, weight);
  }



  template <int dim>
  std::vector<double>
  EquilibriumProblem<dim>::constitutive_gaps(
    const std::vector<CellDisplacement<dim>> &u,
    const DofVector                          &unknowns) const
  {
    std::vector<double> gaps(mesh.n_active_cells(), 0.);
    for (unsigned int element = 0; element < places.size(); ++element)
      {
        const Place                   &place  = places[element];
        const EquilibriumElement<dim> &shape  = all_elements[element];
        const Eigen::VectorXd          stress = stress_of(element, unknowns);
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          {
            const Cell                  &cell = place.cells[i];
            const CellDisplacement<dim> &own  = u[cell->active_cell_index()];
            const BernsteinSimplex<dim>  simplex(cell, own.degree);
            const Material &material = materials(cell->material_id());
            const auto      local    = corners_of_side<dim>(
              static_cast<unsigned int>(place.vertices.size()), i);
            // Linear, as both stresses are.
            LinearStress<dim> difference =
              stress.segment<n_of_part<dim>>(n_of_part<dim> * i);
            for (unsigned int corner = 0; corner <= dim; ++corner)
              {
                const dealii::Point<dim> &point =
                  corner < dim ? shape.corners[local[corner]] : shape.centre;
                const dealii::SymmetricTensor<2, dim> elastic =
                  material.template elasticity_tensor<dim>() *
                  own.strain(simplex,
                             barycentric_of<dim>(simplex, cell, point));
                for (unsigned int k = 0; k < n_at_corner<dim>; ++k)
                  difference(n_at_corner<dim> * corner + k) -=
                    elastic.access_raw_entry(k) -
                    (k < dim ? thermal_stress(cell) : 0.);
              }
            // A cell's parts have the same measure.
            gaps[cell->active_cell_index()] +=
              0.5 * complementary_energy<dim>(difference,
                                              std::abs(simplex.volume) /
                                                place.parts_of_a_cell(),
                                              material);
          }
      }
    return gaps;
  }



  template <int dim>
  double
  EquilibriumProblem<dim>::rounding_of(const Condensation        &condensed,
                                       const Eigen::VectorXd     &kept,
                                       const std::vector<double> &weights) const
  {
    const DofVector unknowns = condensed.expand(kept);
    double          energy   = 0.;
    for (unsigned int element = 0; element < places.size(); ++element)
      {
        const Place          &place  = places[element];
        const double          weight = weights.empty() ? 1. : weights[element];
        const Eigen::VectorXd stress = stress_of(element, unknowns, weight);
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          {
            const Cell       &cell = place.cells[i];
            LinearStress<dim> total =
              stress.segment<n_of_part<dim>>(n_of_part<dim> * i);
            for (unsigned int corner = 0; corner <= dim; ++corner)
              total.template segment<dim>(n_at_corner<dim> * corner).array() +=
                thermal_stress(cell);
            energy +=
              0.5 / weight *
              complementary_energy<dim>(total,
                                        std::abs(
                                          LinearSimplex<dim>(cell).volume) /
                                          place.parts_of_a_cell(),
                                        materials(cell->material_id()));
          }
      }
    const auto S = condensed.schur_complement();
    // It may be more at other displacements.
    return 4. * std::abs(condensed.energy_at_zero() - 0.5 * kept.dot(S * kept) +
                         energy);
  }



  template <int dim>
  std::vector<dealii::SymmetricTensor<2, dim>>
  EquilibriumProblem<dim>::mean_stresses(const DofVector &unknowns) const
  {
    std::vector<dealii::SymmetricTensor<2, dim>> result(mesh.n_active_cells());
    for (unsigned int element = 0; element < places.size(); ++element)
      {
        const Place          &place  = places[element];
        const Eigen::VectorXd stress = stress_of(element, unknowns);
        const double          share  = (dim + 1.) * place.parts_of_a_cell();
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
