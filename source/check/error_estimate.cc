// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/base/text.h>
#include <debond/check/error_estimate.h>
#include <debond/contact/field_value.h>
#include <debond/elasticity/linear_simplex.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

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

    /// The mean of b_F over a cell, by the one over F.
    constexpr double mean_in_cell = 0.5;



    /// int_K |grad b_F|^2, F being opposite to a vertex.
    template <int dim>
    double
    bubble_energy(const LinearSimplex<dim> &cell, const unsigned int opposite)
    {
      double sum = 0.;
      for (unsigned int i = 0; i <= dim; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          if (i != opposite && j != opposite)
            sum += cell.gradients[i] * cell.gradients[j];
      return (dim == 2 ? 8. / 3. : 243. / 70.) * cell.volume * sum;
    }



    /// What J would fall by the product of all barycentric coordinates of a
    /// cell, for a force on it that is constant.
    template <int dim>
    double
    fall_inside(const LinearSimplex<dim>     &cell,
                const dealii::Tensor<1, dim> &force,
                const double                  stiffness)
    {
      double sum = 0.;
      for (const dealii::Tensor<1, dim> &gradient : cell.gradients)
        sum += gradient.norm_square();
      const double mean   = dim == 2 ? 1. / 60. : 1. / 840.;
      const double energy = cell.volume * sum / (dim == 2 ? 180. : 15120.);
      return 0.5 * mean * mean * force.norm_square() / (stiffness * energy);
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



    template <int dim>
    struct FaceRule
    {
      std::vector<std::array<double, dim>> barycentric;
      std::vector<double>                  weights; ///< their sum is 1

      FaceRule()
      {
        const auto add = [this](const auto &rule, const double measure) {
          for (unsigned int q = 0; q < rule.size(); ++q)
            {
              std::array<double, dim> point;
              point[0] = 1.;
              for (unsigned int d = 1; d < dim; ++d)
                {
                  point[d] = rule.point(q)[d - 1];
                  point[0] -= point[d];
                }
              barycentric.push_back(point);
              weights.push_back(rule.weight(q) / measure);
            }
        };
        // Loads and bonds may jump within a face.
        if constexpr (dim == 2)
          add(dealii::QGauss<1>(4), 1.);
        else
          add(dealii::QGaussSimplex<2>(3), 0.5);
      }
    };



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
                const Loads<dim>            *dead_loads,
                const ProblemPiece<dim>     *piece)
        : degree(problem.unknowns().degree())
        , adhesion(adhesion)
        , boundary(problem.unknowns().contact().boundary())
        , conditions(conditions)
        , supports(supports)
        , loads(loads)
        , s(problem.unknowns().contact().trace(u))
        , dead_loads(dead_loads)
        , load_factor(factors.loads)
        , largest_s((piece == nullptr ? s : piece->trace(u))
                      .template lpNorm<Eigen::Infinity>())
      {
        const DofVector displacement =
          problem.unknowns().cartesian_displacement(u, factors);
        const auto &dofs = problem.unknowns().dof_handler();
        cells.reserve(dofs.get_triangulation().n_active_cells());
        for (const auto &cell : dofs.active_cell_iterators())
          {
            const Material &material = problem.fields().material(cell);
            CellStress      here     = {LinearSimplex<dim>(cell),
                                        material.shear_modulus(),
                                        material.template lame_lambda<dim>(),
                                        problem.fields().stress(cell,
                                                       displacement,
                                                       factors),
                                        0.,
                                        {},
                                        0.,
                                        {}};
            if (loads.body_force || loads.temperature_change ||
                (dead_loads != nullptr && dead_loads->body_force))
              add_volume_forces(cell, material, here);
            const double trace    = dealii::trace(here.stress);
            const double dilation = (trace + dim * here.thermal_pressure) /
                                    (2. * here.mu + dim * here.lambda);
            here.pressure = here.thermal_pressure - here.lambda * dilation;
            if (degree == 2)
              add_linear_part(
                cell,
                [&](const auto &point) {
                  return problem.fields().stress(cell,
                                                 displacement,
                                                 factors,
                                                 point);
                },
                here);
            stress_energies.push_back(
              here.simplex.volume *
              (here.stress * here.stress -
               here.lambda / (2. * here.mu + dim * here.lambda) * trace *
                 trace) /
              (4. * here.mu));
            cells.push_back(here);
          }
        parts.assign(cells.size(), 0.);
        if (degree == 2)
          for (unsigned int c = 0; c < cells.size(); ++c)
            parts[c] =
              fall_inside(cells[c].simplex, cells[c].force, cells[c].mu);
        for (const auto &cell : dofs.active_cell_iterators())
          for (const unsigned int f : cell->face_indices())
            if (!cell->face(f)->at_boundary())
              add_inner_face(cell, f);
            else
              add_boundary_face(cell, f);
      }

      /// What J would fall, of each cell.
      std::vector<double> parts;

      /// Those of an elastic body with these stresses.
      std::vector<double> stress_energies;

    private:
      struct CellStress
      {
        LinearSimplex<dim>              simplex;
        double                          mu;
        double                          lambda;
        dealii::SymmetricTensor<2, dim> stress;

        /// sigma is what shears minus this times the identity.
        double pressure;

        /// int_K (f_0 + div sigma).
        dealii::Tensor<1, dim> force;

        /// What keeps the cell from expanding, and its gradient.
        double                 thermal_pressure;
        dealii::Tensor<1, dim> pressure_gradient;
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
        unsigned int           opposite; ///< vertex of the cell
        double                 measure;
        dealii::Tensor<1, dim> normal;

        /// The numbers of its vertices in the cell, in the order of
        /// ContactBoundary's faces.
        std::array<unsigned int, dim> in_cell;
      };

      /// Loads are evaluated where load_vector() and thermal_stresses() do it:
      /// there they are finite.
      template <typename CellIterator>
      void
      add_volume_forces(const CellIterator &cell,
                        const Material     &material,
                        CellStress         &here) const
      {
        const double stress_of_one =
          loads.temperature_change ?
            load_factor * material.template thermal_stress<dim>() :
            0.;
        for (unsigned int q = 0; q < cell_rule.size(); ++q)
          {
            const double weight = cell_rule.weight(q) * (dim == 2 ? 2. : 6.);
            dealii::Point<dim> point = cell->vertex(0);
            // Times the basis' gradients at the vertices.
            dealii::Tensor<1, dim> towards = here.simplex.gradients[0];
            for (unsigned int d = 0; d < dim; ++d)
              {
                const double lambda = cell_rule.point(q)[d];
                point += lambda * (cell->vertex(d + 1) - cell->vertex(0));
                towards += lambda * (here.simplex.gradients[d + 1] -
                                     here.simplex.gradients[0]);
              }
            const auto add_force = [&](const Loads<dim> &load,
                                       const double      factor) {
              if (load.body_force)
                for (unsigned int d = 0; d < dim; ++d)
                  here.force[d] += factor * weight * here.simplex.volume *
                                   field_value(*load.body_force, point, d);
            };
            add_force(loads, load_factor);
            if (dead_loads != nullptr)
              add_force(*dead_loads, 1.);
            if (stress_of_one != 0.)
              {
                // The linear function with the same mean and moments.
                const double pressure =
                  stress_of_one * field_value(*loads.temperature_change, point);
                here.thermal_pressure += weight * pressure;
                here.pressure_gradient +=
                  (dim + 1.) * (dim + 2.) * weight * pressure * towards;
              }
          }
        if (degree == 1)
          here.force -= here.simplex.volume * here.pressure_gradient;
      }

      /// What varies in a cell, of degree 2, from the stress at its points.
      template <typename CellIterator, typename Stress>
      void
      add_linear_part(const CellIterator &cell,
                      const Stress       &stress,
                      CellStress         &here)
      {
        linear_stresses.emplace_back();
        auto &[stresses, pressures] = linear_stresses.back();
        for (unsigned int v = 0; v <= dim; ++v)
          {
            std::array<double, dim + 1> vertex = {};
            vertex[v]                          = 1.;
            stresses[v]                        = stress(vertex);
            const double thermal =
              here.thermal_pressure +
              here.pressure_gradient * (cell->vertex(v) - cell->center());
            pressures[v] =
              thermal - here.lambda *
                          (dealii::trace(stresses[v]) + dim * thermal) /
                          (2. * here.mu + dim * here.lambda);
            here.force +=
              here.simplex.volume * (stresses[v] * here.simplex.gradients[v]);
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
      face_of(const unsigned int cell, const unsigned int f) const
      {
        Face face = {cell, dim * (dim + 1) / 2, 0., {}, face_vertices[f]};
        for (const unsigned int vertex : face.in_cell)
          face.opposite -= vertex;
        const LinearSimplex<dim>     &simplex = cells[face.cell].simplex;
        const dealii::Tensor<1, dim> &inward = simplex.gradients[face.opposite];
        face.measure = dim * simplex.volume * inward.norm();
        face.normal  = -inward / inward.norm();
        return face;
      }

      /// - sigma n and its share of the volume's force, in the middle of the
      /// face.
      template <typename CellIterator>
      dealii::Tensor<1, dim>
      traction(const CellIterator &cell,
               const unsigned int  f,
               const Face         &face) const
      {
        const CellStress &here = cells[face.cell];
        return -(here.stress * face.normal) +
               pressure_change(cell, f, face) * face.normal +
               mean_in_cell / face.measure * here.force;
      }

      /// From the middle of the cell to that of the face.
      template <typename CellIterator>
      double
      pressure_change(const CellIterator &cell,
                      const unsigned int  f,
                      const Face         &face) const
      {
        return loads.temperature_change ?
                 cells[face.cell].pressure_gradient *
                   (cell->face(f)->center() - cell->center()) :
                 0.;
      }

      double
      bubble(const Face &face) const
      {
        return bubble_energy(cells[face.cell].simplex, face.opposite);
      }

      /// What J would fall by r with the given mean square.
      static double
      fall(const double square, const double measure, const double stiffness)
      {
        const double force = mean_on_face<dim> * measure;
        return 0.5 * force * force * square / stiffness;
      }

      template <typename CellIterator>
      void
      add_inner_face(const CellIterator &cell, const unsigned int f)
      {
        const auto neighbor = cell->neighbor(f);
        if (neighbor->active_cell_index() < cell->active_cell_index())
          return;
        const Face         face  = face_of(cell->active_cell_index(), f);
        const unsigned int g     = cell->neighbor_face_no(f);
        const Face         back  = face_of(neighbor->active_cell_index(), g);
        const CellStress  &here  = cells[face.cell];
        const CellStress  &there = cells[back.cell];
        const double       a = bubble(face), b = bubble(back);
        if (degree == 2)
          {
            const double energy =
              fall_of_linear_jump(cell, face, neighbor, back, a, b);
            parts[face.cell] += 0.5 * energy;
            parts[back.cell] += 0.5 * energy;
            return;
          }

        dealii::Tensor<1, dim> r =
          traction(cell, f, face) + traction(neighbor, g, back);
        double energy = 0.;
        // At the interface of two materials only their sum has no jump.
        if (here.mu == there.mu && here.lambda == there.lambda)
          {
            const double jump = here.pressure + pressure_change(cell, f, face) -
                                there.pressure -
                                pressure_change(neighbor, g, back);
            r -= jump * face.normal;
            energy = fall(jump * jump,
                          face.measure,
                          (here.lambda + 2. * here.mu) * (a + b));
          }
        energy +=
          fall(r.norm_square(), face.measure, here.mu * a + there.mu * b);
        parts[face.cell] += 0.5 * energy;
        parts[back.cell] += 0.5 * energy;
      }

      /// The same of degree 2, where tractions are linear on the face.
      template <typename CellIterator, typename OtherIterator>
      double
      fall_of_linear_jump(const CellIterator  &cell,
                          const Face          &face,
                          const OtherIterator &neighbor,
                          const Face          &back,
                          const double         a,
                          const double         b) const
      {
        const CellStress &here  = cells[face.cell];
        const CellStress &there = cells[back.cell];
        const bool        is_one_material =
          here.mu == there.mu && here.lambda == there.lambda;
        std::array<dealii::Tensor<1, dim>, dim> r;
        std::array<double, dim>                 jumps = {};
        for (unsigned int v = 0; v < dim; ++v)
          {
            const unsigned int other =
              *std::find_if(back.in_cell.begin(),
                            back.in_cell.end(),
                            [&, index = cell->vertex_index(face.in_cell[v])](
                              const unsigned int w) {
                              return neighbor->vertex_index(w) == index;
                            });
            const LinearStress &from = linear_stresses[face.cell];
            const LinearStress &to   = linear_stresses[back.cell];
            r[v] = (to.stresses[other] - from.stresses[face.in_cell[v]]) *
                   face.normal;
            if (is_one_material)
              {
                jumps[v] =
                  from.pressures[face.in_cell[v]] - to.pressures[other];
                r[v] -= jumps[v] * face.normal;
              }
          }
        return fall(mean_square(jumps),
                    face.measure,
                    (here.lambda + 2. * here.mu) * (a + b)) +
               fall(mean_square(r), face.measure, here.mu * a + there.mu * b);
      }

      template <typename CellIterator>
      void
      add_boundary_face(const CellIterator &cell, const unsigned int f)
      {
        const auto id         = cell->face(f)->boundary_id();
        const bool is_contact = conditions.contact.count(id) > 0;
        // They are numbered in this order.
        const unsigned int contact_face = n_contact_faces;
        n_contact_faces += is_contact;
        if (conditions.clamped.count(id) > 0)
          return;

        const Face face = face_of(cell->active_cell_index(), f);
        const dealii::Tensor<1, dim> inner =
          degree == 1 ? traction(cell, f, face) : dealii::Tensor<1, dim>();
        double square = 0.;
        for (unsigned int q = 0; q < rule.weights.size(); ++q)
          {
            dealii::Tensor<1, dim> r = inner;
            if (degree == 2)
              for (unsigned int v = 0; v < dim; ++v)
                r -= rule.barycentric[q][v] *
                     (linear_stresses[face.cell].stresses[face.in_cell[v]] *
                      face.normal);
            const auto add_traction = [&](const Loads<dim> &load,
                                          const double      factor) {
              const auto entry = load.tractions.find(id);
              if (entry == load.tractions.end())
                return;
              dealii::Point<dim> point;
              for (unsigned int v = 0; v < dim; ++v)
                point += rule.barycentric[q][v] * cell->vertex(face.in_cell[v]);
              for (unsigned int d = 0; d < dim; ++d)
                r[d] += factor * field_value(*entry->second, point, d);
            };
            add_traction(loads, load_factor);
            if (dead_loads != nullptr)
              add_traction(*dead_loads, 1.);
            if (is_contact)
              r = with_foundation(r,
                                  face.normal,
                                  boundary.faces[contact_face],
                                  rule.barycentric[q]);
            square +=
              rule.weights[q] * free_part(r, face.normal, id).norm_square();
          }
        parts[face.cell] +=
          fall(square, face.measure, cells[face.cell].mu * bubble(face));
      }

      /// With what bonds bear, as far as the foundation lets the body go.
      dealii::Tensor<1, dim>
      with_foundation(const dealii::Tensor<1, dim>              &r,
                      const dealii::Tensor<1, dim>              &normal,
                      const typename ContactBoundary<dim>::Face &face,
                      const std::array<double, dim> &barycentric) const
      {
        // Displacements of iterative methods may be off by so much.
        constexpr double tolerance = 1e-6;
        double r_nu      = r * normal - adhesion.traction(face, barycentric, s);
        bool   is_closed = true;
        for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
          is_closed = is_closed &&
                      (face.node(k) == dealii::numbers::invalid_unsigned_int ||
                       s(face.node(k)) >= -tolerance * largest_s);
        if (is_closed)
          r_nu = std::min(r_nu, 0.);
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

      const unsigned int                                       degree;
      const AdhesionIntegral<dim>                             &adhesion;
      const ContactBoundary<dim>                              &boundary;
      const BoundaryConditions                                &conditions;
      const Supports<dim>                                     &supports;
      const Loads<dim>                                        &loads;
      const Eigen::VectorXd                                    s;
      const Loads<dim>                                        *dead_loads;
      const double                                             load_factor;
      const double                                             largest_s;
      const FaceRule<dim>                                      rule;
      const std::array<std::array<unsigned int, dim>, dim + 1> face_vertices =
        make_face_vertices();
      const dealii::QGaussSimplex<dim> cell_rule =
        dealii::QGaussSimplex<dim>(2);
      std::vector<CellStress>   cells;
      std::vector<LinearStress> linear_stresses;
      unsigned int              n_contact_faces = 0;
    };



    template <int dim>
    std::string
    outside_calibration(const ElasticProblem<dim> &problem,
                        const ProblemPiece<dim>   *piece)
    {
      std::set<std::string> reasons;
      for (const auto &cell :
           problem.unknowns().dof_handler().active_cell_iterators())
        {
          const Material &material = problem.fields().material(cell);
          if (material.template lame_lambda<dim>() >
              largest_calibrated_lambda * material.shear_modulus())
            reasons.insert("nearly incompressible materials");
          if (dim == 3 && cell->diameter() > largest_calibrated_stretch *
                                               cell->minimum_vertex_distance())
            reasons.insert("cells that are stretched");
        }
      if (piece != nullptr)
        for (const std::vector<std::string> &of_rank :
             dealii::Utilities::MPI::all_gather(
               piece->nodes().communicator(),
               std::vector<std::string>(reasons.begin(), reasons.end())))
          reasons.insert(of_rank.begin(), of_rank.end());
      return join({reasons.begin(), reasons.end()}, " and ");
    }
  } // namespace



  double
  ErrorEstimate::relative() const
  {
    return scale > 0. ? functional / scale : 0.;
  }



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
                 const Loads<dim>            *dead_loads,
                 const ProblemPiece<dim>     *piece)
  {
    std::optional<Residuals<dim>> residuals;
    std::string                   error;
    try
      {
        residuals.emplace(problem,
                          adhesion,
                          conditions,
                          supports,
                          loads,
                          u,
                          factors,
                          dead_loads,
                          piece);
      }
    catch (const std::invalid_argument &exception)
      {
        if (piece == nullptr)
          throw;
        error = exception.what();
      }
    if (piece != nullptr)
      for (const std::string &of_rank :
           dealii::Utilities::MPI::all_gather(piece->nodes().communicator(),
                                              error))
        if (!of_rank.empty())
          throw std::invalid_argument(of_rank);

    const double constant = calibration<dim>(problem.unknowns().degree());
    const auto   sum      = [piece](const std::vector<double> &v) {
      const auto add = [](const std::vector<double> &numbers) {
        return std::accumulate(numbers.begin(), numbers.end(), 0.);
      };
      return piece == nullptr ? add(v) : add(piece->gather_cells(v));
    };
    ErrorEstimate result;
    result.cells = std::move(residuals->parts);
    for (double &part : result.cells)
      part *= constant;
    result.functional          = sum(result.cells);
    result.outside_calibration = outside_calibration(problem, piece);
    const double stress_energy = sum(residuals->stress_energies);
    result.is_of_J =
      std::abs(functional) >= least_part_of_energy * stress_energy;
    result.scale = result.is_of_J ? std::abs(functional) : stress_energy;
    return result;
  }



  template ErrorEstimate
  estimate_error(const ElasticProblem<2> &,
                 const AdhesionIntegral<2> &,
                 const BoundaryConditions &,
                 const Supports<2> &,
                 const Loads<2> &,
                 const DofVector &,
                 const double,
                 const LoadFactors,
                 const Loads<2> *,
                 const ProblemPiece<2> *);
  template ErrorEstimate
  estimate_error(const ElasticProblem<3> &,
                 const AdhesionIntegral<3> &,
                 const BoundaryConditions &,
                 const Supports<3> &,
                 const Loads<3> &,
                 const DofVector &,
                 const double,
                 const LoadFactors,
                 const Loads<3> *,
                 const ProblemPiece<3> *);
} // namespace Debond
