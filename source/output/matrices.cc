// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/output/matrices.h>

#include <functional>
#include <limits>
#include <memory>
#include <tuple>

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
          out << (columns.empty() ? 0 : columns[0].size()) << ' '
              << columns.size() << '\n';
          for (const Column &column : columns)
            for (const auto number : column)
              out << number << '\n';
        },
        path);
    }



    /// The lower triangle.
    void
    write_sparse(const dealii::SparseMatrix<double> &A, const std::string &path)
    {
      write(
        "coordinate real symmetric",
        [&](std::ostream &out) {
          std::size_t n_entries = 0;
          for (const auto &entry : A)
            n_entries += entry.column() <= entry.row() ? 1 : 0;
          out << A.m() << ' ' << A.n() << ' ' << n_entries << '\n';
          for (const auto &entry : A)
            if (entry.column() <= entry.row())
              out << entry.row() + 1 << ' ' << entry.column() + 1 << ' '
                  << entry.value() << '\n';
        },
        path);
    }



    void
    write_dense(const MatrixView &S, const std::string &path)
    {
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



    /// F in u = F x, x being Cartesian components.
    template <int dim>
    void
    write_frames(const ElasticUnknowns<dim> &unknowns, const std::string &path)
    {
      std::vector<bool> is_cartesian(unknowns.n_dofs(), true);
      std::vector<std::tuple<std::size_t, std::size_t, double>> entries;
      for (const auto &frame : unknowns.frames())
        for (unsigned int i = 0; i < dim; ++i)
          {
            is_cartesian[frame.dofs[i]] = false;
            for (unsigned int j = 0; j < dim; ++j)
              if (frame.to_frame[i][j] != 0.)
                entries.emplace_back(frame.dofs[i],
                                     frame.dofs[j],
                                     frame.to_frame[i][j]);
          }
      for (unsigned int i = 0; i < is_cartesian.size(); ++i)
        if (is_cartesian[i])
          entries.emplace_back(i, i, 1.);
      write(
        "coordinate real general",
        [&](std::ostream &out) {
          out << unknowns.n_dofs() << ' ' << unknowns.n_dofs() << ' '
              << entries.size() << '\n';
          for (const auto &[i, j, number] : entries)
            out << i + 1 << ' ' << j + 1 << ' ' << number << '\n';
        },
        path);
    }
  } // namespace



  template <int dim>
  std::vector<OutputFile>
  matrix_files(const Scene<dim> &scene, const bool wanted)
  {
    // S and g together, once one of them is to be written.
    const auto on_contact = std::make_shared<std::unique_ptr<Condensation>>();
    const auto condensed  = [&scene, on_contact]() -> const Condensation  &{
      if (*on_contact == nullptr)
        on_contact->reset(new Condensation(
          condense_to_contact(scene.problem(), scene.adhesion())));
      return **on_contact;
    };
    const auto of_nodes = [&scene](const std::string &path,
                                   const auto        &number_of) {
      std::vector<double> numbers;
      for (const auto &node : scene.contact_boundary().nodes)
        numbers.push_back(number_of(node));
      write_array<std::vector<double>>({numbers}, path);
    };
    std::vector<OutputFile> files;
    const auto add = [&](const std::string &name, const auto &write) {
      files.push_back(
        {name,
         [&scene, wanted]() { return wanted && scene.piece() == nullptr; },
         write});
    };
    add("A.mtx", [&scene](const std::string &path) {
      write_sparse(scene.problem().matrix(), path);
    });
    add("f.mtx", [&scene](const std::string &path) {
      write_array<DofVector>({scene.problem().load()}, path);
    });
    add("frames.mtx", [&scene](const std::string &path) {
      write_frames(scene.problem().unknowns(), path);
    });
    add("modes.mtx", [&scene](const std::string &path) {
      write_array(scene.problem().unknowns().rigid_body_modes(), path);
    });
    add("S.mtx", [condensed](const std::string &path) {
      write_dense(condensed().schur_complement(), path);
    });
    add("g.mtx", [condensed](const std::string &path) {
      const Eigen::VectorXd &g = condensed().load();
      write_array<std::vector<double>>({{g.begin(), g.end()}}, path);
    });
    add("contact.mtx", [&scene](const std::string &path) {
      std::vector<double> rows;
      for (const auto i : scene.problem().unknowns().contact().normals())
        rows.push_back(static_cast<double>(i) + 1.);
      write_array<std::vector<double>>({rows}, path);
    });
    add("weights.mtx", [of_nodes](const std::string &path) {
      of_nodes(path, [](const auto &node) { return node.measure; });
    });
    add("bounds.mtx", [of_nodes](const std::string &path) {
      of_nodes(path, [](const auto &node) { return node.gap; });
    });
    return files;
  }



  template decltype(matrix_files<2>) matrix_files<2>;
  template decltype(matrix_files<3>) matrix_files<3>;
} // namespace Debond
