// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/elasticity/temperature_load.h>
#include <debond/linear_algebra/eigen_view.h>
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



    EquilibriumProblem
    equilibrium_problem(const Scene<2> &scene)
    {
      const auto &dofs = scene.problem().unknowns().dof_handler();
      return EquilibriumProblem(dofs.get_triangulation(),
                                scene.conditions(),
                                scene.supports(),
                                scene.materials(),
                                scene.loads(),
                                thermal_stresses(dofs,
                                                 scene.materials(),
                                                 scene.loads()));
    }



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



    /// Means of u_nu on sides, from a mesh at least as fine.
    Eigen::VectorXd
    side_means(const EquilibriumProblem     &equilibrium,
               const ContactBoundary<2>     &boundary,
               const dealii::Vector<double> &trace)
    {
      const auto     &sides = equilibrium.contact_sides();
      Eigen::VectorXd means = Eigen::VectorXd::Zero(sides.size());
      for (const ContactBoundary<2>::Face &face : boundary.faces)
        {
          double value = 0.;
          for (const unsigned int node : face.nodes)
            if (node < boundary.nodes.size())
              value += 0.5 * trace(node);
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
                means(i) += face.measure / sides[i].length * value;
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
              const double measure = side.ends[0].distance(side.ends[1]);
              const auto  &piece   = law.branches()[k];
              const bool   is_likely =
                side.linear.upper > piece.lower &&
                (k == 0 || side.linear.lower < piece.upper);
              if (side.piece ? *side.piece == k : is_likely)
                length.largest += measure;
              if (side.piece == k)
                length.least += measure;
            }
          lengths.push_back(length);
        }
      return lengths;
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
  } // namespace



  double
  Certificate::width() const
  {
    return (upper - lower) / std::abs(upper);
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
                     const dealii::Vector<double>   &u,
                     const BranchAndBoundParameters &proof,
                     const std::function<bool()>    &may_go_on) const
  {
    Assert(&solved == scene.get() || is_for_finer_meshes(),
           dealii::ExcInternalError());
    dealii::Timer        timer;
    const BranchMinimum &law  = scene->law().branches();
    const auto  displacements = vertex_displacements(solved.problem(), u);
    Certificate certificate;
    certificate.minimum         = minimum;
    certificate.loads_are_exact = equilibrium.loads_are_exact();
    certificate.n_unknowns      = equilibrium.n_unknowns();
    certificate.n_sides =
      static_cast<unsigned int>(equilibrium.contact_sides().size());
    const double strain_energy = solved.problem().fields().strain_energy(u);
    const auto   reserve       = [&]() {
      return certificate_rounding *
             std::max(std::abs(certificate.upper), strain_energy);
    };
    if (trace_constants.empty())
      try
        {
          bound_fixed_state(equilibrium, law, displacements, certificate);
          certificate.upper += reserve();
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
        const ContactQuadrature<2> quadrature(exact, scene->law().kinks());
        const ContactSpace<2> &contact = solved.problem().unknowns().contact();
        certificate.upper =
          elastic_functional(solved, displacements) +
          AdhesionIntegral<2>(contact.boundary(), scene->law(), quadrature)
            .energy(contact.trace(u));
        certificate.upper += reserve();
        GlobalBound bound        = bound_global(equilibrium,
                                         trace_constants,
                                         law,
                                         side_means(equilibrium,
                                                    contact.boundary(),
                                                    contact.trace(u)),
                                         certificate.upper,
                                         proof,
                                         may_go_on);
        certificate.lower        = bound.lower;
        certificate.proof_status = bound.status;
        certificate.proof_nodes  = bound.nodes;
        certificate.sides        = std::move(bound.sides);
        certificate.lengths =
          certified_lengths(certificate.sides, scene->law());
      }
    if (!std::isfinite(certificate.lower))
      throw EquilibriumError("no bound was found (" +
                             to_string(certificate.proof_status) + ")");
    certificate.lower -= reserve();
    certificate.seconds = timer.wall_time();
    return certificate;
  }



  double
  Certifier::elastic_functional(
    const Scene<2>                          &solved,
    const std::vector<dealii::Tensor<1, 2>> &displacements) const
  {
    if (&solved == scene.get())
      return equilibrium.elastic_functional(displacements);
    return equilibrium_problem(solved).elastic_functional(displacements);
  }
} // namespace Debond
