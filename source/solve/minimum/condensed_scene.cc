// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/solve/minimum/condensed_scene.h>

namespace Debond
{
  template <int dim>
  StationaryPath::Problem
  CondensedScene<dim>::between(const LoadFactors            first,
                               const LoadFactors            last,
                               const double                 length,
                               const AdhesionIntegral<dim> &integral) const
  {
    // With nodal bonds each s_i has the law w_i f(s_i / l_i), and g is affine
    // in the factor, as StationaryPath needs it: its slope is the difference of
    // g over the length of the interval of t. Pieces that a bond has left for
    // good are below its least one.
    const Eigen::VectorXd             g = load(first);
    std::vector<StationaryPath::Bond> bonds_of_nodes;
    const auto                       &nodes = scene.contact_boundary().nodes;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const BondScale scale = integral.points().bonds_at(i);
        bonds_of_nodes.push_back({nodes[i].measure * scale.energy,
                                  scale.length,
                                  integral.least_piece(i)});
      }
    return {condensed.schur_complement(),
            g,
            (load(last) - g) / length,
            scene.law().pieces(),
            bonds_of_nodes,
            scene.parameters().load_path.bonds_heal};
  }



  DEBOND_INSTANTIATE_CLASS(CondensedScene);
} // namespace Debond
