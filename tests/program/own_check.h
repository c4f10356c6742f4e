// SPDX-License-Identifier: LGPL-2.1-or-later
// A check of results that shares nothing with the solver: the crossed mesh of
// an unturned box, assembly, condensation, the law and descents of its own, in
// long double. Unknowns are numbered vertex by vertex, the components along the
// edges of the box.
#ifndef debond_tests_application_own_check_h
#define debond_tests_application_own_check_h

#include <deal.II/base/quadrature_lib.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace OwnCheck
{
  using Real    = long double;
  using VectorX = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using MatrixX = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;



  /// A force density, affine on each cell: at a point of the cell with the
  /// given centre.
  template <int dim>
  using Density =
    std::function<std::array<Real, dim>(const std::array<Real, dim> &point,
                                        const std::array<Real, dim> &centre)>;



  template <int dim>
  struct Scene
  {
    std::array<double, dim>       lengths;
    std::array<unsigned int, dim> cells;
    double                        lambda, mu; ///< of the plane problem in 2D

    std::set<std::string> clamped, contact;
    bool                  tangential_fixed;

    std::map<std::string, Density<dim>> tractions;
    Density<dim>                        body_force; ///< empty if there is none

    double      a, M; ///< a = 0 without adhesion
    std::string quadrature;

    /// Components along the edges of the box that are prescribed on a side.
    struct Prescribed
    {
      std::array<bool, dim>   is_prescribed;
      std::array<double, dim> values;
    };
    std::map<std::string, Prescribed> prescribed = {};

    using Field     = std::function<Real(const std::array<Real, dim> &point)>;
    Field gap       = {};                 ///< empty for none
    Field stiffness = {}, threshold = {}; ///< in place of a, M

    /// What a contact side has of its own: empty where it is as all others.
    struct Own
    {
      Field               gap = {}, stiffness = {}, threshold = {};
      std::optional<bool> tangential_fixed = {};
    };
    std::map<std::string, Own> own = {};

    /// Whether supports alone may leave rigid motions free.
    bool held_by_bonds = false;

    Real
    gap_at(const std::string &side, const std::array<Real, dim> &point) const
    {
      const Field &field = choose(side, &Own::gap, gap);
      return field ? field(point) : Real(0);
    }

    Real
    a_at(const std::string &side, const std::array<Real, dim> &point) const
    {
      const Field &field = choose(side, &Own::stiffness, stiffness);
      return field ? field(point) : Real(a);
    }

    Real
    M_at(const std::string &side, const std::array<Real, dim> &point) const
    {
      const Field &field = choose(side, &Own::threshold, threshold);
      return field ? field(point) : Real(M);
    }

    bool
    fixes_tangential(const std::string &side) const
    {
      const auto entry = own.find(side);
      return entry == own.end() ?
               tangential_fixed :
               entry->second.tangential_fixed.value_or(tangential_fixed);
    }

  private:
    const Field &
    choose(const std::string &side,
           Field Own::*const member,
           const Field      &others) const
    {
      const auto entry = own.find(side);
      return entry != own.end() && entry->second.*member ?
               entry->second.*member :
               others;
    }
  };



  /// The axis and the sense of the outward normal of a side.
  inline std::pair<unsigned int, int>
  direction(const std::string &side)
  {
    static const std::map<std::string, std::pair<unsigned int, int>>
      directions = {{"left", {0, -1}},
                    {"right", {0, 1}},
                    {"bottom", {1, -1}},
                    {"top", {1, 1}},
                    {"back", {2, -1}},
                    {"front", {2, 1}}};
    return directions.at(side);
  }



  template <int dim>
  class Body
  {
  public:
    using Point = std::array<Real, dim>;
    using Key   = std::array<int, dim>; ///< twice the indices of the grid

    explicit Body(const Scene<dim> &scene)
      : scene(scene)
    {
      make_mesh();
      make_unknowns();
      assemble();
      condense();
    }

    unsigned int
    n_contact() const
    {
      return contact_dofs.size();
    }

    unsigned int
    n_dofs() const
    {
      return dim * points.size();
    }

    /// The vertex at a point of the box.
    unsigned int
    vertex(const std::array<double, dim> &point) const
    {
      Key key;
      for (unsigned int d = 0; d < dim; ++d)
        key[d] = static_cast<int>(
          std::lround(2. * scene.cells[d] * point[d] / scene.lengths[d]));
      return vertices.at(key);
    }

    /// A u - f.
    VectorX
    residual(const VectorX &u) const
    {
      return A * u - f;
    }

    /// What displacements that were rounded to double leave of A u - f.
    VectorX
    rounding(const VectorX &u) const
    {
      VectorX sums = VectorX::Zero(n_dofs());
      for (int column = 0; column < A.outerSize(); ++column)
        for (typename Eigen::SparseMatrix<Real>::InnerIterator entry(A, column);
             entry;
             ++entry)
          sums(entry.row()) += std::abs(entry.value() * u(column));
      return std::numeric_limits<double>::epsilon() * sums;
    }

    /// The same of what stays of gaps in s.
    VectorX
    rounding_of_gaps() const
    {
      VectorX closed = VectorX::Zero(n_dofs());
      for (unsigned int i = 0; i < n_contact(); ++i)
        closed(contact_dofs[i]) = gap(i);
      return rounding(closed);
    }

    Real
    largest_gap() const
    {
      return n_contact() > 0 ? gap.maxCoeff() : 0;
    }

    /// Forces or prescribed displacements.
    bool
    has_loads() const
    {
      return !f.isZero(0) || !fixed_values.isZero(0);
    }

    VectorX
    normal_displacements(const VectorX &u) const
    {
      VectorX s(n_contact());
      for (unsigned int i = 0; i < n_contact(); ++i)
        s(i) = sense[i] * u(contact_dofs[i]) - gap(i);
      return s;
    }

    /// Of forces there is no gap.
    VectorX
    normal_forces(const VectorX &f) const
    {
      VectorX s(n_contact());
      for (unsigned int i = 0; i < n_contact(); ++i)
        s(i) = sense[i] * f(contact_dofs[i]);
      return s;
    }

    /// What is prescribed at a fixed component.
    Real
    prescribed(const unsigned int dof) const
    {
      return fixed_values(dof);
    }

    Real
    elastic_part(const VectorX &u) const
    {
      Real energy = 0;
      for (const auto &cell : simplices)
        {
          Real gradient[dim][dim] = {};
          for (unsigned int v = 0; v <= dim; ++v)
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int d = 0; d < dim; ++d)
                gradient[k][d] +=
                  u(dim * cell.vertices[v] + k) * cell.gradients[v][d];
          Real trace = 0, square = 0;
          for (unsigned int k = 0; k < dim; ++k)
            {
              trace += gradient[k][k];
              for (unsigned int d = 0; d < dim; ++d)
                {
                  const Real strain = (gradient[k][d] + gradient[d][k]) / 2;
                  square += strain * strain;
                }
            }
          energy += cell.volume *
                    (scene.lambda / 2 * trace * trace + scene.mu * square);
        }
      return energy;
    }

    Real
    functional(const VectorX &u) const
    {
      return elastic_part(u) - f.dot(u) + adhesion(normal_displacements(u));
    }

    /// What the terms of J are made of, for tolerances.
    Real
    size_of_terms(const VectorX &u) const
    {
      return elastic_part(u) + std::abs(f.dot(u)) +
             adhesion(normal_displacements(u));
    }

    /// The integral of j_1.
    Real
    adhesion(const VectorX &s) const
    {
      Real energy = 0;
      integrate(s,
                [&](const Face &,
                    const Real weight,
                    const Real trace,
                    const std::array<Real, dim> &,
                    const Real a,
                    const Real M) {
                  energy +=
                    weight * a / 2 * (trace > -M ? trace * trace : M * M);
                });
      return energy;
    }

    /// The bonds that hold at some s: j_1' there is stiffness * s + held.
    struct Bonds
    {
      MatrixX stiffness;
      VectorX held; ///< of prescribed vertices
    };

    Bonds
    bonds(const VectorX &s) const
    {
      Bonds B = {MatrixX::Zero(n_contact(), n_contact()),
                 VectorX::Zero(n_contact())};
      integrate(s,
                [&](const Face                  &face,
                    const Real                   weight,
                    const Real                   trace,
                    const std::array<Real, dim> &phi,
                    const Real                   a,
                    const Real                   M) {
                  if (!(trace > -M))
                    return;
                  for (unsigned int v = 0; v < dim; ++v)
                    for (unsigned int w = 0; w < dim; ++w)
                      if (face.contact[v] >= 0)
                        {
                          const Real k = weight * a * phi[v] * phi[w];
                          if (face.contact[w] >= 0)
                            B.stiffness(face.contact[v], face.contact[w]) += k;
                          else
                            B.held(face.contact[v]) += k * face.held[w];
                        }
                });
      return B;
    }

    /// The most that the bonds of a contact node can bear: those that there
    /// are, which may be none though the scene has a law.
    Real
    largest_strength() const
    {
      VectorX strength = VectorX::Zero(n_contact());
      integrate(VectorX::Zero(n_contact()),
                [&](const Face &face,
                    const Real  weight,
                    const Real,
                    const std::array<Real, dim> &phi,
                    const Real                   a,
                    const Real                   M) {
                  for (unsigned int v = 0; v < dim; ++v)
                    if (face.contact[v] >= 0)
                      strength(face.contact[v]) += weight * phi[v] * a * M;
                });
      return n_contact() > 0 ? strength.maxCoeff() : 0;
    }

    /// The body with loads, and prescribed displacements and gaps as loads,
    /// that differ by one rounding in double of their largest component. What
    /// this changes, the loads do not decide.
    Body
    with_rounded_loads(const unsigned int seed) const
    {
      std::mt19937  signs(seed);
      const VectorX of_supports = A.cwiseAbs() * at_zero().cwiseAbs();
      Body          body        = *this;
      for (unsigned int i = 0; i < n_dofs(); ++i)
        {
          Real size = of_supports(i);
          for (unsigned int k = 0; k < dim; ++k)
            size = std::max(size, std::abs(f(i / dim * dim + k)));
          body.f(i) += (signs() % 2 == 0 ? 1 : -1) *
                       Real(std::numeric_limits<double>::epsilon()) * size;
        }
      body.condense_loads();
      return body;
    }

    /// Majorise-minimise from the state of the bonds at s. Of a body that
    /// comes off, a displacement far away. What nothing resists stays where it
    /// is at s: J is the same all along it, until a bond closes.
    VectorX
    descend(VectorX s) const
    {
      Bonds         B          = bonds(s);
      const MatrixX W          = held_weakly();
      const VectorX from_start = W * s;
      for (unsigned int k = 0; k < 200; ++k)
        {
          s = minimise_convex(S + B.stiffness + W, g - B.held + from_start);
          if (is_off(s))
            break;
          Bonds next = bonds(s);
          std::swap(B, next);
          if (next.stiffness == B.stiffness)
            break;
        }
      return s;
    }

    /// The contact nodes of the body at rest.
    VectorX
    at_rest() const
    {
      return -gap;
    }

    /// What the foundation cannot balance of the resultants of the loads along
    /// the rigid motions that neither supports nor the bonds that hold at s
    /// resist, relative to the terms that are summed up in them: the body goes
    /// off unless this is zero. Bonds that hold beside a node about which the
    /// body turns off are on a part of a face, and resist by its cube. Bonds
    /// that are softer than the weak springs hold nothing: descend() does not
    /// see them.
    Real
    unbalanced(const VectorX &s) const
    {
      if (free_normals.cols() == 0)
        return 0;
      const MatrixX B_0 = bonds(VectorX::Zero(n_contact())).stiffness;
      const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(
        MatrixX(free_normals.transpose() * bonds(s).stiffness * free_normals));
      const Real none    = std::max(Real(1e-10) * B_0.norm(), weak_stiffness());
      const int  n_loose = (eigen.eigenvalues().array() <= none).count();
      if (n_loose == 0)
        return 0;
      const MatrixX turn  = eigen.eigenvectors().leftCols(n_loose);
      const VectorX work  = (free_motions * turn).transpose() * f;
      const Real    terms = (free_motions.cwiseAbs().transpose() * f.cwiseAbs())
                           .template lpNorm<Eigen::Infinity>();
      return terms > 0 ?
               not_balanced(work, free_normals * turn).norm() / terms :
               0;
    }

    /// Whether s is a result of descend() that nothing holds. What is less
    /// rounding in double.
    bool
    is_off(const VectorX &s) const
    {
      return scene.held_by_bonds && s.size() > 0 &&
             unbalanced(s) > 100 * std::numeric_limits<double>::epsilon();
    }

    /// Whether this is a question of rounding.
    bool
    is_hardly_off(const VectorX &s) const
    {
      const Real rest = unbalanced(s);
      return scene.held_by_bonds && s.size() > 0 &&
             rest > 100 * std::numeric_limits<Real>::epsilon() &&
             rest <= 100 * std::numeric_limits<double>::epsilon();
    }

    /// All unknowns, at the minimum for the given normal displacements.
    VectorX
    expand(const VectorX &s) const
    {
      VectorX u = fixed_values;
      for (unsigned int i = 0; i < n_contact(); ++i)
        u(contact_dofs[i]) = sense[i] * (s(i) + gap(i));
      const VectorX inside = X_f - X * s;
      for (unsigned int i = 0; i < free_dofs.size(); ++i)
        u(free_dofs[i]) = inside(i);
      return u;
    }

    /// Whether a component is neither fixed nor a contact normal.
    bool
    is_free(const unsigned int dof) const
    {
      return kind[dof] == Kind::free;
    }

    bool
    is_fixed(const unsigned int dof) const
    {
      return kind[dof] == Kind::fixed;
    }

  private:
    enum class Kind
    {
      free,
      fixed,
      contact
    };

    struct Simplex
    {
      std::array<unsigned int, dim + 1>          vertices;
      std::array<std::array<Real, dim>, dim + 1> gradients;
      Real                                       volume;
      Point                                      centre; ///< of the cell
    };

    struct Face
    {
      std::array<unsigned int, dim> vertices;
      std::array<int, dim>          contact;   ///< number, -1 where fixed
      std::array<Real, dim>         held = {}; ///< s where fixed
      Real                          measure;
      std::string                   side;
      Point                         centre;
    };

    unsigned int
    add_vertex(const Key &key)
    {
      const auto [place, is_new] = vertices.emplace(key, points.size());
      if (is_new)
        {
          Point point;
          for (unsigned int d = 0; d < dim; ++d)
            point[d] = Real(scene.lengths[d]) * key[d] / (2 * scene.cells[d]);
          points.push_back(point);
        }
      return place->second;
    }

    void
    make_mesh()
    {
      unsigned int n_cells = 1;
      for (const unsigned int n : scene.cells)
        n_cells *= n;
      for (unsigned int c = 0; c < n_cells; ++c)
        {
          Key          centre;
          unsigned int rest = c;
          for (unsigned int d = 0; d < dim; ++d)
            {
              centre[d] = 2 * static_cast<int>(rest % scene.cells[d]) + 1;
              rest /= scene.cells[d];
            }
          const unsigned int middle = add_vertex(centre);
          for (unsigned int d = 0; d < dim; ++d)
            for (const int s : {-1, 1})
              add_pyramid(centre, middle, d, s);
        }
    }

    /// The simplices between the centre of a cell and a face of it.
    void
    add_pyramid(const Key         &centre,
                const unsigned int middle,
                const unsigned int d,
                const int          s)
    {
      Key face = centre;
      face[d] += s;
      std::vector<std::array<unsigned int, dim>> parts;
      if constexpr (dim == 2)
        {
          Key first = face, second = face;
          first[1 - d] -= 1;
          second[1 - d] += 1;
          parts.push_back({{add_vertex(first), add_vertex(second)}});
        }
      else
        {
          const unsigned int e = (d + 1) % 3, g = (d + 2) % 3;
          const int          turns[5][2] = {
                     {-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
          for (unsigned int k = 0; k < 4; ++k)
            {
              Key first = face, second = face;
              first[e] += turns[k][0];
              first[g] += turns[k][1];
              second[e] += turns[k + 1][0];
              second[g] += turns[k + 1][1];
              parts.push_back(
                {{add_vertex(face), add_vertex(first), add_vertex(second)}});
            }
        }
      const bool at_boundary =
        face[d] == 0 || face[d] == 2 * static_cast<int>(scene.cells[d]);
      for (const auto &part : parts)
        {
          Simplex simplex;
          simplex.vertices[0] = middle;
          for (unsigned int v = 0; v < dim; ++v)
            simplex.vertices[v + 1] = part[v];
          Eigen::Matrix<Real, dim, dim> edges;
          for (unsigned int v = 0; v < dim; ++v)
            for (unsigned int k = 0; k < dim; ++k)
              edges(v, k) = points[part[v]][k] - points[middle][k];
          const Eigen::Matrix<Real, dim, dim> inverse = edges.inverse();
          simplex.volume = std::abs(edges.determinant()) / (dim == 2 ? 2 : 6);
          for (unsigned int k = 0; k < dim; ++k)
            {
              simplex.gradients[0][k] = 0;
              for (unsigned int v = 0; v < dim; ++v)
                {
                  simplex.gradients[v + 1][k] = inverse(k, v);
                  simplex.gradients[0][k] -= inverse(k, v);
                }
            }
          simplex.centre = points[middle];
          simplices.push_back(simplex);
          if (!at_boundary)
            continue;

          Face boundary;
          boundary.vertices = part;
          boundary.centre   = points[middle];
          boundary.side     = std::array<std::array<const char *, 2>, 3>{
                {{{"left", "right"}},
                 {{"bottom", "top"}},
                 {{"back", "front"}}}}[d][s > 0];
          boundary.contact.fill(-1);
          // The height of the pyramid is half a cell.
          boundary.measure = simplex.volume * dim /
                             (Real(scene.lengths[d]) / (2 * scene.cells[d]));
          faces.push_back(boundary);
        }
    }

    void
    make_unknowns()
    {
      kind.assign(n_dofs(), Kind::free);
      std::map<unsigned int, int>                   senses;
      std::map<unsigned int, std::set<std::string>> sides_at;
      std::map<unsigned int, std::string>           sides_of;
      for (const Face &face : faces)
        if (scene.contact.count(face.side) > 0)
          for (const unsigned int v : face.vertices)
            {
              const auto [d, s]     = direction(face.side);
              kind[dim * v + d]     = Kind::contact;
              senses[dim * v + d]   = s;
              sides_of[dim * v + d] = face.side;
              sides_at[v].insert(face.side);
            }
      // Where one side fixes what is tangential, all is tangential to one.
      for (const auto &[v, sides] : sides_at)
        for (const std::string &side : sides)
          if (scene.fixes_tangential(side))
            for (unsigned int e = 0; e < dim; ++e)
              if (sides.size() > 1 || e != direction(side).first)
                kind[dim * v + e] = Kind::fixed;
      for (const Face &face : faces)
        if (scene.clamped.count(face.side) > 0)
          for (const unsigned int v : face.vertices)
            for (unsigned int e = 0; e < dim; ++e)
              kind[dim * v + e] = Kind::fixed;

      fixed_values = VectorX::Zero(n_dofs());
      for (const Face &face : faces)
        if (const auto entry = scene.prescribed.find(face.side);
            entry != scene.prescribed.end())
          for (const unsigned int v : face.vertices)
            for (unsigned int e = 0; e < dim; ++e)
              if (entry->second.is_prescribed[e])
                {
                  kind[dim * v + e]         = Kind::fixed;
                  fixed_values(dim * v + e) = entry->second.values[e];
                }

      number.assign(n_dofs(), -1);
      for (unsigned int i = 0; i < n_dofs(); ++i)
        if (kind[i] == Kind::free)
          {
            number[i] = free_dofs.size();
            free_dofs.push_back(i);
          }
        else if (kind[i] == Kind::contact)
          {
            number[i] = contact_dofs.size();
            contact_dofs.push_back(i);
            sense.push_back(senses.at(i));
          }
      gap = VectorX::Zero(n_contact());
      for (unsigned int i = 0; i < n_contact(); ++i)
        gap(i) = scene.gap_at(sides_of.at(contact_dofs[i]),
                              points[contact_dofs[i] / dim]);

      std::vector<Face> in_contact;
      for (Face face : faces)
        if (scene.contact.count(face.side) > 0)
          {
            const auto [d, s] = direction(face.side);
            for (unsigned int v = 0; v < dim; ++v)
              if (kind[dim * face.vertices[v] + d] == Kind::contact)
                face.contact[v] = number[dim * face.vertices[v] + d];
              else
                face.held[v] =
                  s * fixed_values(dim * face.vertices[v] + d) -
                  scene.gap_at(face.side, points[face.vertices[v]]);
            in_contact.push_back(face);
          }
      all_faces.swap(faces);
      faces.swap(in_contact);
    }

    void
    assemble()
    {
      std::vector<Eigen::Triplet<Real>> entries;
      f = VectorX::Zero(n_dofs());
      for (const Simplex &cell : simplices)
        {
          for (unsigned int v = 0; v <= dim; ++v)
            for (unsigned int w = 0; w <= dim; ++w)
              {
                Real product = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  product += cell.gradients[v][d] * cell.gradients[w][d];
                for (unsigned int k = 0; k < dim; ++k)
                  for (unsigned int l = 0; l < dim; ++l)
                    entries.emplace_back(
                      dim * cell.vertices[v] + k,
                      dim * cell.vertices[w] + l,
                      cell.volume * (scene.lambda * cell.gradients[v][k] *
                                       cell.gradients[w][l] +
                                     scene.mu * (cell.gradients[v][l] *
                                                   cell.gradients[w][k] +
                                                 (k == l ? product : 0))));
              }
          if (scene.body_force)
            add_load(cell.vertices, cell.volume, cell.centre, scene.body_force);
        }
      A.resize(n_dofs(), n_dofs());
      A.setFromTriplets(entries.begin(), entries.end());
      for (const Face &face : all_faces)
        {
          const auto traction = scene.tractions.find(face.side);
          if (traction != scene.tractions.end())
            add_load(face.vertices,
                     face.measure,
                     face.centre,
                     traction->second);
        }
    }

    /// The exact integral of an affine density and the basis functions.
    template <std::size_t n>
    void
    add_load(const std::array<unsigned int, n> &corners,
             const Real                         measure,
             const Point                       &centre,
             const Density<dim>                &density)
    {
      for (unsigned int v = 0; v < n; ++v)
        {
          const std::array<Real, dim> value =
            density(points[corners[v]], centre);
          for (unsigned int w = 0; w < n; ++w)
            for (unsigned int k = 0; k < dim; ++k)
              f(dim * corners[w] + k) +=
                measure / (n * (n + 1)) * (v == w ? 2 : 1) * value[k];
        }
    }

    void
    condense()
    {
      std::vector<Eigen::Triplet<Real>> inside, coupling, outside;
      for (int column = 0; column < A.outerSize(); ++column)
        for (typename Eigen::SparseMatrix<Real>::InnerIterator entry(A, column);
             entry;
             ++entry)
          {
            const unsigned int i = entry.row(), j = entry.col();
            if (kind[i] == Kind::free && kind[j] == Kind::free)
              inside.emplace_back(number[i], number[j], entry.value());
            else if (kind[i] == Kind::free && kind[j] == Kind::contact)
              coupling.emplace_back(number[i],
                                    number[j],
                                    sense[number[j]] * entry.value());
            else if (kind[i] == Kind::contact && kind[j] == Kind::contact)
              outside.emplace_back(number[i],
                                   number[j],
                                   sense[number[i]] * sense[number[j]] *
                                     entry.value());
          }
      const unsigned int        n = free_dofs.size(), n_c = n_contact();
      Eigen::SparseMatrix<Real> A_ii(n, n), A_ic(n, n_c), A_cc(n_c, n_c);
      A_ii.setFromTriplets(inside.begin(), inside.end());
      A_ic.setFromTriplets(coupling.begin(), coupling.end());
      A_cc.setFromTriplets(outside.begin(), outside.end());
      factor =
        std::make_shared<Eigen::SimplicialLDLT<Eigen::SparseMatrix<Real>>>(
          A_ii);
      X = factor->solve(MatrixX(A_ic));
      S = MatrixX(A_cc) - A_ic.transpose() * X;
      S = ((S + S.transpose()) / 2).eval();
      A_inside_contact.swap(A_ic);
      condense_loads();
      if (scene.held_by_bonds)
        remove_rigid_motions();
    }

    /// What is prescribed, and contact nodes on the foundation.
    VectorX
    at_zero() const
    {
      VectorX u = fixed_values;
      for (unsigned int i = 0; i < n_contact(); ++i)
        u(contact_dofs[i]) = sense[i] * gap(i);
      return u;
    }

    void
    condense_loads()
    {
      const VectorX load = f - A * at_zero();
      VectorX       f_i(free_dofs.size()), f_c(n_contact());
      for (unsigned int i = 0; i < free_dofs.size(); ++i)
        f_i(i) = load(free_dofs[i]);
      for (unsigned int i = 0; i < n_contact(); ++i)
        f_c(i) = sense[i] * load(contact_dofs[i]);
      X_f = factor->solve(f_i);
      g   = f_c - A_inside_contact.transpose() * X_f;
    }

    /// What rounding leaves of S along motions that nothing resists.
    void
    remove_rigid_motions()
    {
      constexpr int n_motions = dim * (dim + 1) / 2;
      MatrixX       motions   = MatrixX::Zero(n_dofs(), n_motions);
      Real          size      = 0;
      for (const double length : scene.lengths)
        size = std::max(size, Real(length));
      for (unsigned int v = 0; v < points.size(); ++v)
        {
          int column = 0;
          for (unsigned int k = 0; k < dim; ++k)
            motions(dim * v + k, column++) = 1;
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int l = k + 1; l < dim; ++l, ++column)
              {
                const Point &x = points[v];
                motions(dim * v + k, column) =
                  -(x[l] - Real(scene.lengths[l]) / 2) / size;
                motions(dim * v + l, column) =
                  (x[k] - Real(scene.lengths[k]) / 2) / size;
              }
        }
      MatrixX gram = MatrixX::Zero(n_motions, n_motions);
      for (unsigned int i = 0; i < n_dofs(); ++i)
        if (is_fixed(i))
          gram += motions.row(i).transpose() * motions.row(i);
      const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(gram);
      MatrixX free(n_contact(), 0), whole(n_dofs(), 0);
      for (int k = 0; k < n_motions; ++k)
        if (eigen.eigenvalues()(k) <= Real(1e-15) * n_dofs())
          {
            VectorX motion = motions * eigen.eigenvectors().col(k);
            VectorX normal(n_contact());
            for (unsigned int i = 0; i < n_contact(); ++i)
              normal(i) = sense[i] * motion(contact_dofs[i]);
            for (int l = 0; l < free.cols(); ++l)
              {
                const Real part = free.col(l).dot(normal);
                normal -= free.col(l) * part;
                motion -= whole.col(l) * part;
              }
            if (normal.norm() == 0)
              continue;
            free.conservativeResize(Eigen::NoChange, free.cols() + 1);
            free.col(free.cols() - 1) = normal / normal.norm();
            whole.conservativeResize(Eigen::NoChange, free.cols());
            whole.col(free.cols() - 1) = motion / normal.norm();
          }
      S -= (free * (free.transpose() * S)).eval();
      S -= ((S * free) * free.transpose()).eval();
      free_normals = free;
      free_motions = whole;
    }

    /// w - Z'p with pressures p >= 0 that leave the least of w (Lawson and
    /// Hanson's algorithm; Z has few columns).
    static VectorX
    not_balanced(const VectorX &w, const MatrixX &Z)
    {
      const MatrixX    columns = Z.transpose();
      const int        n       = static_cast<int>(columns.cols());
      const Real       noise   = 1e-17 * w.norm();
      const Real       longest = columns.colwise().norm().maxCoeff();
      std::vector<int> loaded;
      VectorX          p    = VectorX::Zero(n);
      VectorX          rest = w;
      for (int k = 0; k < 10 * n; ++k)
        {
          int  next = -1;
          Real most = 0;
          for (int i = 0; i < n; ++i)
            if (std::find(loaded.begin(), loaded.end(), i) == loaded.end())
              {
                // Nodes about which the body turns move by rounding.
                const Real size = columns.col(i).norm();
                const Real gain = columns.col(i).dot(rest);
                if (size > 1e-9 * longest && gain > noise * size && gain > most)
                  {
                    next = i;
                    most = gain;
                  }
              }
          if (next < 0)
            break;
          loaded.push_back(next);
          while (true)
            {
              MatrixX part(columns.rows(), loaded.size());
              for (unsigned int i = 0; i < loaded.size(); ++i)
                part.col(i) = columns.col(loaded[i]);
              const VectorX best = part.colPivHouseholderQr().solve(w);
              // As far as all stay positive.
              Real step = 1;
              int  ends = -1;
              for (unsigned int i = 0; i < loaded.size(); ++i)
                if (best(i) <= 0)
                  {
                    const Real until = p(loaded[i]) / (p(loaded[i]) - best(i));
                    if (until < step || ends < 0)
                      {
                        step = until;
                        ends = i;
                      }
                  }
              for (unsigned int i = 0; i < loaded.size(); ++i)
                p(loaded[i]) += step * (best(i) - p(loaded[i]));
              if (ends < 0)
                break;
              p(loaded[ends]) = 0;
              loaded.erase(loaded.begin() + ends);
              if (loaded.empty())
                break;
            }
          const VectorX before = rest;
          rest                 = w - columns * p;
          if (!(rest.norm() < before.norm()))
            break;
        }
      return rest;
    }

    using Integrand = std::function<void(const Face &,
                                         const Real                   weight,
                                         const Real                   trace,
                                         const std::array<Real, dim> &phi,
                                         const Real                   a,
                                         const Real                   M)>;

    void
    at_point(const Face                  &face,
             const Real                   weight,
             const std::array<Real, dim> &t,
             const std::array<Real, dim> &phi,
             const Integrand             &integrand) const
    {
      Real  trace = 0;
      Point point = {};
      for (unsigned int v = 0; v < dim; ++v)
        {
          trace += phi[v] * t[v];
          for (unsigned int d = 0; d < dim; ++d)
            point[d] += phi[v] * points[face.vertices[v]][d];
        }
      integrand(face,
                weight * face.measure,
                trace,
                phi,
                scene.a_at(face.side, point),
                scene.M_at(face.side, point));
    }

    /// Calls the integrand at the points of the rule of the scene.
    void
    integrate(const VectorX &s, const Integrand &integrand) const
    {
      if (scene.a == 0.)
        return;
      for (const Face &face : faces)
        {
          std::array<Real, dim> t;
          for (unsigned int v = 0; v < dim; ++v)
            t[v] = face.contact[v] >= 0 ? s(face.contact[v]) : face.held[v];
          std::array<Real, dim> phi = {};
          if (scene.quadrature == "nodal")
            for (unsigned int v = 0; v < dim; ++v)
              {
                phi.fill(0);
                phi[v] = 1;
                at_point(face, Real(1) / dim, t, phi, integrand);
              }
          else if (scene.quadrature == "midpoint")
            {
              phi.fill(Real(1) / dim);
              at_point(face, 1, t, phi, integrand);
            }
          else if (scene.quadrature == "exact")
            integrate_exactly(face, t, integrand);
          else
            {
              const dealii::QWitherdenVincentSimplex<dim - 1> rule(
                std::stoi(scene.quadrature.substr(6)));
              for (unsigned int q = 0; q < rule.size(); ++q)
                {
                  phi[0] = 1;
                  for (unsigned int k = 1; k < dim; ++k)
                    {
                      phi[k] = rule.point(q)[k - 1];
                      phi[0] -= phi[k];
                    }
                  at_point(face,
                           rule.weight(q) * (dim == 2 ? 1 : 2),
                           t,
                           phi,
                           integrand);
                }
            }
        }
    }

    /// The face is cut where the trace is -M; quadratics on the pieces are
    /// integrated by Simpson's rule and by the midpoints of edges.
    void
    integrate_exactly(const Face                  &face,
                      const std::array<Real, dim> &t,
                      const Integrand             &integrand) const
    {
      // The same all over a face.
      Point middle_of_face = {};
      for (unsigned int v = 0; v < dim; ++v)
        for (unsigned int d = 0; d < dim; ++d)
          middle_of_face[d] += points[face.vertices[v]][d] / dim;
      const Real a      = scene.a_at(face.side, middle_of_face),
                 M      = scene.M_at(face.side, middle_of_face);
      using Barycentric = std::array<Real, dim>;
      for (const int side : {1, -1})
        {
          std::vector<Barycentric> polygon;
          for (unsigned int v = 0; v < dim; ++v)
            {
              const unsigned int w = (v + 1) % dim;
              const Real at_v = side * (t[v] + M), at_w = side * (t[w] + M);
              if (at_v >= 0)
                {
                  Barycentric corner = {};
                  corner[v]          = 1;
                  polygon.push_back(corner);
                }
              if ((at_v > 0 && at_w < 0) || (at_v < 0 && at_w > 0))
                {
                  Barycentric cut = {};
                  cut[v]          = at_w / (at_w - at_v);
                  cut[w]          = 1 - cut[v];
                  if (dim == 3 || polygon.size() < 2)
                    polygon.push_back(cut);
                }
            }
          const auto visit = [&](const Real weight, const Barycentric &phi) {
            Real trace = 0;
            for (unsigned int v = 0; v < dim; ++v)
              trace += phi[v] * t[v];
            // On the cut the piece decides.
            trace = side > 0 ? std::max(trace, -M * (1 - Real(1e-18))) :
                               std::min(trace, -M);
            integrand(face, weight * face.measure, trace, phi, a, M);
          };
          const auto middle = [](const Barycentric &p, const Barycentric &q) {
            Barycentric m;
            for (unsigned int v = 0; v < dim; ++v)
              m[v] = (p[v] + q[v]) / 2;
            return m;
          };
          if constexpr (dim == 2)
            {
              if (polygon.size() < 2)
                continue;
              const Real part = std::abs(polygon[1][0] - polygon[0][0]);
              visit(part / 6, polygon[0]);
              visit(part / 6, polygon[1]);
              visit(part * 2 / 3, middle(polygon[0], polygon[1]));
            }
          else
            for (unsigned int k = 2; k < polygon.size(); ++k)
              {
                const Barycentric &p = polygon[0], &q = polygon[k - 1],
                                  &r = polygon[k];
                const Real part      = std::abs((q[1] - p[1]) * (r[2] - p[2]) -
                                           (q[2] - p[2]) * (r[1] - p[1]));
                visit(part / 3, middle(p, q));
                visit(part / 3, middle(q, r));
                visit(part / 3, middle(r, p));
              }
        }
    }

    /// Of springs at the contact nodes that are lost beside whatever holds a
    /// body.
    Real
    weak_stiffness() const
    {
      return 1e-12 * scene.mu *
             (dim == 3 ?
                *std::max_element(scene.lengths.begin(), scene.lengths.end()) :
                1.);
    }

    MatrixX
    held_weakly() const
    {
      const unsigned int n = n_contact();
      return scene.held_by_bonds ?
               MatrixX(weak_stiffness() * MatrixX::Identity(n, n)) :
               MatrixX(MatrixX::Zero(n, n));
    }

    /// min 1/2 s'Qs - g's subject to s <= 0: all that is wrong is exchanged
    /// while fewer and fewer are wrong, else the last one alone, which ends.
    VectorX
    minimise_convex(const MatrixX &Q, const VectorX &g) const
    {
      const unsigned int n = n_contact();
      std::vector<bool>  is_loose(n, true);
      VectorX            s     = VectorX::Zero(n);
      unsigned int       least = n + 1, patience = 5;
      for (unsigned int k = 0; k < 20 * n + 100; ++k)
        {
          std::vector<unsigned int> loose;
          for (unsigned int i = 0; i < n; ++i)
            if (is_loose[i])
              loose.push_back(i);
          MatrixX Q_l(loose.size(), loose.size());
          VectorX g_l(loose.size());
          for (unsigned int i = 0; i < loose.size(); ++i)
            {
              g_l(i) = g(loose[i]);
              for (unsigned int j = 0; j < loose.size(); ++j)
                Q_l(i, j) = Q(loose[i], loose[j]);
            }
          s.setZero();
          if (!loose.empty())
            {
              const VectorX s_l = Q_l.ldlt().solve(g_l);
              for (unsigned int i = 0; i < loose.size(); ++i)
                s(loose[i]) = s_l(i);
            }
          const VectorX force = g - Q * s;
          const Real    noise = 1e-15 * g.template lpNorm<Eigen::Infinity>();
          std::vector<unsigned int> wrong;
          for (unsigned int i = 0; i < n; ++i)
            if (is_loose[i] ? s(i) > 0 : force(i) < -noise)
              wrong.push_back(i);
          if (wrong.empty())
            break;
          patience = wrong.size() < least ? 5 : patience - (patience > 0);
          least    = std::min<unsigned int>(least, wrong.size());
          if (patience > 0)
            for (const unsigned int i : wrong)
              is_loose[i] = !is_loose[i];
          else
            is_loose[wrong.back()] = !is_loose[wrong.back()];
        }
      return s.cwiseMin(Real(0));
    }

    const Scene<dim>            scene;
    std::map<Key, unsigned int> vertices;
    std::vector<Point>          points;
    std::vector<Simplex>        simplices;
    std::vector<Face>           faces, all_faces; ///< faces: of contact

    std::vector<Kind>         kind;
    std::vector<int>          number, sense;
    std::vector<unsigned int> free_dofs, contact_dofs;

    Eigen::SparseMatrix<Real> A, A_inside_contact;
    VectorX                   f, g, X_f, fixed_values, gap;
    MatrixX                   S, X;

    std::shared_ptr<const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Real>>>
      factor; ///< of A inside

    /// Rigid motions that supports do not resist: what they move the contact
    /// nodes by, orthonormal, and all unknowns.
    MatrixX free_normals, free_motions;
  };
} // namespace OwnCheck

#endif
