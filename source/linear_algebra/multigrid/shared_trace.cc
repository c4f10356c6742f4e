// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <debond/linear_algebra/multigrid/shared_trace.h>

namespace Debond
{
  SharedTrace::SharedTrace(const SharedNodes               &nodes,
                           const unsigned int               dim,
                           const std::vector<unsigned int> &unknowns)
    : ranks(nodes.communicator())
  {
    std::vector<unsigned int> own_places;
    for (unsigned int i = 0; i < unknowns.size(); ++i)
      if (unknowns[i] != dealii::numbers::invalid_unsigned_int &&
          nodes.is_own(unknowns[i] / dim))
        {
          own.push_back(unknowns[i]);
          own_places.push_back(i);
        }
    for (const std::vector<unsigned int> &of_rank :
         dealii::Utilities::MPI::all_gather(ranks, own_places))
      {
        starts.push_back(static_cast<int>(places.size()));
        counts.push_back(static_cast<int>(of_rank.size()));
        places.insert(places.end(), of_rank.begin(), of_rank.end());
      }
  }



  Eigen::VectorXd
  SharedTrace::operator()(const DofVector &v) const
  {
    // deal.II's all_gather() compresses what it sends.
    std::vector<double> sent, received(places.size());
    sent.reserve(own.size());
    for (const unsigned int unknown : own)
      sent.push_back(v(unknown));
    const int error = MPI_Allgatherv(sent.data(),
                                     static_cast<int>(sent.size()),
                                     MPI_DOUBLE,
                                     received.data(),
                                     counts.data(),
                                     starts.data(),
                                     MPI_DOUBLE,
                                     ranks);
    AssertThrowMPI(error);
    Eigen::VectorXd result(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      result(places[i]) = received[i];
    return result;
  }
} // namespace Debond
