// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <debond/linear_algebra/aggregation.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>
#include <ml_epetra_utils.h>
#include <ml_utils.h>

namespace Debond
{
  const bool has_aggregation = true;



  namespace
  {
    void
    check(const int error)
    {
      AssertThrow(error == 0, dealii::ExcTrilinosError(error));
    }



    /// The matrix with blocks of @p height x @p width entries.
    Prolongation
    in_blocks(const Epetra_CrsMatrix &P,
              const unsigned int      height,
              const unsigned int      width)
    {
      // Rows and columns of Epetra's matrix are those of single unknowns; both
      // follow each other by nodes, so that quotients by the height and the
      // width of the blocks are nodes. Columns are local numbers there and
      // become those of the whole. The rows of a node may have different
      // columns, and the blocks in these are zero if a row has none; a node has
      // few, so that a linear search finds them.
      Prolongation result;
      result.n_own_columns = P.DomainMap().NumMyElements() / width;
      result.rows.height   = height;
      result.rows.width    = width;
      auto &columns        = result.rows.columns;
      auto &values         = result.rows.values;
      for (int first = 0; first < P.NumMyRows(); first += height)
        {
          const std::size_t begin = columns.size();
          for (unsigned int c = 0; c < height; ++c)
            {
              int     n, *indices;
              double *entries;
              check(P.ExtractMyRowView(first + c, n, entries, indices));
              for (int k = 0; k < n; ++k)
                {
                  const unsigned int column = P.GCID(indices[k]);
                  const std::size_t  block  = std::find(columns.begin() + begin,
                                                      columns.end(),
                                                      column / width) -
                                            columns.begin();
                  if (block == columns.size())
                    {
                      columns.push_back(column / width);
                      values.resize(values.size() + height * width, 0.f);
                    }
                  result.rows.block(block)[c * width + column % width] =
                    static_cast<float>(entries[k]);
                }
            }
          result.rows.end_row();
        }
      return result;
    }
  } // namespace



  std::vector<Prolongation>
  aggregated_prolongations(
    const MatrixOnRanks                  &A,
    const unsigned int                    n_components,
    const std::vector<DistributedVector> &near_null_space)
  {
    // ML reads the modes one after the other from a plain array.
    std::vector<double> modes;
    for (const DistributedVector &mode : near_null_space)
      modes.insert(modes.end(), mode.begin(), mode.end());
    const auto n_modes = static_cast<unsigned int>(near_null_space.size());
    // ML makes its whole hierarchy, of which the prolongations alone are used:
    // without smoothers and without a factor of its coarsest level. "PDE
    // equations" keeps the unknowns of a node in one aggregate. "Uncoupled"
    // aggregates do not extend over ranks, so that coarse nodes belong to the
    // rank of their fine ones.
    Teuchos::ParameterList parameters;
    check(ML_Epetra::SetDefaults("SA", parameters));
    parameters.set("ML output", 0);
    parameters.set("PDE equations", static_cast<int>(n_components));
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", static_cast<int>(n_modes));
    parameters.set("null space: vectors", modes.data());
    parameters.set("aggregation: type", "Uncoupled");
    parameters.set("smoother: type", "do-nothing");
    parameters.set("coarse: type", "do-nothing");
    parameters.set("coarse: max size",
                   static_cast<int>(largest_without_aggregates));
    // Else the levels would depend on what ML has made before.
    ML_set_random_seed(1);
    dealii::TrilinosWrappers::SparseMatrix matrix;
    matrix.reinit(A.own_rows, A.own_rows, A.A, A.ranks, /*drop_tolerance=*/0.);
    const ML_Epetra::MultiLevelPreconditioner ml(matrix.trilinos_matrix(),
                                                 parameters);
    // The conversion does not change what it reads.
    ML *const                 hierarchy = const_cast<ML *>(ml.GetML());
    std::vector<Prolongation> result;
    for (int l = 1; l < hierarchy->ML_num_actual_levels; ++l)
      {
        // Pmat[l] leads from level l to l - 1, 0 being the finest. Only there a
        // node has its displacements for unknowns; an aggregate has one for
        // each mode. The copy that ML makes here is the caller's to delete.
        Epetra_CrsMatrix *P = nullptr;
        check(ML_Operator2EpetraCrsMatrix(&hierarchy->Pmat[l], P));
        const std::unique_ptr<Epetra_CrsMatrix> owner(P);
        result.push_back(
          in_blocks(*P, l == 1 ? n_components : n_modes, n_modes));
      }
    return result;
  }
} // namespace Debond
