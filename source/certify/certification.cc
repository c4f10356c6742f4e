// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/atomic_file.h>
#include <debond/base/instantiate.h>
#include <debond/base/processes.h>
#include <debond/certify/certification.h>
#include <debond/input/bad_input.h>
#include <debond/output/csv_table.h>

#include <new>

namespace Debond
{
  namespace
  {
    /// Says why @p work has no certificate, nothing if it has one: rounding,
    /// memory and data at points that the displacements do not need set limits
    /// to it.
    template <typename Work>
    std::string
    no_certificate(const Work &work)
    {
      // A run has its result without a certificate, too, so that these errors
      // become a note.
      std::string reason;
      try
        {
          work();
          return "";
        }
      catch (const EntryError &error)
        {
          reason = error.what();
        }
      // The equilibrated stresses have several times as many unknowns as the
      // displacements, so that they may not fit where these did.
      catch (const std::bad_alloc &)
        {
          reason = "there is not enough memory for the equilibrated stresses";
        }
      return "There is no certificate: " + reason + '.';
    }



    std::string
    too_wide(const Certificate &certificate, const double target)
    {
      std::ostringstream text;
      text << "The interval is " << std::setprecision(2) << certificate.width()
           << " of |J| wide, Certificate/Target is " << target;
      if (!certificate.loads_are_exact)
        text << " (a vertex where a load jumps or bends makes it narrower)";
      return text.str();
    }



    /// Returns the mean equilibrated stress and the gap per area or volume, if
    /// the certificate has those of the same mesh.
    template <int dim>
    std::vector<CellField>
    fields_of_cells(const Scene<dim> &scene, const Certificate &certificate)
    {
      // Where the bound for fixed branches has failed there are no stresses.
      if (certificate.gaps.empty())
        return {};
      std::vector<CellField>               fields;
      std::vector<dealii::TableIndices<2>> components;
      for (unsigned int k = 0;
           k < dealii::SymmetricTensor<2, dim>::n_independent_components;
           ++k)
        {
          const auto indices =
            dealii::SymmetricTensor<2, dim>::unrolled_to_component_indices(k);
          components.push_back(indices);
          fields.push_back({std::string("equilibrated_stress_") +
                              "xyz"[indices[0]] + "xyz" [indices[1]],
                            {}});
        }
      fields.push_back({"gap_density", {}});
      for (const auto &cell :
           scene.problem().unknowns().dof_handler().active_cell_iterators())
        {
          // The gap of a cell has the unit of an energy, and that of the sides
          // below it is in it; divided by the measure of the cell it can be
          // compared between cells.
          const auto &stress = certificate.stresses[cell->active_cell_index()];
          for (unsigned int k = 0; k < components.size(); ++k)
            fields[k].second.push_back(stress[components[k]]);
          fields.back().second.push_back(
            certificate.gaps[cell->active_cell_index()] / cell->measure());
        }
      return fields;
    }



    /// Returns the number of the law's branch on which each face is in all
    /// minima, -1 where that is not known, if the certificate has the state of
    /// bonds.
    template <int dim>
    std::vector<CellField>
    fields_of_faces(const Scene<dim> &scene, const Certificate &certificate)
    {
      if (certificate.sides.empty())
        return {};
      CellField field = {"certain_branch", {}};
      if constexpr (dim == 2)
        for (const auto &face : scene.contact_boundary().faces)
          {
            const dealii::Point<2> middle =
              0.5 * (face.vertices[0] + face.vertices[1]);
            // The middle of a face is on a side, but for rounding, if the way
            // from end to end over it is no longer than the side.
            const auto side =
              std::find_if(certificate.sides.begin(),
                           certificate.sides.end(),
                           [&](const CertifiedSide &other) {
                             const auto &[a, b] = other.ends;
                             return a.distance(middle) + middle.distance(b) <=
                                    (1. + Tolerance::on_side) * a.distance(b);
                           });
            field.second.push_back(
              side == certificate.sides.end() || !side->piece ? -1. :
                                                                *side->piece);
          }
      return {field};
    }



    void
    write_certified_sides(const Certificate &certificate,
                          const AdhesiveLaw &law,
                          const std::string &file_name)
    {
      // In the order of the contact sides, with the ranges of the mean and of
      // the linear function p of each.
      CsvTable   table;
      const auto add = [&](const std::string &title, const auto &value) {
        table.add(title, certificate.sides, value);
      };
      add("x0", [](const auto &side) { return side.ends[0][0]; });
      add("y0", [](const auto &side) { return side.ends[0][1]; });
      add("x1", [](const auto &side) { return side.ends[1][0]; });
      add("y1", [](const auto &side) { return side.ends[1][1]; });
      add("least_mean", [](const auto &side) { return side.mean.lower; });
      add("largest_mean", [](const auto &side) { return side.mean.upper; });
      add("least_linear", [](const auto &side) { return side.linear().lower; });
      add("largest_linear",
          [](const auto &side) { return side.linear().upper; });
      add("state", [&law](const auto &side) {
        return side.piece ? law.name(*side.piece) : "uncertain";
      });
      table.write(file_name);
    }



    void
    report_certificate(const Certificate &certificate, Record &record)
    {
      const bool is_global = certificate.minimum == CertifiedMinimum::global;
      const std::string status = to_string(certificate.proof_status);
      // Ends of the interval are rounded outwards when they are printed, so
      // that what the log says is true as well.
      record.heading("Certificate");
      record.add("/certificate",
                 {{"minimum", is_global ? "global" : "fixed state"},
                  {"loads_are_exact", certificate.loads_are_exact},
                  {"lower", certificate.lower},
                  {"upper", certificate.upper},
                  {"relative_width", certificate.width()}});
      record.line("of",
                  is_global ?
                    "the least J of the continuous problem" :
                    "the least J of the continuous problem with the bonds of "
                    "each side as they are");
      if (!certificate.loads_are_exact)
        record.line("loads",
                    "taken as linear on each side and constant in each "
                    "element; the interval is wider by the work of the rest "
                    "at the result");
      record.line("interval",
                  scientific_below(certificate.lower, 10),
                  " to ",
                  scientific_above(certificate.upper, 10));
      record.line("certified to",
                  scientific_above(certificate.width(), 1),
                  " of |J|");
      // Lengths of a state in all minima are what the user can rely on,
      // whichever of the minima is the global one.
      for (const CertifiedLength &length : certificate.lengths)
        {
          record.add("/certificate/lengths/" + length.state,
                     {{"least", length.least}, {"largest", length.largest}});
          record.line(length.state + " in all minima",
                      scientific_below(length.least, 3),
                      " to ",
                      scientific_above(length.largest, 3));
        }
      record.add("/certificate",
                 {{"unknowns", certificate.n_unknowns},
                  {"contact_sides", certificate.n_sides},
                  {"proof_nodes", certificate.proof_nodes},
                  {"proof_status", status}});
      if (record.has_details())
        record.line("equilibrated stresses",
                    certificate.n_unknowns,
                    " unknowns, ",
                    certificate.n_sides,
                    " contact sides, ",
                    certificate.proof_nodes,
                    " nodes of branch and bound (",
                    status,
                    ")");
    }
  } // namespace



  template <int dim>
  Certification<dim>::Certification(
    const CertificateKind                    kind,
    const double                             target,
    const BranchAndBoundParameters          &proof,
    const std::shared_ptr<const Scene<dim>> &scene)
    : kind(kind)
    , target(target)
    , proof(proof)
  {
    if (kind == CertificateKind::none)
      return;
    try
      {
        // What cannot be certified is refused here, before the solve takes its
        // time.
        if (n_started_ranks() > 1)
          throw EquilibriumError("several ranks have no certificate; run the "
                                 "scene on one rank");
        check_certifiable(*scene);
      }
    catch (const EquilibriumError &error)
      {
        throw BadInput({scene->parameters().locations.at(error.entry) + ": " +
                        error.entry + ": " + error.what()});
      }
    catch (const EntryError &)
      {
        // Data without a value at a point that displacements do not need:
        // after() will say it.
      }
  }



  template <int dim>
  void
  Certification<dim>::make(const CertificateKind kind_of_this,
                           const std::shared_ptr<const Scene<dim>> &scene,
                           const Solution                          &result)
  {
    certificate = Certifier<dim>(kind_of_this, scene)
                    .certify(result.u,
                             proof,
                             Interruption::by_signal(),
                             latest_global ? &*latest_global : nullptr);
    // What is known of the least J on this mesh, before the interval is widened
    // below, may help on the next one.
    if (certificate->minimum == CertifiedMinimum::global)
      latest_global = certificate;
    // J of the result is by the scene's quadrature, and may lie outside of what
    // is exact. The interval is widened to hold it, so that nobody reads two
    // numbers that contradict each other.
    certificate->include(result.functional);
  }



  template <int dim>
  GoalOnMesh
  Certification<dim>::look(const std::shared_ptr<const Scene<dim>> &scene,
                           const Solution                          &result,
                           const bool                               is_last)
  {
    const std::string failure = no_certificate([&]() {
      // As long as the interval with fixed branches is too wide, that for all
      // minima would hardly be narrower. The cells are refined by the first
      // one, which is cheap.
      if (!is_last)
        {
          certificate.reset();
          if (kind == CertificateKind::global)
            try
              {
                make(CertificateKind::fixed_state, scene, result);
              }
            catch (const EquilibriumError &)
              {
                // The bound for bonds that may break need not have that.
              }
        }
      // Once it is narrow enough, or there can be no finer mesh, the bound for
      // all minima is made.
      const bool is_global =
        certificate && certificate->minimum == CertifiedMinimum::global;
      const bool is_wide = certificate && certificate->width() > target;
      if (!certificate || (kind == CertificateKind::global && !is_global &&
                           (is_last || !is_wide)))
        make(kind, scene, result);
    });
    if (!failure.empty())
      {
        certificate.reset();
        GoalOnMesh nothing;
        nothing.failure = failure;
        return nothing;
      }
    // Refinement bisects the cells with the largest gaps.
    return {certificate->width() <= target,
            certificate->width(),
            certificate->gaps,
            too_wide(*certificate, target),
            ""};
  }



  template <int dim>
  double
  Certification<dim>::n_unknowns(const double n_cells) const
  {
    // Four on each of 3/2 sides a triangle, or nine on each of two faces a
    // tetrahedron.
    return (dim == 2 ? 6. : 18.) * n_cells;
  }



  template <int dim>
  void
  Certification<dim>::after(RunResult<dim> &result)
  {
    // With a target the goal has made the certificate of the last mesh already.
    if (kind != CertificateKind::none && result.is_success() && !certificate)
      {
        dealii::Timer     timer;
        const std::string failure = no_certificate([&]() {
          make(kind, result.scene, result.solution);
          if (Interruption::by_signal().requested())
            result.solution.minimum.interrupted = true;
        });
        if (!failure.empty())
          result.notes.push_back(failure);
        result.times.emplace_back("certificate", timer.wall_time());
      }
    if (certificate)
      {
        result.cell_fields = fields_of_cells(*result.scene, *certificate);
        result.face_fields = fields_of_faces(*result.scene, *certificate);
      }
  }



  template <int dim>
  void
  Certification<dim>::report(Record &record) const
  {
    if (certificate)
      report_certificate(*certificate, record);
  }



  template <int dim>
  std::vector<OutputFile>
  Certification<dim>::files(const OutputParameters &output,
                            const Scene<dim>       &scene) const
  {
    return {{"certificate_proof.json",
             [&]() { return certificate && !certificate->proof.is_null(); },
             [&](const std::string &path) {
               auto proof        = certificate->proof;
               proof["interval"] = {certificate->lower, certificate->upper};
               write_atomically(path, [&](std::ostream &out) {
                 out << proof << '\n';
               });
             }},
            {"certified_sides.csv",
             [&]() {
               return output.contact_profile && certificate &&
                      !certificate->sides.empty();
             },
             [&](const std::string &path) {
               write_certified_sides(*certificate, scene.law(), path);
             }}};
  }



  DEBOND_INSTANTIATE_CLASS(Certification);
} // namespace Debond
