// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_archive_h
#define debond_base_archive_h

#include <debond/base/checkpoints.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array_wrapper.hpp>
#include <boost/serialization/vector.hpp>

#include <Eigen/Core>

#include <stdexcept>

// How states are written and read. The types of deal.II and Eigen go as plain
// numbers; whoever reads them has made room for them before.
namespace Debond
{
  /// Throws std::invalid_argument unless a state has the sizes of the problem.
  inline void
  require_fit(const bool fits)
  {
    if (!fits)
      throw std::invalid_argument(
        "the state has other sizes than the problem of the scene");
  }



  template <typename VectorType>
  void
  save_values(OutArchive &archive, const VectorType &v)
  {
    const std::size_t size = v.locally_owned_size();
    archive << size;
    archive << boost::serialization::make_array(v.begin(), size);
  }



  template <typename VectorType>
  void
  load_values(InArchive &archive, VectorType &v)
  {
    std::size_t size;
    archive >> size;
    require_fit(size == v.locally_owned_size());
    archive >> boost::serialization::make_array(v.begin(), size);
  }



  /// Of any size.
  inline void
  save_matrix(OutArchive &archive, const Eigen::MatrixXd &matrix)
  {
    const Eigen::Index rows = matrix.rows(), cols = matrix.cols();
    archive << rows << cols;
    archive << boost::serialization::make_array(matrix.data(), matrix.size());
  }



  inline Eigen::MatrixXd
  load_matrix(InArchive &archive)
  {
    Eigen::Index rows, cols;
    archive >> rows >> cols;
    Eigen::MatrixXd matrix(rows, cols);
    archive >> boost::serialization::make_array(matrix.data(), matrix.size());
    return matrix;
  }
} // namespace Debond

#endif
