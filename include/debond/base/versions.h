// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_versions_h
#define debond_base_versions_h

// What is called differently by the versions of deal.II that the program is
// built with.
#if __has_include(<deal.II/base/enable_observer_pointer.h>)
#  include <deal.II/base/enable_observer_pointer.h>
#else
#  include <deal.II/base/subscriptor.h>
#endif

namespace Debond
{
  /// The base of what deal.II's objects may point to.
#if __has_include(<deal.II/base/enable_observer_pointer.h>)
  using EnableObserverPointer = dealii::EnableObserverPointer; // from 9.7
#else
  using EnableObserverPointer = dealii::Subscriptor;
#endif
} // namespace Debond

#endif
