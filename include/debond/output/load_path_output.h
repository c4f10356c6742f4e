// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_load_path_output_h
#define debond_output_load_path_output_h

#include <debond/output/output_files.h>

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
    /// Keeps references.
    LoadPathOutput(const OutputParameters    &output,
                   const ElasticProblem<dim> &problem)
      : output(output)
      , problem(problem)
    {}

    /// Removes the files that an earlier run left in load_path/.
    void
    remove_steps() const;

    /// Goes on after the steps @p done of an earlier run, whose files are
    /// there. The last one is to be added again.
    void
    go_on_after(const std::vector<LoadPathStep<dim>> &done);

    /// Writes the files of one factor, and the table as it is. A file that
    /// cannot be written ends no path: the last of files() throws for it.
    void
    add(const LoadPathStep<dim> &step,
        const DofVector         &u,
        const Verification<dim> &verification);

    /// Returns all files but those in load_path/: the tables of @p steps and @p
    /// arc, which are kept, and the records of the files above.
    std::vector<OutputFile>
    files(const std::vector<LoadPathStep<dim>> &steps,
          const std::vector<LoadPathStep<dim>> &arc) const;

  private:
    std::string
    path(const std::string &name) const;

    std::string
    name_of_step(const std::string &body, const unsigned int step) const;

    /// Times with the files that belong to them.
    using Series = std::vector<std::pair<double, std::string>>;

    OutputFile
    series_file(const std::string &name, const Series &series) const;

    const OutputParameters        &output;
    const ElasticProblem<dim>     &problem;
    std::vector<LoadPathStep<dim>> so_far; ///< without a global branch
    Series                         bodies;
    Series                         contacts;
    std::string                    error;
  };
} // namespace Debond

#endif
