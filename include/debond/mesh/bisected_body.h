// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_bisected_body_h
#define debond_mesh_bisected_body_h

#include <debond/mesh/bisection.h>
#include <debond/mesh/body.h>

namespace Debond
{
  /**
   * A body on the mesh of another one, refined locally. The new faces and cells
   * have the names of those that they are parts of: curved sides, and the edges
   * of parts, stay as the first mesh has them.
   */
  template <int dim>
  class BisectedBody : public Body<dim>
  {
  public:
    /// The mesh of @p whole as it is. Throws as its make_mesh() and Bisection
    /// do.
    explicit BisectedBody(const std::shared_ptr<const Body<dim>> &whole);

    /// With each cell cut at least @p times as often, in the order of the
    /// active cells.
    std::shared_ptr<const BisectedBody>
    refined(const std::vector<unsigned int> &times) const
    {
      return std::shared_ptr<const BisectedBody>(
        new BisectedBody(*this, times));
    }

    /// The same P1 function on this mesh, from the values at the vertices of
    /// the mesh that this one is refined() from.
    template <typename T>
    void
    extend(std::vector<T> &values) const
    {
      bisection.extend(values);
    }

    /// In the order of the whole mesh.
    const std::vector<dealii::Point<dim>> &
    vertices() const
    {
      return bisection.vertices();
    }

    /// For each vertex of a part of the mesh its place there.
    std::vector<unsigned int>
    vertex_numbers(const dealii::Triangulation<dim> &part) const;

    /// Of each cell the one of the mesh that this one is refined() from.
    const std::vector<unsigned int> &
    ancestors() const
    {
      return bisection.ancestors();
    }

    std::set<std::string>
    whole_boundaries() const override
    {
      return whole->boundaries();
    }

    std::set<std::string>
    whole_regions() const override
    {
      return whole->regions();
    }

    double
    n_cells() const override
    {
      return bisection.n_cells();
    }

    double
    n_vertices() const override;

    /// With as many cells as there would be if they were alike. Refined it is
    /// no box of so many cells.
    BodyShape
    shape() const override;

    PieceNames
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// None: a solution goes from mesh to mesh by extend().
    std::unique_ptr<Body<dim>>
    coarser_whole() const override
    {
      return nullptr;
    }

  private:
    BisectedBody(const BisectedBody              &coarse,
                 const std::vector<unsigned int> &times);

    /// A mesh of the body, for its constructor.
    static Bisection<dim>
    bisection_of(const Body<dim> &whole, PieceNames &names);

    const std::shared_ptr<const Body<dim>> whole;
    PieceNames                             names;
    Bisection<dim>                         bisection;
  };
} // namespace Debond

#endif
