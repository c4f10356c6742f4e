// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>

#include <debond/base/ranks.h>
#include <debond/base/text.h>
#include <debond/check/error_estimate.h>
#include <debond/contact/field_value.h>
#include <debond/mesh/owned_cells.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

namespace Debond
{
  namespace
  {
    /// What the estimate of the faces is multiplied by, see
    /// doc/notes/error-estimate.md.
    template <int dim>
    double
    calibration(const unsigned int degree)
    {
      return degree == 1 ? (dim == 2 ? 0.97 : 2.65) : (dim == 2 ? 0.41 : 1.05);
    }

    /// Beyond this lambda / mu, that of nu = 0.45 in plane strain, the ratio of
    /// estimate and error depends on the mesh.
    constexpr double largest_calibrated_lambda = 9.;

    /// Of the longest edge of a cell to the shortest one, in 3D: three halves
    /// of that of a cube's.
    constexpr double largest_calibrated_stretch = 3.;

    /// J that is less than so much of the energy of the stresses is what large
    /// terms leave.
    constexpr double least_part_of_energy = 0.01;

    /// The mean of b_F over F.
    template <int dim>
    constexpr double mean_on_face = dim == 2 ? 2. / 3. : 9. / 20.;

    /// The mean of b_F^2 over F.
    template <int dim>
    constexpr double mean_square_on_face = dim == 2 ? 8. / 15. : 81. / 280.;

    /// The mean of b_F over a cell, by the one over F.
    constexpr double mean_in_cell = 0.5;



    /// Of the gradients of the barycentric coordinates.
    template <int dim>
    double
    sum_of_squares(const dealii::FEValues<dim> &barycentric)
    {
      double sum = 0.;
      for (const unsigned int v : barycentric.dof_indices())
        sum += barycentric.shape_grad(v, 0).norm_square();
      return sum;
    }



    /// int_K |grad b_F|^2, which is the same for all faces F of a cell, as its
    /// gradients add up to zero. In 2D that of half a square for all triangles:
    /// stretched ones yield together with their neighbors, for less than the
    /// b_F of one of them takes.
    template <int dim>
    double
    bubble_energy(const dealii::FEValues<dim> &barycentric, const double volume)
    {
      return dim == 2 ? 8. / 3. :
                        243. / 140. * volume * sum_of_squares(barycentric);
    }



    /// What J would fall by the product of all barycentric coordinates of a
    /// cell, for a force on it that is constant.
    template <int dim>
    double
    fall_inside(const dealii::FEValues<dim>  &barycentric,
                const double                  volume,
                const dealii::Tensor<1, dim> &force,
                const double                  stiffness)
    {
      const double mean = dim == 2 ? 1. / 60. : 1. / 840.;
      const double energy =
        volume * sum_of_squares(barycentric) / (dim == 2 ? 180. : 15120.);
      return 0.5 * mean * mean * force.norm_square() / (stiffness * energy);
    }



    template <int dim>
    bool
    is_stretched(const std::array<dealii::Point<dim>, dim + 1> &vertices)
    {
      double shortest = std::numeric_limits<double>::infinity();
      double longest  = 0.;
      for (unsigned int v = 1; v <= dim; ++v)
        for (unsigned int w = 0; w < v; ++w)
          {
            const double square = vertices[v].distance_square(vertices[w]);
            shortest            = std::min(shortest, square);
            longest             = std::max(longest, square);
          }
      return longest >
             largest_calibrated_stretch * largest_calibrated_stretch * shortest;
    }



    /// The mean square of a linear function with these values at the vertices
    /// of a face.
    template <typename Value, std::size_t n>
    double
    mean_square(const std::array<Value, n> &values)
    {
      double squares = 0.;
      Value  sum     = values[0];
      for (unsigned int v = 0; v < n; ++v)
        {
          squares += values[v] * values[v];
          if (v > 0)
            sum += values[v];
        }
      return (squares + sum * sum) / (n * (n + 1.));
    }



    /// The middle of a cell, and of degree 2, where stresses are linear, its
    /// vertices.
    template <int dim>
    std::vector<dealii::Point<dim>>
    stress_points(const unsigned int degree)
    {
      std::vector<dealii::Point<dim>> points =
        dealii::QGaussSimplex<dim>(1).get_points();
      const auto cell = dealii::ReferenceCells::get_simplex<dim>();
      if (degree == 2)
        for (const unsigned int v : cell.vertex_indices())
          points.push_back(cell.template vertex<dim>(v));
      return points;
    }



    /// The tractions that do not fit, cell by cell.
    template <int dim>
    class Residuals
    {
    public:
      Residuals(const ElasticProblem<dim>   &problem,
                const AdhesionIntegral<dim> &adhesion,
                const BoundaryConditions    &conditions,
                const Supports<dim>         &supports,
                const Loads<dim>            &loads,
                const DofVector             &u,
                const LoadFactors            factors,
                const Loads<dim>            *dead_loads)
        : degree(problem.unknowns().degree())
        , adhesion(adhesion)
        , boundary(problem.unknowns().contact().boundary())
        , conditions(conditions)
        , supports(supports)
        , loads(loads)
        , s(problem.unknowns().contact().trace(u))
        , dead_loads(dead_loads)
        , load_factor(factors.loads)
        , has_volume_loads(loads.body_force || loads.temperature_change ||
                           (dead_loads != nullptr && dead_loads->body_force))
        , largest_s(s.template lpNorm<Eigen::Infinity>())
        , fe(1)
        , barycentric(problem.unknowns().mapping(),
                      fe,
                      dealii::QGaussSimplex<dim>(has_volume_loads ? 2 : 1),
                      dealii::update_gradients |
                        dealii::update_quadrature_points |
                        dealii::update_JxW_values)
        , on_face(problem.unknowns().mapping(),
                  fe,
                  face_rule<dim>(1),
                  dealii::update_values | dealii::update_quadrature_points |
                    dealii::update_normal_vectors | dealii::update_JxW_values)
      {
        const ElasticFields<dim> &fields = problem.fields();
        const DofVector           displacement =
          problem.unknowns().cartesian_displacement(u, factors);
        const auto        &dofs = problem.unknowns().dof_handler();
        const unsigned int n    = dofs.get_triangulation().n_active_cells();
        cells.reserve(n);
        if (degree == 2)
          linear_stresses.reserve(n);
        if (has_volume_loads)
          volume_loads.reserve(n);
        parts.assign(n, 0.);
        for (unsigned int f = static_cast<unsigned int>(boundary.faces.size());
             f-- > 0;)
          first_contact_face[boundary.faces[f].cell] = f;
        CellStresses<dim> stresses(fields,
                                   displacement,
                                   factors,
                                   stress_points<dim>(degree));
        for (const auto &cell : dofs.active_cell_iterators())
          {
            stresses.reinit(cell);
            barycentric.reinit(
              typename dealii::Triangulation<dim>::cell_iterator(cell));
            volume = 0.;
            for (const unsigned int q : barycentric.quadrature_point_indices())
              volume += barycentric.JxW(q);
            Vertices vertices;
            for (unsigned int v = 0; v <= dim; ++v)
              vertices[v] = cell->vertex(v);
            add_cell(vertices,
                     fields.material(cell),
                     stresses,
                     cell->is_locally_owned());
            // Of cells of other ranks not all faces are here.
            unsigned int n_contact_faces = 0;
            for (unsigned int f = 0; f <= dim; ++f)
              if (cell->neighbor_index(f) < 0)
                {
                  if (cell->is_locally_owned())
                    add_boundary_face(cell, f, vertices, n_contact_faces);
                }
              else if (const auto neighbor = cell->neighbor(f);
                       neighbor->active_cell_index() <
                       cell->active_cell_index())
                add_inner_face(cell, f, vertices, neighbor);
          }
      }

      /// What J would fall, of each cell.
      std::vector<double> parts;

      /// That of an elastic body with these stresses, of own cells.
      double stress_energy = 0.;

      /// What the constant was not measured for.
      bool is_nearly_incompressible = false;
      bool has_stretched_cells      = false;

    private:
      using Vertices = std::array<dealii::Point<dim>, dim + 1>;

      /// What the next cells need of one that is done.
      struct CellStress
      {
        double                          mu;
        double                          lambda;
        double                          part_of_lambda; ///< tr sigma's in eps
        dealii::SymmetricTensor<2, dim> stress;

        /// sigma is what shears minus this times the identity.
        double pressure;

        double bubble_energy;
      };

      struct VolumeLoad
      {
        /// int_K (f_0 + div sigma).
        dealii::Tensor<1, dim> force;

        /// What keeps the cell from expanding, and its gradient.
        double                 thermal_pressure = 0.;
        dealii::Tensor<1, dim> pressure_gradient;

        dealii::Point<dim> middle;
      };

      /// Of degree 2, at the vertices of a cell.
      struct LinearStress
      {
        std::array<dealii::SymmetricTensor<2, dim>, dim + 1> stresses;
        std::array<double, dim + 1>                          pressures;
      };

      struct Face
      {
        unsigned int           cell;
        dealii::Tensor<1, dim> area; ///< the normal times the measure

        /// Of the face, if there are loads in the volume.
        dealii::Point<dim> middle;

        /// The numbers of its vertices in the cell, in the order of
        /// ContactBoundary's faces.
        std::array<unsigned int, dim> in_cell;
      };

      /// Of the next cell; @p stresses: at stress_points().
      void
      add_cell(const Vertices          &vertices,
               const Material          &material,
               const CellStresses<dim> &stresses,
               const bool               is_own)
      {
        const double mu     = material.shear_modulus();
        const double lambda = material.template lame_lambda<dim>();
        CellStress   here   = {mu,
                               lambda,
                               lambda / (2. * mu + dim * lambda),
                               stresses.stress(0),
                               0.,
                               bubble_energy<dim>(barycentric, volume)};
        VolumeLoad   load;
        if (has_volume_loads)
          load = volume_load(vertices, material);
        const double trace = dealii::trace(here.stress);
        here.pressure =
          load.thermal_pressure -
          here.part_of_lambda * (trace + dim * load.thermal_pressure);
        if (degree == 2)
          {
            add_linear_part(vertices, stresses, here.part_of_lambda, load);
            parts[cells.size()] =
              fall_inside<dim>(barycentric, volume, load.force, here.mu);
          }
        if (is_own)
          stress_energy +=
            0.5 * (1. / (2. * mu)) * volume *
            (here.stress * here.stress - here.part_of_lambda * trace * trace);
        is_nearly_incompressible =
          is_nearly_incompressible || lambda > largest_calibrated_lambda * mu;
        has_stretched_cells =
          has_stretched_cells || (dim == 3 && is_stretched<dim>(vertices));
        cells.push_back(here);
        if (has_volume_loads)
          volume_loads.push_back(load);
      }

      /// Loads are evaluated where load_vector() and thermal_stresses() do it:
      /// there they are finite.
      VolumeLoad
      volume_load(const Vertices &vertices, const Material &material) const
      {
        VolumeLoad result;
        for (const dealii::Point<dim> &vertex : vertices)
          result.middle += vertex / (dim + 1.);
        const double stress_of_one =
          loads.temperature_change ?
            load_factor * material.template thermal_stress<dim>() :
            0.;
        for (const unsigned int q : barycentric.quadrature_point_indices())
          {
            const double             weight = barycentric.JxW(q) / volume;
            const dealii::Point<dim> point  = barycentric.quadrature_point(q);
            // The gradients at the vertices times the coordinates.
            dealii::Tensor<1, dim> towards;
            for (unsigned int v = 0; v <= dim; ++v)
              towards +=
                fe.shape_value(v, barycentric.get_quadrature().point(q)) *
                barycentric.shape_grad(v, q);
            const auto add_force = [&](const Loads<dim> &load,
                                       const double      factor) {
              if (load.body_force)
                result.force += factor * weight * volume * load.force_at(point);
            };
            add_force(loads, load_factor);
            if (dead_loads != nullptr)
              add_force(*dead_loads, 1.);
            if (stress_of_one != 0.)
              {
                // The linear function with the same mean and moments.
                const double pressure =
                  stress_of_one * field_value(*loads.temperature_change, point);
                result.thermal_pressure += weight * pressure;
                result.pressure_gradient +=
                  (dim + 1.) * (dim + 2.) * weight * pressure * towards;
              }
          }
        if (degree == 1)
          result.force -= volume * result.pressure_gradient;
        return result;
      }

      /// What varies in a cell, of degree 2, from the stress at its points.
      void
      add_linear_part(const Vertices          &vertices,
                      const CellStresses<dim> &at_points,
                      const double             part_of_lambda,
                      VolumeLoad              &load)
      {
        linear_stresses.emplace_back();
        auto &[stresses, pressures] = linear_stresses.back();
        for (unsigned int v = 0; v <= dim; ++v)
          {
            stresses[v] = at_points.stress(1 + v);
            const double thermal =
              load.thermal_pressure +
              load.pressure_gradient * (vertices[v] - load.middle);
            pressures[v] =
              thermal -
              part_of_lambda * (dealii::trace(stresses[v]) + dim * thermal);
            load.force += volume * (stresses[v] * barycentric.shape_grad(v, 0));
          }
      }

      /// Of each face of a cell: asking ReferenceCell for each of them takes
      /// longer than all the rest.
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

      Face
      face_of(const unsigned int cell,
              const unsigned int f,
              const Vertices    &vertices) const
      {
        Face         face     = {cell, {}, {}, face_vertices[f]};
        unsigned int opposite = dim * (dim + 1) / 2;
        for (const unsigned int vertex : face.in_cell)
          opposite -= vertex;
        if (has_volume_loads)
          for (const unsigned int vertex : face.in_cell)
            face.middle += vertices[vertex] / double(dim);
        face.area = -dim * volume * barycentric.shape_grad(opposite, 0);
        return face;
      }

      /// What the volume's force and the pressure's change from the middle of a
      /// cell add to minus the traction on a side of a face, times its measure.
      dealii::Tensor<1, dim>
      share_of_volume(const unsigned int            cell,
                      const Face                   &face,
                      const dealii::Tensor<1, dim> &outward) const
      {
        return pressure_change(cell, face) * outward +
               mean_in_cell * volume_loads[cell].force;
      }

      /// From the middle of a cell to that of its face.
      double
      pressure_change(const unsigned int cell, const Face &face) const
      {
        return has_volume_loads ? volume_loads[cell].pressure_gradient *
                                    (face.middle - volume_loads[cell].middle) :
                                  0.;
      }

      /// What J would fall by r, given the mean square of its product with the
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
                     const Vertices      &vertices,
                     const OtherIterator &neighbor)
      {
        const Face face = face_of(cell->active_cell_index(), f, vertices);
        const unsigned int other  = neighbor->active_cell_index();
        const CellStress  &here   = cells[face.cell];
        const CellStress  &there  = cells[other];
        const double       a      = here.bubble_energy;
        const double       b      = there.bubble_energy;
        double             energy = 0.;
        // At the interface of two materials only tractions have no jump.
        const bool is_one_material =
          here.mu == there.mu && here.lambda == there.lambda;
        const double stiffness = here.mu * a + there.mu * b;
        const double pressure_stiffness =
          (here.lambda + 2. * here.mu) * (a + b);
        if (degree == 2)
          {
            // Linear on the face: r times the measure, without the jumps of the
            // pressure, and these, at its vertices.
            std::array<dealii::Tensor<1, dim>, dim> r;
            std::array<double, dim>                 jumps = {};
            const LinearStress &from = linear_stresses[face.cell];
            const LinearStress &to   = linear_stresses[other];
            for (unsigned int v = 0; v < dim; ++v)
              {
                const unsigned int index = cell->vertex_index(face.in_cell[v]);
                unsigned int       w     = 0;
                while (neighbor->vertex_index(w) != index)
                  ++w;
                r[v] =
                  (to.stresses[w] - from.stresses[face.in_cell[v]]) * face.area;
                if (is_one_material)
                  {
                    jumps[v] =
                      from.pressures[face.in_cell[v]] - to.pressures[w];
                    r[v] -= jumps[v] * face.area;
                  }
              }
            energy = fall(mean_square(jumps) * face.area.norm_square(),
                          pressure_stiffness) +
                     fall(mean_square(r), stiffness);
          }
        else
          {
            dealii::Tensor<1, dim> r = (there.stress - here.stress) * face.area;
            if (has_volume_loads)
              r += share_of_volume(face.cell, face, face.area) +
                   share_of_volume(other, face, -face.area);
            if (is_one_material)
              {
                const double jump =
                  here.pressure + pressure_change(face.cell, face) -
                  there.pressure - pressure_change(other, face);
                r -= jump * face.area;
                energy = fall(jump * jump * face.area.norm_square(),
                              pressure_stiffness);
              }
            energy += fall(r.norm_square(), stiffness);
          }
        parts[face.cell] += 0.5 * energy;
        parts[other] += 0.5 * energy;
      }

      template <typename CellIterator>
      void
      add_boundary_face(const CellIterator &cell,
                        const unsigned int  f,
                        const Vertices     &vertices,
                        unsigned int       &n_contact_faces)
      {
        const auto id         = cell->face(f)->boundary_id();
        const bool is_contact = conditions.contact.count(id) > 0;
        // Those of a cell follow each other.
        const unsigned int contact_face =
          is_contact ? first_contact_face.at(cell->id().get_coarse_cell_id()) +
                         n_contact_faces++ :
                       0;
        if (conditions.clamped.count(id) > 0)
          return;

        const Face   face    = face_of(cell->active_cell_index(), f, vertices);
        const double measure = face.area.norm();
        const dealii::Tensor<1, dim> normal = face.area / measure;
        dealii::Tensor<1, dim>       inner;
        if (degree == 1)
          {
            inner = -(cells[face.cell].stress * normal);
            if (has_volume_loads)
              inner += share_of_volume(face.cell, face, face.area) / measure;
          }
        on_face.reinit(typename dealii::Triangulation<dim>::cell_iterator(cell),
                       f);
        double square = 0.;
        for (const unsigned int q : on_face.quadrature_point_indices())
          {
            std::array<double, dim> coordinates;
            for (unsigned int v = 0; v < dim; ++v)
              coordinates[v] = on_face.shape_value(face.in_cell[v], q);
            const dealii::Point<dim> &point = on_face.quadrature_point(q);
            dealii::Tensor<1, dim>    r     = inner;
            if (degree == 2)
              for (unsigned int v = 0; v < dim; ++v)
                r -= coordinates[v] *
                     (linear_stresses[face.cell].stresses[face.in_cell[v]] *
                      normal);
            r += load_factor * loads.traction(id, point, normal);
            if (dead_loads != nullptr)
              r += dead_loads->traction(id, point, normal);
            if (is_contact)
              r = with_foundation(r,
                                  face,
                                  boundary.faces[contact_face],
                                  coordinates);
            square +=
              on_face.JxW(q) / measure * free_part(r, normal, id).norm_square();
          }
        const CellStress &here = cells[face.cell];
        parts[face.cell] +=
          fall(square * measure * measure, here.mu * here.bubble_energy);
      }

      /// With what bonds bear, as far as the foundation lets the body go.
      dealii::Tensor<1, dim>
      with_foundation(const dealii::Tensor<1, dim>              &r,
                      const Face                                &side,
                      const typename ContactBoundary<dim>::Face &face,
                      const std::array<double, dim> &coordinates) const
      {
        // Displacements of iterative methods may be off by so much.
        constexpr double             tolerance = 1e-6;
        const double                 measure   = side.area.norm();
        const dealii::Tensor<1, dim> normal    = side.area / measure;
        const double traction  = adhesion.traction(face, coordinates, s);
        const double trace     = adhesion.trace(face, coordinates, s);
        double       r_nu      = r * normal - traction;
        bool         is_closed = true;
        for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
          is_closed = is_closed && (face.is_held(k) ||
                                    s(face.node(k)) >= -tolerance * largest_s);
        if (is_closed)
          r_nu = std::min(r_nu, 0.);
        // What yields stretches the bonds, too.
        if (trace != 0.)
          r_nu /= std::sqrt(1. + mean_square_on_face<dim> * measure * traction /
                                   (trace * cells[side.cell].mu *
                                    cells[side.cell].bubble_energy));
        return conditions.fixes_tangential(face.id) ?
                 r_nu * normal :
                 r + (r_nu - r * normal) * normal;
      }

      /// Without the directions that supports hold.
      dealii::Tensor<1, dim>
      free_part(dealii::Tensor<1, dim>           r,
                const dealii::Tensor<1, dim>    &normal,
                const dealii::types::boundary_id id) const
      {
        for (const PrescribedDisplacement<dim> &held : supports.displacements)
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

      const unsigned int             degree;
      const AdhesionIntegral<dim>   &adhesion;
      const ContactBoundary<dim>    &boundary;
      const BoundaryConditions      &conditions;
      const Supports<dim>           &supports;
      const Loads<dim>              &loads;
      const Eigen::VectorXd          s;
      const Loads<dim>              *dead_loads;
      const double                   load_factor;
      const bool                     has_volume_loads;
      const double                   largest_s;
      const dealii::FE_SimplexP<dim> fe;
      dealii::FEValues<dim>          barycentric; ///< of the cell
      dealii::FEFaceValues<dim>      on_face;
      double                         volume = 0.; ///< of the cell
      const std::array<std::array<unsigned int, dim>, dim + 1> face_vertices =
        make_face_vertices();
      std::vector<CellStress>   cells;
      std::vector<LinearStress> linear_stresses; ///< of degree 2
      std::vector<VolumeLoad>   volume_loads;    ///< if there are any

      /// Of each cell that has any.
      std::unordered_map<dealii::types::coarse_cell_id, unsigned int>
        first_contact_face;
    };



    template <int dim>
    std::string
    outside_calibration(const Residuals<dim> &residuals, const MPI_Comm ranks)
    {
      const auto is_anywhere = [ranks](const bool is_here) {
        return dealii::Utilities::MPI::max(is_here ? 1 : 0, ranks) == 1;
      };
      std::vector<std::string> reasons;
      if (is_anywhere(residuals.has_stretched_cells))
        reasons.emplace_back("cells that are stretched");
      if (is_anywhere(residuals.is_nearly_incompressible))
        reasons.emplace_back("nearly incompressible materials");
      return join(reasons, " and ");
    }
  } // namespace



  template <int dim>
  ErrorEstimate
  estimate_error(const ElasticProblem<dim>   &problem,
                 const AdhesionIntegral<dim> &adhesion,
                 const BoundaryConditions    &conditions,
                 const Supports<dim>         &supports,
                 const Loads<dim>            &loads,
                 const DofVector             &u,
                 const double                 functional,
                 const LoadFactors            factors,
                 const Loads<dim>            *dead_loads)
  {
    const auto                   &dofs  = problem.unknowns().dof_handler();
    const MPI_Comm                ranks = problem.unknowns().communicator();
    std::optional<Residuals<dim>> residuals;
    on_all_ranks(ranks, [&]() {
      residuals.emplace(
        problem, adhesion, conditions, supports, loads, u, factors, dead_loads);
    });

    const double  constant = calibration<dim>(problem.unknowns().degree());
    ErrorEstimate result;
    result.cells = std::move(residuals->parts);
    for (double &part : result.cells)
      part *= constant;
    double sum = 0.;
    for (const auto &cell : owned_cells(dofs))
      sum += result.cells[cell->active_cell_index()];
    result.functional          = dealii::Utilities::MPI::sum(sum, ranks);
    result.outside_calibration = outside_calibration(*residuals, ranks);
    const double stress_energy =
      dealii::Utilities::MPI::sum(residuals->stress_energy, ranks);
    result.is_of_J =
      std::abs(functional) >= least_part_of_energy * stress_energy;
    result.scale = result.is_of_J ? std::abs(functional) : stress_energy;
    return result;
  }



  template decltype(estimate_error<2>) estimate_error<2>;
  template decltype(estimate_error<3>) estimate_error<3>;
} // namespace Debond
