// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/rtree.h>

#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/check/error_estimate.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/mesh/cell_search.h>
#include <debond/mesh/field_value.h>
#include <debond/mesh/owned_cells.h>

#include <numeric>
#include <unordered_map>

namespace Debond
{
  namespace
  {
    /// The factor of the estimate of the faces, see doc/notes/accuracy.md.
    template <int dim>
    double
    calibration(const unsigned int degree)
    {
      return degree == 1 ? (dim == 2 ? 0.97 : 2.65) : (dim == 2 ? 0.41 : 1.05);
    }

    /// J that is less than so much of the energy of the stresses is what large
    /// terms leave when they cancel, and no scale for errors.
    constexpr double least_part_of_energy = 0.01;

    /// The mean of b_F over F.
    template <int dim>
    constexpr double mean_on_face = dim == 2 ? 2. / 3. : 9. / 20.;

    /// The mean of b_F^2 over F.
    template <int dim>
    constexpr double mean_square_on_face = dim == 2 ? 8. / 15. : 81. / 280.;

    /// The mean of b_F over a cell, by the one over F.
    constexpr double mean_in_cell = 0.5;



    /// The sum of the squares of the barycentric coordinates' gradients.
    template <int dim>
    double
    sum_of_squares(const SimplexValues<dim> &of_cell)
    {
      double sum = 0.;
      for (unsigned int v = 0; v <= dim; ++v)
        sum += of_cell.barycentric_gradient(v).norm_square();
      return sum;
    }



    /// int_K |grad b_F|^2, which is the same for all faces F of a cell, as its
    /// gradients add up to zero. In 2D that of half a square for all triangles:
    /// stretched ones yield together with their neighbors, for less than the
    /// b_F of one of them takes.
    template <int dim>
    double
    bubble_energy(const SimplexValues<dim> &of_cell)
    {
      return dim == 2 ?
               8. / 3. :
               243. / 140. * of_cell.measure() * sum_of_squares(of_cell);
    }



    /// The fall of J by the product of all barycentric coordinates of a cell,
    /// for a force on it that is constant.
    template <int dim>
    double
    fall_inside(const SimplexValues<dim>              &of_cell,
                const dealii::Tensor<1, dim>          &force,
                const dealii::SymmetricTensor<2, dim> &yield)
    {
      // With b the product of all barycentric coordinates and F the integral of
      // f_0 + div sigma over the cell K, J falls by (mean_K(b) |F|)^2 / (2 mu
      // int_K |grad b|^2). The two integrals are those of monomials in
      // barycentric coordinates.
      const double mean   = dim == 2 ? 1. / 60. : 1. / 840.;
      const double energy = of_cell.measure() * sum_of_squares(of_cell) /
                            (dim == 2 ? 180. : 15120.);
      return 0.5 * mean * mean * (force * (yield * force)) / energy;
    }



    /// The mean square over a face of a linear function with these values at
    /// its vertices; of degree 1 the square of the mean, as no more than means
    /// are known.
    template <typename Value, std::size_t n>
    double
    mean_square(const std::array<Value, n> &values, const unsigned int degree)
    {
      // The mass matrix of n linear functions on a simplex has 2 / (n (n + 1))
      // on its diagonal and half of it elsewhere, for a measure of one.
      double squares = 0.;
      Value  sum     = values[0];
      for (unsigned int v = 0; v < n; ++v)
        {
          squares += values[v] * values[v];
          if (v > 0)
            sum += values[v];
        }
      return degree == 1 ? (sum * sum) / double(n * n) :
                           (squares + sum * sum) / (n * (n + 1.));
    }



    /// The tractions that do not fit, cell by cell.
    template <int dim>
    class Residuals
    {
    public:
      Residuals(const EstimatedProblem<dim> &given,
                const DofVector             &u,
                const LoadFactors            factors)
        : given(given)
        , degree(given.problem.unknowns().degree())
        , boundary(given.problem.unknowns().contact().boundary())
        , symmetry(given.problem.unknowns().symmetry())
        , s(given.problem.unknowns().contact().trace(u))
        , load_factor(factors.loads)
        , heat_factor(given.problem.fields().heat_factor(factors))
        , temperature_change(given.loads.temperature_change ?
                               given.loads.temperature_change :
                               given.dead_loads.temperature_change)
        , has_volume_loads(given.loads.body_force ||
                           given.dead_loads.body_force || temperature_change)
        , largest_s(s.template lpNorm<Eigen::Infinity>())
        , n_stresses(degree == 2 || temperature_change ? dim + 1 : 1)
        , displacement(
            given.problem.unknowns().cartesian_displacement(u, factors))
        , at_points(given.problem.fields(),
                    displacement,
                    factors,
                    strain_rule<dim>(degree))
        , fe(1)
        , at_loads(fe, dealii::QGaussSimplex<dim>(2), Symmetry::none)
        , on_face(given.problem.unknowns().mapping(),
                  fe,
                  face_rule<dim>(1),
                  dealii::update_values | dealii::update_quadrature_points |
                    dealii::update_normal_vectors | dealii::update_JxW_values)
      {
        // One pass over the cells: each cell adds its stresses and its force,
        // and then its faces. An inner face is added from that of its cells
        // which comes later, when both have their stresses. So nothing but a
        // few numbers of each cell is kept.
        const auto        &dofs = given.problem.unknowns().dof_handler();
        const unsigned int n    = dofs.get_triangulation().n_active_cells();
        cells.reserve(n);
        stresses.reserve(std::size_t(n) * n_stresses);
        parts.assign(n, 0.);
        // Contact faces of a cell follow each other. The loop runs downwards,
        // so that the first one of each cell is what remains. Those on the high
        // side of an interface can be found by their place, for the faces of
        // the low side have no contact faces of their own.
        std::vector<std::pair<dealii::BoundingBox<dim>, unsigned int>> boxes;
        for (unsigned int f = static_cast<unsigned int>(boundary.faces.size());
             f-- > 0;)
          {
            first_contact_face[boundary.faces[f].cell] = f;
            if (given.conditions.high_sides.count(boundary.faces[f].id) > 0)
              boxes.emplace_back(boundary.faces[f].vertices, f);
          }
        of_interfaces = dealii::pack_rtree(boxes);
        for (const auto &cell : dofs.active_cell_iterators())
          {
            at_points.reinit(cell);
            add_cell(cell);
            // Of cells of other ranks not all faces are here.
            unsigned int n_contact_faces = 0;
            for (unsigned int f = 0; f <= dim; ++f)
              if (cell->neighbor_index(f) < 0)
                {
                  if (cell->is_locally_owned())
                    add_boundary_face(cell, f, n_contact_faces);
                }
              else if (const auto neighbor = cell->neighbor(f);
                       neighbor->active_cell_index() <
                       cell->active_cell_index())
                add_inner_face(cell, f, neighbor);
          }
      }

      /// The parts of the cells in the fall of J.
      std::vector<double> parts;

      /// The energy of these stresses in own cells.
      double stress_energy = 0.;

    private:
      /// The numbers that the next cells need of one that is done.
      struct DoneCell
      {
        double lambda_and_2_mu;

        /// Times the identity 1 / mu, what yields to forces.
        dealii::SymmetricTensor<2, dim> yield;
        double                          bubble_energy;

        /// int_K (f_0 + div sigma), of which faces bear their share; of degree
        /// 2 zero, for there fall_inside() has it.
        dealii::Tensor<1, dim> force;
      };

      /// A stress, and its pressure.
      struct Stress
      {
        dealii::SymmetricTensor<2, dim> whole;
        double                          pressure;
      };

      struct Face
      {
        unsigned int           cell;
        dealii::Tensor<1, dim> area; ///< the normal times the measure

        /// The numbers of its vertices in the cell, in the order of
        /// ContactBoundary's faces.
        std::array<unsigned int, dim> in_cell;
      };

      /// Of the next cell. Loads are evaluated where load_vector() and
      /// temperature_changes() do it: there they are finite.
      template <typename CellIterator>
      void
      add_cell(const CellIterator &cell)
      {
        const SimplexValues<dim> &of_cell = at_points.values();
        const Material &material = given.problem.fields().material(cell);
        const double    mu       = material.shear_modulus();
        const double    lambda   = material.template lame_lambda<dim>();
        const bool      has_axis = symmetry == Symmetry::axis;
        const double    around =
          has_axis ? circumference(symmetry, cell->center()) : 1.;
        // The trace of the elastic stress over n components is (2 mu + n
        // lambda) div u. So this is the part of it that lambda div u, minus the
        // pressure, is.
        const int    n_traced       = has_axis ? 3 : dim;
        const double part_of_lambda = lambda / (2. * mu + n_traced * lambda);
        cells.push_back(
          {lambda + 2. * mu,
           material.orthotropy ?
             orthotropic_yield(given.problem.fields().solid_tensor(cell)) :
             1. / mu * dealii::unit_symmetric_tensor<dim>(),
           around * bubble_energy(of_cell),
           {}});
        dealii::Tensor<1, dim> &force = cells.back().force;

        std::array<double, dim + 1> heat = {};
        if (has_volume_loads)
          heat = add_volume_loads(cell, force);
        // Strains across a plane body count around an axis only.
        using Stress3    = dealii::SymmetricTensor<2, 3>;
        const auto trace = [has_axis](const Stress3 &of_solid) {
          return has_axis ? dealii::trace(of_solid) :
                            dealii::trace(resized<dim>(of_solid));
        };
        // The stress of degree 1 is constant but for that of the temperature,
        // and of degree 2 it is linear. What is kept of it are its values at
        // the vertices, or one if they are the same.
        const Stress3 &of_heat = given.problem.fields().thermal_stress(cell);
        const double   mean =
          std::accumulate(heat.begin(), heat.end(), 0.) / (dim + 1);
        Stress3      in_middle;
        const double n_points = at_points.values().get_quadrature().size();
        for (const unsigned int q : of_cell.quadrature_point_indices())
          in_middle += 1. / n_points * at_points.stress(q);
        for (unsigned int v = 0; v < n_stresses; ++v)
          {
            // The points of strain_rule() of degree 2 lie on the ways from the
            // middle to the vertices, at this part of each, so that a linear
            // stress is extrapolated to the vertices.
            const Stress3 stress =
              degree == 2 ?
                in_middle + (at_points.stress(v) - in_middle) /
                              (1. - (dim + 1) * near_vertex<dim, double>()) :
                in_middle - (heat[v] - mean) * of_heat;
            // The pressure -lambda div u, with the isotropic part of what the
            // temperature adds to it. Orthotropic materials are estimated
            // without a jump of the pressure.
            const double thermal = heat[v] * trace(of_heat);
            stresses.push_back(
              {resized<dim>(stress),
               material.orthotropy ?
                 0. :
                 thermal / n_traced -
                   part_of_lambda * (trace(stress) + thermal)});
            if (n_stresses > 1)
              force +=
                around * of_cell.measure() *
                (stresses.back().whole * of_cell.barycentric_gradient(v));
          }
        if (has_axis)
          {
            // The rest of the divergence, (sigma_rr - sigma_tt, sigma_rz) / r.
            dealii::Tensor<1, dim> rest;
            for (unsigned int d = 0; d < dim; ++d)
              rest[d] = in_middle[0][d];
            rest[0] -= in_middle[2][2];
            force += around * of_cell.measure() / cell->center()[0] * rest;
          }
        if (degree == 2)
          {
            // Forces are integrals around the axis, while the energy of the
            // cell's bubble is that of a plane cell: hence the quotient by the
            // circumference.
            parts[cell->active_cell_index()] =
              fall_inside(of_cell, force, cells.back().yield) / around;
            force = 0.;
          }

        if (cell->is_locally_owned())
          stress_energy +=
            around * of_cell.measure() * material.energy_density(in_middle);
      }

      /// Adds to the force on a cell. Returns the change of temperature at its
      /// vertices: the linear function with the same mean and moments.
      template <typename CellIterator>
      std::array<double, dim + 1>
      add_volume_loads(const CellIterator &cell, dealii::Tensor<1, dim> &force)
      {
        std::array<double, dim + 1> heat = {};
        at_loads.reinit(*cell);
        for (const unsigned int q : at_loads.quadrature_point_indices())
          {
            const dealii::Point<dim> point = at_loads.quadrature_point(q);
            const double             around =
              at_loads.JxW(q) * circumference(symmetry, point);
            if (given.loads.body_force)
              // The divergence of the linear stress is the sum over the
              // vertices of their stresses times the gradients of their
              // coordinates.
              force += load_factor * around * given.loads.force_at(point);
            if (given.dead_loads.body_force)
              force += around * given.dead_loads.force_at(point);
            if (!temperature_change)
              continue;
            const double change = at_loads.JxW(q) / at_loads.measure() *
                                  heat_factor *
                                  field_value(*temperature_change, point);
            for (unsigned int v = 0; v <= dim; ++v)
              // Moments times the inverse of the mass matrix of linear
              // functions, (d + 1) ((d + 2) I - 1 1') / |K|.
              heat[v] += (dim + 1.) *
                         ((dim + 2.) * at_loads.shape_value(v, q) - 1.) *
                         change;
          }
        return heat;
      }

      /// The stress at a vertex of a cell that is done.
      const Stress &
      stress_at(const unsigned int cell, const unsigned int vertex) const
      {
        return stresses[std::size_t(cell) * n_stresses +
                        std::min(vertex, n_stresses - 1)];
      }

      /// The vertices of each face of a cell: asking ReferenceCell for each of
      /// them takes longer than all the rest.
      static std::array<std::array<unsigned int, dim>, dim + 1>
      make_face_vertices()
      {
        std::array<std::array<unsigned int, dim>, dim + 1> result;
        for (unsigned int f = 0; f <= dim; ++f)
          for (unsigned int v = 0; v < dim; ++v)
            result[f][v] =
              dealii::ReferenceCells::get_simplex<dim>().face_to_cell_vertices(
                f, v, 1);
        return result;
      }

      template <typename CellIterator>
      Face
      face_of(const CellIterator &cell, const unsigned int f) const
      {
        const auto  &in_cell  = face_vertices[f];
        unsigned int opposite = dim * (dim + 1) / 2;
        for (const unsigned int vertex : in_cell)
          opposite -= vertex;
        const double around =
          symmetry == Symmetry::axis ?
            circumference(symmetry, cell->face(f)->center()) :
            1.;
        // The gradient of the opposite vertex' coordinate points into the cell
        // and has the length |F| / (d |K|), so that this is the outward normal
        // times |F|, and around an axis times the circumference.
        return {cell->active_cell_index(),
                -dim * around * at_points.values().measure() *
                  at_points.values().barycentric_gradient(opposite),
                in_cell};
      }

      /// The mean over all directions of a gradient, times what makes it 1 /
      /// mu of an isotropic material with a Poisson ratio of 0.3.
      static dealii::SymmetricTensor<2, dim>
      orthotropic_yield(const dealii::SymmetricTensor<4, 3> &stiffness)
      {
        // The acoustic tensor n.C.n has the mean C_ikjk / d over all directions
        // n. Of an isotropic material it is a multiple of the identity that
        // depends on mu and on the Poisson ratio.
        dealii::SymmetricTensor<2, dim> mean;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = i; j < dim; ++j)
            for (unsigned int k = 0; k < dim; ++k)
              mean[i][j] += stiffness[i][k][j][k] / dim;
        return (dim == 2 ? 1.93 : 1.83) * dealii::invert(mean);
      }

      /// The yield to forces in the direction of the mean of r.
      static double
      along(const std::array<dealii::Tensor<1, dim>, dim> &r,
            const dealii::SymmetricTensor<2, dim>         &yield)
      {
        dealii::Tensor<1, dim> sum;
        for (const dealii::Tensor<1, dim> &value : r)
          sum += value;
        return sum.norm_square() > 0. ?
                 sum * (yield * sum) / sum.norm_square() :
                 dealii::trace(yield) / dim;
      }

      /// The fall of J by r, given the mean square of its product with the
      /// measure of the face.
      static double
      fall(const double square, const double stiffness)
      {
        return 0.5 * mean_on_face<dim> * mean_on_face<dim> * square / stiffness;
      }

      /// @p neighbor is done.
      template <typename CellIterator, typename OtherIterator>
      void
      add_inner_face(const CellIterator  &cell,
                     const unsigned int   f,
                     const OtherIterator &neighbor)
      {
        // The function b_F of the face moves both cells, so that what it takes
        // is the sum of their energies, mu_T int_T |grad b_F|^2 each. The jump
        // of the pressure pushes along the normal and has lambda + 2 mu in
        // place of mu. Each cell has one half of what J falls by.
        const Face         face  = face_of(cell, f);
        const unsigned int other = neighbor->active_cell_index();
        const DoneCell    &here  = cells[face.cell];
        const DoneCell    &there = cells[other];
        const double       a     = here.bubble_energy;
        const double       b     = there.bubble_energy;
        // At the interface of two materials only tractions have no jump.
        const bool is_one_material =
          here.yield == there.yield &&
          here.lambda_and_2_mu == there.lambda_and_2_mu;
        // Linear on the face: r times the measure, without the jumps of the
        // pressure, and these, at its vertices.
        std::array<dealii::Tensor<1, dim>, dim> r;
        std::array<double, dim>                 jumps = {};
        for (unsigned int v = 0; v < dim; ++v)
          {
            const unsigned int own   = face.in_cell[v];
            const unsigned int index = cell->vertex_index(own);
            // The vertex of the neighbour that is the same as this one, if
            // stresses differ from vertex to vertex.
            unsigned int w = 0;
            while (n_stresses > 1 && neighbor->vertex_index(w) != index)
              ++w;
            const Stress &inside  = stress_at(face.cell, own);
            const Stress &outside = stress_at(other, w);
            r[v]                  = (outside.whole - inside.whole) * face.area +
                   mean_in_cell * (here.force + there.force);
            if (is_one_material)
              {
                jumps[v] = inside.pressure - outside.pressure;
                r[v] -= jumps[v] * face.area;
              }
          }
        // Both terms are quotients of the square of int_F r b_F and twice an
        // energy; the area of the face is a factor of r, and of the jumps it is
        // put beside them.
        const double energy =
          fall(mean_square(jumps, degree) * face.area.norm_square(),
               here.lambda_and_2_mu * (a + b)) +
          fall(mean_square(r, degree),
               a / along(r, here.yield) + b / along(r, there.yield));
        parts[face.cell] += 0.5 * energy;
        parts[other] += 0.5 * energy;
      }

      template <typename CellIterator>
      void
      add_boundary_face(const CellIterator &cell,
                        const unsigned int  f,
                        unsigned int       &n_contact_faces)
      {
        const auto id         = cell->face(f)->boundary_id();
        const bool is_contact = given.conditions.contact.count(id) > 0;
        // Those of a cell follow each other.
        const bool   is_low       = given.conditions.low_sides.count(id) > 0;
        unsigned int contact_face = 0;
        if (is_contact && !is_low)
          contact_face =
            first_contact_face.at(cell->id().get_coarse_cell_id()) +
            n_contact_faces++;
        if (given.conditions.clamped.count(id) > 0)
          return;

        const Face      face    = face_of(cell, f);
        const DoneCell &here    = cells[face.cell];
        const double    measure = face.area.norm();
        // The axis is no boundary.
        if (symmetry == Symmetry::axis &&
            measure < Tolerance::rounding_of_data *
                        std::pow(cell->face(f)->measure(), 2))
          return;
        // On the boundary r is the load less sigma n, and on Gamma_C less what
        // bonds and foundation bear, all in force per area, with half of the
        // force of the cell. Loads and bonds may be any functions of the place,
        // so that the mean square, r.r / mu, is integrated by a rule.
        const dealii::Tensor<1, dim> normal = face.area / measure;
        on_face.reinit(typename dealii::Triangulation<dim>::cell_iterator(cell),
                       f);
        double square = 0.;
        for (const unsigned int q : on_face.quadrature_point_indices())
          {
            std::array<double, dim> coordinates;
            for (unsigned int v = 0; v < dim; ++v)
              coordinates[v] = on_face.shape_value(face.in_cell[v], q);
            const dealii::Point<dim> &point = on_face.quadrature_point(q);
            dealii::Tensor<1, dim>    r = mean_in_cell / measure * here.force;
            // With linear displacements the stress of a face is its mean over
            // the vertices.
            for (unsigned int v = 0; v < dim; ++v)
              r -= (degree == 1 ? 1. / dim : coordinates[v]) *
                   (stress_at(face.cell, face.in_cell[v]).whole * normal);
            r += load_factor * given.loads.traction(id, point, normal) +
                 given.dead_loads.traction(id, point, normal);
            if (is_low)
              {
                if (const auto [across, there] = face_across(point, id);
                    across != nullptr)
                  r = with_foundation(r, face, *across, there);
              }
            else if (is_contact)
              r = with_foundation(r,
                                  face,
                                  boundary.faces[contact_face],
                                  coordinates);
            r = free_part(r, normal, id);
            square += on_face.JxW(q) * circumference(symmetry, point) /
                      measure * (r * (here.yield * r));
          }
        parts[face.cell] +=
          fall(square * measure * measure, here.bubble_energy);
      }

      /// The contact face on the high side of an interface that is across from
      /// a point of its low side, a face with this id, and the barycentric
      /// coordinates there; null where nothing is across. What bonds bear is
      /// the same along the normals of both.
      std::pair<const typename ContactBoundary<dim>::Face *,
                std::array<double, dim>>
      face_across(const dealii::Point<dim>        &point,
                  const dealii::types::boundary_id low_id) const
      {
        // Sides of other interfaces may be nearer, beyond a thin ply.
        const auto &interfaces = given.conditions.interfaces;
        const auto  own        = std::find_if(interfaces.begin(),
                                      interfaces.end(),
                                      [low_id](const auto &interface) {
                                        return interface.low.count(low_id) > 0;
                                      });
        const auto  is_across  = [&](const auto &box) {
          return own->high.count(boundary.faces[box.second].id) > 0;
        };
        std::vector<std::pair<dealii::BoundingBox<dim>, unsigned int>> near;
        of_interfaces.query(boost::geometry::index::nearest(point, n_nearest) &&
                              boost::geometry::index::satisfies(is_across),
                            std::back_inserter(near));

        // Boxes of curved sides overlap: that face is taken which is nearest to
        // the point, and there the coordinates of its foot, those in the
        // simplex of the face and a point above its first vertex.
        const typename ContactBoundary<dim>::Face *best = nullptr;
        std::array<double, dim>                    best_place{};
        double                                     least_distance = infinity;
        for (const auto &[unused, f] : near)
          {
            const auto                             &face = boundary.faces[f];
            std::array<dealii::Point<dim>, dim + 1> corners;
            std::copy_n(face.vertices.begin(), dim, corners.begin());
            corners[dim] =
              corners[0] + corners[0].distance(corners[1]) * face.normal;
            const auto all = barycentric_coordinates<dim>(corners, point);
            std::array<double, dim> place;
            std::copy_n(all.begin(), dim, place.begin());
            place[0] += all[dim];
            if (*std::min_element(place.begin(), place.end()) <=
                Tolerance::covered - 1.)
              continue;
            double sum = 0.;
            for (double &coordinate : place)
              sum += coordinate = std::max(coordinate, 0.);
            dealii::Tensor<1, dim> to_foot = -1. * point;
            for (unsigned int v = 0; v < dim; ++v)
              to_foot += (place[v] /= sum) * face.vertices[v];
            if (to_foot.norm() < least_distance)
              {
                least_distance = to_foot.norm();
                best           = &face;
                best_place     = place;
              }
          }
        return {best, best_place};
      }

      /// r with the traction that bonds bear, as far as the foundation lets the
      /// body go.
      dealii::Tensor<1, dim>
      with_foundation(const dealii::Tensor<1, dim>              &r,
                      const Face                                &side,
                      const typename ContactBoundary<dim>::Face &face,
                      const std::array<double, dim> &coordinates) const
      {
        // The residual with the traction of the bonds, j_1', which pulls the
        // body back. If all nodes of the face are in contact, the foundation
        // bears a residual that pushes the body into it, and only one that
        // pulls the body off counts. Displacements of iterative methods may
        // miss contact by a small part of the largest one.
        const double                 measure = side.area.norm();
        const dealii::Tensor<1, dim> normal =
          (side.area * face.normal > 0. ? 1. : -1.) * face.normal;
        const Jump<dim> traction =
          Debond::traction(given.adhesion, face, coordinates, s);
        const ContactPoint<dim> point =
          given.adhesion.points().point_at(face, coordinates);
        const double trace     = point.normal_displacement(s);
        double       r_nu      = r * normal - traction.normal;
        bool         is_closed = true;
        for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
          is_closed =
            is_closed &&
            (face.is_held(k) ||
             s(face.node(k)) >= -Tolerance::estimated_contact * largest_s);
        if (is_closed)
          r_nu = std::min(r_nu, 0.);
        // What yields stretches the bonds too: they add their secant stiffness,
        // force / way, times int_F b_F^2 to the energy of b_F. J falls by the
        // square of r over the energy, so that r is divided by the root of what
        // multiplies the energy.
        const auto stretched = [&](const dealii::Tensor<1, dim> &direction,
                                   const double                  force,
                                   const double                  way) {
          return way == 0. ?
                   1. :
                   std::sqrt(
                     1. + mean_square_on_face<dim> * measure * force /
                            (way * cells[side.cell].bubble_energy) *
                            (direction * (cells[side.cell].yield * direction)));
        };
        r_nu /= stretched(normal, traction.normal, trace);
        if (given.conditions.fixes_tangential(face.id))
          return r_nu * normal;
        // On the low side of an interface bonds pull the other way.
        const double side_of_bonds   = normal * face.normal > 0. ? 1. : -1.;
        dealii::Tensor<1, dim> along = r - (r * normal) * normal;
        if (point.shears())
          {
            const dealii::Tensor<1, dim> slip = point.jump(s).tangential;
            along -= side_of_bonds * traction.tangential;
            if (slip.norm() > 0.)
              along /= stretched(slip / slip.norm(),
                                 traction.tangential.norm(),
                                 slip.norm());
          }
        // Friction balances what it may.
        if (const double size = along.norm(); size > 0.)
          {
            const dealii::Tensor<1, dim> direction = along / size;
            const Interval               friction =
              friction_along(face, coordinates, side_of_bonds * direction);
            along -=
              std::clamp(size, friction.lower, friction.upper) * direction;
          }
        return along + r_nu * normal;
      }

      /// What friction may bear along a face at a place: between its nodes it
      /// is as displacements are.
      Interval
      friction_along(const typename ContactBoundary<dim>::Face &face,
                     const std::array<double, dim>             &coordinates,
                     const dealii::Tensor<1, dim>              &direction) const
      {
        const Kinks &friction = given.adhesion.kinks();
        const auto   shape    = bernstein(coordinates, boundary.degree);
        Interval     sum      = {0., 0.};
        for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
          if (!face.is_held(k))
            {
              const auto            &node  = boundary.nodes[face.node(k)];
              double                 bound = 0.;
              dealii::Tensor<1, dim> way;
              for (const auto &tangent : node.tangents)
                if (!tangent.is_held && friction.has(tangent.index))
                  {
                    bound =
                      friction.weight(tangent.index) * shape[k] / node.measure;
                    way += (s(tangent.index) - friction.place(tangent.index)) *
                           tangent.direction;
                  }
              // What sticks bears up to the bound in any direction.
              const double length = way.norm();
              const double along  = way * direction;
              sum.lower += bound * (length > 0. ? along / length : -1.);
              sum.upper += bound * (length > 0. ? along / length : 1.);
            }
        return sum;
      }

      /// r without the directions that supports hold.
      dealii::Tensor<1, dim>
      free_part(dealii::Tensor<1, dim>           r,
                const dealii::Tensor<1, dim>    &normal,
                const dealii::types::boundary_id id) const
      {
        // A roller holds the normal direction, other supports hold Cartesian
        // components. There the reaction balances any traction.
        for (const PrescribedDisplacement<dim> &held :
             given.supports.displacements)
          if (held.boundaries.count(id) > 0)
            {
              if (held.is_roller)
                r -= (r * normal) * normal;
              else
                for (unsigned int d = 0; d < dim; ++d)
                  if (held.components[d])
                    r[d] = 0.;
            }
        return r;
      }

      const EstimatedProblem<dim> given;
      const unsigned int          degree;
      const ContactBoundary<dim> &boundary;
      const Symmetry              symmetry;
      const Eigen::VectorXd       s;
      const double                load_factor, heat_factor;
      const std::shared_ptr<const dealii::Function<dim>> temperature_change;
      const bool                                         has_volume_loads;
      const double                                       largest_s;
      const unsigned int             n_stresses; ///< that differ in a cell
      const DofVector                displacement;
      CellStresses<dim>              at_points; ///< of strain_rule()
      const dealii::FE_SimplexP<dim> fe;
      SimplexValues<dim>             at_loads;
      dealii::FEFaceValues<dim>      on_face;
      const std::array<std::array<unsigned int, dim>, dim + 1> face_vertices =
        make_face_vertices();
      std::vector<DoneCell> cells;
      std::vector<Stress>   stresses; ///< see stress_at()

      /// Contact faces on interfaces by the boxes around them.
      dealii::RTree<std::pair<dealii::BoundingBox<dim>, unsigned int>>
        of_interfaces;

      /// So many boxes of triangles may contain a point.
      static constexpr unsigned int n_nearest = 12;

      /// The first contact face of each cell that has any.
      std::unordered_map<dealii::types::coarse_cell_id, unsigned int>
        first_contact_face;
    };
  } // namespace



  template <int dim>
  ErrorEstimate
  estimate_error(const EstimatedProblem<dim> &given,
                 const DofVector             &u,
                 const double                 functional,
                 const LoadFactors            factors,
                 const std::optional<double>  error_factor)
  {
    const auto    &dofs  = given.problem.unknowns().dof_handler();
    const MPI_Comm ranks = given.problem.unknowns().communicator();
    std::optional<Residuals<dim>> residuals;
    on_all_ranks(ranks, [&]() { residuals.emplace(given, u, factors); });

    // The calibration is for the sum of all parts. The factor of an
    // AdaptiveLevel multiplies it, and the density of the error with it.
    const double constant =
      calibration<dim>(given.problem.unknowns().degree()) *
      error_factor.value_or(1.);
    ErrorEstimate result;
    result.factor = error_factor;
    result.cells  = std::move(residuals->parts);
    for (double &part : result.cells)
      part *= constant;
    double sum = 0.;
    for (const auto &cell : owned_cells(dofs))
      sum += result.cells[cell->active_cell_index()];
    result.functional = dealii::Utilities::MPI::sum(sum, ranks);
    // J near zero, as a sum of terms that cancel, says nothing about the size
    // of errors; the energy of the stresses takes its place.
    const double stress_energy =
      dealii::Utilities::MPI::sum(residuals->stress_energy, ranks);
    result.is_of_J =
      std::abs(functional) >= least_part_of_energy * stress_energy;
    result.scale = result.is_of_J ? std::abs(functional) : stress_energy;
    return result;
  }



  DEBOND_INSTANTIATE(estimate_error);
} // namespace Debond
