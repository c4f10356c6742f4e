// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_study_parameters_h
#define debond_study_study_parameters_h

#include <debond/base/parameter_table.h>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Debond
{
  /// Parameters of the scene that vary together, mostly one, or the method,
  /// and the values they are given.
  struct Sweep
  {
    std::string              parameter; ///< "Section/Entry [& ...]"
    std::string              label;     ///< in tables and plots
    std::vector<std::string> values;    ///< as in a scene, "a [& ...]"

    /// For --set. Throws std::invalid_argument if the value has not as many
    /// parts as there are parameters.
    std::vector<std::string>
    settings(const std::string &value) const;
  };



  /// Printed results that stand beside those of the study.
  struct ReferenceParameters
  {
    std::string file; ///< CSV with a line of titles; empty for none
    std::string label = "reference";

    /// Which rows count: the text that a column has to have.
    std::map<std::string, std::string> rows;

    /// The column that holds the value of the first sweep.
    std::string key = "value";

    /// By the column of the study, the column of the file. Where the column
    /// of the study is an "error", the file has the functional.
    std::map<std::string, std::string> columns;

    /// The minimum to which the functionals of the file are compared.
    double minimum = 0.;
  };



  struct PlotParameters
  {
    std::vector<std::string> kinds;

    /// Labels of the cases whose fitted line is drawn.
    std::vector<std::string> fitted;
  };



  /// A study as its .prm describes it.
  struct StudyParameters
  {
    std::string file;
    std::string title;
    std::string description;
    std::string scene; ///< the base scene's path
    std::string directory = "output/{study}";

    /// "Section/Entry=value", for all cases.
    std::vector<std::string> settings;

    /// Those of the case that is run before the others; empty for none.
    std::vector<std::string> preparation;

    std::vector<Sweep>       sweeps; ///< the last one may be the method
    std::vector<std::string> columns           = {"status",
                                                  "iterations",
                                                  "long",
                                                  "short",
                                                  "null",
                                                  "J",
                                                  "error",
                                                  "law violation",
                                                  "seconds"};
    std::vector<std::string> accepted_statuses = {"success", "comes off"};
    bool                     fields            = false;

    /// Between these relative errors the rate of convergence is fitted.
    double fit_from = 1e-3;
    double fit_to   = 1e-8;

    PlotParameters      plots;
    ReferenceParameters reference;
  };

  /// The table of all entries of a study.
  class StudyTable : public ParameterTable
  {
  public:
    StudyTable();

    /**
     * The values of what has been read, @p file being its path. Checks that the
     * base scene exists and knows the parameters and values that it is given.
     * Throws BadInput with the errors of the table and these.
     */
    StudyParameters
    parameters(const std::string &file);

  private:
    StudyParameters          study;
    std::array<Sweep, 2>     sweeps;
    std::vector<std::string> methods;
  };

  /// The values of "a | b | c", or of "geometric FIRST LAST COUNT". Throws
  /// std::invalid_argument if it is neither.
  std::vector<std::string>
  parse_sweep_values(const std::string &text);
} // namespace Debond

#endif
