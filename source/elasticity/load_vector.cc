// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/point.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/crossed_mesh.h>
#include <debond/elasticity/load_vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace Debond
{
  namespace
  {
    /// A load with checked values.
    template <int dim>
    class CheckedLoad
    {
    public:
      CheckedLoad(const dealii::Function<dim> &load,
                  const std::string           &load_name)
        : function(load)
        , name(load_name)
        , values(dim)
      {
        if (function.n_components != dim)
          throw std::invalid_argument(
            "The " + name + " has " + std::to_string(function.n_components) +
            " components, it needs " + std::to_string(dim) + ".");
      }

      dealii::Tensor<1, dim>
      operator()(const dealii::Point<dim> &point)
      {
        try
          {
            function.vector_value(point, values);
          }
        catch (const std::exception &)
          {
            std::ostringstream message;
            message << "The " << name << " cannot be evaluated at (" << point
                    << ").";
            throw std::invalid_argument(message.str());
          }

        dealii::Tensor<1, dim> result;
        for (unsigned int d = 0; d < dim; ++d)
          {
            if (!std::isfinite(values[d]))
              {
                std::ostringstream message;
                message << "The " << name << " is " << values[d] << " at ("
                        << point << "), component " << d + 1 << ".";
                throw std::invalid_argument(message.str());
              }
            result[d] = values[d];
          }
        return result;
      }

    private:
      const dealii::Function<dim> &function;
      const std::string            name;
      dealii::Vector<double>       values;
    };



    /// The integrals of a traction times each of the face's basis functions.
    template <int dim>
    using FaceForces = std::array<dealii::Tensor<1, dim>, dim>;

    template <typename Forces>
    double
    largest_difference(const Forces &a, const Forces &b)
    {
      double largest = 0.;
      for (unsigned int v = 0; v < a.size(); ++v)
        largest = std::max(largest, (a[v] - b[v]).norm());
      return largest;
    }

    template <typename Forces>
    Forces
    sum(Forces a, const Forces &b)
    {
      for (unsigned int v = 0; v < a.size(); ++v)
        a[v] += b[v];
      return a;
    }



    /// Adaptive integration over a face. The rule has points at the ends of an
    /// interval, for otherwise a jump close to an end would go unnoticed.
    template <int dim>
    class TractionIntegral
    {
    public:
      /// @p n_faces: faces of the side, which is sampled at 64 intervals in
      /// each direction at least, however coarse the mesh is.
      TractionIntegral(CheckedLoad<dim>  &load,
                       const std::string &load_name,
                       const unsigned int n_faces)
        : traction(load)
        , name(load_name)
        , rule(4)
        , minimum_depth(static_cast<unsigned int>(std::max(
            0.,
            std::ceil(std::log2(64. / std::pow(n_faces, 1. / (dim - 1)))))))
      {}

      /// The nodal forces on the face with the given vertices.
      FaceForces<dim>
      operator()(const std::array<dealii::Point<dim>, dim> &face_vertices,
                 const double                               measure)
      {
        vertices      = face_vertices;
        largest       = 0.;
        n_evaluations = 0;

        FaceForces<dim> forces;
        if constexpr (dim == 2)
          forces = integrate(1e-13, [&](const double s) {
            return integrand({{1. - s, s}});
          });
        else
          {
            // The means over the lines that are parallel to one side of the
            // triangle, times the length of the line. The means themselves are
            // integrated as well: they notice a jump that cuts off the vertex
            // where that length is zero.
            const auto integrals = integrate(1e-11, [&](const double s) {
              const FaceForces<dim> mean =
                integrate(1e-13, [&](const double t) {
                  return integrand({{(1. - s) * (1. - t), s, (1. - s) * t}});
                });
              std::array<dealii::Tensor<1, dim>, 2 * dim> both;
              for (unsigned int v = 0; v < dim; ++v)
                {
                  both[v]       = (1. - s) * mean[v];
                  both[dim + v] = mean[v];
                }
              return both;
            });
            std::copy_n(integrals.begin(), dim, forces.begin());
          }

        // From the reference line (triangle) of measure 1 (1/2).
        for (auto &force : forces)
          force *= (dim - 1) * measure;
        return forces;
      }

    private:
      FaceForces<dim>
      integrand(const std::array<double, dim> &barycentric)
      {
        // The sample points on the edge of the face are moved inwards, so that
        // a traction which jumps there is taken from this side of the jump.
        constexpr double   inset = 1e-12;
        dealii::Point<dim> point;
        for (unsigned int v = 0; v < dim; ++v)
          point += ((1. - inset) * barycentric[v] + inset / dim) * vertices[v];

        if (++n_evaluations > maximum_evaluations)
          {
            std::ostringstream message;
            message << "The " << name << " cannot be integrated near (" << point
                    << "): it is not piecewise smooth.";
            throw std::invalid_argument(message.str());
          }
        const dealii::Tensor<1, dim> value = traction(point);
        largest                            = std::max(largest, value.norm());

        FaceForces<dim> result;
        for (unsigned int v = 0; v < dim; ++v)
          result[v] = barycentric[v] * value;
        return result;
      }

      /// The integral over (0, 1).
      template <typename Integrand>
      auto
      integrate(const double tolerance, const Integrand &f)
      {
        return refine(0., 1., lobatto(0., 1., f), tolerance, 0, f);
      }

      template <typename Integrand>
      auto
      lobatto(const double begin, const double end, const Integrand &f) const
      {
        decltype(f(begin)) result{};
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            auto value = f(begin + (end - begin) * rule.point(q)[0]);
            for (auto &force : value)
              force *= (end - begin) * rule.weight(q);
            result = sum(result, value);
          }
        return result;
      }

      /// Halves the interval until that makes no difference.
      template <typename Forces, typename Integrand>
      Forces
      refine(const double     begin,
             const double     end,
             const Forces    &whole,
             const double     tolerance,
             const unsigned   depth,
             const Integrand &f)
      {
        const double middle = 0.5 * (begin + end);
        const Forces left   = lobatto(begin, middle, f);
        const Forces right  = lobatto(middle, end, f);
        const Forces halves = sum(left, right);

        if (depth >= minimum_depth &&
            largest_difference(whole, halves) <= tolerance * largest)
          return halves;
        return sum(refine(begin, middle, left, tolerance, depth + 1, f),
                   refine(middle, end, right, tolerance, depth + 1, f));
      }

      /// For one face. A jump takes 1e3 in 2D and 1e6 on a coarse face in 3D.
      static constexpr unsigned int maximum_evaluations = 10000000;

      CheckedLoad<dim>                   &traction;
      const std::string                   name;
      const dealii::QGaussLobatto<1>      rule;
      const unsigned int                  minimum_depth;
      std::array<dealii::Point<dim>, dim> vertices;
      unsigned int                        n_evaluations = 0;

      /// The largest traction seen so far, the scale of the tolerance.
      double largest = 0.;
    };



    template <int dim>
    void
    add_body_force(const dealii::DoFHandler<dim> &dof_handler,
                   const dealii::Function<dim>   &function,
                   dealii::Vector<double>        &forces)
    {
      CheckedLoad<dim>                 body_force(function, "body force");
      const dealii::QGaussSimplex<dim> rule(2);
      const double reference_volume = dim == 2 ? 0.5 : 1. / 6.;

      for (const auto &cell : dof_handler.active_cell_iterators())
        {
          const double measure = cell->measure();
          for (unsigned int q = 0; q < rule.size(); ++q)
            {
              std::array<double, dim + 1> barycentric;
              barycentric[0] = 1.;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  barycentric[d + 1] = rule.point(q)[d];
                  barycentric[0] -= rule.point(q)[d];
                }
              dealii::Point<dim> point;
              for (unsigned int v = 0; v <= dim; ++v)
                point += barycentric[v] * cell->vertex(v);

              const dealii::Tensor<1, dim> force =
                rule.weight(q) / reference_volume * measure * body_force(point);
              for (unsigned int v = 0; v <= dim; ++v)
                for (unsigned int d = 0; d < dim; ++d)
                  forces[cell->vertex_dof_index(v, d)] +=
                    barycentric[v] * force[d];
            }
        }
    }



    template <int dim>
    void
    add_traction(const dealii::DoFHandler<dim>   &dof_handler,
                 const dealii::types::boundary_id id,
                 const dealii::Function<dim>     &function,
                 dealii::Vector<double>          &forces)
    {
      const std::string name    = boundary_name<dim>(id);
      unsigned int      n_faces = 0;
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          n_faces += face->at_boundary() && face->boundary_id() == id;
      if (n_faces == 0)
        throw std::invalid_argument("There is a traction on " + name +
                                    ", but the mesh has no such boundary.");

      CheckedLoad<dim>      traction(function, "traction on " + name);
      TractionIntegral<dim> integral(traction, "traction on " + name, n_faces);
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() == id)
            {
              std::array<dealii::Point<dim>, dim> vertices;
              for (unsigned int v = 0; v < dim; ++v)
                vertices[v] = face->vertex(v);

              const FaceForces<dim> face_forces =
                integral(vertices, face->measure());
              for (unsigned int v = 0; v < dim; ++v)
                for (unsigned int d = 0; d < dim; ++d)
                  forces[face->vertex_dof_index(v, d)] += face_forces[v][d];
            }
    }
  } // namespace



  template <int dim>
  dealii::Vector<double>
  load_vector(const dealii::DoFHandler<dim> &dof_handler,
              const Loads<dim>              &loads)
  {
    dealii::Vector<double> forces(dof_handler.n_dofs());
    if (loads.body_force)
      add_body_force(dof_handler, *loads.body_force, forces);
    for (const auto &[id, traction] : loads.tractions)
      add_traction(dof_handler, id, *traction, forces);
    return forces;
  }



  template dealii::Vector<double>
  load_vector(const dealii::DoFHandler<2> &, const Loads<2> &);
  template dealii::Vector<double>
  load_vector(const dealii::DoFHandler<3> &, const Loads<3> &);
} // namespace Debond
