// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_checkpoints_h
#define debond_base_checkpoints_h

#include <functional>

namespace boost
{
  namespace archive
  {
    class binary_iarchive;
    class binary_oarchive;
  } // namespace archive
} // namespace boost

namespace Debond
{
  /// What states are read from and written to. Binary, so that a number that
  /// is read is the number that was written.
  using InArchive  = boost::archive::binary_iarchive;
  using OutArchive = boost::archive::binary_oarchive;

  /**
   * Where a method keeps its state between two iterations, and takes it from to
   * go on as if it had not ended.
   */
  class Checkpoints
  {
  public:
    virtual ~Checkpoints() = default;

    /// The state to go on from; null for a run from its beginning.
    virtual InArchive *
    resume_from() = 0;

    /// Called between two iterations, @p iterations after the beginning; calls
    /// @p save if the state is to be kept now. @p last says that the method
    /// will make no more iterations.
    virtual void
    offer(const std::function<void(OutArchive &)> &save,
          const unsigned int                       iterations,
          const bool                               last) = 0;
  };
} // namespace Debond

#endif
