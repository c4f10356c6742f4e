// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/make_body.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    std::shared_ptr<const BodyDescription>
    make(const BodyParameters &parameters)
    {
      return std::make_shared<const Box<dim>>(parameters.box);
    }
  } // namespace



  std::shared_ptr<const BodyDescription>
  make_body(const unsigned int dimension, const BodyParameters &parameters)
  {
    return dimension == 2 ? make<2>(parameters) : make<3>(parameters);
  }
} // namespace Debond
