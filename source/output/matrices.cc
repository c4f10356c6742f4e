// SPDX-License-Identifier: LGPL-2.1-or-later

#include <debond/base/atomic_file.h>
#include <debond/base/instantiate.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/output/matrices.h>
#include <debond/output/proof_files.h>
#include <debond/solve/minimum/lumped_bonds.h>

#include <boost/serialization/utility.hpp>

namespace Debond
{
  namespace
  {
    using Writer = std::function<void(std::ostream &)>;



    /// Begins with what the numbers are, as in "array real general".
    void
    write(const std::string &kind,
          const Writer      &numbers,
          const std::string &path)
    {
      // Seventeen digits give back the same numbers. The first line says what
      // follows: an array of all numbers, column by column, or coordinates with
      // a value, and which symmetry lets a part of them out.
      write_atomically(path, [&](std::ostream &out) {
        out.precision(std::numeric_limits<double>::max_digits10);
        out << "%%MatrixMarket matrix " << kind << '\n';
        numbers(out);
      });
    }



    /// Columns of numbers.
    template <typename Column>
    void
    write_array(const std::vector<Column> &columns, const std::string &path)
    {
      write(
        "array real general",
        [&](std::ostream &out) {
          // The sizes come first, rows and columns. All columns have as many
          // numbers as the first one.
          out << (columns.empty() ? 0 : columns[0].size()) << ' '
              << columns.size() << '\n';
          for (const Column &column : columns)
            for (const auto number : column)
              out << number << '\n';
        },
        path);
    }



    using Order = std::vector<dealii::types::global_dof_index>;

    DofVector
    in_order(const DofVector &v, const Order &order)
    {
      // The numbers of degrees of freedom depend on the number of ranks. Files
      // have those of one rank, order[i] being that of degree of freedom i.
      DofVector result(v.size());
      for (unsigned int i = 0; i < v.size(); ++i)
        result(order[i]) = v(i);
      return result;
    }



    using Entries =
      std::vector<std::pair<std::pair<unsigned int, unsigned int>, double>>;

    /// Entries by rows and columns of a square matrix with @p n rows.
    void
    write_sparse(const std::string &symmetry,
                 const unsigned int n,
                 Entries            entries,
                 const std::string &path)
    {
      // Entries come from the ranks in any order. Sorted by row and column the
      // file is the same on any number of them. The format counts rows and
      // columns from 1.
      std::sort(entries.begin(), entries.end());
      write(
        "coordinate real " + symmetry,
        [&](std::ostream &out) {
          out << n << ' ' << n << ' ' << entries.size() << '\n';
          for (const auto &[place, value] : entries)
            out << place.first + 1 << ' ' << place.second + 1 << ' ' << value
                << '\n';
        },
        path);
    }



    /// The lower triangle of A.
    template <int dim>
    void
    write_operator(const ElasticProblem<dim> &problem, const std::string &path)
    {
      // Each rank has the rows of A that it owns, and every rank gets all
      // entries, since other programs want one file. The format has one
      // triangle of a symmetric matrix, here the lower one in the numbers of
      // one rank, which need not be a triangle in those of A.
      const auto &A     = problem.matrix();
      const Order order = problem.unknowns().serial_order();
      Entries     own, all;
      for (const auto row :
           problem.unknowns().dof_handler().locally_owned_dofs())
        for (auto entry = A.begin(row); entry != A.end(row); ++entry)
          if (order[entry->column()] <= order[row])
            own.push_back(
              {{order[row], order[entry->column()]}, entry->value()});
      for (const auto &of_rank :
           dealii::Utilities::MPI::all_gather(problem.unknowns().communicator(),
                                              own))
        all.insert(all.end(), of_rank.begin(), of_rank.end());
      write_sparse("symmetric", A.m(), all, path);
    }



    void
    write_dense(const MatrixView &S, const std::string &path)
    {
      // The lower triangle, column by column, is what the format has of a dense
      // symmetric matrix.
      write(
        "array real symmetric",
        [&](std::ostream &out) {
          out << S.rows() << ' ' << S.cols() << '\n';
          for (Eigen::Index j = 0; j < S.cols(); ++j)
            for (Eigen::Index i = j; i < S.rows(); ++i)
              out << S(i, j) << '\n';
        },
        path);
    }



    /// Returns whether J is a sum over nodes: a friction that depends on the
    /// pressure, and an energy that depends on the mode, have no J.
    template <int dim>
    bool
    has_functional(const AdhesionIntegral<dim> &adhesion)
    {
      return is_sum_over_nodes(adhesion) &&
             !adhesion.friction().depends_on_pressure() &&
             !adhesion.points().depends_on_mode();
    }



    /// The problem on the contact nodes alone.
    template <int dim>
    DiscreteProblem
    discrete_problem(const Scene<dim> &scene)
    {
      const AdhesionIntegral<dim> &adhesion = scene.adhesion();
      const Condensation           condensed =
        condense_to_contact(scene.problem(), adhesion);
      NeighbourGraph graph(adhesion.n_nodes());
      return {condensed.schur_complement(),
              condensed.load(),
              condensed.energy_at_zero(),
              adhesion.contact_boundary().upper_bounds(),
              lumped_bonds(adhesion, graph)};
    }



    /// F in u = F x, x being Cartesian components at nodes.
    template <int dim>
    void
    write_frames(const ElasticUnknowns<dim> &unknowns, const std::string &path)
    {
      // F is the product of the matrices of the steps in their order, each of
      // which is the identity but for the rows of some nodes. There the
      // unknowns are to_unknowns times the value at the node less the multiples
      // of those at others, as ChangeOfBasis::to_unknowns() has it. Entries
      // that cancel to 0 in the product are left out.
      using Matrix                    = Eigen::SparseMatrix<double>;
      const ChangeOfBasis<dim> &basis = unknowns.basis();
      const unsigned int        n     = unknowns.n_dofs();
      Matrix                    F(n, n);
      F.setIdentity();
      for (const BasisStep step :
           {BasisStep::coefficients, BasisStep::jumps, BasisStep::frames})
        {
          std::vector<Eigen::Triplet<double>> entries;
          for (unsigned int i = 0; i < n; ++i)
            if (basis.find(step, i / dim) == nullptr)
              entries.emplace_back(i, i, 1.);
          for (const BasisRow<dim> &row : basis.rows(step))
            {
              const dealii::Tensor<2, dim> from_others =
                row.to_unknowns * row.of_others;
              for (unsigned int i = 0; i < dim; ++i)
                for (unsigned int j = 0; j < dim; ++j)
                  {
                    const unsigned int at = dim * row.node + i;
                    entries.emplace_back(at,
                                         dim * row.node + j,
                                         row.to_unknowns[i][j]);
                    for (const auto &[other, weight] : row.others)
                      entries.emplace_back(at,
                                           dim * other + j,
                                           -weight * from_others[i][j]);
                  }
            }
          Matrix of_step(n, n);
          of_step.setFromTriplets(entries.begin(), entries.end());
          F = Matrix(of_step * F);
        }
      const Order order = unknowns.serial_order();
      Entries     entries;
      for (int j = 0; j < F.outerSize(); ++j)
        for (Matrix::InnerIterator entry(F, j); entry; ++entry)
          if (entry.value() != 0.)
            entries.push_back({{order[entry.row()], order[j]}, entry.value()});
      write_sparse("general", n, entries, path);
    }
  } // namespace



  template <int dim>
  std::vector<OutputFile>
  matrix_files(const bool        wanted,
               const Scene<dim> &scene,
               const Solution   &result)
  {
    // A proof that does not hold for J as it is has been withdrawn.
    const WhichMinimum &minimum   = result.minimum;
    const auto          has_proof = [&minimum]() {
      return minimum.recorded != nullptr && minimum.kind == MinimumKind::global;
    };
    const auto has_either = [wanted, has_proof]() {
      return wanted || has_proof();
    };
    // S, g and c_0 together, once one of them is to be written: those of a
    // proof, which is about just these numbers.
    const auto on_contact = std::make_shared<std::optional<DiscreteProblem>>();
    const auto condensed =
      [&scene, &minimum, on_contact]() -> const DiscreteProblem & {
      if (minimum.recorded != nullptr)
        return minimum.recorded->problem;
      if (!*on_contact)
        on_contact->emplace(discrete_problem(scene));
      return **on_contact;
    };
    // The numbers of contact nodes are in the order of contact_profile.csv and
    // need no renumbering, since all ranks know the whole contact boundary.
    const auto of_nodes = [&scene](const std::string &path,
                                   const auto        &number_of) {
      std::vector<double> numbers;
      for (const auto &node : scene.contact_boundary().nodes)
        numbers.push_back(number_of(node));
      write_array<std::vector<double>>({numbers}, path);
    };
    std::vector<OutputFile> files;
    // No file of these is written unless the scene asks for them, but all are
    // listed, so that those of an earlier run are removed. Each function
    // computes what it writes when it is called, so that other scenes have no
    // factorisation for S.
    const auto add = [&](const std::string &name, const auto &write) {
      files.push_back({name, [wanted]() { return wanted; }, write});
    };
    add("A.mtx", [&scene](const std::string &path) {
      write_operator(scene.problem(), path);
    });
    add("f.mtx", [&scene](const std::string &path) {
      const auto &problem = scene.problem();
      write_array<DofVector>(
        {in_order(problem.load(), problem.unknowns().serial_order())}, path);
    });
    add("frames.mtx", [&scene](const std::string &path) {
      write_frames(scene.problem().unknowns(), path);
    });
    add("modes.mtx", [&scene](const std::string &path) {
      const auto            &unknowns = scene.problem().unknowns();
      std::vector<DofVector> modes    = unknowns.rigid_body_modes();
      for (DofVector &mode : modes)
        mode = in_order(mode, unknowns.serial_order());
      write_array(modes, path);
    });
    files.push_back({"S.mtx", has_either, [condensed](const std::string &path) {
                       write_dense(condensed().S, path);
                     }});
    add("g.mtx", [condensed](const std::string &path) {
      const Eigen::VectorXd &g = condensed().g;
      write_array<std::vector<double>>({{g.begin(), g.end()}}, path);
    });
    add("c_0.mtx", [condensed](const std::string &path) {
      write_array<std::vector<double>>({{condensed().c_0}}, path);
    });
    // These have the checksums of S.mtx and of each other.
    files.push_back({"problem.json",
                     [has_either, condensed, &scene]() {
                       return has_either() &&
                              has_functional(scene.adhesion()) &&
                              has_format(condensed());
                     },
                     [condensed](const std::string &path) {
                       write_problem(condensed(), path);
                     }});
    files.push_back(
      {"proof.json", has_proof, [&result, &minimum](const std::string &path) {
         write_proof(*minimum.recorded,
                     {{minimum.lower_bound,
                       std::max(result.functional, minimum.functional) +
                         minimum.rounding}},
                     path);
       }});
    // Rows of A, counted from 1 as in the files. They say which unknowns the
    // rows of S are.
    add("contact.mtx", [&scene](const std::string &path) {
      std::vector<double> rows;
      const Order         order = scene.problem().unknowns().serial_order();
      for (const auto i : scene.problem().unknowns().contact().dofs())
        rows.push_back(static_cast<double>(order[i]) + 1.);
      write_array<std::vector<double>>({rows}, path);
    });
    // The share of the boundary that belongs to a node, by which nodal
    // quadrature weights the law there, and below its initial gap, by which
    // u_nu exceeds the unknown s.
    add("weights.mtx", [of_nodes](const std::string &path) {
      of_nodes(path, [](const auto &node) { return node.measure; });
    });
    add("bounds.mtx", [of_nodes](const std::string &path) {
      of_nodes(path, [](const auto &node) { return node.gap; });
    });
    return files;
  }



  DEBOND_INSTANTIATE(matrix_files);
} // namespace Debond
