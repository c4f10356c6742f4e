// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_parted_body_h
#define debond_mesh_parted_body_h

#include <debond/mesh/body.h>

#include <functional>
#include <vector>

namespace Debond
{
  /// A piece of a boundary, or of the body, with a name of its own: the faces
  /// (cells) whose centre satisfies a condition.
  template <int dim>
  struct Part
  {
    std::string                                     name;
    std::string                                     boundary; ///< or none
    std::function<bool(const dealii::Point<dim> &)> contains;
  };



  /// A body whose parts have names beside those of its boundaries and regions.
  /// Parts may overlap.
  template <int dim>
  class PartedBody : public Body<dim>
  {
  public:
    /// The boundaries of the parts are of @p whole.
    PartedBody(const std::shared_ptr<const Body<dim>> &whole,
               const std::vector<Part<dim>>           &parts);

    std::set<std::string>
    boundaries() const override;

    std::set<std::string>
    regions() const override;

    double
    n_cells() const override;

    double
    n_vertices() const override;

    /// Of a part: at most those of its boundary.
    double
    n_vertices_on(const std::string &boundary) const override;

    BodyShape
    shape() const override;

    bool
    has_coarse_levels() const override;

    /// Throws PartError if a part has no face (no cell).
    PieceNames
    make_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// That of the whole, if each part has a face (a cell) in it.
    std::unique_ptr<const Body<dim>>
    coarser() const override;

    std::vector<dealii::Tensor<1, dim>>
    interpolate(const dealii::Triangulation<dim>          &mesh,
                const std::vector<dealii::Tensor<1, dim>> &values,
                const std::vector<dealii::Point<dim>> &points) const override;

    /// Those of the whole.
    std::vector<CoarseLevel<dim>>
    coarse_levels(const dealii::Triangulation<dim> &mesh,
                  const std::vector<unsigned int>  &vertices) const override;

    std::vector<unsigned int>
    slabs(const dealii::Triangulation<dim> &mesh) const override;

  private:
    const std::shared_ptr<const Body<dim>> whole;
    const std::vector<Part<dim>>           parts;
  };
} // namespace Debond

#endif
