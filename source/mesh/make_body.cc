// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/make_body.h>

namespace Debond
{
  template <int dim>
  std::unique_ptr<const Body<dim>>
  make_body(const BodyParameters &parameters)
  {
    return std::make_unique<const Box<dim>>(parameters.box);
  }



  template std::unique_ptr<const Body<2>>
  make_body(const BodyParameters &);
  template std::unique_ptr<const Body<3>>
  make_body(const BodyParameters &);
} // namespace Debond
