// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_substructures_h
#define debond_linear_algebra_substructures_h

#include <debond/linear_algebra/views.h>

#include <Eigen/Core>

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace Debond
{
  /// What Substructures know of an element.
  struct SubstructureElement
  {
    /// Elements of one kind have the same matrix.
    unsigned int kind;

    /// Of the rows of its matrix.
    std::vector<unsigned int> unknowns;

    std::array<double, 3> centre;
    std::array<double, 3> extent; ///< of the box around it

    /// Whether it may get a weight other than 1.
    bool has_weight;
  };



  /// A sum over elements condensed onto the kept unknowns s: with all others at
  /// equilibrium
  ///     1/2 x'A x - f'x = c_0 + 1/2 s'S s - g's.
  class CondensedSubstructures
  {
  public:
    // Private to the source.
    struct Factor;
    struct Tree;

    CondensedSubstructures(const CondensedSubstructures &) = delete;

    ~CondensedSubstructures();

    /// S, in the order of the kept unknowns.
    const Eigen::MatrixXd &
    schur_complement() const;

    /// g.
    const Eigen::VectorXd &
    load() const;

    /// c_0.
    double
    energy_at_zero() const;

    /// x at equilibrium for given s, with the size of f; 0 where no element has
    /// an unknown.
    Eigen::VectorXd
    expand(const VectorView &s) const;

  private:
    friend class Substructures;

    explicit CondensedSubstructures(const std::shared_ptr<const Tree> &tree);

    std::shared_ptr<const Tree>                tree;
    std::vector<std::shared_ptr<const Factor>> factors; ///< of the tree's parts
    Eigen::MatrixXd                            S;
    Eigen::VectorXd                            g;
    Eigen::VectorXd                            y; ///< L^{-1} f, by unknown
    double                                     c_0 = 0.;
  };



  /**
   * A body of elements that is divided in two again and again, and condensed
   * from its elements upwards, each part onto the unknowns that it has in
   * common with others (multilevel substructuring; as a factorisation it is the
   * multifrontal method of Duff and Reid, ACM TOMS 9, 1983, ordered by nested
   * dissection). Parts that are made in the same way of elements of the same
   * kinds are condensed once, so that a uniform mesh takes little more than one
   * part of each size; what no weight changes is condensed once and for all.
   */
  class Substructures
  {
  public:
    /// Each of @p n_unknowns is one of at most two elements; those that are not
    /// in any are 0. @p kept: the unknowns s, each in at least one element. @p
    /// matrix has that of a kind, symmetric, of which the lower triangle is
    /// read; it is called whenever something is condensed.
    Substructures(
      const std::vector<SubstructureElement>                  &elements,
      const unsigned int                                       n_unknowns,
      const std::vector<unsigned int>                         &kept,
      const std::function<Eigen::MatrixXd(unsigned int kind)> &matrix);

    ~Substructures();

    /// For the load @p f and the matrices times @p weights, one for each
    /// element (all 1 if empty); the energy gets @p constant more. Throws
    /// std::runtime_error if the matrix of what is not kept is not positive
    /// definite.
    std::unique_ptr<CondensedSubstructures>
    condense(const Eigen::VectorXd     &f,
             const std::vector<double> &weights  = {},
             const double               constant = 0.);

  private:
    using Factor = CondensedSubstructures::Factor;
    using Tree   = CondensedSubstructures::Tree;

    const std::function<Eigen::MatrixXd(unsigned int)> matrix;
    std::shared_ptr<const Tree>                        tree;

    /// By kind of part; of those without weights, once they are there.
    std::vector<std::shared_ptr<Factor>> factors;
  };
} // namespace Debond

#endif
