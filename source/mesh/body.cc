// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/body.h>

namespace Debond
{
  std::string
  boundary_name(const BoundaryNames &names, const dealii::types::boundary_id id)
  {
    auto narrowest = names.end();
    for (auto named = names.begin(); named != names.end(); ++named)
      if (named->second.count(id) > 0 &&
          (narrowest == names.end() ||
           named->second.size() < narrowest->second.size()))
        narrowest = named;
    return narrowest != names.end() ? narrowest->first :
                                      "boundary " + std::to_string(id);
  }



  bool
  BodyDescription::has_coarse_levels() const
  {
    return false;
  }



  template <int dim>
  std::vector<CoarseLevel<dim>>
  Body<dim>::coarse_levels(const dealii::Triangulation<dim> &,
                           const std::vector<unsigned int> &) const
  {
    return {};
  }



  template <int dim>
  std::vector<unsigned int>
  Body<dim>::slabs(const dealii::Triangulation<dim> &mesh) const
  {
    return std::vector<unsigned int>(mesh.n_vertices(), 0);
  }



  template class Body<2>;
  template class Body<3>;
} // namespace Debond
