// SPDX-License-Identifier: LGPL-2.1-or-later
// A contact problem that ranks share has, to the last bit, the matrices, cycles
// and the solution that it has on one rank, whatever their number. The same
// output is expected of 1, 2, 3 and 4 ranks.

#include <deal.II/base/mpi.h>

#include <debond/contact/adhesion_integral.h>
#include <debond/contact/laws/winkler.h>
#include <debond/elasticity/elastic_levels.h>
#include <debond/elasticity/level_problem.h>
#include <debond/mesh/box_piece.h>
#include <debond/mesh/make_body.h>
#include <debond/mesh/mesh_piece.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <array>
#include <cstring>
#include <iostream>
#include <map>

#include "../check.h"

using namespace Debond;

namespace
{
  using Vector = DofVector;

  const MPI_Comm communicator = MPI_COMM_WORLD;



  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  }



  template <typename A, typename B>
  bool
  are_same_bits(const A &a, const B &b)
  {
    return a.size() == b.size() &&
           (a.size() == 0 ||
            std::memcmp(&*a.begin(), &*b.begin(), a.size() * sizeof(double)) ==
              0);
  }



  /// Which are clamped, have bonds, are pulled upwards and pressed down.
  struct Sides
  {
    std::string clamped, contact, pulled, pressed;
  };



  /// Bonds tear under a force that lifts one part and presses another one.
  template <int dim>
  struct BodyProblem
  {
    BodyProblem(const Body<dim>            &body,
                const Sides                &sides,
                const BodyPiece<dim> *const piece)
    {
      const BoundaryNames names = body.make_mesh(mesh).boundaries;
      BoundaryConditions  conditions;
      conditions.clamped = names.at(sides.clamped);
      conditions.contact = names.at(sides.contact);
      problem =
        std::make_unique<ElasticProblem<dim>>(mesh,
                                              conditions,
                                              Supports<dim>(),
                                              1,
                                              piece == nullptr ?
                                                std::vector<unsigned int>() :
                                                node_order(*piece, mesh));
      Loads<dim>             loads;
      dealii::Tensor<1, dim> up, down;
      up[1]                                            = 0.02;
      down[1]                                          = -0.003;
      loads.tractions[*names.at(sides.pulled).begin()] = {
        {std::make_shared<dealii::Functions::ConstantFunction<dim>>(
          up.begin_raw(), dim)}};
      loads.tractions[*names.at(sides.pressed).begin()] = {
        {std::make_shared<dealii::Functions::ConstantFunction<dim>>(
          down.begin_raw(), dim)}};
      Material material;
      material.young_modulus = 69.;
      material.poisson_ratio = 0.33;
      problem->assemble(material, loads);
    }

    dealii::Triangulation<dim>           mesh;
    std::unique_ptr<ElasticProblem<dim>> problem;
  };



  /// From the solution on the level @p l; what ranks share of that and of
  /// finer levels they solve together.
  template <int dim>
  MajoriseMinimiseResult
  minimise(ElasticLevels<dim>          &levels,
           const AdhesionIntegral<dim> &adhesion,
           unsigned int                 l,
           Vector                      &u)
  {
    MajoriseMinimiseResult result;
    const unsigned int     n_shared = levels.n_shared_levels();
    if (l < n_shared || levels.is_root())
      u.reinit(levels.n_unknowns(l));
    while (true)
      {
        if (l < n_shared || levels.is_root())
          {
            const RestrictedFunction phi(adhesion,
                                         levels.trace_prolongation(l));
            LevelCorrection<dim>     cycle(levels, l);
            LevelProblem<dim>        problem(cycle, phi, u);
            result = MajoriseMinimise({}).minimize(
              problem, [](const MajoriseMinimiseIteration &) { return true; });
          }
        if (l == 0)
          return result;
        --l;
        if (l >= n_shared && !levels.is_root())
          continue;
        u = levels.prolongate(l + 1, u);
        for (const unsigned int normal : levels.normals(l))
          if (normal != dealii::numbers::invalid_unsigned_int)
            u(normal) = std::min(u(normal), 0.);
      }
  }



  /// Whether a coarser level of a rank has the load, the rows and the normal
  /// displacements that the whole has there.
  template <int dim>
  bool
  is_part_of(const ElasticLevels<dim>       &whole,
             ElasticLevels<dim>             &part,
             const BlockMatrix<dim, double> &A,
             const BlockMatrix<dim, double> &B,
             const unsigned int              l)
  {
    std::map<std::array<double, dim>, unsigned int> node_at;
    const auto key = [](const dealii::Point<dim> &point) {
      std::array<double, dim> result;
      std::copy_n(point.begin_raw(), dim, result.begin());
      return result;
    };
    for (unsigned int i = 0; i < whole.vertices(l).size(); ++i)
      node_at[key(whole.vertices(l)[i])] = i;
    std::vector<unsigned int> node;
    for (const dealii::Point<dim> &point : part.vertices(l))
      node.push_back(node_at.at(key(point)));

    bool same =
      (part.trace_prolongation(l) - whole.trace_prolongation(l)).norm() == 0.;
    unsigned int n_complete = 0;
    for (unsigned int i = 0; i < node.size(); ++i)
      {
        for (unsigned int c = 0; c < dim; ++c)
          same = same &&
                 part.load(l)(i * dim + c) == whole.load(l)(node[i] * dim + c);
        for (std::size_t k = B.starts[i]; k < B.starts[i + 1]; ++k)
          {
            const std::size_t m = A.find(node[i], node[B.columns[k]]);
            same                = same && m < A.columns.size() &&
                   std::equal(A.values.begin() + m * dim * dim,
                              A.values.begin() + (m + 1) * dim * dim,
                              B.values.begin() + k * dim * dim);
          }
        n_complete += B.starts[i + 1] - B.starts[i] ==
                      A.starts[node[i] + 1] - A.starts[node[i]];
      }
    for (unsigned int j = 0; j < whole.normals(l).size(); ++j)
      same = same &&
             (part.normals(l)[j] == dealii::numbers::invalid_unsigned_int ||
              node[part.normals(l)[j] / dim] * dim + part.normals(l)[j] % dim ==
                whole.normals(l)[j]);
    // Of the own rows nothing is missing.
    return same && (l < part.n_shared_levels() ?
                      dealii::Utilities::MPI::sum(n_complete, communicator) :
                      n_complete) >= A.n_rows();
  }



  template <int dim>
  void
  test(const Body<dim>      &body,
       const BodyPiece<dim> &piece,
       const Sides          &sides,
       const double          stiffness,
       const double          threshold,
       const unsigned int    end_shared)
  {
    const BodyProblem<dim> whole(body, sides, nullptr);
    const AdhesiveLaw      law(winkler_law(stiffness, threshold).branches);
    const ContactQuadrature<dim> quadrature(
      {ContactQuadratureParameters::Rule::nodal});
    const ContactBoundary<dim> &boundary =
      whole.problem->unknowns().contact().boundary();
    const AdhesionIntegral<dim> adhesion(boundary, law, quadrature);
    const auto levels = ElasticLevels<dim>::make(body, *whole.problem);

    const BodyProblem<dim>      part(piece, sides, &piece);
    const ProblemPiece<dim>     shared(piece,
                                   part.problem->unknowns(),
                                   communicator);
    const AdhesionIntegral<dim> shared_adhesion(shared.boundary(),
                                                law,
                                                quadrature);
    const auto                  shared_levels =
      ElasticLevels<dim>::make(shared, *part.problem, end_shared);

    bool same = shared.boundary().nodes.size() == boundary.nodes.size() &&
                shared.boundary().faces.size() == boundary.faces.size();
    for (unsigned int i = 0; same && i < boundary.nodes.size(); ++i)
      same =
        shared.boundary().nodes[i].position == boundary.nodes[i].position &&
        shared.boundary().nodes[i].normal == boundary.nodes[i].normal &&
        shared.boundary().nodes[i].measure == boundary.nodes[i].measure;
    for (unsigned int f = 0; same && f < boundary.faces.size(); ++f)
      same =
        shared.boundary().faces[f].nodes == boundary.faces[f].nodes &&
        shared.boundary().faces[f].id == boundary.faces[f].id &&
        shared.boundary().faces[f].vertices == boundary.faces[f].vertices &&
        shared.boundary().faces[f].measure == boundary.faces[f].measure;
    check("  contact boundary", same);

    const Vector f = shared.gather(shared_levels->load(0));
    if (is_root())
      check("  load", are_same_bits(f, levels->load(0)));
    bool are_parts = true;
    for (unsigned int l = 1; l < shared_levels->n_levels(); ++l)
      are_parts = is_part_of(*levels,
                             *shared_levels,
                             levels->cycle().matrix(l),
                             shared_levels->cycle().matrix(l),
                             l) &&
                  are_parts;
    check("  coarser levels",
          dealii::Utilities::MPI::min(static_cast<int>(are_parts),
                                      communicator) == 1);
    bool are_rows = true;
    for (unsigned int l = 0; l < shared_levels->n_shared_levels(); ++l)
      are_rows =
        are_rows &&
        (shared_levels->contact_rows(l) - levels->contact_rows(l)).norm() == 0.;
    check("  rows of contact nodes", are_rows);

    // Cycles, with half of the nodes held and bonds at all.
    Vector x = levels->load(0), part_x = shared_levels->load(0), y(x),
           z(part_x);
    for (const bool is_truncated : {false, true})
      {
        const auto truncate = [&](ElasticLevels<dim> &of) {
          std::vector<unsigned int> held;
          for (unsigned int i = 0; i < of.normals(0).size() / 2; ++i)
            held.push_back(of.normals(0)[i]);
          of.cycle().truncate(0,
                              held,
                              of.normals(0),
                              adhesion.curvature(
                                Eigen::VectorXd::Zero(of.normals(0).size())));
        };
        if (is_truncated)
          {
            truncate(*levels);
            truncate(*shared_levels);
          }
        for (unsigned int k = 0; k < 2; ++k)
          {
            levels->vmult(0, y, x);
            levels->cycle().vmult(x, y);
            shared_levels->vmult(0, z, part_x);
            shared_levels->cycle().vmult(part_x, z);
          }
        const Vector all = shared.gather(part_x);
        if (is_root())
          check(is_truncated ? "  truncated cycles" : "  cycles",
                are_same_bits(all, x));
        const double product = shared_levels->product(0, part_x, part_x);
        if (is_root())
          check("  products", product == levels->product(0, x, x));
      }

    Vector             u, part_u;
    const unsigned int last   = std::min(levels->n_levels() - 1, 2u);
    const auto         result = minimise(*levels, adhesion, last, u);
    const auto         shared_result =
      minimise(*shared_levels, shared_adhesion, last, part_u);
    const Vector all = shared.gather(part_u);
    const double J = shared.elastic_functional(part.problem->fields(), part_u);
    if (is_root())
      {
        unsigned int n_contact = 0;
        for (const double s : whole.problem->unknowns().contact().trace(u))
          n_contact += s == 0.;
        check("  contact, and bonds that open",
              n_contact < levels->normals(0).size());
        check("  status",
              result.status == SolverStatus::success &&
                shared_result.status == SolverStatus::success);
        check("  J, residual and iterations",
              shared_result.functional == result.functional &&
                shared_result.residual == result.residual &&
                shared_result.history.size() == result.history.size());
        check("  displacement", are_same_bits(all, u));
        check("  energy from the strains",
              J == whole.problem->fields().elastic_functional(u));
      }
  }



  template <int dim>
  void
  test(const std::array<unsigned int, 3> &cells,
       const unsigned int                 end_shared,
       const std::array<double, 3>       &lengths = BoxParameters().lengths)
  {
    BoxParameters parameters;
    parameters.cells        = cells;
    parameters.lengths      = lengths;
    const auto          box = std::make_shared<const Box<dim>>(parameters);
    const BoxPiece<dim> piece(
      box,
      dealii::Utilities::MPI::this_mpi_process(communicator),
      dealii::Utilities::MPI::n_mpi_processes(communicator));
    test<dim>(
      *box, piece, {"left", "bottom", "right", "top"}, 69., 2e-3, end_shared);
  }



  /// A mesh that is halved, with a curved contact boundary.
  template <int dim>
  void
  test(const std::string &generator,
       const std::string &arguments,
       const unsigned int n_refinements,
       const Sides       &sides,
       const double       stiffness,
       const double       threshold,
       const unsigned int end_shared)
  {
    BodyParameters parameters;
    parameters.source        = BodyParameters::Source::generator;
    parameters.generator     = generator;
    parameters.arguments     = arguments;
    parameters.n_refinements = n_refinements;
    const auto body          = std::dynamic_pointer_cast<const MeshBody<dim>>(
      make_body(dim, parameters));
    const MeshPiece<dim> piece(body, communicator);
    test<dim>(*body, piece, sides, stiffness, threshold, end_shared);
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (!is_root())
    std::cout.setstate(std::ios::failbit);
  for (const unsigned int end_shared : {1, 100})
    {
      std::cout << (end_shared == 1 ? "The finest level is shared" :
                                      "Coarser ones as well")
                << std::endl;
      section("2D");
      test<2>({{160, 16, 1}}, end_shared);
      section("2D, odd numbers");
      test<2>({{149, 15, 1}}, end_shared);
      section("3D");
      test<3>({{40, 4, 4}}, end_shared);
      section("Few layers of cells");
      test<2>({{4, 512, 1}}, end_shared, {{0.01, 1.28, 1.}});
      section("3D, odd numbers");
      test<3>({{37, 5, 3}}, end_shared);
      section("A quarter of a ring");
      test<2>("quarter_hyper_shell",
              "0, 0 : 0.1 : 0.2 : 3 : true",
              5,
              {"2", "1", "3", "0"},
              69.,
              2e-3,
              end_shared);
      section("A plate with a hole");
      test<2>(
        "plate_with_a_hole",
        "0.05 : 0.1 : 0.02 : 0.02 : 0.02 : 0.02 : 0, 0 : 0 : 1 : 1 : 2 : true",
        4,
        {"0", "4", "1", "3"},
        69.,
        2e-3,
        end_shared);
      if (end_shared == 1)
        continue;
      section("A plate with a hole, 3D");
      test<3>(
        "plate_with_a_hole",
        "0.05 : 0.1 : 0.02 : 0.02 : 0.02 : 0.02 : 0, 0, 0 : 0 : 1 : 0.1 : 4 : true",
        2,
        {"0", "4", "1", "3"},
        69.,
        2e-3,
        end_shared);
    }
}
