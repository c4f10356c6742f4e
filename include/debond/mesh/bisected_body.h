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

    /// Returns for each cell the one of the mesh that this one is refined()
    /// from.
    const std::vector<unsigned int> &
    ancestors() const
    {
      return bisection.ancestors();
    }

    double
    n_cells() const override
    {
      return bisection.n_cells();
    }

    double
    n_vertices() const override
    {
      return static_cast<double>(bisection.vertices().size());
    }

    PieceNames
    whole_names() const override
    {
      return names;
    }

    void
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override
    {
      bisection.make_mesh(mesh);
    }

    /// None: a solution goes from mesh to mesh by ancestors().
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
