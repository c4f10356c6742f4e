// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/grid/grid_generator.h>

#include <debond/base/instantiate.h>
#include <debond/mesh/source_mesh.h>

#include <boost/algorithm/string/replace.hpp>

#include <sstream>

namespace Debond
{
  namespace
  {
    /// The words of an exception of deal.II, without where it was thrown.
    std::string
    words_of(const dealii::ExceptionBase &error)
    {
      // deal.II prints the text of an exception over several indented lines,
      // which become one line of a message. The range of its pattern for
      // numbers says nothing to a user.
      std::ostringstream text;
      error.print_info(text);
      std::string       words, line;
      std::stringstream lines(text.str());
      while (std::getline(lines, line))
        if (const std::size_t first = line.find_first_not_of(' ');
            first != std::string::npos)
          words += (words.empty() ? "" : " ") + line.substr(first);
      return boost::replace_all_copy(words,
                                     " -MAX_DOUBLE...MAX_DOUBLE (inclusive)",
                                     "");
    }
  } // namespace



  template <int dim>
  void
  SourceMesh<dim>::refine(const unsigned int n_refinements)
  {
    if (n_refinements == 0)
      return;
    // Cells are halved before they are crossed. A mesh of simplices is used as
    // it is, so that there is no step at which it would be refined.
    if (mesh.all_reference_cells_are_simplex())
      throw std::invalid_argument(
        "A mesh of triangles or tetrahedra is not refined, but one of "
        "quadrilaterals or hexahedra.");
    mesh.refine_global(n_refinements);
  }



  template <int dim>
  std::unique_ptr<SourceMesh<dim>>
  generate_mesh(const std::string &name,
                const std::string &arguments,
                const unsigned int n_refinements)
  {
    // The refinement happens before the cells are crossed, with the manifolds
    // that the generator has attached: new vertices of a curved side are on the
    // curve.
    auto source = std::make_unique<SourceMesh<dim>>();
    try
      {
        dealii::GridGenerator::generate_from_name_and_arguments(source->mesh,
                                                                name,
                                                                arguments);
        source->refine(n_refinements);
      }
    catch (const dealii::ExceptionBase &error)
      {
        throw std::invalid_argument("deal.II's GridGenerator makes no " + name +
                                    " of these arguments: " + words_of(error));
      }
    // deal.II's generators have numbers in place of names.
    for (const dealii::types::boundary_id id : source->mesh.get_boundary_ids())
      source->names.boundaries[std::to_string(id)] = {id};
    for (const auto &cell : source->mesh.active_cell_iterators())
      source->names.regions[std::to_string(cell->material_id())] = {
        cell->material_id()};
    return source;
  }



  DEBOND_INSTANTIATE_CLASS(SourceMesh);
  DEBOND_INSTANTIATE(generate_mesh);
} // namespace Debond
