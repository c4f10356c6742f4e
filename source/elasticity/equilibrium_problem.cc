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

namespace Debond
{
  namespace
  {
    using Triangle = dealii::Triangulation<2>::cell_iterator;

    /// Of geometry and loads, relative.
    constexpr double equilibrium_rounding = 1e-10;

    constexpr unsigned int unknowns_of_a_side = 4;



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



    /// Of a point of the reference triangle.
    dealii::Point<2>
    point_of(const Triangle &cell, const dealii::Point<2> &reference)
    {
      return dealii::Point<2>(
        cell->vertex(0) + reference[0] * (cell->vertex(1) - cell->vertex(0)) +
        reference[1] * (cell->vertex(2) - cell->vertex(0)));
    }



    /// The face of the cell with these vertices.
    unsigned int
    face_between(const Triangle                    &cell,
                 const std::array<unsigned int, 2> &vertices)
    {
      for (const unsigned int face : cell->face_indices())
        {
          const unsigned int a = cell->face(face)->vertex_index(0);
          const unsigned int b = cell->face(face)->vertex_index(1);
          if (std::min(a, b) == vertices[0] && std::max(a, b) == vertices[1])
            return face;
        }
      throw std::logic_error("The cell has no such face.");
    }



    std::vector<double>
    values(const dealii::Function<2> &function, const dealii::Point<2> &point)
    {
      return {field_value(function, point, 0), field_value(function, point, 1)};
    }



    /// Whether both are the same polygon at different places, but for the
    /// rounding of coordinates.
    bool
    is_moved(const std::vector<dealii::Point<2>> &one,
             const std::vector<dealii::Point<2>> &other)
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
    std::array<double, 3>
    barycentric_of(const LinearSimplex<2> &simplex,
                   const Triangle         &cell,
                   const dealii::Point<2> &point)
    {
      std::array<double, 3> result;
      for (unsigned int v = 0; v < 3; ++v)
        result[v] = 1. + simplex.gradients[v] * (point - cell->vertex(v));
      return result;
    }
  } // namespace



  EquilibriumProblem::EquilibriumProblem(
    const dealii::Triangulation<2> &mesh,
    const BoundaryConditions       &conditions,
    const Supports<2>              &supports,
    const ByRegion<Material>       &materials,
    const Loads<2>                 &loads,
    const std::vector<double>      &thermal_stresses)
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



  void
  EquilibriumProblem::find_elements()
  {
    std::vector<std::vector<Triangle>> cells_at(mesh.n_vertices());
    for (const auto &cell : mesh.active_cell_iterators())
      for (unsigned int v = 0; v < 3; ++v)
        cells_at[cell->vertex_index(v)].push_back(cell);

    std::vector<char> is_taken(mesh.n_active_cells(), 0);
    for (unsigned int vertex = 0; vertex < mesh.n_vertices(); ++vertex)
      {
        const auto corners = parallelogram(mesh, vertex, cells_at[vertex]);
        const bool is_free =
          !corners.empty() &&
          std::all_of(corners.begin(), corners.end(), [&](const auto &corner) {
            const Triangle &cell = corner.second;
            return is_taken[cell->active_cell_index()] == 0 &&
                   cell->material_id() == corners[0].second->material_id() &&
                   thermal_stress(cell) == thermal_stress(corners[0].second);
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
    for (const auto &cell : mesh.active_cell_iterators())
      if (is_taken[cell->active_cell_index()] == 0)
        {
          const auto [second, third] = others(cell, cell->vertex_index(0));
          places.push_back(
            {{static_cast<unsigned int>(cell->vertex_index(0)), second, third},
             {cell, cell, cell},
             {},
             {},
             {}});
        }
  }



  void
  EquilibriumProblem::make_elements(const Loads<2> &loads)
  {
    const dealii::QGaussSimplex<2> rule(2);
    // The last ones that were no copies.
    constexpr unsigned int   most_distinct = 64;
    std::deque<unsigned int> distinct;
    for (Place &place : places)
      {
        std::vector<dealii::Point<2>> corners;
        for (const unsigned int vertex : place.vertices)
          corners.push_back(mesh.get_vertices()[vertex]);
        if (loads.body_force)
          {
            // The mean, and how far the values are from it.
            std::vector<dealii::Tensor<1, 2>> forces;
            double                            largest = 0.;
            for (unsigned int i = 0; i < (corners.size() == 3 ? 1 : 4); ++i)
              for (unsigned int q = 0; q < rule.size(); ++q)
                {
                  const dealii::Point<2> point =
                    point_of(place.cells[i], rule.point(q));
                  const auto value = values(*loads.body_force, point);
                  forces.emplace_back(
                    dealii::Tensor<1, 2>({value[0], value[1]}));
                  largest = std::max(largest, forces.back().norm());
                }
            // All points have the same weight, in all parts of the element.
            for (const dealii::Tensor<1, 2> &force : forces)
              place.body_force += force / static_cast<double>(forces.size());
            for (const dealii::Tensor<1, 2> &force : forces)
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



  bool
  EquilibriumProblem::is_temperature_exact(const Loads<2> &loads) const
  {
    if (!loads.temperature_change)
      return true;
    const dealii::QGaussSimplex<2> rule(2);
    for (const auto &cell : mesh.active_cell_iterators())
      {
        double least   = std::numeric_limits<double>::infinity();
        double largest = -least;
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double value = field_value(*loads.temperature_change,
                                             point_of(cell, rule.point(q)));
            least              = std::min(least, value);
            largest            = std::max(largest, value);
          }
        if (largest - least >
            equilibrium_rounding * std::max(std::abs(largest), std::abs(least)))
          return false;
      }
    return true;
  }



  void
  EquilibriumProblem::make_sides()
  {
    std::map<std::array<unsigned int, 2>, unsigned int> numbers;
    for (Place &place : places)
      for (unsigned int i = 0; i < place.vertices.size(); ++i)
        {
          std::array<unsigned int, 2> ends = {
            {place.vertices[i],
             place.vertices[(i + 1) % place.vertices.size()]}};
          place.is_reversed.push_back(ends[1] < ends[0] ? 1 : 0);
          std::sort(ends.begin(), ends.end());
          const auto [entry, is_new] =
            numbers.emplace(ends, static_cast<unsigned int>(sides.size()));
          if (is_new)
            sides.push_back({ends, dealii::unit_symmetric_tensor<2>()});
          place.sides.push_back(entry->second);
        }
    is_fixed.assign(unknowns_of_a_side * sides.size(), 0);
    loads_on_sides = Eigen::VectorXd::Zero(is_fixed.size());
  }



  void
  EquilibriumProblem::fix_sides(const BoundaryConditions &conditions,
                                const Supports<2>        &supports,
                                const Loads<2>           &loads)
  {
    for (unsigned int element = 0; element < places.size(); ++element)
      for (unsigned int i = 0; i < places[element].sides.size(); ++i)
        {
          const Triangle    &cell   = places[element].cells[i];
          const unsigned int number = places[element].sides[i];
          Side              &side   = sides[number];
          const unsigned int face   = face_between(cell, side.vertices);
          if (!cell->face(face)->at_boundary())
            continue;

          const dealii::types::boundary_id id = cell->face(face)->boundary_id();
          const auto                      &points = mesh.get_vertices();
          const dealii::Tensor<1, 2>       along =
            points[side.vertices[1]] - points[side.vertices[0]];
          const double length = along.norm();
          const double sign   = places[element].is_reversed[i] != 0 ? -1. : 1.;
          const dealii::Tensor<1, 2> normal(
            {sign * along[1] / length, -sign * along[0] / length});

          const auto fix = [&](const unsigned int direction) {
            is_fixed[unknowns_of_a_side * number + direction]     = 1;
            is_fixed[unknowns_of_a_side * number + 2 + direction] = 1;
          };
          const auto use_normal = [&]() {
            side.directions[0] = normal;
            side.directions[1] = dealii::Tensor<1, 2>({-normal[1], normal[0]});
          };
          bool is_supported = false;
          for (const PrescribedDisplacement<2> &support :
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
                for (unsigned int d = 0; d < 2; ++d)
                  if (!support.is_roller && support.components[d])
                    {
                      for (const unsigned int vertex : side.vertices)
                        if (field_value(*support.values, points[vertex], d) !=
                            0.)
                          throw EquilibriumError(
                            "a prescribed displacement "
                            "that is not zero is not done");
                      fix(d);
                    }
              }
          if (conditions.clamped.count(id) > 0)
            {
              fix(0);
              fix(1);
            }
          if (conditions.contact.count(id) > 0)
            {
              if (is_supported)
                throw EquilibriumError(
                  "a contact boundary with supports is not done");
              use_normal();
              if (conditions.fixes_tangential(id))
                fix(1);
              sides_in_contact.push_back(
                {{{points[side.vertices[0]], points[side.vertices[1]]}},
                 side.vertices,
                 normal,
                 length,
                 element,
                 static_cast<unsigned int>(cell->active_cell_index()),
                 cell->material_id(),
                 unknowns_of_a_side * number,
                 unknowns_of_a_side * number + 2});
            }
          const auto traction = loads.tractions.find(id);
          if (traction != loads.tractions.end())
            add_tractions(number, *traction->second);
        }
  }



  void
  EquilibriumProblem::add_tractions(const unsigned int         number,
                                    const dealii::Function<2> &traction)
  {
    constexpr unsigned int            parts = 16;
    const dealii::QGauss<1>           rule(3);
    const Side                       &side   = sides[number];
    const auto                       &points = mesh.get_vertices();
    const dealii::Point<2>           &a      = points[side.vertices[0]];
    const dealii::Tensor<1, 2>        along  = points[side.vertices[1]] - a;
    std::vector<double>               xi;
    std::vector<dealii::Tensor<1, 2>> tractions;
    dealii::Tensor<1, 2>              mean, slope;
    double                            largest = 0.;
    for (unsigned int part = 0; part < parts; ++part)
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          const double t      = (part + rule.point(q)[0]) / parts;
          const double weight = rule.weight(q) / parts;
          const auto value = values(traction, dealii::Point<2>(a + t * along));
          xi.push_back(2. * t - 1.);
          tractions.emplace_back(dealii::Tensor<1, 2>({value[0], value[1]}));
          mean += weight * tractions.back();
          slope += weight * 3. * xi.back() * tractions.back();
          largest = std::max(largest, tractions.back().norm());
        }
    for (unsigned int q = 0; q < xi.size(); ++q)
      exact_loads =
        exact_loads && (tractions[q] - mean - xi[q] * slope).norm() <=
                         equilibrium_rounding * largest;
    const double length = along.norm();
    for (unsigned int d = 0; d < 2; ++d)
      {
        const unsigned int first = unknowns_of_a_side * number + d;
        loads_on_sides(first) += length * (mean * side.directions[d]);
        loads_on_sides(first + 2) += length / 3. * (slope * side.directions[d]);
      }
  }



  const std::vector<EquilibriumElement> &
  EquilibriumProblem::elements() const
  {
    return all_elements;
  }



  const std::vector<EquilibriumProblem::ContactSide> &
  EquilibriumProblem::contact_sides() const
  {
    return sides_in_contact;
  }



  const std::vector<dealii::Point<2>> &
  EquilibriumProblem::vertices() const
  {
    return mesh.get_vertices();
  }



  void
  EquilibriumProblem::fix(const unsigned int unknown)
  {
    is_fixed[unknown] = 1;
  }



  unsigned int
  EquilibriumProblem::n_unknowns() const
  {
    return static_cast<unsigned int>(
      std::count(is_fixed.begin(), is_fixed.end(), 0));
  }



  bool
  EquilibriumProblem::loads_are_exact() const
  {
    return exact_loads;
  }



  double
  EquilibriumProblem::thermal_stress(const Triangle &cell) const
  {
    return thermal_stresses.empty() ?
             0. :
             thermal_stresses[cell->active_cell_index()];
  }



  std::vector<unsigned int>
  EquilibriumProblem::unknowns_of(const unsigned int element) const
  {
    std::vector<unsigned int> result;
    for (const unsigned int side : places[element].sides)
      for (unsigned int k = 0; k < unknowns_of_a_side; ++k)
        result.push_back(unknowns_of_a_side * side + k);
    return result;
  }



  Eigen::MatrixXd
  EquilibriumProblem::to_element(const unsigned int element) const
  {
    const Place    &place = places[element];
    Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(4 * place.sides.size(), 4 * place.sides.size());
    for (unsigned int i = 0; i < place.sides.size(); ++i)
      {
        const auto  &directions = sides[place.sides[i]].directions;
        const double sign       = place.is_reversed[i] != 0 ? -1. : 1.;
        for (unsigned int d = 0; d < 2; ++d)
          for (unsigned int k = 0; k < 2; ++k)
            {
              result(4 * i + d, 4 * i + k)         = directions[k][d];
              result(4 * i + 2 + d, 4 * i + 2 + k) = sign * directions[k][d];
            }
      }
    return result;
  }



  std::unique_ptr<Condensation>
  EquilibriumProblem::condense(
    const bool                                          keep_slopes,
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
        const EquilibriumElement &own = all_elements[element];
        const double          weight  = weights.empty() ? 1. : weights[element];
        const Eigen::MatrixXd turn    = to_element(element);
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
    for (const ContactSide &side : sides_in_contact)
      kept.push_back(side.mean);
    if (keep_slopes)
      for (const ContactSide &side : sides_in_contact)
        kept.push_back(side.slope);
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



  double
  EquilibriumProblem::elastic_functional(
    const std::vector<CellDisplacement> &u) const
  {
    double sum = 0.;
    for (const double energy : strain_energies(u))
      sum += 0.5 * energy;
    for (const auto &cell : mesh.active_cell_iterators())
      if (const double p = thermal_stress(cell); p != 0.)
        {
          const CellDisplacement   &own = u[cell->active_cell_index()];
          const BernsteinSimplex<2> simplex(cell, own.degree);
          for (unsigned int q = 0; q < simplex.n_points; ++q)
            sum -= std::abs(simplex.weight) * p *
                   trace(own.strain(simplex, simplex.point(q)));
        }
    for (const Place &place : places)
      for (unsigned int i = 0; i < place.sides.size(); ++i)
        {
          const CellDisplacement &own = u[place.cells[i]->active_cell_index()];
          const double            area =
            std::abs(LinearSimplex<2>(place.cells[i]).volume) /
            (place.vertices.size() == 3 ? 3. : 1.);
          sum -= area * (place.body_force * own.mean());

          // Only sides of the boundary have loads.
          const Side &side                 = sides[place.sides[i]];
          const auto [first, middle, last] = own.on_side(side.vertices);
          for (unsigned int d = 0; d < 2; ++d)
            {
              const unsigned int k = unknowns_of_a_side * place.sides[i] + d;
              const dealii::Tensor<1, 2> direction = side.directions[d];
              sum -= loads_on_sides(k) / 6. *
                       ((first + 4. * middle + last) * direction) +
                     loads_on_sides(k + 2) / 2. * ((last - first) * direction);
            }
        }
    return sum;
  }



  std::vector<double>
  EquilibriumProblem::strain_energies(
    const std::vector<CellDisplacement> &u) const
  {
    std::vector<double> result;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        const CellDisplacement   &own = u[cell->active_cell_index()];
        const BernsteinSimplex<2> simplex(cell, own.degree);
        const auto C = materials(cell->material_id()).elasticity_tensor<2>();
        result.push_back(0.);
        for (unsigned int q = 0; q < simplex.n_points; ++q)
          {
            const dealii::SymmetricTensor<2, 2> epsilon =
              own.strain(simplex, simplex.point(q));
            result.back() +=
              std::abs(simplex.weight) * (epsilon * (C * epsilon));
          }
      }
    return result;
  }



  std::vector<double>
  EquilibriumProblem::element_energies(
    const std::vector<CellDisplacement> &u) const
  {
    const std::vector<double> of_cells = strain_energies(u);
    std::vector<double>       result;
    for (const Place &place : places)
      {
        // All three of a triangle are the same one.
        const unsigned int n   = place.vertices.size() == 3 ? 1 : 4;
        double             sum = 0.;
        for (unsigned int i = 0; i < n; ++i)
          sum += of_cells[place.cells[i]->active_cell_index()];
        result.push_back(sum);
      }
    return result;
  }



  Eigen::VectorXd
  EquilibriumProblem::stress_of(const unsigned int element,
                                const DofVector   &unknowns,
                                const double       weight) const
  {
    const std::vector<unsigned int> numbers = unknowns_of(element);
    Eigen::VectorXd                 own(numbers.size());
    for (unsigned int i = 0; i < numbers.size(); ++i)
      own(i) = unknowns(numbers[i]);
    return all_elements[element].stress(to_element(element) * own, weight);
  }



  std::vector<double>
  EquilibriumProblem::constitutive_gaps(const std::vector<CellDisplacement> &u,
                                        const DofVector &unknowns) const
  {
    std::vector<double> gaps(mesh.n_active_cells(), 0.);
    for (unsigned int element = 0; element < places.size(); ++element)
      {
        const Place              &place  = places[element];
        const EquilibriumElement &shape  = all_elements[element];
        const Eigen::VectorXd     stress = stress_of(element, unknowns);
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          {
            const Triangle           &cell = place.cells[i];
            const CellDisplacement   &own  = u[cell->active_cell_index()];
            const BernsteinSimplex<2> simplex(cell, own.degree);
            const Material           &material = materials(cell->material_id());
            const dealii::Point<2>    points[] = {
                 shape.corners[i],
                 shape.corners[(i + 1) % shape.corners.size()],
                 shape.centre};
            // Linear, as both stresses are.
            Eigen::Matrix<double, 9, 1> difference = stress.segment<9>(9 * i);
            for (unsigned int corner = 0; corner < 3; ++corner)
              {
                const dealii::SymmetricTensor<2, 2> elastic =
                  material.elasticity_tensor<2>() *
                  own.strain(simplex,
                             barycentric_of(simplex, cell, points[corner]));
                difference.segment<3>(3 * corner) -=
                  Eigen::Vector3d(elastic[0][0] - thermal_stress(cell),
                                  elastic[1][1] - thermal_stress(cell),
                                  elastic[0][1]);
              }
            // A triangle's three parts have the same area.
            const double area =
              std::abs(simplex.volume) / (place.vertices.size() == 3 ? 3. : 1.);
            gaps[cell->active_cell_index()] +=
              0.5 * complementary_energy(difference, area, material);
          }
      }
    return gaps;
  }



  double
  EquilibriumProblem::rounding_of(const Condensation        &condensed,
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
        const double          share  = place.vertices.size() == 3 ? 3. : 1.;
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          {
            const Triangle             &cell  = place.cells[i];
            Eigen::Matrix<double, 9, 1> total = stress.segment<9>(9 * i);
            for (unsigned int corner = 0; corner < 3; ++corner)
              total.segment<2>(3 * corner).array() += thermal_stress(cell);
            energy +=
              0.5 / weight *
              complementary_energy(total,
                                   std::abs(LinearSimplex<2>(cell).volume) /
                                     share,
                                   materials(cell->material_id()));
          }
      }
    const auto S = condensed.schur_complement();
    // It may be more at other displacements.
    return 4. * std::abs(condensed.energy_at_zero() - 0.5 * kept.dot(S * kept) +
                         energy);
  }



  std::vector<dealii::SymmetricTensor<2, 2>>
  EquilibriumProblem::mean_stresses(const DofVector &unknowns) const
  {
    std::vector<dealii::SymmetricTensor<2, 2>> result(mesh.n_active_cells());
    for (unsigned int element = 0; element < places.size(); ++element)
      {
        const Place          &place  = places[element];
        const Eigen::VectorXd stress = stress_of(element, unknowns);
        const double          share  = place.vertices.size() == 3 ? 9. : 3.;
        for (unsigned int i = 0; i < place.cells.size(); ++i)
          for (unsigned int k = 9 * i; k < 9 * (i + 1); k += 3)
            {
              auto &mean = result[place.cells[i]->active_cell_index()];
              mean[0][0] += stress(k) / share;
              mean[1][1] += stress(k + 1) / share;
              mean[0][1] += stress(k + 2) / share;
            }
      }
    return result;
  }
} // namespace Debond
