// SPDX-License-Identifier: LGPL-2.1-or-later
// Slender bodies, and J of the benchmark: results beside the same discrete
// problem solved in extended precision (64 bits) by code of its own: assembly,
// Eigen's sparse Cholesky and refinement with residuals from strains. Taken
// over are the mesh, f, the directions of the unknowns and the state of contact
// and bonds. Both results are rounded to double and verified by the program.
//
// Arguments are lengths over height: all scenes of such strips, with the law
// violation and the residual of the program's result and of the reference.

#include <deal.II/base/mpi.h>

#include <debond/check/verification.h>

#include <Eigen/LU>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <cmath>
#include <iostream>
#include <sstream>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  using Real    = long double;
  using VectorX = Eigen::Matrix<Real, Eigen::Dynamic, 1>;



  constexpr double epsilon = 2.2e-16;



  /// What became of the scenes.
  struct Tally
  {
    unsigned int scenes = 0, successes = 0, accurate = 0;
    double law = 0., residual = 0.; ///< largest multiples of the reference

    void
    add(const bool success, const double of_law, const double of_residual)
    {
      ++scenes;
      successes += success;
      accurate += success && of_law <= 100. && of_residual <= 100.;
      raise(law, of_law);
      raise(residual, of_residual);
    }
  };



  template <int dim>
  struct Element
  {
    Real         volume;
    unsigned int dofs[dim * (dim + 1)];
    Real         gradient[dim + 1][dim];
    Real         direction[dim * (dim + 1)][dim]; ///< of the unknowns
  };



  template <int dim>
  std::vector<Element<dim>>
  make_elements(const ElasticProblem<dim> &problem)
  {
    std::map<unsigned int, std::array<Real, dim>> direction;
    for (const auto &frame : problem.unknowns().frames())
      for (unsigned int k = 0; k < dim; ++k)
        for (unsigned int d = 0; d < dim; ++d)
          direction[frame.dofs[k]][d] = frame.to_cartesian[d][k];

    std::vector<Element<dim>> elements;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        Element<dim>                  element;
        Eigen::Matrix<Real, dim, dim> edges;
        for (unsigned int v = 0; v < dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            edges(v, d) = Real(cell->vertex(v + 1)[d]) - cell->vertex(0)[d];
        element.volume = edges.determinant() / (dim == 2 ? 2 : 6);
        const Eigen::Matrix<Real, dim, dim> inverse = edges.inverse();
        for (unsigned int d = 0; d < dim; ++d)
          {
            element.gradient[0][d] = 0;
            for (unsigned int v = 1; v <= dim; ++v)
              {
                element.gradient[v][d] = inverse(d, v - 1);
                element.gradient[0][d] -= inverse(d, v - 1);
              }
          }
        for (unsigned int v = 0; v <= dim; ++v)
          for (unsigned int k = 0; k < dim; ++k)
            {
              const unsigned int dof    = cell->vertex_dof_index(v, k);
              element.dofs[v * dim + k] = dof;
              const auto it             = direction.find(dof);
              for (unsigned int d = 0; d < dim; ++d)
                element.direction[v * dim + k][d] =
                  it == direction.end() ? Real(k == d) : it->second[d];
            }
        elements.push_back(element);
      }
    return elements;
  }



  struct Reference
  {
    DofVector minimiser; ///< rounded to double

    Real value;
    Real value_at_u; ///< J(u) of the result
  };



  /// The minimum with the contact nodes and broken bonds of u, for nodal
  /// quadrature.
  template <int dim>
  Reference
  extended_minimum(const Parameters &parameters,
                   const Scene<dim> &scene,
                   const DofVector  &u)
  {
    const ElasticProblem<dim>      &problem  = scene.problem();
    const std::vector<Element<dim>> elements = make_elements(problem);
    const Real E  = parameters.materials.everywhere.young_modulus;
    const Real nu = parameters.materials.everywhere.poisson_ratio;
    const Real mu = E / (2 * (1 + nu));
    const bool plane_stress =
      dim == 2 && parameters.materials.everywhere.hypothesis ==
                    Material::Hypothesis::plane_stress;
    const Real lambda = plane_stress ? E * nu / (1 - nu * nu) :
                                       E * nu / ((1 + nu) * (1 - 2 * nu));

    const unsigned int n = problem.unknowns().n_dofs();
    std::vector<char>  fixed(n, 0);
    std::vector<Real>  spring(n, 0);
    const AdhesiveLaw  law(parameters.law.branches);
    const Real         M             = law.bond_threshold();
    Real               broken_energy = 0;
    for (unsigned int i = 0; i < n; ++i)
      fixed[i] = problem.unknowns().is_constrained(i);
    const auto &contact = problem.unknowns().contact();
    for (unsigned int i = 0; i < contact.size(); ++i)
      if (const auto dof = contact.normals()[i]; u(dof) == 0.)
        fixed[dof] = 1;
      else
        {
          const Real measure = contact.boundary().nodes[i].measure;
          spring[dof]        = law.curvature(u(dof)) * measure;
          if (u(dof) < -law.bond_threshold())
            broken_energy += law.curvature(0.) * M * M / 2 * measure;
        }
    std::vector<int> place(n, -1);
    int              n_unknowns = 0;
    for (unsigned int i = 0; i < n; ++i)
      if (fixed[i] == 0)
        place[i] = n_unknowns++;

    std::vector<Eigen::Triplet<Real>> entries;
    for (const auto &e : elements)
      for (unsigned int i = 0; i < dim * (dim + 1); ++i)
        for (unsigned int j = 0; j < dim * (dim + 1); ++j)
          {
            if (place[e.dofs[i]] < 0 || place[e.dofs[j]] < 0)
              continue;
            const Real *g = e.gradient[i / dim], *h = e.gradient[j / dim],
                       *a = e.direction[i], *b = e.direction[j];
            Real ag = 0, bh = 0, ah = 0, bg = 0, ab = 0, gh = 0;
            for (unsigned int d = 0; d < dim; ++d)
              {
                ag += a[d] * g[d];
                bh += b[d] * h[d];
                ah += a[d] * h[d];
                bg += b[d] * g[d];
                ab += a[d] * b[d];
                gh += g[d] * h[d];
              }
            entries.emplace_back(place[e.dofs[i]],
                                 place[e.dofs[j]],
                                 e.volume * (lambda * ag * bh +
                                             mu * (ah * bg + ab * gh)));
          }
    for (unsigned int i = 0; i < n; ++i)
      if (place[i] >= 0)
        entries.emplace_back(place[i], place[i], spring[i]);
    Eigen::SparseMatrix<Real> A(n_unknowns, n_unknowns);
    A.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Real>> factor(A);

    // The symmetric gradient of displacements by unknown.
    const auto strain_of = [](const Element<dim> &e, const auto &value) {
      Real                          w[dim + 1][dim] = {};
      Eigen::Matrix<Real, dim, dim> gradient;
      for (unsigned int i = 0; i < dim * (dim + 1); ++i)
        for (unsigned int d = 0; d < dim; ++d)
          w[i / dim][d] += e.direction[i][d] * value(e.dofs[i]);
      gradient.setZero();
      for (unsigned int v = 1; v <= dim; ++v)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            gradient(c, d) += (w[v][c] - w[0][c]) * e.gradient[v][d];
      return ((gradient + gradient.transpose()) / 2).eval();
    };

    // Refinement: products from strains, of differences of displacements.
    VectorX         x = VectorX::Zero(n_unknowns);
    VectorX         f(n_unknowns);
    const DofVector load = problem.load();
    for (unsigned int i = 0; i < n; ++i)
      if (place[i] >= 0)
        f(place[i]) = load(i);
    const auto x_of = [&](const unsigned int i) {
      return place[i] < 0 ? Real(0) : x(place[i]);
    };
    for (unsigned int step = 0; step < 10; ++step)
      {
        VectorX r = f;
        for (unsigned int i = 0; i < n; ++i)
          if (place[i] >= 0)
            r(place[i]) -= spring[i] * x(place[i]);
        for (const auto &e : elements)
          {
            const auto strain = strain_of(e, x_of);
            for (unsigned int i = 0; i < dim * (dim + 1); ++i)
              if (place[e.dofs[i]] >= 0)
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int d = 0; d < dim; ++d)
                    r(place[e.dofs[i]]) -=
                      e.volume * e.direction[i][c] * e.gradient[i / dim][d] *
                      (2 * mu * strain(c, d) +
                       (c == d ? lambda * strain.trace() : 0));
          }
        x += factor.solve(r);
      }

    Reference result = {DofVector(n),
                        broken_energy - f.dot(x) / 2,
                        broken_energy};
    for (const auto &e : elements)
      {
        const auto strain =
          strain_of(e, [&](const unsigned int i) { return Real(u(i)); });
        result.value_at_u +=
          e.volume * (lambda / 2 * strain.trace() * strain.trace() +
                      mu * strain.squaredNorm());
      }
    for (unsigned int i = 0; i < n; ++i)
      {
        result.value_at_u += spring[i] / 2 * u(i) * u(i) - Real(load(i)) * u(i);
        result.minimiser(i) = static_cast<double>(x_of(i));
      }
    return result;
  }



  template <int dim>
  void
  test(const std::string &name, const Values &assignments, Tally &tally)
  {
    const Parameters  parameters = parameters_of(assignments);
    const Scene<dim>  scene      = scene_of<dim>(parameters);
    const SolveResult result     = solved(parameters, scene);

    const DofVector reference =
      extended_minimum(parameters, scene, result.u).minimiser;
    const auto verified = [&](const DofVector &u) {
      return verify(scene.problem(), scene.adhesion(), scene.law(), u);
    };
    const Verification<dim> ours = verified(result.u),
                            best = verified(reference);
    DofVector difference         = result.u;
    difference -= reference;
    const double error =
      difference.linfty_norm() / std::max(reference.linfty_norm(), 1e-300);
    const double of_law =
                   ours.law_violation / std::max(best.law_violation, epsilon),
                 of_residual = ours.equilibrium_residual /
                               std::max(best.equilibrium_residual, epsilon);
    tally.add(result.status == SolverStatus::success, of_law, of_residual);
    section(name);
    check("success", result.status == SolverStatus::success);
    check("law violation by that of the reference", of_law, 100.);
    check("residual", of_residual, 100.);
    check("displacement", error, 1e-9);
    if (print_figures)
      {
        std::cout << "  law " << ours.law_violation << " reference "
                  << best.law_violation << ", residual "
                  << ours.equilibrium_residual << " reference "
                  << best.equilibrium_residual << ", J " << result.functional
                  << ", broken " << ours.count(BondState::broken)
                  << ", contact " << ours.count(BondState::contact) << " of "
                  << ours.nodes.size() << '\n';
        if (!result.message.empty())
          std::cout << "  " << result.message << '\n';
      }
  }



  /// The work of the exact load on u: q in the left half of the top, -q/2 in
  /// the right one. The jump is at a vertex.
  Real
  exact_work(const ElasticProblem<2> &problem,
             const double             q,
             const DofVector         &u)
  {
    Real work = 0;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() &&
            face->boundary_id() == box_sides<2>().at("top"))
          for (unsigned int v = 0; v < 2; ++v)
            work += (face->center()[0] < 0.2 ? Real(q) : -Real(q) / 2) *
                    std::abs(Real(face->vertex(1)[0]) - face->vertex(0)[0]) /
                    2 * u(face->vertex_dof_index(v, 1));
    return work;
  }



  /// How many digits of J are true. Of the load f, which is taken over, the
  /// exact work is known; a change of f by df changes the minimum by -<df, u>.
  void
  test_functional(const std::string &name,
                  const double       q,
                  const Values      &assignments)
  {
    const Parameters parameters =
      parameters_of(Values{"Loads/Traction top=0; if(x < 0.2, q, -q/2)",
                           "Loads/Constants=q=" + text(q),
                           "Solver/Method=majorise minimise"} +
                    assignments);
    const Scene<2>    scene   = scene_of<2>(parameters);
    const SolveResult result  = solved(parameters, scene);
    const Reference   minimum = extended_minimum(parameters, scene, result.u);
    const auto        error   = [&](const Real value) {
      return static_cast<double>(std::abs(value / minimum.value - 1));
    };
    Real            work = exact_work(scene.problem(), q, result.u);
    const DofVector load = scene.problem().load();
    for (unsigned int i = 0; i < result.u.size(); ++i)
      work -= Real(load(i)) * result.u(i);
    section("J, ", name);
    check("success", result.status == SolverStatus::success);
    check("J", error(result.functional), 1e-12);
    check("J of u is the minimum", error(minimum.value_at_u), 1e-12);
    check("effect of the load's error", error(minimum.value + work), 1e-12);
    // What others give, for comparison.
    if (print_figures)
      std::cout << "condensed "
                << error(result.majorise_history.back().functional)
                << ", from A " << error(scene.functional().value(result.u))
                << '\n';
  }



  struct Strip
  {
    double      aspect;
    std::string cells;
    std::string clamped, law, tangential, method;

    /// Of a length and of a stress: mm and MPa if both are 1.
    double length_unit = 1., stress_unit = 1.;
  };



  /// A strip of height 1 mm that is lifted off at its end, or in the middle if
  /// both ends are clamped. The deflection of the end would be 0.04 mm without
  /// bonds, which break at 0.01 mm.
  template <int dim>
  void
  test(const Strip &strip, Tally &tally)
  {
    const auto text = [](const double value) {
      std::ostringstream out;
      out.precision(17);
      out << value;
      return out.str();
    };
    const double      aspect = strip.aspect;
    const double      height = strip.length_unit, length = aspect * height;
    const double      traction = 8e3 / std::pow(aspect, 3) * strip.stress_unit;
    const std::string side     = dim == 2 ? "" : "; 0";
    std::vector<std::string> assignments = {
      "Dimension=" + std::to_string(dim),
      "Mesh/Lengths=" + text(length) + ", " + text(height) +
        (dim == 2 ? "" : ", " + text(height)),
      "Mesh/Cells=" + strip.cells,
      "Material/Young modulus=" + text(2e5 * strip.stress_unit),
      "Boundary conditions/Clamped boundaries=" + strip.clamped,
      "Contact law/Tangential displacement=" + strip.tangential,
      "Contact law/Law=" + strip.law,
      strip.clamped == "left" ?
        "Loads/Traction right=0; " + text(traction) + side :
        "Loads/Traction top=0; if(x > " + text(0.375 * length) + " && x < " +
          text(0.625 * length) + ", " + text(64. * traction / aspect) + ", " +
          text(-traction / aspect) + ")" + side,
      "Contact law/Bond threshold=" + text(0.01 * height),
      "Contact law/Bond stiffness=" +
        text(8e5 / std::pow(aspect, 4) * strip.stress_unit / height)};
    if (strip.method == "multigrid")
      {
        assignments.push_back("Solver/Method=majorise minimise");
        assignments.push_back("Solver/Linear solver=multigrid");
        // By default it is 1e-10, which an iterative solver goes no further
        // than.
        assignments.push_back("Solver/Majorise minimise/Stop tolerance=1e-12");
      }
    else
      assignments.push_back("Solver/Method=" + strip.method);
    std::ostringstream name;
    name << dim << "D, " << aspect << ", cells " << strip.cells << ", clamped "
         << strip.clamped << ", " << strip.law << ", " << strip.tangential
         << ", " << strip.method
         << (strip.length_unit == 1.  ? "" :
             strip.stress_unit == 1e6 ? ", Pa, m" :
                                        ", GPa, m");
    test<dim>(name.str(), assignments, tally);
  }



  void
  test_all(const double aspect, Tally &tally)
  {
    for (const std::string clamped : {"left", "left, right"})
      for (const std::string tangential : {"free", "fixed"})
        for (const double stress_unit : {1., 1e6, 1e-3})
          for (const std::string law : {"none", "winkler"})
            for (const std::string method :
                 {"automatic", "energy bundle", "multigrid"})
              {
                // The other units where rounding is at its worst.
                if (stress_unit != 1. &&
                    (clamped != "left" || tangential != "free"))
                  continue;
                Strip strip = {aspect, "", clamped, law, tangential, method};
                if (stress_unit != 1.)
                  {
                    strip.length_unit = 1e-3;
                    strip.stress_unit = stress_unit;
                  }
                for (const std::string cells : {"100, 1", "300, 1", "100, 4"})
                  {
                    strip.cells = cells;
                    test<2>(strip, tally);
                  }
                for (const std::string cells : {"40, 1, 1", "60, 2, 2"})
                  {
                    strip.cells = cells;
                    test<3>(strip, tally);
                  }
              }
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_figures = argc > 1;
  for (const std::string cells : {"20, 2", "40, 4", "80, 8", "160, 16"})
    test_functional(cells, 0.69, {"Mesh/Cells=" + cells});
  for (const std::string nu : {"0.49", "0.499", "0.4999"})
    test_functional("nu = " + nu,
                    0.69,
                    {"Material/Hypothesis=plane strain",
                     "Material/Poisson ratio=" + nu});
  test_functional("slender",
                  0.69,
                  {"Mesh/Lengths=0.4, 0.01", "Mesh/Cells=80, 2"});
  test_functional("very slender",
                  0.69,
                  {"Mesh/Lengths=0.4, 0.002", "Mesh/Cells=200, 1"});
  test_functional("load 10", 6.9, {});
  test_functional("a = 690", 0.69, {"Contact law/Bond stiffness=690"});
  test_functional("no adhesion", 0.69, {"Contact law/Law=none"});
  test_functional("Pa",
                  0.69e9,
                  {"Material/Young modulus=69e9",
                   "Contact law/Bond stiffness=69e9"});

  Tally tally;
  for (int k = 1; k < argc; ++k)
    test_all(std::stod(argv[k]), tally);
  if (print_figures)
    {
      std::cout << tally.scenes << " scenes, " << tally.successes
                << " successes, " << tally.accurate
                << " within 100 times the reference; at most " << tally.law
                << " times its law violation, " << tally.residual
                << " times its residual\n";
      return 0;
    }

  test<2>({100., "100, 1", "left", "none", "free", "automatic"}, tally);
  test<2>({1e3, "150, 1", "left", "winkler", "free", "automatic"}, tally);
  test<2>({1e3, "100, 1", "left", "winkler", "free", "automatic", 1e-3, 1e6},
          tally);
  test<2>({1e4, "150, 1", "left", "winkler", "fixed", "automatic"}, tally);
  test<2>({1e4, "150, 1", "left", "winkler", "free", "energy bundle"}, tally);
  test<2>({1e4, "60, 3", "left, right", "winkler", "free", "automatic"}, tally);
  test<2>({1e3, "100, 2", "left", "winkler", "free", "multigrid"}, tally);
  // Where linear solvers in double precision do not get through.
  test<2>({1e4, "100, 4", "left", "none", "free", "multigrid"}, tally);
  test<2>({1e4, "60, 4", "left", "winkler", "free", "multigrid", 1e-3, 1e6},
          tally);
  test<3>({1e4, "40, 1, 1", "left", "winkler", "free", "automatic"}, tally);
  test<3>({1e4, "20, 2, 2", "left", "none", "fixed", "automatic"}, tally);
  // Both nodes of the contact boundary are clamped.
  for (const std::string linear_solver : {"direct", "multigrid"})
    test<2>("no free contact node, " + linear_solver,
            {"Mesh/Lengths=1000, 1",
             "Mesh/Cells=600, 3",
             "Parts/held=left: y < 0.3 || y > 0.7",
             "Parts/glued=left: y > 0.3 && y < 0.7",
             "Material/Young modulus=2e5",
             "Boundary conditions/Clamped boundaries=held",
             "Boundary conditions/Contact boundary=glued",
             "Contact law/Tangential displacement=free",
             "Loads/Traction right=0; 1e-5",
             "Solver/Method=majorise minimise",
             "Solver/Linear solver=" + linear_solver},
            tally);
}
