// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_window_h
#define debond_linear_algebra_window_h

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <debond/linear_algebra/dof_vector.h>

#include <functional>
#include <vector>

namespace Debond
{
  /// The part of 1/2 <A u, u> - <f, u> that depends on some unknowns near each
  /// other, the others being given: 1/2 <M v, v> - <b, v> in these.
  class Window
  {
  public:
    /// The unknowns that are at most @p n_rings couplings of the symmetric A
    /// away from @p center, but for those that @p is_excluded tells.
    Window(const dealii::SparseMatrix<double>      &A,
           const DofVector                         &f,
           const DofVector                         &u,
           const unsigned int                       center,
           const unsigned int                       n_rings,
           const std::function<bool(unsigned int)> &is_excluded);

    Window(const Window &) = delete;

    /// Rows of A, ascending.
    const std::vector<unsigned int> &
    unknowns() const;

    /// Whether all but excluded unknowns that these are coupled with are among
    /// them.
    bool
    is_everything() const;

    /// M.
    const dealii::SparseMatrix<double> &
    matrix() const;

    /// b.
    const DofVector &
    load() const;

  private:
    std::vector<unsigned int>    rows;
    bool                         has_outside = false;
    dealii::SparsityPattern      sparsity;
    dealii::SparseMatrix<double> M;
    DofVector                    b;
  };
} // namespace Debond

#endif
