// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/point.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/load_vector.h>
#include <debond/mesh/crossed_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
      DofVector                    values;
    };



    /// The integrals of a traction times each of the face's basis functions.
    template <int dim, int degree>
    using FaceForces =
      std::array<dealii::Tensor<1, dim>, n_coefficients(dim, degree)>;

    template <typename Forces>
    double
    largest_difference(const Forces &a, const Forces &b)
    {
      double largest = 0.;
      for (unsigned int v = 0; v < a.size(); ++v)
        largest = std::max(largest, (a[v] - b[v]).norm());
      return largest;
    }

    /// Of the first @p n entries, which are the forces themselves.
    template <unsigned int n, typename Forces>
    double
    sum_of_sizes(const Forces &forces)
    {
      double sum = 0.;
      for (unsigned int v = 0; v < n; ++v)
        sum += forces[v].norm();
      return sum;
    }

    template <typename Forces>
    Forces
    sum(Forces a, const Forces &b)
    {
      for (unsigned int v = 0; v < a.size(); ++v)
        a[v] += b[v];
      return a;
    }



    /// A load is no function with an integral, or one that sampling cannot
    /// find, if that much of it is in that part of an interval (of a cell), to
    /// which bisections lead: 1/sqrt(x) has 1e-5 of its integral there, 1/x 4
    /// %, and 1/x^2 all of it.
    constexpr unsigned int bisections_to_a_point   = 33; // 1.2e-10
    constexpr double       largest_part_at_a_point = 1e-3;

    template <int dim>
    [[noreturn]] void
    throw_unbounded(const std::string &name, const dealii::Point<dim> &point)
    {
      std::ostringstream message;
      message << "The " << name << " cannot be integrated near (" << point
              << "): it grows without bound.";
      throw std::invalid_argument(message.str());
    }



    /// Adaptive integration over a face. The rule has points at the ends of an
    /// interval, for otherwise a jump close to an end would go unnoticed.
    template <int dim, int degree>
    class TractionIntegral
    {
    public:
      static constexpr unsigned int n_forces = n_coefficients(dim, degree);

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
      FaceForces<dim, degree>
      operator()(const std::array<dealii::Point<dim>, dim> &face_vertices,
                 const double                               measure)
      {
        vertices      = face_vertices;
        largest       = 0.;
        n_evaluations = 0;

        FaceForces<dim, degree> forces;
        if constexpr (dim == 2)
          {
            Pieces pieces;
            forces = integrate(1e-13, pieces, [&](const double s) {
              return integrand({{1. - s, s}});
            });
            if (pieces.grow_without_bound())
              throw_unbounded(name,
                              point_at({{1. - pieces.place, pieces.place}}));
          }
        else
          {
            // The means over the lines that are parallel to one side of the
            // triangle, times the length of the line. The means themselves are
            // integrated as well: they notice a jump that cuts off the vertex
            // where that length is zero. The last entry is the part of the
            // lines on which the load grows without bound.
            std::array<double, dim> pole;
            Pieces                  lines;
            const auto integrals = integrate(1e-11, lines, [&](const double s) {
              Pieces                        pieces;
              const FaceForces<dim, degree> mean =
                integrate(1e-13, pieces, [&](const double t) {
                  return integrand({{(1. - s) * (1. - t), s, (1. - s) * t}});
                });
              std::array<dealii::Tensor<1, dim>, 2 * n_forces + 1> both;
              for (unsigned int v = 0; v < n_forces; ++v)
                {
                  both[v]            = (1. - s) * mean[v];
                  both[n_forces + v] = mean[v];
                }
              if (pieces.grow_without_bound())
                {
                  both[2 * n_forces][0] = pieces.size;
                  pole                  = {{(1. - s) * (1. - pieces.place),
                                            s,
                                            (1. - s) * pieces.place}};
                }
              return both;
            });
            if (integrals[2 * n_forces][0] >
                largest_part_at_a_point * lines.size)
              throw_unbounded(name, point_at(pole));
            if (lines.grow_without_bound())
              throw_unbounded(name,
                              point_at({{0.5 * (1. - lines.place),
                                         lines.place,
                                         0.5 * (1. - lines.place)}}));
            std::copy_n(integrals.begin(), n_forces, forces.begin());
          }

        // From the reference line (triangle) of measure 1 (1/2).
        for (auto &force : forces)
          force *= (dim - 1) * measure;
        return forces;
      }

    private:
      /// How much of the load on an interval is where.
      struct Pieces
      {
        double size   = 0.; ///< of all
        double narrow = 0.; ///< the largest one in a narrow interval
        double place  = 0.; ///< of it

        bool
        grow_without_bound() const
        {
          return narrow > largest_part_at_a_point * size;
        }
      };

      dealii::Point<dim>
      point_at(const std::array<double, dim> &barycentric) const
      {
        // The sample points on the edge of the face are moved inwards, so that
        // a traction which jumps there is taken from this side of the jump. A
        // coordinate that all vertices share stays as it is, for the traction
        // may jump there, too.
        constexpr double   inset = 1e-12;
        dealii::Point<dim> point = vertices[0];
        for (unsigned int v = 1; v < dim; ++v)
          point += ((1. - inset) * barycentric[v] + inset / dim) *
                   (vertices[v] - vertices[0]);
        return point;
      }

      FaceForces<dim, degree>
      integrand(const std::array<double, dim> &barycentric)
      {
        const dealii::Point<dim> point = point_at(barycentric);
        if (++n_evaluations > maximum_evaluations)
          {
            std::ostringstream message;
            message << "The " << name << " cannot be integrated near (" << point
                    << "): it is not piecewise smooth.";
            throw std::invalid_argument(message.str());
          }
        const dealii::Tensor<1, dim> value = traction(point);
        largest                            = std::max(largest, value.norm());

        const auto              basis = bernstein(barycentric, degree);
        FaceForces<dim, degree> result;
        for (unsigned int v = 0; v < n_forces; ++v)
          result[v] = basis[v] * value;
        return result;
      }

      /// The integral over (0, 1).
      template <typename Integrand>
      auto
      integrate(const double tolerance, Pieces &pieces, const Integrand &f)
      {
        return refine(0., 1., lobatto(0., 1., f), tolerance, 0, pieces, f);
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
             Pieces          &pieces,
             const Integrand &f)
      {
        const double middle = 0.5 * (begin + end);
        const Forces left   = lobatto(begin, middle, f);
        const Forces right  = lobatto(middle, end, f);
        const Forces halves = sum(left, right);

        if (depth >= minimum_depth &&
            largest_difference(whole, halves) <= tolerance * largest)
          {
            pieces.size += sum_of_sizes<n_forces>(halves);
            return halves;
          }
        const double size_before = pieces.size;
        const Forces result =
          sum(refine(begin, middle, left, tolerance, depth + 1, pieces, f),
              refine(middle, end, right, tolerance, depth + 1, pieces, f));
        if (depth == bisections_to_a_point &&
            pieces.size - size_before > pieces.narrow)
          {
            pieces.narrow = pieces.size - size_before;
            pieces.place  = middle;
          }
        return result;
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
    using Simplex = std::array<dealii::Point<dim>, dim + 1>;



    /// The points of the rule of degree 2, for quadratic displacements of
    /// degree 3 and more, in a simplex.
    template <int dim>
    class SimplexRule
    {
    public:
      explicit SimplexRule(const unsigned int degree)
        : rule(degree + 1)
      {
        for (const dealii::Point<dim> &point : rule.get_points())
          {
            std::array<double, dim + 1> barycentric;
            barycentric[0] = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              {
                barycentric[d + 1] = point[d];
                barycentric[0] -= point[d];
              }
            barycentrics.push_back(barycentric);
          }
      }

      unsigned int
      size() const
      {
        return rule.size();
      }

      const std::array<double, dim + 1> &
      barycentric(const unsigned int q) const
      {
        return barycentrics[q];
      }

      /// The part of the simplex' measure that belongs to the point.
      double
      weight(const unsigned int q) const
      {
        return rule.weight(q) * (dim == 2 ? 2. : 6.);
      }

      dealii::Point<dim>
      point(const unsigned int q, const Simplex<dim> &simplex) const
      {
        dealii::Point<dim> point;
        for (unsigned int v = 0; v <= dim; ++v)
          point += barycentrics[q][v] * simplex[v];
        return point;
      }

    private:
      const dealii::QGaussSimplex<dim>         rule;
      std::vector<std::array<double, dim + 1>> barycentrics;
    };



    /// Values in a part of a cell that differ by less do not grow without bound
    /// there.
    constexpr double largest_ratio = 2.;



    /// The halves of a simplex, cut at the middle of its longest edge.
    template <int dim>
    std::array<Simplex<dim>, 2>
    bisect(const Simplex<dim> &simplex)
    {
      unsigned int a = 0, b = 1;
      for (unsigned int v = 0; v <= dim; ++v)
        for (unsigned int w = v + 1; w <= dim; ++w)
          if (simplex[v].distance_square(simplex[w]) >
              simplex[a].distance_square(simplex[b]))
            {
              a = v;
              b = w;
            }
      const dealii::Point<dim> middle =
        simplex[a] + 0.5 * (simplex[b] - simplex[a]);
      std::array<Simplex<dim>, 2> halves = {{simplex, simplex}};
      halves[0][b]                       = middle;
      halves[1][a]                       = middle;
      return halves;
    }



    /// Throws std::invalid_argument if the body force grows without bound in
    /// the cell so much that it has no integral. The parts of the cell in which
    /// it is large and varies, those at a pole, are halved again and again.
    /// Their share of the integral stays as it is for 1/x and for 1/r^2 around
    /// a line, grows for 1/x^2, and halves for 1/sqrt(x) when parts are a
    /// quarter as wide.
    template <int dim>
    void
    check_growth(const Simplex<dim>     &cell,
                 const SimplexRule<dim> &rule,
                 const std::string      &name,
                 CheckedLoad<dim>       &body_force)
    {
      constexpr unsigned int first_halvings = dim == 2 ? 8 : 6;
      constexpr unsigned int last_halvings  = dim == 2 ? 16 : 15;
      constexpr double       least_growth   = 3.;
      constexpr double       largest_share  = 0.7;

      struct Part
      {
        Simplex<dim>       simplex;
        double             smallest = 0., largest = 0.; // of the body force
        bool               varies = true;
        dealii::Point<dim> place; // of the largest
      };

      // The smallest value stands for all in a part: the largest one depends on
      // how close to the pole a point of the rule happens to be.
      std::vector<Part> parts(1);
      parts[0].simplex = cell;
      double mean = 0., share_before = 0.;
      for (unsigned int halvings = 1; halvings <= last_halvings; ++halvings)
        {
          const double measure = std::ldexp(1., -static_cast<int>(halvings));
          std::vector<Part> halves;
          for (const Part &part : parts)
            for (const Simplex<dim> &simplex : bisect(part.simplex))
              {
                Part half;
                half.simplex  = simplex;
                half.smallest = std::numeric_limits<double>::max();
                for (unsigned int q = 0; q < rule.size(); ++q)
                  {
                    const dealii::Point<dim> point = rule.point(q, simplex);
                    const double             size  = body_force(point).norm();
                    half.smallest = std::min(half.smallest, size);
                    if (size > half.largest)
                      {
                        half.largest = size;
                        half.place   = point;
                      }
                  }
                half.varies = half.largest > largest_ratio * half.smallest;
                // Points on both sides of a pole may have about one value.
                const bool goes_on = half.varies || part.varies;
                if (halvings == first_halvings ||
                    (halvings < first_halvings && !goes_on))
                  mean += measure * half.smallest;
                if (goes_on)
                  halves.push_back(half);
              }
          parts.clear();
          double share = 0.;
          for (const Part &half : halves)
            if (halvings < first_halvings || half.largest > least_growth * mean)
              {
                parts.push_back(half);
                share += measure * half.smallest;
              }
          if (halvings == first_halvings)
            share_before = share;
          if (halvings == last_halvings && share > largest_share * share_before)
            throw_unbounded(name,
                            std::max_element(parts.begin(),
                                             parts.end(),
                                             [](const Part &a, const Part &b) {
                                               return a.largest < b.largest;
                                             })
                              ->place);
        }
    }



    template <int dim>
    void
    add_body_force(const dealii::DoFHandler<dim> &dof_handler,
                   const dealii::Function<dim>   &function,
                   DofVector                     &forces)
    {
      const std::string      name = "body force";
      CheckedLoad<dim>       body_force(function, name);
      const unsigned int     degree = dof_handler.get_fe().degree;
      const SimplexRule<dim> rule(degree);
      for (const auto &cell : dof_handler.active_cell_iterators())
        {
          Simplex<dim> simplex;
          for (unsigned int v = 0; v <= dim; ++v)
            simplex[v] = cell->vertex(v);

          const CellNodes<dim> nodes(cell);
          const double         measure  = cell->measure();
          double               smallest = std::numeric_limits<double>::max();
          double               largest  = 0.;
          for (unsigned int q = 0; q < rule.size(); ++q)
            {
              const auto basis = bernstein(rule.barycentric(q), degree);
              const dealii::Tensor<1, dim> value =
                body_force(rule.point(q, simplex));
              smallest = std::min(smallest, value.norm());
              largest  = std::max(largest, value.norm());
              for (unsigned int n = 0; n < nodes.size; ++n)
                for (unsigned int d = 0; d < dim; ++d)
                  forces[nodes.dofs[n][d]] +=
                    basis[n] * rule.weight(q) * measure * value[d];
            }
          if (largest > largest_ratio * smallest)
            check_growth(simplex, rule, name, body_force);
        }
    }



    template <int dim, int degree>
    void
    add_traction(const dealii::DoFHandler<dim>   &dof_handler,
                 const dealii::types::boundary_id id,
                 const std::string               &name,
                 const dealii::Function<dim>     &function,
                 const unsigned int               n_faces_of_whole,
                 DofVector                       &forces)
    {
      unsigned int n_faces = n_faces_of_whole;
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          n_faces += n_faces_of_whole == 0 && face->at_boundary() &&
                     face->boundary_id() == id;
      if (n_faces == 0)
        throw std::invalid_argument("There is a traction on " + name +
                                    ", but the mesh has no such boundary.");

      CheckedLoad<dim>              traction(function, "traction on " + name);
      TractionIntegral<dim, degree> integral(traction,
                                             "traction on " + name,
                                             n_faces);
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() == id)
            {
              const CellNodes<dim>                nodes(cell);
              std::array<dealii::Point<dim>, dim> vertices;
              std::array<unsigned int, dim>       in_cell;
              for (unsigned int v = 0; v < dim; ++v)
                {
                  vertices[v] = face->vertex(v);
                  in_cell[v]  = nodes.find(face->vertex_index(v));
                }

              const FaceForces<dim, degree> face_forces =
                integral(vertices, face->measure());
              for (unsigned int n = 0; n < face_forces.size(); ++n)
                {
                  const unsigned int node =
                    n < dim ?
                      in_cell[n] :
                      dim + 1 +
                        edge_between(in_cell[simplex_edges[n - dim][0]],
                                     in_cell[simplex_edges[n - dim][1]]);
                  for (unsigned int d = 0; d < dim; ++d)
                    forces[nodes.dofs[node][d]] += face_forces[n][d];
                }
            }
    }
  } // namespace



  LoadError::LoadError(
    const std::string                               &message,
    const std::optional<dealii::types::boundary_id> &boundary)
    : std::invalid_argument(message)
    , boundary(boundary)
  {}



  template <int dim>
  DofVector
  load_vector(const dealii::DoFHandler<dim> &dof_handler,
              const Loads<dim>              &loads)
  {
    DofVector forces(dof_handler.n_dofs());

    // The load that is being integrated, for errors.
    std::optional<dealii::types::boundary_id> boundary;
    try
      {
        if (loads.body_force)
          add_body_force(dof_handler, *loads.body_force, forces);
        for (const auto &[id, traction] : loads.tractions)
          {
            boundary                 = id;
            const std::string  name  = boundary_name(loads.boundary_names, id);
            const auto         entry = loads.n_faces.find(id);
            const unsigned int n_faces =
              entry == loads.n_faces.end() ? 0 : entry->second;
            if (dof_handler.get_fe().degree == 1)
              add_traction<dim, 1>(
                dof_handler, id, name, *traction, n_faces, forces);
            else
              add_traction<dim, 2>(
                dof_handler, id, name, *traction, n_faces, forces);
          }
      }
    catch (const std::invalid_argument &error)
      {
        throw LoadError(error.what(), boundary);
      }
    return forces;
  }



  template <int dim>
  std::array<dealii::Tensor<1, dim>, dim>
  traction_moments(const dealii::Function<dim>               &traction,
                   const std::array<dealii::Point<dim>, dim> &corners,
                   const unsigned int                         n_faces)
  {
    CheckedLoad<dim> load(traction, "traction");
    return TractionIntegral<dim, 1>(load, "traction", n_faces)(corners, 1.);
  }



  template decltype(load_vector<2>)      load_vector<2>;
  template decltype(load_vector<3>)      load_vector<3>;
  template decltype(traction_moments<2>) traction_moments<2>;
  template decltype(traction_moments<3>) traction_moments<3>;
} // namespace Debond
