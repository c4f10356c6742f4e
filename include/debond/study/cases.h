// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_cases_h
#define debond_study_cases_h

#include <debond/contact/law.h>
#include <debond/study/study_parameters.h>

#include <optional>
#include <string>
#include <vector>

namespace Debond
{
  /// One run of the program.
  struct Case
  {
    std::vector<std::string> values;   ///< one for each sweep
    std::string              label;    ///< "u_k = 0.1, method = ..."
    std::vector<std::string> settings; ///< for --set
    std::string              directory;

    /// All parameters, as the run will write them to its parameters.prm: what
    /// tells whether a directory has the results of this case.
    std::string effective_scene;

    double               cell_edge = 0.; ///< h, along the first axis
    ContactLawParameters law;

    /// The number of the case that finds the exact minimum, if a column or a
    /// plot needs it.
    std::optional<std::size_t> minimum;
  };



  struct Cases
  {
    std::optional<Case> preparation;
    std::vector<Case>   cases;  ///< the first sweep is the outer loop
    std::vector<Case>   minima; ///< by majorise-minimise, each problem once
  };

  /// Makes and checks the cases of a study. Throws BadInput if one of them has
  /// values that do not fit together.
  Cases
  make_cases(const StudyParameters &study);
} // namespace Debond

#endif
