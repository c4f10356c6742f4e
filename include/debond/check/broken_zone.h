// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_broken_zone_h
#define debond_check_broken_zone_h

#include <debond/contact/adhesion_integral.h>

namespace Debond
{
  /// The length (in 3D the area) of the faces in whose middle the scene has no
  /// bonds, open or closed.
  template <int dim>
  double
  zone_without_bonds(const ContactBoundary<dim>  &boundary,
                     const AdhesionIntegral<dim> &adhesion);

  /// The length (in 3D the area) of the contact boundary that is open and not
  /// bonded: where bonds are opened beyond AdhesiveLaw::broken_beyond(), or at
  /// all where there are none or they are broken for good. So a crack in 2D
  /// ends between two nodes, or where the scene's bonds begin.
  template <int dim>
  double
  broken_zone(const ContactBoundary<dim>  &boundary,
              const AdhesionIntegral<dim> &adhesion,
              const VectorView            &s);

  /// Returns where bonds that hold meet bonds that do not, or none: where they
  /// are opened by AdhesiveLaw::broken_beyond(), at a vertex or edge where the
  /// scene's bonds begin, or halfway on a face at one vertex of which there are
  /// none. Of plane bodies these are places in the order of the faces. Of
  /// solids they are lines, and the result has the least coordinates of all,
  /// the mean ones by length, and the largest; nothing where there is no line.
  /// They stay where they are when a crack closes.
  template <int dim>
  std::vector<dealii::Point<dim>>
  fronts(const ContactBoundary<dim>  &boundary,
         const AdhesionIntegral<dim> &adhesion,
         const VectorView            &s);
} // namespace Debond

#endif
