// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/certify/certificate.h>
#include <debond/certify/exact_energy.h>
#include <debond/certify/positive_part.h>
#include <debond/certify/side_moments.h>
#include <debond/elasticity/temperature_load.h>
#include <debond/optimization/global/convex_envelope.h>
#include <debond/optimization/majorise/bound_qp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

namespace Debond
{
  namespace
  {
    template <int dim>
    using SideOf = typename EquilibriumProblem<dim>::ContactSide;



    template <int dim>
    EquilibriumProblem<dim>
    equilibrium_problem(const Scene<dim> &scene)
    {
      const auto &triangulation =
        scene.problem().unknowns().dof_handler().get_triangulation();
      // As pressures.
      std::vector<double> thermal_stresses =
        temperature_changes(triangulation, scene.loads());
      if (!thermal_stresses.empty())
        for (const auto &cell : triangulation.active_cell_iterators())
          thermal_stresses[cell->active_cell_index()] *=
            scene.materials()(cell->material_id())
              .template thermal_stress<dim>()[0][0];
      return EquilibriumProblem<dim>(triangulation,
                                     scene.conditions(),
                                     scene.supports(),
                                     scene.materials(),
                                     scene.loads(),
                                     thermal_stresses);
    }



    /// Throws EquilibriumError if a contact node has a normal that is not that
    /// of its sides.
    template <int dim>
    void
    check_normals(const ContactBoundary<dim> &boundary)
    {
      for (const auto &face : boundary.faces)
        for (const unsigned int node : face.nodes)
          if (node < boundary.nodes.size() &&
              (boundary.nodes[node].normal - face.normal).norm() >
                Tolerance::same_normal)
            throw EquilibriumError("a contact boundary with corners that are "
                                   "rounded by a mean normal is not done");
    }



    /// The law of each side with its bonds, which must not vary along it.
    template <int dim>
    std::vector<PiecewiseEnergy>
    laws_of_sides(const std::vector<SideOf<dim>> &sides,
                  const PiecewiseEnergy          &law,
                  const AdhesionIntegral<dim>    &bonds)
    {
      std::vector<PiecewiseEnergy> laws;
      for (const SideOf<dim> &side : sides)
        {
          if (!bonds.points().has_field())
            {
              laws.push_back(law);
              continue;
            }
          std::vector<BondScale> scales;
          for (const auto &[barycentric, weight] : side_rule<dim>())
            {
              dealii::Point<dim> position;
              for (unsigned int k = 0; k < dim; ++k)
                position += barycentric[k] * side.corners[k];
              scales.push_back(bonds.points().bonds_at(position, side.id));
              const auto differ = [](const double a, const double b) {
                return std::abs(a - b) > Tolerance::linear_data * std::abs(b);
              };
              if (differ(scales.back().energy, scales[0].energy) ||
                  differ(scales.back().stretch, scales[0].stretch))
                throw EquilibriumError("bonds that vary along a side are not "
                                       "done");
            }
          const auto &[energy, stretch] = scales[0];
          laws.push_back(law.scaled(energy, stretch));
        }
      return laws;
    }



    /// Throws EquilibriumError if the gap of @p boundary is not linear on its
    /// faces as that of the sides is.
    template <int dim>
    void
    check_gaps(const ContactBoundary<dim>     &boundary,
               const std::vector<SideOf<dim>> &sides)
    {
      std::map<std::vector<double>, double> gaps; ///< by corner and normal
      const auto key = [](const dealii::Point<dim>     &position,
                          const dealii::Tensor<1, dim> &normal) {
        std::vector<double> result;
        for (unsigned int d = 0; d < dim; ++d)
          {
            result.push_back(position[d]);
            result.push_back(std::round(1e6 * normal[d]));
          }
        return result;
      };
      double largest = 0.;
      for (const SideOf<dim> &side : sides)
        for (unsigned int k = 0; k < dim; ++k)
          {
            gaps[key(side.corners[k], side.normal)] = side.gap[k];
            largest = std::max(largest, std::abs(side.gap[k]));
          }
      const auto check = [&](const double gap, const double linear) {
        if (std::abs(gap - linear) > Tolerance::linear_data * largest)
          throw EquilibriumError("a gap that is not linear on each side, or "
                                 "differs between sides, is not done");
      };
      for (const auto &face : boundary.faces)
        {
          const auto gap_of = [&](const unsigned int k) {
            return face.is_held(k) ?
                     (boundary.held_vertices.empty() ?
                        0. :
                        boundary.held_vertices[face.held_at(k)].gap) :
                     boundary.nodes[face.node(k)].gap;
          };
          for (unsigned int k = 0; k < dim; ++k)
            check(gap_of(k), gaps.at(key(face.vertices[k], face.normal)));
          for (unsigned int k = dim; k < boundary.n_face_nodes(); ++k)
            {
              const auto &[a, b] = simplex_edges[k - dim];
              check(gap_of(k), 0.5 * (gap_of(a) + gap_of(b)));
            }
        }
    }



    std::vector<CertifiedLength>
    certified_lengths(const std::vector<CertifiedSide>   &sides,
                      const std::vector<PiecewiseEnergy> &laws,
                      const AdhesiveLaw                  &whole)
    {
      std::vector<CertifiedLength> lengths;
      for (unsigned int k = 0; k < whole.branches().size(); ++k)
        {
          CertifiedLength length = {whole.name(k), 0., 0.};
          for (unsigned int i = 0; i < sides.size(); ++i)
            {
              const CertifiedSide   &side = sides[i];
              const PiecewiseEnergy &law  = laws[i];
              const double measure        = side.ends[0].distance(side.ends[1]);
              // Without bonds all of them are broken.
              if (law.size() < whole.branches().size())
                {
                  if (k + 1 == whole.branches().size())
                    {
                      length.largest += measure;
                      length.least += measure;
                    }
                  continue;
                }
              const auto    &piece     = law[k];
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



    /// int h(q) of the linear q with the values @p at_corners,
    ///     h(q) = inf_{s <= 0} piece(s) + q s
    ///          = constant - (q + slope)_+^2 / (2 curvature).
    /// Without a curvature q has to be below -slope but for @p rounding; throws
    /// EquilibriumError if it is not, as h is minus infinity then.
    template <int dim>
    double
    conjugate_integral(const PiecewiseEnergy::Piece  &piece,
                       const double                   measure,
                       const std::array<double, dim> &at_corners,
                       const double                   rounding)
    {
      std::array<double, dim> pull = at_corners;
      for (double &value : pull)
        value += piece.slope;
      const double constant = measure * static_cast<double>(piece.constant);
      if (piece.curvature > 0.)
        return constant -
               measure * mean_positive_square(pull) / (2. * piece.curvature);
      if (*std::max_element(pull.begin(), pull.end()) > rounding)
        throw EquilibriumError("the tractions pull where no bond holds");
      return constant;
    }



    /// The normal displacement of a side less the gap, of degree 1 or 2.
    template <int dim>
    class Trace
    {
    public:
      Trace(const SideOf<dim>          &side,
            const ElasticUnknowns<dim> &unknowns,
            const DofVector            &displacement)
        : side(side)
        , u(unknowns, displacement, side.cell, side.vertices)
      {}

      double
      mean() const
      {
        return integral([](const auto &, const double s) { return s; }) /
               side.measure;
      }

      /// Of a function of the barycentric coordinates and the displacement
      /// there, exact up to degree 5.
      template <typename Function>
      double
      integral(const Function &function) const
      {
        double sum = 0.;
        for (const auto &[barycentric, weight] : side_rule<dim>())
          sum += weight * side.measure *
                 function(barycentric,
                          u(barycentric) * side.normal - gap_at(barycentric));
        return sum;
      }

    private:
      double
      gap_at(const std::array<double, dim> &barycentric) const
      {
        return std::inner_product(barycentric.begin(),
                                  barycentric.end(),
                                  side.gap.begin(),
                                  0.);
      }

      const SideOf<dim>          &side;
      const SideDisplacement<dim> u;
    };



    /// The least J with given branches.
    template <int dim>
    void
    bound_fixed_state(const EquilibriumProblem<dim>      &equilibrium,
                      const std::vector<PiecewiseEnergy> &laws,
                      const ElasticFields<dim>           &fields,
                      const DofVector                    &displacement,
                      Certificate                        &certificate)
    {
      const std::vector<SideOf<dim>> &sides = equilibrium.contact_sides();
      const Eigen::Index     n = static_cast<Eigen::Index>(sides.size());
      const auto             condensed = equilibrium.condense();
      const Eigen::MatrixXd  S         = condensed->schur_complement();
      const Eigen::VectorXd &g         = condensed->load();

      // The unknowns are <= 0 if the displacement is, as linear tractions <= 0
      // see it. Their work-conjugates are the tractions at the corners times a
      // part of the side.
      std::vector<PiecewiseEnergy::Piece> pieces;
      Eigen::VectorXd                     u_nu(dim * n);
      Eigen::MatrixXd                     M = S;
      Eigen::VectorXd                     r = g;
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const Trace<dim> trace(sides[i], fields.unknowns(), displacement);
          pieces.push_back(laws[i][laws[i].index(trace.mean())]);
          // The integral of the square of the linear function with these means.
          const double weight =
            sides[i].measure * pieces.back().curvature / dim;
          for (Eigen::Index k = 0; k < dim; ++k)
            {
              u_nu(k * n + i) =
                trace.integral([k](const std::array<double, dim> &barycentric,
                                   const double                   value) {
                  return dim * barycentric[k] * value;
                }) /
                sides[i].measure;
              for (Eigen::Index l = 0; l < dim; ++l)
                M(k * n + i, l * n + i) += weight * (k == l ? dim : -1.);
              r(k * n + i) -= sides[i].measure * pieces.back().slope / dim;
            }
        }
      // Where the displacement is in contact, and what is wrong there is found.
      ActiveSet active(dim * n, 0);
      for (Eigen::Index i = 0; i < dim * n; ++i)
        active[i] = u_nu(i) >= -Tolerance::certificate *
                                 u_nu.template lpNorm<Eigen::Infinity>();
      const BoundQPResult minimum =
        solve_bound_qp(M, r, Eigen::VectorXd::Zero(dim * n), active);
      if (minimum.status != SolverStatus::success &&
          minimum.status != SolverStatus::stagnated)
        throw EquilibriumError("the tractions of the contact boundary were not "
                               "found (" +
                               to_string(minimum.status) + ")");
      const Eigen::VectorXd &x = minimum.x;

      // Of the stresses that x leads to.
      const Eigen::VectorXd moments    = S * x - g;
      const auto            at_corners = [&](const Eigen::VectorXd &conjugates,
                                  const Eigen::Index     i) {
        std::array<double, dim> result;
        for (Eigen::Index k = 0; k < dim; ++k)
          result[k] = dim * conjugates(k * n + i) / sides[i].measure;
        return result;
      };
      double largest_traction = 0.;
      for (Eigen::Index i = 0; i < n; ++i)
        for (const Eigen::VectorXd *of : {&moments, &g})
          for (const double traction : at_corners(*of, i))
            largest_traction = std::max(largest_traction, std::abs(traction));
      certificate.lower = condensed->energy_at_zero() - 0.5 * x.dot(S * x);
      const std::vector<Eigen::VectorXd> stresses =
        equilibrium.stresses(condensed->expand(x));
      certificate.reserve = equilibrium.rounding_of(*condensed, x);
      certificate.upper = equilibrium.elastic_functional(fields, displacement);
      certificate.gaps =
        equilibrium.constitutive_gaps(fields, displacement, stresses);
      for (const auto &stress : equilibrium.mean_stresses(stresses))
        {
          certificate.stresses.emplace_back();
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e <= d; ++e)
              certificate.stresses.back()[d][e] = stress[d][e];
        }
      for (Eigen::Index i = 0; i < n; ++i)
        {
          const std::array<double, dim> tractions = at_corners(moments, i);
          const double                  bonds =
            conjugate_integral<dim>(pieces[i],
                                    sides[i].measure,
                                    tractions,
                                    Tolerance::certificate * largest_traction);
          const Trace<dim> trace(sides[i], fields.unknowns(), displacement);
          const double     of_bonds = trace.integral(
            [&](const auto &, const double s) { return pieces[i].value(s); });
          // Nothing may pull there: what rounding pulls costs this much at the
          // displacement, and is reserved four times.
          if (pieces[i].curvature == 0.)
            certificate.reserve +=
              4. *
              std::max(*std::max_element(tractions.begin(), tractions.end()) +
                         pieces[i].slope,
                       0.) *
              sides[i].measure * std::abs(trace.mean());
          certificate.lower += bonds;
          certificate.upper += of_bonds;
          certificate.gaps[sides[i].cell->active_cell_index()] +=
            of_bonds - bonds +
            trace.integral([&](const auto &barycentric, const double s) {
              double traction = 0.;
              for (unsigned int k = 0; k < dim; ++k)
                traction += barycentric[k] * tractions[k];
              return traction * s;
            });
        }
    }
  } // namespace



  void
  Certificate::include(const double functional)
  {
    lower = std::min(lower, functional);
    upper = std::max(upper, functional);
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



  template <int dim>
  Certifier<dim>::Certifier(const CertificateKind                    kind,
                            const std::shared_ptr<const Scene<dim>> &scene)
    : scene(scene)
    , minimum(kind == CertificateKind::global ||
                  scene->law().branches().size() == 1 ?
                CertifiedMinimum::global :
                CertifiedMinimum::fixed_state)
    , equilibrium(equilibrium_problem(*scene))
  {
    check_normals(scene->contact_boundary());
    check_gaps<dim>(scene->contact_boundary(), equilibrium.contact_sides());
    laws = laws_of_sides<dim>(equilibrium.contact_sides(),
                              scene->law().branches(),
                              scene->adhesion());
    if constexpr (dim == 2)
      if (minimum == CertifiedMinimum::global &&
          scene->law().branches().size() > 1)
        trace_constants =
          side_constants(equilibrium, scene->materials(), scene->conditions());
  }



  namespace
  {
    /// What one's own computations may have lost at J of @p certificate.
    double
    own_rounding(const Certificate &certificate, const double strain_energy)
    {
      return Tolerance::certificate *
             std::max(std::abs(certificate.upper), strain_energy);
    }
  } // namespace



  template <int dim>
  Certificate
  Certifier<dim>::certify(const DofVector                &u,
                          const BranchAndBoundParameters &proof,
                          const Interruption             &interruption,
                          const Certificate              *earlier) const
  {
    const ElasticFields<dim> &fields = scene->problem().fields();
    const DofVector           displacement =
      scene->problem().unknowns().cartesian_displacement(u);
    Certificate certificate;
    certificate.minimum         = minimum;
    certificate.loads_are_exact = equilibrium.loads_are_exact();
    certificate.n_unknowns      = equilibrium.n_unknowns();
    certificate.n_sides =
      static_cast<unsigned int>(equilibrium.contact_sides().size());
    try
      {
        bound_fixed_state(equilibrium, laws, fields, displacement, certificate);
        const double own = own_rounding(certificate, fields.strain_energy(u));
        certificate.upper += own;
        certificate.lower -= certificate.reserve + own;
        certificate.reserve += 2. * own;
      }
    catch (const EquilibriumError &)
      {
        // Such as a body that only bonds hold.
        if (trace_constants.empty())
          throw;
        certificate.gaps.clear();
      }
    if constexpr (dim == 2)
      if (!trace_constants.empty())
        certify_global(
          u, displacement, proof, interruption, earlier, certificate);
    if (!std::isfinite(certificate.lower))
      throw EquilibriumError("no bound was found (" +
                             to_string(certificate.proof_status) + ")");
    add_load_rests(u, displacement, certificate);
    if (earlier != nullptr)
      intersect(certificate, *earlier);
    if (!(certificate.lower <= certificate.upper))
      {
        std::ostringstream text;
        text.precision(10);
        text << std::scientific << "the lower bound " << certificate.lower
             << " is above the upper one " << certificate.upper
             << ", so that one of them is wrong";
        throw EquilibriumError(text.str());
      }
    return certificate;
  }



  template <>
  void
  Certifier<2>::certify_global(const DofVector                &u,
                               const DofVector                &displacement,
                               const BranchAndBoundParameters &proof,
                               const Interruption             &interruption,
                               const Certificate              *earlier,
                               Certificate &certificate) const
  {
    const ElasticFields<2> &fields  = scene->problem().fields();
    const ContactSpace<2>  &contact = scene->problem().unknowns().contact();
    certificate.upper = equilibrium.elastic_functional(fields, displacement) +
                        exact_energy(scene->adhesion(),
                                     contact.boundary(),
                                     scene->law(),
                                     contact.trace(u));
    const double own = own_rounding(certificate, fields.strain_energy(u));
    certificate.upper += own;
    // The value that is reached: that of the better displacement.
    if (earlier != nullptr && is_for_least(*earlier) &&
        is_for_least(certificate))
      certificate.upper = std::min(certificate.upper, earlier->upper);

    const std::vector<double> energies = strain_energies(fields, displacement);
    std::vector<double>       side_energies;
    Eigen::VectorXd           means(certificate.n_sides);
    for (unsigned int i = 0; i < certificate.n_sides; ++i)
      {
        const SideOf<2> &side = equilibrium.contact_sides()[i];
        side_energies.push_back(energies[side.cell->active_cell_index()]);
        means(i) =
          std::min(Trace<2>(side, fields.unknowns(), displacement).mean(), 0.);
      }
    const MeanProblems problems(equilibrium,
                                trace_constants,
                                laws,
                                side_energies);
    GlobalBound        bound =
      bound_global(problems, means, certificate.upper, proof, interruption);
    certificate.lower        = bound.lower - own;
    certificate.reserve      = bound.rounding + 2. * own;
    certificate.proof_status = bound.status;
    certificate.proof_nodes  = bound.nodes;
    if (!certificate.gaps.empty())
      for (unsigned int i = 0; i < bound.losses.size(); ++i)
        certificate
          .gaps[equilibrium.contact_sides()[i].cell->active_cell_index()] +=
          bound.losses[i];
    certificate.sides = std::move(bound.sides);
    certificate.lengths =
      certified_lengths(certificate.sides, laws, scene->law());
  }



  template <int dim>
  void
  Certifier<dim>::add_load_rests(const DofVector &u,
                                 const DofVector &displacement,
                                 Certificate     &certificate) const
  {
    // What the equilibrium does not know of the loads: as much as at u.
    const ElasticFields<dim> &fields = scene->problem().fields();
    const std::vector<double> rests =
      equilibrium.load_rests(fields, displacement);
    for (unsigned int cell = 0; cell < rests.size(); ++cell)
      {
        certificate.lower -= rests[cell];
        if (!certificate.gaps.empty())
          certificate.gaps[cell] += rests[cell];
      }
    const double rest = fields.elastic_functional(u) -
                        equilibrium.elastic_functional(fields, displacement);
    if (std::abs(rest) > own_rounding(certificate, fields.strain_energy(u)))
      {
        certificate.loads_are_exact = false;
        certificate.upper += rest;
        certificate.lower -= std::abs(rest);
      }
  }



  template class Certifier<2>;
  template class Certifier<3>;
} // namespace Debond
