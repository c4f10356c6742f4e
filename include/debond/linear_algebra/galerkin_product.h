// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_galerkin_product_h
#define debond_linear_algebra_galerkin_product_h

#include <debond/linear_algebra/block_rows.h>

#include <functional>

namespace Debond
{
  /// The part of P'MP that comes from the given rows M of a matrix, in
  /// ascending order of rows and columns. Row r of @p pattern is that of the
  /// node rows[r], and @p blocks gives its blocks, until its next call. Rows of
  /// P are those of all nodes and columns that M has; its columns are below @p
  /// n_columns.
  NumberedRows
  galerkin_product(const std::vector<unsigned int>                   &rows,
                   const BlockPattern                                &pattern,
                   const std::function<const double *(unsigned int)> &blocks,
                   const BlockRows<float>                            &P,
                   const unsigned int n_columns);
} // namespace Debond

#endif
