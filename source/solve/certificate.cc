// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>

#include <debond/elasticity/temperature_load.h>
#include <debond/optimization/global/rounded_branches.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/solve/certificate.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    using ContactSide = EquilibriumProblem<2>::ContactSide;



    /// What one's own computations may have lost, relative to J and the strain
    /// energy.
    constexpr double certificate_rounding = 1e-9;

    /// Of tractions, relative to the largest one, or that of the boundary if it
    /// were held.
    constexpr double traction_rounding = 1e-9;

    /// Of displacements in contact, relative to the largest one.
    constexpr double contact_rounding = 1e-9;



    EquilibriumProblem<2>
    equilibrium_problem(const Scene<2> &scene)
    {
      const auto &dofs = scene.problem().unknowns().dof_handler();
      return EquilibriumProblem<2>(dofs.get_triangulation(),
                                   scene.conditions(),
                                   scene.supports(),
                                   scene.materials(),
                                   scene.loads(),
                                   thermal_stresses(dofs,
                                                    scene.materials(),
                                                    scene.loads()));
    }



    /// Throws EquilibriumError if a contact node has a normal that is not that
    /// of its sides.
    void
    check_normals(const ContactBoundary<2> &boundary)
    {
      for (const ContactBoundary<2>::Face &face : boundary.faces)
        for (const unsigned int node : face.nodes)
          if (node < boundary.nodes.size() &&
              (boundary.nodes[node].normal - face.normal).norm() > 1e-8)
            throw EquilibriumError("a contact boundary with corners that are "
                                   "rounded by a mean normal is not done");
    }



    /// Means of u_nu on sides, from a mesh at least as fine.
    Eigen::VectorXd
    side_means(const EquilibriumProblem<2> &equilibrium,
               const ContactBoundary<2>    &boundary,
               const VectorView            &trace)
    {
      const auto     &sides = equilibrium.contact_sides();
      Eigen::VectorXd means = Eigen::VectorXd::Zero(sides.size());
      for (const ContactBoundary<2>::Face &face : boundary.faces)
        {
          double value = 0.;
          // All functions of the basis have the same mean.
          const unsigned int n = n_coefficients(2, boundary.degree);
          for (unsigned int k = 0; k < n; ++k)
            if (face.node(k) < boundary.nodes.size())
              value += trace(face.node(k)) / n;
          const dealii::Point<2> middle =
            0.5 * (face.vertices[0] + face.vertices[1]);
          for (unsigned int i = 0; i < sides.size(); ++i)
            {
              const dealii::Point<2> first =
                equilibrium.vertices()[sides[i].vertices[0]];
              const dealii::Tensor<1, 2> along =
                equilibrium.vertices()[sides[i].vertices[1]] - first;
              const dealii::Tensor<1, 2> here = middle - first;
              const double part = here * along / along.norm_square();
              if (part > 0. && part < 1. &&
                  (here - part * along).norm() < 1e-8 * along.norm())
                means(i) += face.measure / sides[i].measure * value;
            }
        }
      return means.cwiseMin(0.);
    }



    std::vector<CertifiedLength>
    certified_lengths(const std::vector<CertifiedSide> &sides,
                      const AdhesiveLaw                &law)
    {
      std::vector<CertifiedLength> lengths;
      for (unsigned int k = 0; k < law.branches().size(); ++k)
        {
          CertifiedLength length = {law.name(k), 0., 0.};
          for (const CertifiedSide &side : sides)
            {
              const double   measure   = side.ends[0].distance(side.ends[1]);
              const auto    &piece     = law.branches()[k];
              const Interval linear    = side.linear();
              const bool     is_likely = linear.upper > piece.lower &&
                                     (k == 0 || linear.lower < piece.upper);
              if (side.piece ? *side.piece == k : is_likely)
                length.largest += measure;
              if (side.piece == k)
                length.least += measure;
            }
          lengths.push_back(length);
        }
      return lengths;
    }



    /// int h(q) of the linear q with the values @p first and @p last at the
    /// ends,
    ///     h(q) = inf_{s <= 0} piece(s) + q s
    ///          = constant - (q + slope)_+^2 / (2 curvature).
    /// Without a curvature q has to be below -slope but for @p rounding; throws
    /// EquilibriumError if it is not, as h is minus infinity then.
    double
    conjugate_integral(const BranchMinimum::Piece &piece,
                       const double                length,
                       const double                first,
                       const double                last,
                       const double                rounding)
    {
      const double a = first + piece.slope, b = last + piece.slope;
      const double largest = std::max(a, b), least = std::min(a, b);
      const double constant = length * static_cast<double>(piece.constant);
      if (piece.curvature == 0. && largest > rounding)
        throw EquilibriumError("the tractions pull where no bond holds");
      if (largest <= 0. || piece.curvature == 0.)
        return constant;
      const double square =
        least >= 0. ? (a * a + a * b + b * b) / 3. :
                      largest * largest * largest / (3. * (largest - least));
      return constant - length * square / (2. * piece.curvature);
    }



    /// The normal displacement of a side, of degree 1 or 2 in xi.
    class Trace
    {
    public:
      Trace(const ContactSide                      &side,
            const std::vector<CellDisplacement<2>> &displacement)
        : length(side.measure)
      {
        const auto   u     = displacement[side.cell].on_side(side.vertices);
        const double first = u[0] * side.normal;
        const double last  = u[1] * side.normal;
        const dealii::Tensor<1, 2> at_middle =
          0.5 * (0.5 * (u[0] + u[1])) + 0.5 * u[2];
        middle    = at_middle * side.normal;
        slope     = 0.5 * (last - first);
        curvature = 0.5 * (last + first) - middle;
      }

      double
      value(const double xi) const
      {
        return middle + xi * (slope + xi * curvature);
      }

      double
      mean() const
      {
        return middle + curvature / 3.;
      }

      /// Of a function of xi and the displacement there, exact up to degree 5.
      template <typename Function>
      double
      integral(const Function &function) const
      {
        const dealii::QGauss<1> rule(3);
        double                  sum = 0.;
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double xi = 2. * rule.point(q)[0] - 1.;
            sum += rule.weight(q) * length * function(xi, value(xi));
          }
        return sum;
      }

      double slope;

    private:
      double length, middle, curvature;
    };



    /// The least J with given branches.
    void
    bound_fixed_state(const EquilibriumProblem<2>            &equilibrium,
                      const BranchMinimum                    &law,
                      const std::vector<CellDisplacement<2>> &displacement,
                      Certificate                            &certificate)
    {
      const std::vector<ContactSide> &sides = equilibrium.contact_sides();
      const Eigen::Index    n         = static_cast<Eigen::Index>(sides.size());
      const auto            condensed = equilibrium.condense(true);
      const Eigen::MatrixXd S         = condensed->schur_complement();
      const Eigen::VectorXd g         = condensed->load();

      // Means and slopes from mean +- slope / 3, which are <= 0 if the
      // displacement is, as linear tractions <= 0 see it.
      Eigen::MatrixXd T(2 * n, 2 * n);
      T << 0.5 * Eigen::MatrixXd::Identity(n, n),
        0.5 * Eigen::MatrixXd::Identity(n, n),
        1.5 * Eigen::MatrixXd::Identity(n, n),
        -1.5 * Eigen::MatrixXd::Identity(n, n);
      std::vector<BranchMinimum::Piece> pieces;
      Eigen::VectorXd                   u_nu(2 * n); ///< of the displacement
      Eigen::MatrixXd                   M = S;
      Eigen::VectorXd                   r = g;
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const Trace trace(sides[i], displacement);
          pieces.push_back(law[law.index(trace.mean())]);
          u_nu(i)             = trace.value(1. / 3.);
          u_nu(n + i)         = trace.value(-1. / 3.);
          const double weight = sides[i].measure * pieces.back().curvature;
          M(i, i) += weight;
          M(n + i, n + i) += weight / 3.;
          r(i) -= sides[i].measure * pieces.back().slope;
        }
      // Where the displacement is in contact, and what is wrong there is found.
      ActiveSet active(2 * n, 0);
      for (Eigen::Index i = 0; i < 2 * n; ++i)
        active[i] =
          u_nu(i) >= -contact_rounding * u_nu.lpNorm<Eigen::Infinity>();
      const BoundQPResult minimum = solve_bound_qp(T.transpose() * M * T,
                                                   T.transpose() * r,
                                                   Eigen::VectorXd::Zero(2 * n),
                                                   active);
      if (minimum.status != SolverStatus::success &&
          minimum.status != SolverStatus::stagnated)
        throw EquilibriumError("the tractions of the contact boundary were not "
                               "found (" +
                               to_string(minimum.status) + ")");
      const Eigen::VectorXd x = T * minimum.x;

      // Of the stresses that x leads to; their tractions are moments / length.
      const Eigen::VectorXd moments          = S * x - g;
      double                largest_traction = 0.;
      for (Eigen::Index i = 0; i < n; ++i)
        for (const Eigen::VectorXd *f : {&moments, &g})
          largest_traction =
            std::max(largest_traction,
                     (std::abs((*f)(i)) + 3. * std::abs((*f)(n + i))) /
                       sides[i].measure);
      certificate.lower   = condensed->energy_at_zero() - 0.5 * x.dot(S * x);
      certificate.reserve = equilibrium.rounding_of(*condensed, x);
      certificate.upper   = equilibrium.elastic_functional(displacement);
      const DofVector unknowns = condensed->expand(x);
      certificate.gaps = equilibrium.constitutive_gaps(displacement, unknowns);
      certificate.stresses = equilibrium.mean_stresses(unknowns);
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const double length = sides[i].measure;
          const double mean   = moments(i) / length;
          const double slope  = 3. * moments(n + i) / length;
          const double bonds =
            conjugate_integral(pieces[i],
                               length,
                               mean - slope,
                               mean + slope,
                               traction_rounding * largest_traction);
          const Trace  trace(sides[i], displacement);
          const double of_bonds = trace.integral(
            [&](double, const double s) { return pieces[i].value(s); });
          // Nothing may pull there: what rounding pulls costs this much at the
          // displacement, and is reserved four times.
          if (pieces[i].curvature == 0.)
            certificate.reserve +=
              4. * std::max(mean + std::abs(slope) + pieces[i].slope, 0.) *
              length * std::abs(trace.mean());
          certificate.lower += bonds;
          certificate.upper += of_bonds;
          certificate.gaps[sides[i].cell] +=
            of_bonds - bonds +
            trace.integral([&](const double xi, const double s) {
              return (mean + slope * xi) * s;
            });
        }
    }
  } // namespace



  double
  Certificate::width() const
  {
    return upper == lower ? 0. : (upper - lower) / std::abs(upper);
  }



  namespace
  {
    bool
    is_for_least(const Certificate &certificate)
    {
      return certificate.minimum == CertifiedMinimum::global &&
             certificate.loads_are_exact;
    }
  } // namespace



  void
  intersect(Certificate &certificate, const Certificate &other)
  {
    if (!is_for_least(certificate) || !is_for_least(other))
      return;
    certificate.lower = std::max(certificate.lower, other.lower);
    certificate.upper = std::min(certificate.upper, other.upper);
  }



  Certifier::Certifier(const CertificateKind                  kind,
                       const std::shared_ptr<const Scene<2>> &scene)
    : scene(scene)
    , minimum(kind == CertificateKind::global ||
                  scene->law().branches().size() == 1 ?
                CertifiedMinimum::global :
                CertifiedMinimum::fixed_state)
    , equilibrium(equilibrium_problem(*scene))
  {
    check_normals(scene->problem().unknowns().contact().boundary());
    if (scene->adhesion().has_field())
      throw EquilibriumError("bonds that vary are not done");
    if (!scene->conditions().tangential_exceptions.empty())
      throw EquilibriumError(
        "contact boundaries with different tangential displacements are not "
        "done");
    if (minimum == CertifiedMinimum::global &&
        scene->law().branches().size() > 1)
      trace_constants =
        side_constants(equilibrium,
                       scene->materials(),
                       scene->conditions().tangential_displacement_fixed);
  }



  bool
  Certifier::is_for_finer_meshes() const
  {
    return !trace_constants.empty() && equilibrium.loads_are_exact();
  }



  Certificate
  Certifier::certify(const Scene<2>                 &solved,
                     const DofVector                &u,
                     const BranchAndBoundParameters &proof,
                     const std::function<bool()>    &may_go_on,
                     const Certificate              *earlier,
                     const bool                      is_for_finer) const
  {
    const bool is_own = &solved == scene.get();
    Assert(is_own || is_for_finer_meshes(), dealii::ExcInternalError());
    dealii::Timer                          timer;
    const BranchMinimum                   &law = scene->law().branches();
    const std::vector<CellDisplacement<2>> displacement =
      cell_displacements(solved.problem(), u);
    Certificate certificate;
    certificate.minimum         = minimum;
    certificate.loads_are_exact = equilibrium.loads_are_exact();
    certificate.n_unknowns      = equilibrium.n_unknowns();
    certificate.n_sides =
      static_cast<unsigned int>(equilibrium.contact_sides().size());
    const double strain_energy = solved.problem().fields().strain_energy(u);
    const auto   rounding      = [&]() {
      return certificate_rounding *
             std::max(std::abs(certificate.upper), strain_energy);
    };
    if (is_own)
      try
        {
          bound_fixed_state(equilibrium, law, displacement, certificate);
          const double own = rounding();
          certificate.upper += own;
          certificate.lower -= certificate.reserve + own;
          certificate.reserve += 2. * own;
        }
      catch (const std::runtime_error &error)
        {
          // Such as a body that only bonds hold.
          if (trace_constants.empty())
            throw EquilibriumError(error.what());
          certificate.gaps.clear();
        }
      catch (const EquilibriumError &)
        {
          if (trace_constants.empty())
            throw;
          certificate.gaps.clear();
        }
    if (!trace_constants.empty())
      {
        ContactQuadratureParameters exact;
        exact.rule = ContactQuadratureParameters::Rule::exact;
        const ContactQuadrature<2> quadrature(exact, scene->law().kinks());
        const ContactSpace<2> &contact = solved.problem().unknowns().contact();
        certificate.upper =
          elastic_functional(solved, displacement) +
          AdhesionIntegral<2>(contact.boundary(), scene->law(), quadrature)
            .energy(contact.trace(u));
        const double own = rounding();
        certificate.upper += own;
        std::vector<double> side_energies(certificate.n_sides, 0.);
        if (is_own)
          {
            // Shifts soften the whole element.
            const std::vector<double> energies =
              equilibrium.element_energies(displacement);
            for (unsigned int i = 0; i < certificate.n_sides; ++i)
              side_energies[i] =
                energies[equilibrium.contact_sides()[i].element];
          }
        std::vector<CertifiedSide> known;
        const bool is_known = earlier != nullptr && is_for_least(*earlier) &&
                              is_for_least(certificate);
        if (is_known)
          certificate.upper = std::min(certificate.upper, earlier->upper);
        for (const ContactSide &side : equilibrium.contact_sides())
          known.push_back(known_between(side.corners,
                                        is_known ?
                                          earlier->sides :
                                          std::vector<CertifiedSide>()));
        GlobalBound bound        = bound_global(equilibrium,
                                         trace_constants,
                                         law,
                                         side_means(equilibrium,
                                                    contact.boundary(),
                                                    contact.trace(u)),
                                         side_energies,
                                         certificate.upper,
                                         known,
                                         is_for_finer,
                                         proof,
                                         may_go_on);
        certificate.lower        = bound.lower - own;
        certificate.reserve      = bound.rounding + 2. * own;
        certificate.proof_status = bound.status;
        certificate.proof_nodes  = bound.nodes;
        if (!certificate.gaps.empty())
          for (unsigned int i = 0; i < bound.losses.size(); ++i)
            certificate.gaps[equilibrium.contact_sides()[i].cell] +=
              bound.losses[i];
        certificate.sides = std::move(bound.sides);
        certificate.lengths =
          certified_lengths(certificate.sides, scene->law());
      }
    if (!std::isfinite(certificate.lower))
      throw EquilibriumError("no bound was found (" +
                             to_string(certificate.proof_status) + ")");
    if (earlier != nullptr)
      intersect(certificate, *earlier);
    certificate.seconds = timer.wall_time();
    return certificate;
  }



  double
  Certifier::elastic_functional(
    const Scene<2>                         &solved,
    const std::vector<CellDisplacement<2>> &displacement) const
  {
    if (&solved == scene.get())
      return equilibrium.elastic_functional(displacement);
    return equilibrium_problem(solved).elastic_functional(displacement);
  }
} // namespace Debond
