// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_load_path_output_h
#define debond_output_load_path_output_h

#include <debond/elasticity/elastic_problem.h>
#include <debond/input/parameters.h>
#include <debond/solve/load_path_steps.h>

#include <string>
#include <utility>
#include <vector>

namespace Debond
{
  /**
   * The files of a load path that the scene asks for: those of a factor as soon
   * as it is solved, in the directory load_path/, and the others at the end.
   */
  template <int dim>
  class LoadPathOutput
  {
  public:
    /// Keeps references. Removes files of an earlier run.
    LoadPathOutput(const OutputParameters    &output,
                   const ElasticProblem<dim> &problem);

    /// Writes the files of one factor. A file that cannot be written ends
    /// no path: finish() throws for it.
    void
    add(const LoadPathStep<dim>      &step,
        const dealii::Vector<double> &u,
        const Verification<dim>      &verification);

    /// Writes the table, the records of the files above and the plots; returns
    /// the names of all but those in load_path/. What hinders gnuplot, if it
    /// is wanted, is told in @p note. Throws std::runtime_error naming the
    /// first file that could not be written.
    std::vector<std::string>
    finish(const std::vector<LoadPathStep<dim>> &steps, std::string &note);

  private:
    std::string
    path(const std::string &name) const;

    std::string
    name_of_step(const std::string &body, const unsigned int step) const;

    using Record = std::vector<std::pair<double, std::string>>;

    const OutputParameters    &output;
    const ElasticProblem<dim> &problem;
    Record                     body_record;
    Record                     contact_record;
    std::string                error;
  };
} // namespace Debond

#endif
