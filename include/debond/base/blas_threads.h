// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_blas_threads_h
#define debond_base_blas_threads_h

namespace Debond
{
  /// Has OpenBLAS and OpenMP, which CHOLMOD uses, work with one thread, if they
  /// are there and neither OPENBLAS_NUM_THREADS nor OMP_NUM_THREADS is set: a
  /// second one gains little on factors as small as these and costs much if the
  /// other cores are busy.
  void
  use_one_blas_thread_by_default();
} // namespace Debond

#endif
