// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_instantiate_h
#define debond_base_instantiate_h

/// Instantiates a function template whose only parameter is the dimension in 2D
/// and 3D, as deal.II's .inst.in files do.
#define DEBOND_INSTANTIATE(function)          \
  template decltype(function<2>) function<2>; \
  template decltype(function<3>) function<3>

/// The same for a class template, or a structure.
#define DEBOND_INSTANTIATE_CLASS(Class) \
  template class Class<2>;              \
  template class Class<3>

#endif
