// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_run_checkpoints_h
#define debond_solve_run_checkpoints_h

#include <deal.II/base/timer.h>

#include <debond/base/checkpoint.h>
#include <debond/base/checkpoints.h>
#include <debond/input/solver_parameters.h>
#include <debond/solve/method_choice.h>

#include <memory>
#include <string>

namespace Debond
{
  /**
   * The checkpoint of a run, a file in its output directory: written from time
   * to time and when the run ends without success, removed when it ends with
   * success. A run that restarts goes on from it, if it is one of the same
   * scene solved by the same method; what decides only when a run ends, and
   * what is done with the result, may differ.
   */
  class RunCheckpoints : public Checkpoints
  {
  public:
    /// Throws BadInput if the run restarts and there is no checkpoint that it
    /// can go on from.
    RunCheckpoints(const CheckpointParameters &parameters,
                   const std::string          &directory,
                   const MethodChoice         &choice);

    /// What the log says of it, empty if there is nothing to say.
    std::string
    description() const;

    InArchive *
    resume_from() override;

    /// A checkpoint that cannot be written is no reason to end the run.
    void
    offer(const std::function<void(OutArchive &)> &save,
          const unsigned int                       iterations,
          const bool                               last) override;

    void
    remove() const;

    /// What kept the last checkpoint from being written.
    const std::string &
    error() const;

    /// Whether there is a checkpoint of this run.
    bool
    written() const;

    const std::string &
    file_name() const;

  private:
    void
    check_origin(const CheckpointOrigin &found) const;

    std::string                       path;
    double                            interval; ///< seconds, 0 for none
    bool                              method_has_states;
    CheckpointOrigin                  origin;
    std::unique_ptr<CheckpointReader> reader;
    dealii::Timer                     since_last;
    bool                              is_written = false;
    std::string                       last_error;
  };
} // namespace Debond

#endif
