// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_run_result_h
#define debond_output_run_result_h

#include <debond/check/coming_off.h>
#include <debond/check/displacement_error.h>
#include <debond/check/plausibility.h>
#include <debond/output/vtu.h>
#include <debond/solve/answer.h>

namespace Debond
{
  /// The answer to a scene and what was checked of it, for log and files.
  template <int dim>
  struct RunResult : Answer<dim>
  {
    /// The judgement of the solver and of the verification, in words.
    std::string status;
    std::string message; ///< why it is no success

    /// Notes on what did not go as it should, and did not decide on the status.
    std::vector<std::string> notes;

    Verification<dim> verification;
    LargestValues     largest;
    ProbeValues<dim>  probes;
    ProbeValues<dim>  means; ///< over the pieces with a name

    /// There is one of the solver's result, if the solver came to its end.
    std::optional<ErrorEstimate> estimate;

    /// There is one if the solver says that the body comes off, and it does.
    std::optional<ComingOff<dim>> coming_off;

    /// There is one if the exact displacement is known.
    std::optional<DisplacementError> displacement_error;

    /// More numbers of cells for body.vtu, and of faces for contact.vtu.
    std::vector<CellField> cell_fields, face_fields;

    /// Wall seconds of the parts of the run, in their order.
    std::vector<std::pair<std::string, double>> times;

    /// Says whether both solver and verification are content.
    bool
    is_success() const
    {
      return status == to_string(SolverStatus::success);
    }

    bool
    comes_off() const
    {
      return status == to_string(SolverStatus::comes_off);
    }

    /// Says whether the result can be relied on.
    bool
    is_answer() const
    {
      return is_success() || comes_off();
    }

    /// Says whether there is a displacement: none if the body comes off at
    /// once.
    bool
    has_displacement() const
    {
      return this->solution.status != SolverStatus::comes_off ||
             !this->path.steps.empty();
    }
  };
} // namespace Debond

#endif
