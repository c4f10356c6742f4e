// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_body_h
#define debond_mesh_body_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/grid/tria.h>

#include <debond/base/entry_error.h>
#include <debond/mesh/interpolation.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Debond
{
  /// The faces and the cells of a mesh that have a name, by their ids. All ids
  /// occur in the mesh.
  using BoundaryNames =
    std::map<std::string, std::set<dealii::types::boundary_id>>;
  using RegionNames =
    std::map<std::string, std::set<dealii::types::material_id>>;

  /// Coarser levels of which the last has more vertices are no use: it is
  /// factorised at each change of the contact set.
  constexpr double most_coarsest_vertices = 5000.;

  /// Levels below are not worth a smoother.
  constexpr double fewest_vertices_of_level = 400.;



  /// The name of a boundary for messages, the narrowest of those that it has,
  /// "boundary 7" if it has none.
  std::string
  boundary_name(const BoundaryNames             &names,
                const dealii::types::boundary_id id);

  /// All outer faces, with names or without, unless a body has a boundary of
  /// this name.
  constexpr const char *whole_boundary = "boundary";

  /// A piece of a boundary, or of the body, with a name of its own: the faces
  /// (cells) whose centre satisfies a condition. Parts may overlap.
  template <int dim>
  struct Part
  {
    std::string                                     name;
    std::string                                     boundary; ///< or none
    std::function<bool(const dealii::Point<dim> &)> contains;
  };

  /// A surface between cells along which a body is cut into several.
  template <int dim>
  struct Cut
  {
    std::string name; ///< of the boundary on both sides
    std::string text; ///< for messages

    /// Either all faces that are on it, where the normal points from the low to
    /// the high side, ...
    std::function<bool(
      const typename dealii::Triangulation<dim>::face_iterator &)>
                           contains = {};
    dealii::Tensor<1, dim> normal   = {};

    /// ... or those that these regions have in common.
    std::string low = "", high = "";
  };

  struct PieceNames
  {
    BoundaryNames boundaries;
    RegionNames   regions;

    /// Boundaries NAME that are the two sides NAME_low and NAME_high of a cut.
    std::set<std::string> interfaces = {};

    /// The notes on the pieces for the user.
    std::vector<std::string> notes = {};
  };



  /**
   * What is known of a body without building its mesh, in either dimension.
   * Numbers of cells and vertices are double, as what a user writes may exceed
   * an integer.
   */
  class BodyDescription
  {
  public:
    virtual ~BodyDescription() = default;

    /// Groups in its file with faces that are inside or away from it.
    std::set<std::string> inner_groups;

    /// The pieces of the boundary that a scene can name.
    virtual std::set<std::string>
    boundaries() const = 0;

    /// The pieces of the body that a scene can name.
    virtual std::set<std::string>
    regions() const = 0;

    /// Triangles or tetrahedra.
    virtual double
    n_cells() const = 0;

    virtual double
    n_vertices() const = 0;

    /// Returns the extents of a box around the body, along its edges.
    virtual std::array<double, 3>
    extents() const = 0;

    /// Returns whether Body::coarse_levels() has any.
    virtual bool
    has_coarse_levels() const
    {
      return false;
    }
  };



  /// The vertices of a mesh and its P1 fields: at a point of the body they are
  /// means of the values at these vertices, with these weights. Beside the mesh
  /// weights may be negative.
  template <int dim>
  struct LinearFields
  {
    using Weights = std::array<std::pair<unsigned int, double>, dim + 1>;

    std::vector<dealii::Point<dim>>                    vertices;
    std::function<Weights(const dealii::Point<dim> &)> weights_at;
  };

  /// A coarser mesh: its vertices, and its P1 fields at those of the next finer
  /// mesh.
  template <int dim>
  struct CoarseLevel
  {
    std::vector<dealii::Point<dim>> vertices;
    Interpolation                   to_finer;
  };



  /// A body: its mesh, coarser meshes of the same body and the way between
  /// them.
  template <int dim>
  class Body : public BodyDescription
  {
  public:
    /// The parts that have names beside those of the whole body's boundaries
    /// and regions.
    std::vector<Part<dim>> parts;

    /// The cuts that make several bodies of this one. There are no coarser
    /// meshes then.
    std::vector<Cut<dim>> cuts;

    std::set<std::string>
    boundaries() const final;

    std::set<std::string>
    regions() const final;

    /// Fills an empty triangulation and says which ids the boundaries() and
    /// regions() have. Throws std::invalid_argument if the body is none,
    /// EntryError if a part has no face or cell.
    PieceNames
    make_mesh(dealii::Triangulation<dim> &mesh) const;

    /// Returns this body with about half as many cells in each direction, null
    /// if there is none in which each part has a face (a cell).
    std::unique_ptr<Body>
    coarser() const;

    /// The P1 field with @p values at the vertices of @p mesh, which is the one
    /// of make_mesh(), at points of the body. Points beside the mesh, as on the
    /// curved side of a finer one, belong to a cell next to them.
    std::vector<dealii::Tensor<1, dim>>
    interpolate(const dealii::Triangulation<dim>          &mesh,
                const std::vector<dealii::Tensor<1, dim>> &values,
                const std::vector<dealii::Point<dim>>     &points) const;

    /// The body of the next coarser level for multigrid, without parts; null if
    /// this one takes nothing to solve, or if there is none.
    virtual std::unique_ptr<Body>
    coarser_level() const;

    /// The meshes of the coarser levels, finest first; empty unless
    /// has_coarse_levels(). If @p with_own the body's own mesh comes first,
    /// for displacements of a higher degree there. The first interpolation is
    /// to @p points of the body, each next one to all vertices of the level
    /// before.
    std::vector<CoarseLevel<dim>>
    coarse_levels(const std::vector<dealii::Point<dim>> &points,
                  const bool with_own = false) const;

  private:
    /// Returns the names of the body's boundaries without those of its parts.
    virtual std::set<std::string>
    whole_boundaries() const = 0;

    virtual std::set<std::string>
    whole_regions() const = 0;

    virtual PieceNames
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const = 0;

    virtual std::unique_ptr<Body>
    coarser_whole() const = 0;

    /// Returns the linear fields of a mesh that is as good as the one of
    /// make_whole_mesh(), with vertices in another order.
    virtual LinearFields<dim>
    linear_fields() const;
  };
} // namespace Debond

#endif
