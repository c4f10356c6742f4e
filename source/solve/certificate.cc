// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/elasticity/temperature_load.h>
#include <debond/elasticity/trace_constant.h>
#include <debond/linear_algebra/eigen_view.h>
#include <debond/optimization/global/rounded_branches.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/solve/certificate.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    using ContactSide = EquilibriumProblem::ContactSide;



    /// What one's own computations may have lost, relative to J and the strain
    /// energy.
    constexpr double certificate_rounding = 1e-9;

    /// Of tractions, relative to the largest one.
    constexpr double traction_rounding = 1e-9;

    /// How far a proof goes, which is much less than what meshes leave.
    constexpr double proof_tolerance = 1e-6;



    std::vector<dealii::Tensor<1, 2>>
    vertex_displacements(const ElasticProblem<2>      &problem,
                         const dealii::Vector<double> &u)
    {
      const dealii::DoFHandler<2> &dofs = problem.unknowns().dof_handler();
      const dealii::Vector<double> cartesian =
        problem.unknowns().cartesian_displacement(u);
      std::vector<dealii::Tensor<1, 2>> values(
        dofs.get_triangulation().n_vertices());
      for (const auto &cell : dofs.active_cell_iterators())
        for (unsigned int v = 0; v < 3; ++v)
          for (unsigned int d = 0; d < 2; ++d)
            values[cell->vertex_index(v)][d] =
              cartesian(cell->vertex_dof_index(v, d));
      return values;
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



    double
    integral_of_parabola(const double length,
                         const double first,
                         const double middle,
                         const double last)
    {
      return length / 6. * (first + 4. * middle + last);
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



    /// The normal displacements at the ends of a side, and its unknowns there:
    /// mean +- slope / 3 are <= 0 if the displacement is, as linear tractions
    /// <= 0 see it.
    struct Trace
    {
      double first, last;

      Trace(const ContactSide                       &side,
            const std::vector<dealii::Tensor<1, 2>> &displacements)
        : first(displacements[side.vertices[0]] * side.normal)
        , last(displacements[side.vertices[1]] * side.normal)
      {}

      double
      mean() const
      {
        return 0.5 * (first + last);
      }
    };



    /// The least J with given branches.
    void
    bound_fixed_state(const EquilibriumProblem                &equilibrium,
                      const BranchMinimum                     &law,
                      const std::vector<dealii::Tensor<1, 2>> &displacements,
                      Certificate                             &certificate)
    {
      const std::vector<ContactSide> &sides = equilibrium.contact_sides();
      const Eigen::Index    n         = static_cast<Eigen::Index>(sides.size());
      const auto            condensed = equilibrium.condense(true);
      const Eigen::MatrixXd S = eigen_view(condensed->schur_complement());
      const Eigen::VectorXd g = eigen_view(condensed->load());

      // Means and slopes from mean +- slope / 3.
      Eigen::MatrixXd T(2 * n, 2 * n);
      T << 0.5 * Eigen::MatrixXd::Identity(n, n),
        0.5 * Eigen::MatrixXd::Identity(n, n),
        1.5 * Eigen::MatrixXd::Identity(n, n),
        -1.5 * Eigen::MatrixXd::Identity(n, n);
      std::vector<BranchMinimum::Piece> pieces;
      Eigen::MatrixXd                   M = S;
      Eigen::VectorXd                   r = g;
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const Trace trace(sides[i], displacements);
          pieces.push_back(law[law.index(trace.mean())]);
          const double weight = sides[i].length * pieces.back().curvature;
          M(i, i) += weight;
          M(n + i, n + i) += weight / 3.;
          r(i) -= sides[i].length * pieces.back().slope;
        }
      ActiveSet           active(2 * n, 0);
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
        largest_traction =
          std::max(largest_traction,
                   (std::abs(moments(i)) + 3. * std::abs(moments(n + i))) /
                     sides[i].length);
      certificate.lower = condensed->energy_at_zero() - 0.5 * x.dot(S * x);
      certificate.upper = equilibrium.elastic_functional(displacements);
      const dealii::Vector<double> kept(x.begin(), x.end());
      certificate.gaps =
        equilibrium.constitutive_gaps(displacements, condensed->expand(kept));
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const double length = sides[i].length;
          const double mean   = moments(i) / length;
          const double slope  = 3. * moments(n + i) / length;
          const double bonds =
            conjugate_integral(pieces[i],
                               length,
                               mean - slope,
                               mean + slope,
                               traction_rounding * largest_traction);
          const Trace trace(sides[i], displacements);
          const auto  energy = [&](const double s) {
            return pieces[i].value(s);
          };
          const double of_bonds = integral_of_parabola(length,
                                                       energy(trace.first),
                                                       energy(trace.mean()),
                                                       energy(trace.last));
          certificate.lower += bonds;
          certificate.upper += of_bonds;
          certificate.gaps[sides[i].cell] +=
            of_bonds - bonds +
            integral_of_parabola(length,
                                 (mean - slope) * trace.first,
                                 mean * trace.mean(),
                                 (mean + slope) * trace.last);
        }
    }



    /// Throws EquilibriumError if the element is none.
    RectangleAboveSide
    rectangle(const ContactSide &side, const EquilibriumElement &element)
    {
      const dealii::Tensor<1, 2> a = element.corners[1] - element.corners[0];
      const dealii::Tensor<1, 2> b = element.corners[2] - element.corners[1];
      if (element.corners.size() != 4 ||
          std::abs(a * b) > 1e-10 * a.norm() * b.norm())
        throw EquilibriumError("cells at the contact boundary that are not "
                               "crossed rectangles are not done");
      return {side.length, element.area / side.length};
    }



    /// trace_constant() of the contact sides, once for those that are the same.
    std::vector<double>
    side_constants(const EquilibriumProblem &equilibrium,
                   const ByRegion<Material> &materials,
                   const bool                tangential_fixed)
    {
      struct Known
      {
        RectangleAboveSide Q;
        Material           material;
        double             constant;
      };
      std::vector<Known>  known;
      std::vector<double> constants;
      for (const ContactSide &side : equilibrium.contact_sides())
        {
          const RectangleAboveSide Q =
            rectangle(side, equilibrium.elements()[side.element]);
          const Material &material = materials(side.material);
          const auto      is_same  = [](const double one, const double other) {
            return std::abs(one - other) <= 1e-12 * std::abs(other);
          };
          auto same =
            std::find_if(known.begin(), known.end(), [&](const Known &other) {
              return is_same(other.Q.width, Q.width) &&
                     is_same(other.Q.height, Q.height) &&
                     other.material.young_modulus == material.young_modulus &&
                     other.material.poisson_ratio == material.poisson_ratio;
            });
          if (same == known.end())
            same = known.insert(
              known.end(),
              {Q, material, trace_constant(Q, material, tangential_fixed)});
          constants.push_back(same->constant);
        }
      return constants;
    }



    /// The shift D of each side of the contact boundary: large enough for the
    /// law not to be rounded at its mean, if that can be with the given
    /// multiple of the bonds' stiffness.
    std::vector<double>
    side_shifts(const EquilibriumProblem  &equilibrium,
                const std::vector<double> &trace_constants,
                const BranchMinimum       &law,
                const Eigen::VectorXd     &means,
                const double               multiple)
    {
      const std::vector<ContactSide> &sides = equilibrium.contact_sides();
      std::vector<unsigned int>       sharers(equilibrium.elements().size(), 0);
      for (const ContactSide &side : sides)
        ++sharers[side.element];

      const double        largest = multiple * law[0].curvature;
      std::vector<double> shifts;
      for (unsigned int i = 0; i < sides.size(); ++i)
        {
          double D = 0.02 * law[0].curvature;
          while (D < largest &&
                 RoundedBranches(law, D).is_rounded_near(means(i)))
            D *= 1.25;
          // At least a tenth of an element's stiffness stays.
          const double available =
            0.9 * trace_constants[i] / sharers[sides[i].element];
          shifts.push_back(std::min({D, largest, available}));
        }
      return shifts;
    }



    /// The condensation onto the means for shifts D, which are made smaller
    /// until it is convex in the slopes. Throws EquilibriumError if that does
    /// not help.
    std::unique_ptr<const Condensation>
    condense(const EquilibriumProblem  &equilibrium,
             const std::vector<double> &trace_constants,
             std::vector<double>       &D)
    {
      const std::vector<ContactSide> &sides  = equilibrium.contact_sides();
      constexpr unsigned int          trials = 12;
      for (unsigned int trial = 0; trial < trials; ++trial)
        {
          std::vector<double> weights(equilibrium.elements().size(), 1.);
          std::vector<std::pair<unsigned int, double>> slope_terms;
          for (unsigned int i = 0; i < sides.size(); ++i)
            {
              weights[sides[i].element] -= D[i] / trace_constants[i];
              slope_terms.emplace_back(sides[i].slope,
                                       -D[i] * sides[i].length / 3.);
            }
          try
            {
              return equilibrium.condense(false, weights, slope_terms);
            }
          catch (const std::runtime_error &)
            {
              for (double &shift : D)
                shift *= 0.5;
            }
        }
      throw EquilibriumError("the equilibrated stresses are not determined by "
                             "the mean displacements of the contact sides");
    }



    /// The least J, by branch and bound on the means.
    void
    bound_global(const EquilibriumProblem                &equilibrium,
                 const std::vector<double>               &trace_constants,
                 const BranchMinimum                     &law,
                 const BranchAndBoundParameters          &proof_parameters,
                 const std::vector<dealii::Tensor<1, 2>> &displacements,
                 const std::function<bool()>             &may_go_on,
                 Certificate                             &certificate)
    {
      const std::vector<ContactSide> &sides = equilibrium.contact_sides();
      Eigen::VectorXd                 m(sides.size());
      for (unsigned int i = 0; i < sides.size(); ++i)
        m(i) = std::min(0., Trace(sides[i], displacements).mean());

      certificate.lower        = -std::numeric_limits<double>::infinity();
      certificate.proof_status = ProofStatus::no_bound;
      // Large shifts at the kinks cost stiffness, small ones round the law: the
      // finer the mesh, the larger the best one is.
      for (const double multiple : {2., 6.})
        {
          std::vector<double> D =
            side_shifts(equilibrium, trace_constants, law, m, multiple);
          const auto condensed = condense(equilibrium, trace_constants, D);
          std::vector<BranchMinimum> laws;
          for (unsigned int i = 0; i < sides.size(); ++i)
            laws.push_back(
              RoundedBranches(law, D[i]).minimum().with_first_curvature(
                sides[i].length * law[0].curvature));

          BranchAndBoundParameters parameters = proof_parameters;
          parameters.tolerance = proof_tolerance * std::abs(certificate.upper);
          const dealii::Vector<double> start(m.begin(), m.end());
          const BranchAndBoundResult   proof =
            BranchAndBound(parameters)
              .minimize(condensed->schur_complement(),
                        condensed->load(),
                        SeparableBranches(laws),
                        start,
                        [&](const ProofProgress &) { return may_go_on(); });
          certificate.proof_nodes += proof.nodes;
          const double lower = condensed->energy_at_zero() + proof.lower;
          if (proof.status != ProofStatus::no_bound &&
              lower > certificate.lower)
            {
              certificate.lower        = lower;
              certificate.proof_status = proof.status;
            }
        }
    }
  } // namespace



  double
  Certificate::width() const
  {
    return (upper - lower) / std::abs(upper);
  }



  Certifier::Certifier(const CertificateKind kind, const Scene<2> &scene)
    : scene(scene)
    , minimum(kind == CertificateKind::global ||
                  scene.law().branches().size() == 1 ?
                CertifiedMinimum::global :
                CertifiedMinimum::fixed_state)
    , equilibrium(scene.problem().unknowns().dof_handler().get_triangulation(),
                  scene.conditions(),
                  scene.supports(),
                  scene.materials(),
                  scene.loads(),
                  thermal_stresses(scene.problem().unknowns().dof_handler(),
                                   scene.materials(),
                                   scene.loads()))
  {
    check_normals(scene.problem().unknowns().contact().boundary());
    if (scene.adhesion().has_field())
      throw EquilibriumError("bonds that vary are not done");
    if (minimum == CertifiedMinimum::global &&
        scene.law().branches().size() > 1)
      trace_constants =
        side_constants(equilibrium,
                       scene.materials(),
                       scene.conditions().tangential_displacement_fixed);
  }



  Certificate
  Certifier::certify(const dealii::Vector<double>   &u,
                     const BranchAndBoundParameters &proof,
                     const std::function<bool()>    &may_go_on) const
  {
    dealii::Timer        timer;
    const BranchMinimum &law  = scene.law().branches();
    const auto  displacements = vertex_displacements(scene.problem(), u);
    Certificate certificate;
    certificate.minimum         = minimum;
    certificate.loads_are_exact = equilibrium.loads_are_exact();
    certificate.n_unknowns      = equilibrium.n_unknowns();
    certificate.n_sides =
      static_cast<unsigned int>(equilibrium.contact_sides().size());
    if (trace_constants.empty())
      try
        {
          bound_fixed_state(equilibrium, law, displacements, certificate);
        }
      catch (const std::runtime_error &error)
        {
          // Such as a body that only bonds hold.
          throw EquilibriumError(error.what());
        }
    else
      {
        ContactQuadratureParameters exact;
        exact.rule = ContactQuadratureParameters::Rule::exact;
        const ContactQuadrature<2> quadrature(exact, scene.law().kinks());
        const ContactSpace<2> &contact = scene.problem().unknowns().contact();
        certificate.upper =
          equilibrium.elastic_functional(displacements) +
          AdhesionIntegral<2>(contact.boundary(), scene.law(), quadrature)
            .energy(contact.trace(u));
        bound_global(equilibrium,
                     trace_constants,
                     law,
                     proof,
                     displacements,
                     may_go_on,
                     certificate);
      }
    if (!std::isfinite(certificate.lower))
      throw EquilibriumError("no bound was found (" +
                             to_string(certificate.proof_status) + ")");
    const double rounding = certificate_rounding *
                            std::max(std::abs(certificate.upper),
                                     scene.problem().fields().strain_energy(u));
    certificate.lower -= rounding;
    certificate.upper += rounding;
    certificate.seconds = timer.wall_time();
    return certificate;
  }
} // namespace Debond
