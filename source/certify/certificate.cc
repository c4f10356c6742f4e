// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/certify/certificate.h>
#include <debond/certify/exact_energy.h>
#include <debond/certify/positive_part.h>
#include <debond/certify/side_moments.h>
#include <debond/elasticity/temperature_load.h>
#include <debond/optimization/global/convex_envelope.h>
#include <debond/optimization/majorise/bound_qp.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    template <int dim>
    using SideOf = typename EquilibriumMesh<dim>::Side;



    /// Checks the data of the scene first.
    template <int dim>
    EquilibriumProblem<dim>
    equilibrium_problem(const Scene<dim> &scene)
    {
      check_certifiable(scene);
      // Stresses are sought on the mesh of the displacements, with the same
      // supports, materials and loads.
      const auto &triangulation =
        scene.problem().unknowns().dof_handler().get_triangulation();
      // A change of temperature enters as the pressure that it would make if
      // the body could not move; it belongs to the energy of sigma and not to
      // its equilibrium.
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



    /// The law of a side with its bonds. Throws EquilibriumError if they vary
    /// along it.
    template <int dim>
    PiecewiseEnergy
    law_of_side(const std::array<dealii::Point<dim>, dim> &corners,
                const dealii::types::boundary_id           id,
                const Scene<dim>                          &scene)
    {
      const PiecewiseEnergy &law = scene.law().pieces();
      if (!scene.adhesion().points().has_field())
        return law;
      // Theorem 1 has one law for each side, whose mean stands for all its
      // points. So bonds have to be the same at all points of the rule by which
      // the law is integrated here, which stand for all points of the side.
      std::optional<BondScale> first;
      for (const auto &[barycentric, weight] : side_rule<dim>())
        {
          dealii::Point<dim> position;
          for (unsigned int k = 0; k < dim; ++k)
            position += barycentric[k] * corners[k];
          const BondScale here =
            scene.adhesion().points().bonds_at(position, id);
          first             = first.value_or(here);
          const auto differ = [](const double a, const double b) {
            return std::abs(a - b) > Tolerance::linear_data * std::abs(b);
          };
          if (differ(here.energy, first->energy) ||
              differ(here.length, first->length))
            throw EquilibriumError("bonds that vary along a side are not done");
        }
      return law.scaled(first->energy, first->length);
    }



    /// Throws EquilibriumError if the gap of a face is not linear, with the
    /// values of @p gap at its vertices (zero for null); @p largest: that of
    /// the boundary.
    template <int dim>
    void
    check_gap(const ContactBoundary<dim>                &boundary,
              const typename ContactBoundary<dim>::Face &face,
              const dealii::Function<dim> *const         gap,
              const double                               largest)
    {
      // The moments of s = v_nu - gap are the unknowns, and they are those of
      // v_nu less a linear gap. With quadratic displacements the coefficient of
      // an edge has to be the mean of its ends for that.
      std::vector<double> values, linear;
      for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
        {
          values.push_back(face.is_held(k) ?
                             (boundary.held_vertices.empty() ?
                                0. :
                                boundary.held_vertices[face.held_at(k)].gap) :
                             boundary.nodes[face.node(k)].gap);
          if (k >= dim)
            {
              const auto &[a, b] = simplex_edges[k - dim];
              linear.push_back(0.5 * (values[a] + values[b]));
            }
          else
            linear.push_back(gap == nullptr ? 0. :
                                              gap->value(face.vertices[k]));
        }
      for (unsigned int k = 0; k < values.size(); ++k)
        if (std::abs(values[k] - linear[k]) > Tolerance::linear_data * largest)
          throw EquilibriumError("a gap that is not linear on each side, or "
                                 "differs between sides, is not done");
    }
  } // namespace



  template <int dim>
  void
  check_certifiable(const Scene<dim> &scene)
  {
    check_supports(scene.conditions(), scene.supports());
    const ContactBoundary<dim> &boundary = scene.contact_boundary();
    // What the proof does not cover is refused before anything is solved: mean
    // normals would make v_nu another function than the trace of v on the side.
    double largest = 0.;
    for (const auto &node : boundary.nodes)
      largest = std::max(largest, std::abs(node.gap));
    for (const auto &face : boundary.faces)
      {
        // Joined faces share the mean of their normals, which is that of a face
        // only if they are on one plane.
        for (const unsigned int node : face.nodes)
          if (node < boundary.nodes.size() &&
              (boundary.nodes[node].normal - face.normal).norm() >
                Tolerance::same_normal)
            throw EquilibriumError("a contact boundary with corners that are "
                                   "rounded by a mean normal is not done");
        const auto gap = scene.supports().gaps.find(face.id);
        check_gap(boundary,
                  face,
                  gap == scene.supports().gaps.end() ? nullptr :
                                                       gap->second.value.get(),
                  largest);
        law_of_side<dim>(face.vertices, face.id, scene);
      }
  }



  namespace
  {
    std::vector<CertifiedLength>
    certified_lengths(const std::vector<CertifiedSide>   &sides,
                      const std::vector<PiecewiseEnergy> &laws,
                      const AdhesiveLaw                  &whole)
    {
      std::vector<CertifiedLength> lengths;
      for (unsigned int k = 0; k < whole.pieces().size(); ++k)
        {
          // A side counts for the least length of a state if its piece is
          // certain, and for the largest one if its interval meets the piece at
          // all.
          CertifiedLength length = {whole.name(k), 0., 0.};
          for (unsigned int i = 0; i < sides.size(); ++i)
            {
              const CertifiedSide   &side = sides[i];
              const PiecewiseEnergy &law  = laws[i];
              const double measure        = side.ends[0].distance(side.ends[1]);
              // Without bonds all of them are broken.
              if (law.size() < whole.pieces().size())
                {
                  if (k + 1 == whole.pieces().size())
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
    /// FixedStateError if it is not, as h is minus infinity then.
    template <int dim>
    double
    conjugate_integral(const PiecewiseEnergy::Piece  &piece,
                       const double                   measure,
                       const std::array<double, dim> &at_corners,
                       const double                   rounding)
    {
      // The infimum of c/2 s^2 + (slope + q) s over s <= 0 is at s = -(q +
      // slope)/c where that pulls, otherwise at 0. Without a curvature the
      // bonds do not resist, and the infimum is finite only if nothing pulls.
      std::array<double, dim> pull = at_corners;
      for (double &value : pull)
        value += piece.slope;
      const double constant = measure * static_cast<double>(piece.constant);
      if (piece.curvature > 0.)
        return constant -
               measure * mean_positive_square(pull) / (2. * piece.curvature);
      if (*std::max_element(pull.begin(), pull.end()) > rounding)
        throw FixedStateError("the tractions pull where no bond holds");
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

      /// Integrates a function of the barycentric coordinates and the
      /// displacement there, exactly up to degree 5.
      template <typename Function>
      double
      integral(const Function &function) const
      {
        // The rule has points inside of the side, at each of which the gap is
        // the linear function of its values at the corners.
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



    /// The work-conjugates of the tractions at the corners, corner by corner,
    /// of the least J with these pieces of the law, for S and g of the
    /// equilibrated stresses. They are <= 0 if the displacement is, as linear
    /// tractions <= 0 see it. Throws FixedStateError if they are not found.
    template <int dim>
    Eigen::VectorXd
    fixed_state_displacement(const std::vector<SideOf<dim>>            &sides,
                             const std::vector<Trace<dim>>             &traces,
                             const std::vector<PiecewiseEnergy::Piece> &pieces,
                             Eigen::MatrixXd                            M,
                             Eigen::VectorXd                            r)
    {
      const Eigen::Index n = static_cast<Eigen::Index>(sides.size());
      // The unknowns are the means w_k = d/|I| int lambda_k v_nu of each side
      // (w of doc/reference/certificate.md), in which the bonds' energy is 1/2
      // a |I| ((d+1) |w|^2 - (sum w)^2)/d; here it is added to S and their
      // slope to g.
      Eigen::VectorXd u_nu(dim * n);
      for (Eigen::Index i = 0; i < n; ++i)
        {
          // The integral of the square of the linear function with the means w
          // is |I| ((d + 1) |w|^2 - (sum w)^2) / d: d on the diagonal and -1
          // beside it.
          const double weight = sides[i].measure * pieces[i].curvature / dim;
          for (Eigen::Index k = 0; k < dim; ++k)
            {
              // The means w_k of the result's own trace, less the gap.
              u_nu(k * n + i) =
                traces[i].integral(
                  [k](const std::array<double, dim> &lambda,
                      const double value) { return dim * lambda[k] * value; }) /
                sides[i].measure;
              for (Eigen::Index l = 0; l < dim; ++l)
                M(k * n + i, l * n + i) += weight * (k == l ? dim : -1.);
              r(k * n + i) -= sides[i].measure * pieces[i].slope / dim;
            }
        }
      // Where the displacement is in contact, and what is wrong there is found.
      // The set of the result is close to that of the minimum with stresses.
      ActiveSet active(dim * n, 0);
      for (Eigen::Index i = 0; i < dim * n; ++i)
        active[i] = u_nu(i) >= -Tolerance::certificate *
                                 u_nu.template lpNorm<Eigen::Infinity>();
      // A stagnated iteration does as well: any equilibrated stress gives a
      // bound, and what is wrong in x only makes it a little lower.
      const BoundQPResult minimum =
        solve_bound_qp(M, r, Bounds(Eigen::VectorXd::Zero(dim * n)), active);
      if (minimum.status != SolverStatus::success &&
          minimum.status != SolverStatus::stagnated)
        throw FixedStateError("the tractions of the contact boundary were not "
                              "found (" +
                              to_string(minimum.status) + ")");
      return minimum.x;
    }



    /// Bounds the least J with the bonds' branches as they are. Throws
    /// FixedStateError if it has no bound.
    template <int dim>
    void
    bound_fixed_state(const EquilibriumProblem<dim>      &equilibrium,
                      const std::vector<PiecewiseEnergy> &laws,
                      const ElasticFields<dim>           &fields,
                      const DofVector                    &displacement,
                      Certificate                        &certificate)
    {
      const std::vector<SideOf<dim>> &sides = equilibrium.mesh.contact_sides;
      const Eigen::Index n = static_cast<Eigen::Index>(sides.size());
      // J(v) >= -1/2 int sigma : C^{-1} sigma + int h(sigma_nu) is (1) of
      // doc/reference/certificate.md. The branch of each side is that of the
      // result's mean on it.
      const auto                          condensed = equilibrium.condense();
      const Eigen::MatrixXd               S = condensed->schur_complement();
      const Eigen::VectorXd              &g = condensed->load();
      std::vector<Trace<dim>>             traces;
      std::vector<PiecewiseEnergy::Piece> pieces;
      for (Eigen::Index i = 0; i < n; ++i)
        {
          traces.emplace_back(sides[i], fields.unknowns(), displacement);
          pieces.push_back(laws[i][laws[i].index(traces[i].mean())]);
        }
      // The means w_k whose stresses give the bound. Any others would give one,
      // too, as h is integrated exactly for the tractions that they lead to.
      const Eigen::VectorXd x =
        fixed_state_displacement<dim>(sides, traces, pieces, S, g);

      // The moments of the normal tractions of the stresses that x leads to.
      // Times d/|I| they are the tractions at the corners, which determine the
      // linear sigma_nu.
      const Eigen::VectorXd moments    = S * x - g;
      const auto            at_corners = [&](const Eigen::VectorXd &conjugates,
                                  const Eigen::Index     i) {
        std::array<double, dim> result;
        for (Eigen::Index k = 0; k < dim; ++k)
          result[k] = dim * conjugates(k * n + i) / sides[i].measure;
        return result;
      };
      // Where no bond holds, h is finite only for tractions that do not pull.
      // What rounding pulls is measured by the largest traction.
      double largest_traction = 0.;
      for (Eigen::Index i = 0; i < n; ++i)
        for (const Eigen::VectorXd *of : {&moments, &g})
          for (const double traction : at_corners(*of, i))
            largest_traction = std::max(largest_traction, std::abs(traction));
      // The condensed energy c_0 + 1/2 x'S x - g'x has the work x'(S x - g) of
      // the tractions on x; without it c_0 - 1/2 x'S x is the complementary
      // energy with the work along what is prescribed. Side by side int
      // h(sigma_nu) is added to that.
      certificate.lower = condensed->energy_at_zero() - 0.5 * x.dot(S * x);
      const std::vector<Eigen::VectorXd> stresses =
        equilibrium.stresses(condensed->expand(x));
      certificate.reserve = equilibrium.rounding_of(*condensed, x);
      certificate.upper = equilibrium.elastic_functional(fields, displacement);
      // The parts of the gap, cell by cell and side by side, are not negative;
      // they say where a finer mesh would pay.
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
          const double of_bonds = traces[i].integral(
            [&](const auto &, const double s) { return pieces[i].value(s); });
          // Nothing may pull there: what rounding pulls costs this much at the
          // displacement, and is reserved four times.
          if (pieces[i].curvature == 0.)
            certificate.reserve +=
              4. *
              std::max(*std::max_element(tractions.begin(), tractions.end()) +
                         pieces[i].slope,
                       0.) *
              sides[i].measure * std::abs(traces[i].mean());
          certificate.lower += bonds;
          certificate.upper += of_bonds;
          // The part of the side, int j(s) + sigma_nu s - h(sigma_nu).
          certificate.gaps[sides[i].cell->active_cell_index()] +=
            of_bonds - bonds +
            traces[i].integral([&](const auto &lambda, const double s) {
              return s * std::inner_product(lambda.begin(),
                                            lambda.end(),
                                            tractions.begin(),
                                            0.);
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
    // Intervals of different meshes are for the same number only if that is the
    // least J of the continuous problem with its own loads.
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
                  scene->law().pieces().size() == 1 ?
                CertifiedMinimum::global :
                CertifiedMinimum::fixed_state)
    , equilibrium(equilibrium_problem(*scene))
  {
    // Laws and trace constants Lambda_I depend on the mesh alone, so that they
    // are found once for all results on it.
    for (const SideOf<dim> &side : equilibrium.mesh.contact_sides)
      laws.push_back(law_of_side<dim>(side.corners, side.id, *scene));
    if constexpr (dim == 2)
      if (minimum == CertifiedMinimum::global &&
          scene->law().pieces().size() > 1)
        trace_constants =
          side_constants(equilibrium, scene->materials(), scene->conditions());
  }



  namespace
  {
    /// Returns how much one's own computations may have lost at J of
    /// @p certificate.
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
    // The upper number is J of the displacement, which is admissible in the
    // continuous problem. The lower one is that of equilibrated stresses: for
    // the branches as they are first, which also gives the parts of the gap by
    // cells, and then, if branches may change and this is asked for, by branch
    // and bound over the means of the contact sides. Both are moved outwards by
    // what rounding and loads that are not linear may cost.
    const ElasticFields<dim> &fields = scene->problem().fields();
    const DofVector           displacement =
      scene->problem().unknowns().cartesian_displacement(u);
    Certificate certificate;
    certificate.minimum               = minimum;
    certificate.loads_are_exact       = equilibrium.mesh.loads_are_exact;
    const std::vector<char> &is_fixed = equilibrium.mesh.is_fixed;
    certificate.n_unknowns            = static_cast<unsigned int>(
      std::count(is_fixed.begin(), is_fixed.end(), 0));
    certificate.n_sides = static_cast<unsigned int>(laws.size());
    try
      {
        // The bound with fixed branches is cheap, one factorisation. Where j_1
        // is convex it is the whole answer; otherwise its stresses and gaps
        // still tell where to refine.
        bound_fixed_state(equilibrium, laws, fields, displacement, certificate);
        // Both numbers are moved outwards for the rounding of what is computed
        // here, and the lower one for that of the elimination as well.
        const double own = own_rounding(certificate, fields.strain_energy(u));
        certificate.upper += own;
        certificate.lower -= certificate.reserve + own;
        certificate.reserve += 2. * own;
      }
    catch (const EquilibriumError &)
      {
        // Bodies that only bonds hold, for instance, have no such bound, and
        // rounding may hide that of others. There may be one for all minima all
        // the same.
        if (trace_constants.empty())
          throw;
        certificate.gaps.clear();
      }
    if constexpr (dim == 2)
      if (!trace_constants.empty())
        certify_global(
          u, displacement, proof, interruption, earlier, certificate);
    // A proof that has been interrupted before its first bound leaves minus
    // infinity.
    if (!std::isfinite(certificate.lower))
      throw EquilibriumError("no bound was found (" +
                             to_string(certificate.proof_status) + ")");
    add_load_rests(u, displacement, certificate);
    if (earlier != nullptr)
      intersect(certificate, *earlier);
    // Both numbers are computed in different ways from the same data. If they
    // contradict each other, an assumption is violated, and it is better to
    // give none.
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
    // The upper number is J of the displacement itself, with j_1 integrated
    // exactly between its kinks and not by the quadrature of the scene.
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

    // The loss of the rounded law and of the softer triangles is least if
    // theta_I is chosen by what the result has on each side: the energy of its
    // triangle and the mean of its s.
    const std::vector<double> energies = strain_energies(fields, displacement);
    std::vector<double>       side_energies;
    Eigen::VectorXd           means(certificate.n_sides);
    for (unsigned int i = 0; i < certificate.n_sides; ++i)
      {
        const SideOf<2> &side = equilibrium.mesh.contact_sides[i];
        side_energies.push_back(energies[side.cell->active_cell_index()]);
        means(i) =
          std::min(Trace<2>(side, fields.unknowns(), displacement).mean(), 0.);
      }
    // Theorem 1 as a finite problem in the means and slopes, from which branch
    // and bound and the ranges of Theorem 2 raise the lower number stage by
    // stage.
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
      // Refinement serves the bound for branches as they are and the bound for
      // all of them, so that a cell has the parts of both.
      for (unsigned int i = 0; i < bound.losses.size(); ++i)
        certificate
          .gaps[equilibrium.mesh.contact_sides[i].cell->active_cell_index()] +=
          bound.losses[i];
    certificate.sides = std::move(bound.sides);
    certificate.lengths =
      certified_lengths(certificate.sides, laws, scene->law());
    if (proof.keeps_record)
      certificate.proof = certificate_proof(
        equilibrium, fields, displacement, laws, trace_constants, bound.stages);
  }



  template <int dim>
  void
  Certifier<dim>::add_load_rests(const DofVector &u,
                                 const DofVector &displacement,
                                 Certificate     &certificate) const
  {
    // The stresses may be in equilibrium with other loads than the given ones;
    // the difference is taken for as large as at u. These two estimates are no
    // proof, and vanish with a vertex where a load jumps.
    const ElasticFields<dim> &fields = scene->problem().fields();
    const std::vector<double> rests =
      equilibrium.load_rests(fields, displacement);
    for (unsigned int cell = 0; cell < rests.size(); ++cell)
      {
        certificate.lower -= rests[cell];
        if (!certificate.gaps.empty())
          certificate.gaps[cell] += rests[cell];
      }
    // The difference between both functionals at u is the work of what the
    // means leave out. The upper number is for the true loads; the lower one
    // gives way by as much in either case.
    const double rest = fields.elastic_functional(u) -
                        equilibrium.elastic_functional(fields, displacement);
    if (std::abs(rest) > own_rounding(certificate, fields.strain_energy(u)))
      {
        certificate.loads_are_exact = false;
        // A displacement is admissible whatever the loads are, so that the
        // upper number is right with the true ones.
        certificate.upper += rest;
        certificate.lower -= std::abs(rest);
      }
  }



  DEBOND_INSTANTIATE(check_certifiable);
  DEBOND_INSTANTIATE_CLASS(Certifier);
} // namespace Debond
