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
  /// The ids that the faces (the cells) with a name have. All of them occur in
  /// the mesh.
  using BoundaryNames =
    std::map<std::string, std::set<dealii::types::boundary_id>>;
  using RegionNames =
    std::map<std::string, std::set<dealii::types::material_id>>;

  /// Coarser levels of which the last has more vertices are no use: it is
  /// factorised at each change of the contact set.
  constexpr double most_coarsest_vertices = 5000.;

  /// Levels below are not worth a smoother.
  constexpr double fewest_vertices_of_level = 350.;



  /// The name of a boundary for messages, the narrowest of those that it has,
  /// "boundary 7" if it has none.
  std::string
  boundary_name(const BoundaryNames             &names,
                const dealii::types::boundary_id id);

  /// The name of all outer faces, with names or without, unless a body has a
  /// boundary of this name.
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

    /// ... or those that these regions have in common, ...
    std::string low = "", high = "";

    /// ... or those of a group of the file, in a body that was turned so.
    std::string            group    = "";
    dealii::Tensor<2, dim> rotation = {};

    /// The boundaries that are both sides.
    std::set<std::string>
    names() const
    {
      return group.empty() ? std::set<std::string>{name} :
                             std::set<std::string>{name, group};
    }
  };

  /// What a group of the file has inside the body.
  struct InnerGroup
  {
    std::set<dealii::types::manifold_id> ids; ///< of its faces in the mesh
    std::vector<std::string> notes;           ///< unless the body is cut there
  };

  /// Two sides of bodies that have no vertices in common, whose meshes need not
  /// match. Each is a boundary, or a region: what of its boundary lies on the
  /// other one.
  struct Interface
  {
    std::string name; ///< of both sides
    std::string high; ///< whose nodes carry the jumps
    std::string low;
  };



  /// The pieces of a mesh that have names.
  struct PieceNames
  {
    BoundaryNames boundaries;
    RegionNames   regions;

    /// The boundaries NAME that are both sides NAME_low and NAME_high of a cut
    /// or an interface.
    std::set<std::string> interfaces = {};

    /// Notes on the pieces for the user.
    std::vector<std::string> notes = {};

    /// Those that depend on cuts: on groups with faces inside or away from the
    /// body, and on vertices at the place of others. A Body has made notes of
    /// them.
    std::map<std::string, InnerGroup> inner_groups  = {};
    std::size_t                       n_twins       = 0;
    std::string                       note_on_twins = "";
  };



  /// A body of either dimension, before its mesh is made.
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

    /// About how many vertices the mesh has: what a user asks for may exceed
    /// an integer.
    virtual double
    n_vertices() const = 0;
  };



  /// The vertices of a mesh and its P1 fields. At a point of the body a field
  /// is the mean of its values at some vertices, with weights that may be
  /// negative beside the mesh.
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



  /// A body makes its mesh, and coarser meshes of the same body with the way
  /// between them.
  template <int dim>
  class Body : public BodyDescription
  {
  public:
    /// These have names beside those of the whole body's boundaries and
    /// regions.
    std::vector<Part<dim>> parts;

    /// The body is cut into several here. There are no coarser meshes then.
    std::vector<Cut<dim>> cuts;

    /// Bodies meet here. There are no coarser meshes then, either.
    std::vector<Interface> interfaces;

    std::set<std::string>
    boundaries() const final;

    std::set<std::string>
    regions() const final;

    /// Returns whether contact is between bodies somewhere.
    bool
    has_interfaces() const
    {
      return !cuts.empty() || !interfaces.empty();
    }

    /// The number of triangles or tetrahedra.
    virtual double
    n_cells() const = 0;

    /// The number that a large crossed mesh with so many cells has.
    double
    n_vertices() const override
    {
      return (dim == 2 ? 1. / 2. : 5. / 24.) * n_cells();
    }

    /// Fills an empty triangulation and returns the ids that the boundaries()
    /// and regions() have. Throws std::invalid_argument if the body is none,
    /// EntryError if a part has no face or cell.
    PieceNames
    make_mesh(dealii::Triangulation<dim> &mesh) const;

    /// Returns the same body with about half as many cells in each direction,
    /// null if there is none in which each part has a face (a cell).
    std::unique_ptr<Body>
    coarser() const;

    /// The body of the next coarser level for multigrid, without parts; null if
    /// this one takes nothing to solve, or if there is none.
    virtual std::unique_ptr<Body>
    coarser_level() const;

    /// Returns whether there are coarser levels, down to one that takes little
    /// to factorise.
    bool
    has_coarse_levels() const;

    /// The meshes of the coarser levels, finest first; empty unless
    /// has_coarse_levels(). If @p with_own the body's own mesh comes first,
    /// for displacements of a higher degree there. The first interpolation is
    /// to @p points of the body, each next one to all vertices of the level
    /// before.
    std::vector<CoarseLevel<dim>>
    coarse_levels(const std::vector<dealii::Point<dim>> &points,
                  const bool with_own = false) const;

  private:
    /// The pieces of the body without its parts, cuts and interfaces.
    virtual PieceNames
    whole_names() const = 0;

    /// Fills @p mesh with that of this body, which has the whole_names().
    virtual void
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const = 0;

    /// The body without parts with about half as many cells in each direction,
    /// or null.
    virtual std::unique_ptr<Body>
    coarser_whole() const = 0;

    /// The P1 fields of a mesh that is as good as the one of
    /// make_whole_mesh(), with vertices in another order.
    virtual LinearFields<dim>
    linear_fields() const;
  };
} // namespace Debond

#endif
