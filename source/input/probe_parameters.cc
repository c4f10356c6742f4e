// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/instantiate.h>
#include <debond/input/probe_parameters.h>

namespace Debond
{
  namespace
  {
    /// Throws std::invalid_argument that says what the text is not.
    template <int dim>
    Probe<dim>
    make_probe(const std::string &name, const std::string &text)
    {
      // A text that begins with neither word has to be a point. The same
      // function checks a scene and makes its probes, so that what is accepted
      // can be made.
      Probe<dim> probe;
      probe.name = name;
      for (const auto &[word, kind] :
           {std::make_pair("mean ", Probe<dim>::Kind::mean),
            std::make_pair("force ", Probe<dim>::Kind::force)})
        if (text.rfind(word, 0) == 0)
          {
            probe.kind = kind;
            probe.piece =
              dealii::Utilities::trim(text.substr(std::string(word).size()));
            return probe;
          }

      const std::vector<std::string> coordinates =
        dealii::Utilities::split_string_list(text, ',');
      bool is_point = coordinates.size() == dim;
      for (unsigned int d = 0; d < dim && is_point; ++d)
        is_point = read_number(coordinates[d], probe.point[d]);
      if (!is_point)
        throw std::invalid_argument(
          "it is neither a point (" + std::to_string(dim) +
          " numbers, separated by commas) nor 'mean NAME' nor 'force NAME'" +
          number_hint(text));
      return probe;
    }



    template <int dim>
    void
    check(const std::map<std::string, std::string> &probes,
          const std::set<std::string>              &boundaries,
          const std::set<std::string>              &regions,
          ParameterTable                           &table)
    {
      using Kind = typename Probe<dim>::Kind;
      for (const auto &[name, text] : probes)
        try
          {
            // The name becomes a part of a JSON pointer, in which / and ~ have
            // a meaning. A force is that on a boundary, while a mean may be
            // over a region too; the message lists what may be named.
            const Probe<dim> probe = make_probe<dim>(name, text);
            if (name.find_first_of("/~\",") != std::string::npos)
              throw std::invalid_argument(
                "the name of a probe has none of / ~ \" and commas");
            if (probe.kind == Kind::point ||
                boundaries.count(probe.piece) > 0 ||
                (probe.kind == Kind::mean && regions.count(probe.piece) > 0))
              continue;
            std::set<std::string> known = boundaries;
            if (probe.kind == Kind::mean)
              known.insert(regions.begin(), regions.end());
            throw std::invalid_argument(
              "the body has no " + probe.piece + ", " +
              (known.empty() ?
                 "and no names at all; Parts gives names" :
                 "but " + join({known.begin(), known.end()}, ", ")));
          }
        catch (const std::invalid_argument &error)
          {
            table.reject("Probes/" + name, error.what(), {"Dimension"});
          }
    }
  } // namespace



  void
  bind_probes(std::map<std::string, std::string> &probes, ParameterTable &table)
  {
    table.bind_family(
      "Probes/",
      probes,
      text_with_numbers("a point, 'mean NAME' or 'force NAME'"),
      "A vector that the log, summary.json and load_path.csv have by this name: the displacement at a point, such as '0.4, 0.02', its mean over a boundary, a region or a part ('mean right'), or the force that supports and foundation exert on the body at a boundary or a part of it ('force left')");
  }



  void
  check_probes(const std::map<std::string, std::string> &probes,
               const unsigned int                        dimension,
               const std::set<std::string>              &boundaries,
               const std::set<std::string>              &regions,
               ParameterTable                           &table)
  {
    if (dimension == 2)
      check<2>(probes, boundaries, regions, table);
    else
      check<3>(probes, boundaries, regions, table);
  }



  template <int dim>
  std::vector<Probe<dim>>
  make_probes(const std::map<std::string, std::string> &probes)
  {
    std::vector<Probe<dim>> result;
    for (const auto &[name, text] : probes)
      result.push_back(make_probe<dim>(name, text));
    return result;
  }



  DEBOND_INSTANTIATE(make_probes);
} // namespace Debond
