// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/window.h>

#include <algorithm>
#include <limits>
#include <set>

namespace Debond
{
  Window::Window(const dealii::SparseMatrix<double>      &A,
                 const DofVector                         &f,
                 const DofVector                         &u,
                 const unsigned int                       center,
                 const unsigned int                       n_rings,
                 const std::function<bool(unsigned int)> &is_excluded)
  {
    std::set<unsigned int>    known = {center};
    std::vector<unsigned int> ring  = {center};
    for (unsigned int k = 0; k < n_rings; ++k)
      {
        std::vector<unsigned int> next;
        for (const unsigned int i : ring)
          for (auto entry = A.begin(i); entry != A.end(i); ++entry)
            if (!is_excluded(entry->column()) &&
                known.insert(entry->column()).second)
              next.push_back(entry->column());
        ring = std::move(next);
      }
    rows.assign(known.begin(), known.end());

    constexpr unsigned int outside = std::numeric_limits<unsigned int>::max();
    const auto             index   = [this](const unsigned int row) {
      const auto found = std::lower_bound(rows.begin(), rows.end(), row);
      return found != rows.end() && *found == row ?
                             static_cast<unsigned int>(found - rows.begin()) :
                             outside;
    };
    const auto                n = static_cast<unsigned int>(rows.size());
    std::vector<unsigned int> lengths(n, 0);
    for (unsigned int k = 0; k < n; ++k)
      for (auto entry = A.begin(rows[k]); entry != A.end(rows[k]); ++entry)
        lengths[k] += index(entry->column()) != outside ? 1 : 0;
    sparsity.reinit(n, n, lengths);
    for (unsigned int k = 0; k < n; ++k)
      for (auto entry = A.begin(rows[k]); entry != A.end(rows[k]); ++entry)
        if (const unsigned int l = index(entry->column()); l != outside)
          sparsity.add(k, l);
    sparsity.compress();

    M.reinit(sparsity);
    b.reinit(n);
    for (unsigned int k = 0; k < n; ++k)
      {
        b(k) = f(rows[k]);
        for (auto entry = A.begin(rows[k]); entry != A.end(rows[k]); ++entry)
          if (const unsigned int l = index(entry->column()); l != outside)
            M.set(k, l, entry->value());
          else
            {
              b(k) -= entry->value() * u(entry->column());
              has_outside |= !is_excluded(entry->column());
            }
      }
  }



  const std::vector<unsigned int> &
  Window::unknowns() const
  {
    return rows;
  }



  bool
  Window::is_everything() const
  {
    return !has_outside;
  }



  const dealii::SparseMatrix<double> &
  Window::matrix() const
  {
    return M;
  }



  const DofVector &
  Window::load() const
  {
    return b;
  }
} // namespace Debond
