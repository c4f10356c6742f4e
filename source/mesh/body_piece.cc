// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/body_piece.h>

namespace Debond
{
  template <int dim>
  BodyPiece<dim>::BodyPiece(const std::shared_ptr<const Body<dim>> &whole,
                            const unsigned int                      n_slabs,
                            const unsigned int                      rank,
                            const unsigned int                      n_ranks)
    : n_ranks(n_ranks)
    , first(static_cast<unsigned int>(std::size_t(n_slabs) * rank / n_ranks))
    , end(
        static_cast<unsigned int>(std::size_t(n_slabs) * (rank + 1) / n_ranks))
    , whole(whole)
    , n_of_slabs(n_slabs)
  {}



  template class BodyPiece<2>;
  template class BodyPiece<3>;
} // namespace Debond
