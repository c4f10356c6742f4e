// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/output/tables.h>

#include <iomanip>
#include <limits>

namespace Debond
{
  namespace
  {
    /// Enough digits to read the same number back.
    void
    set_full_precision(std::ostream &out)
    {
      out << std::scientific
          << std::setprecision(std::numeric_limits<double>::max_digits10 - 1);
    }
  } // namespace



  template <int dim>
  void
  write_contact_profile(const ContactBoundary<dim> &boundary,
                        const Verification<dim>    &verification,
                        const std::string          &file_name)
  {
    AssertDimension(boundary.nodes.size(), verification.nodes.size());

    write_atomically(file_name, [&](std::ostream &out) {
      set_full_precision(out);
      out << (dim == 2 ? "x,y," : "x,y,z,")
          << "u_nu,normal_force,normal_force_density,allowed_lower,"
             "allowed_upper,violation,state";
      for (unsigned int d = 0; d < dim; ++d)
        out << ",tangential_force_"
            << "xyz"[d];
      out << ",bond_stiffness,bond_threshold,initial_gap\n";

      for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
        {
          const auto             &node  = boundary.nodes[i];
          const ContactNodeState &state = verification.nodes[i];
          for (unsigned int d = 0; d < dim; ++d)
            out << node.position[d] << ',';
          out << state.u_nu << ',' << state.normal_force << ','
              << state.normal_force / node.measure << ','
              << state.allowed_force.lower << ',' << state.allowed_force.upper
              << ',' << state.violation << ','
              << verification.name(state.state);
          for (unsigned int d = 0; d < dim; ++d)
            out << ',' << verification.tangential_forces[i][d];
          out << ',' << state.bond_stiffness << ',' << state.bond_threshold
              << ',' << node.gap << '\n';
        }
    });
  }



  void
  write_certified_sides(const Certificate &certificate,
                        const AdhesiveLaw &law,
                        const std::string &file_name)
  {
    write_atomically(file_name, [&](std::ostream &out) {
      set_full_precision(out);
      out << "x0,y0,x1,y1,least_mean,largest_mean,least_linear,largest_linear,"
             "state\n";
      for (const CertifiedSide &side : certificate.sides)
        {
          for (const dealii::Point<2> &end : side.ends)
            out << end[0] << ',' << end[1] << ',';
          out << side.mean.lower << ',' << side.mean.upper << ','
              << side.linear.lower << ',' << side.linear.upper << ','
              << (side.piece ? law.name(*side.piece) : "uncertain") << '\n';
        }
    });
  }



  void
  write_history(const std::vector<BundleIteration> &history,
                const std::optional<double>        &found,
                const std::string                  &file_name)
  {
    write_atomically(file_name, [&](std::ostream &out) {
      set_full_precision(out);
      out << "iteration,functional,v,t_L,t_R,bundle_size,qp_steps,kind\n";
      for (const BundleIteration &step : history)
        out << step.iteration << ',' << step.functional << ',' << step.v << ','
            << step.t_L << ',' << step.t_R << ',' << step.bundle_size << ','
            << step.qp_steps << ',' << to_string(step.kind) << '\n';
      if (found)
        out << history.size() + 1 << ',' << *found << ",,,,,,search\n";
    });
  }



  void
  write_history(const std::vector<MajoriseMinimiseIteration> &history,
                const std::optional<double>                  &found,
                const std::string                            &file_name)
  {
    write_atomically(file_name, [&](std::ostream &out) {
      set_full_precision(out);
      out << "iteration,functional,residual,active_set_steps,linear_iterations,"
             "contact_nodes\n";
      for (const MajoriseMinimiseIteration &step : history)
        out << step.iteration << ',' << step.functional << ',' << step.residual
            << ',' << step.active_set_steps << ',' << step.linear_iterations
            << ',' << step.n_active << '\n';
      if (found)
        out << history.size() + 1 << ',' << *found << ",,,,\n";
    });
  }



  void
  write_history(const std::vector<ProofProgress> &history,
                const std::string                &file_name)
  {
    write_atomically(file_name, [&](std::ostream &out) {
      set_full_precision(out);
      out << "nodes,open,lower_bound,functional,seconds\n";
      for (const ProofProgress &step : history)
        out << step.nodes << ',' << step.open << ',' << step.lower << ','
            << step.upper << ',' << step.seconds << '\n';
    });
  }



  template void
  write_contact_profile(const ContactBoundary<2> &,
                        const Verification<2> &,
                        const std::string &);
  template void
  write_contact_profile(const ContactBoundary<3> &,
                        const Verification<3> &,
                        const std::string &);
} // namespace Debond
