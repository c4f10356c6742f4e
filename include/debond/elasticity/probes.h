// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_probes_h
#define debond_elasticity_probes_h

#include <debond/elasticity/elastic_problem.h>

namespace Debond
{
  /// A displacement or a force that the scene asks for by name.
  template <int dim>
  struct Probe
  {
    enum class Kind
    {
      point, ///< the displacement at a point
      mean,  ///< its mean over a piece of the boundary or of the body
      force  ///< what supports and foundation exert on a piece of the boundary
    };

    std::string        name;
    Kind               kind  = Kind::point;
    dealii::Point<dim> point = {};
    std::string        piece = {}; ///< a name of PieceNames
  };



  /// The values are Cartesian vectors, by the names of the probes.
  template <int dim>
  using ProbeValues =
    std::vector<std::pair<std::string, dealii::Tensor<1, dim>>>;



  /**
   * Probes of the displacements on one mesh: each is a sum over vertices, of
   * the displacement or of the forces A u - f times a weight. A force is that
   * of all vertices of a piece, also of those that it shares with another one.
   */
  template <int dim>
  class Probes
  {
  public:
    Probes() = default;

    /// The @p pieces are those of the mesh of @p unknowns. Throws EntryError,
    /// or std::out_of_range if there is no such piece. To be called by all
    /// ranks, and so is values().
    Probes(const ElasticUnknowns<dim>    &unknowns,
           const PieceNames              &pieces,
           const std::vector<Probe<dim>> &probes);

    ProbeValues<dim>
    values(const ElasticProblem<dim> &problem,
           const DofVector           &u,
           const LoadFactors          factors = 1.) const;

  private:
    /// A weighted sum over nodes, given by their first unknowns, which all the
    /// others follow.
    struct Sum
    {
      std::string                                                     name;
      bool                                                            of_forces;
      std::vector<std::pair<dealii::types::global_dof_index, double>> weights;
    };

    std::vector<Sum> sums;
  };

  /// The mean over each piece that has a name; of regions only if there are
  /// several.
  template <int dim>
  std::vector<Probe<dim>>
  means_of_pieces(const PieceNames &pieces);
} // namespace Debond

#endif
