// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/linear_algebra/substructures.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace Debond
{
  /// Of the unknowns of a part, its inner ones first, the symmetric matrix is
  ///     ( L    ) ( L'  B )   ( 0   )
  ///     ( B' 1 ) (     1 ) + (   S ).
  struct CondensedSubstructures::Factor
  {
    Eigen::MatrixXd L; ///< lower triangle
    Eigen::MatrixXd B;
    Eigen::MatrixXd S; ///< lower triangle; empty if no part needs it any more
  };



  struct CondensedSubstructures::Tree
  {
    /// Two parts of a kind have the same matrix if no element has a weight.
    struct Kind
    {
      bool is_element;
      bool has_weight; ///< whether some element may have one

      /// Of the two parts that it is made of, or twice that of the element.
      std::array<unsigned int, 2> kinds;

      /// Where their unknowns are: those on their boundaries, or those of the
      /// element's matrix.
      std::array<std::vector<unsigned int>, 2> places;

      unsigned int n_inner;
      unsigned int size;

      /// Whether a part that has a weight is made of it.
      bool is_below_weight = false;
    };

    struct Part
    {
      unsigned int              kind;
      std::vector<unsigned int> unknowns; ///< the inner ones first

      /// The two that it is made of, or twice the element.
      std::array<unsigned int, 2> parts;
    };

    Tree(const std::vector<SubstructureElement> &elements,
         const unsigned int                      n_unknowns,
         const std::vector<unsigned int>        &kept);

    std::vector<Kind> kinds;

    /// Each after those that it is made of.
    std::vector<Part> parts;

    unsigned int              n_unknowns;
    std::vector<unsigned int> kept;
  };



  namespace
  {
    using Tree   = CondensedSubstructures::Tree;
    using Factor = CondensedSubstructures::Factor;

    using Key = std::vector<unsigned int>;

    struct HashOfKey
    {
      std::size_t
      operator()(const Key &key) const
      {
        std::size_t hash = key.size();
        for (const unsigned int entry : key)
          hash = (hash ^ entry) * 0x100000001b3;
        return hash;
      }
    };



    /// Divides the elements, and finds the parts and their kinds.
    class TreeBuilder
    {
    public:
      TreeBuilder(const std::vector<SubstructureElement> &elements, Tree &tree)
        : elements(elements)
        , tree(tree)
        , order(elements.size())
        , n_elements_with(tree.n_unknowns, 0)
        , is_kept(tree.n_unknowns, 0)
        , place(tree.n_unknowns, 0)
      {
        for (const SubstructureElement &element : elements)
          for (const unsigned int i : element.unknowns)
            ++n_elements_with[i];
        for (const unsigned int i : tree.kept)
          is_kept[i] = 1;
        std::iota(order.begin(), order.end(), 0);
        if (!order.empty())
          make_part(order.begin(), order.end());
      }

    private:
      using Iterator = std::vector<unsigned int>::iterator;

      /// Returns its number.
      unsigned int
      make_part(const Iterator begin, const Iterator end)
      {
        if (end - begin == 1)
          return make_part_of_element(*begin);
        const Iterator     middle = divide(begin, end);
        const unsigned int one    = make_part(begin, middle);
        return join(one, make_part(middle, end));
      }

      /// Half of them on one side, across the direction in which most are
      /// behind each other.
      Iterator
      divide(const Iterator begin, const Iterator end) const
      {
        constexpr double place_rounding = 1e-6;
        double           most = 0., cut = 0.;
        unsigned int     direction = 0;
        for (unsigned int d = 0; d < 3; ++d)
          {
            double least   = elements[*begin].centre[d];
            double largest = least;
            double extent  = 0.;
            for (Iterator i = begin; i != end; ++i)
              {
                const double centre = elements[*i].centre[d];
                least               = std::min(least, centre);
                largest             = std::max(largest, centre);
                extent += elements[*i].extent[d];
              }
            extent /= static_cast<double>(end - begin);
            if (largest - least > most * extent)
              {
                most      = (largest - least) / extent;
                direction = d;
                // Those in the middle are on the same side whatever the
                // rounding of coordinates.
                cut = 0.5 * (least + largest) - place_rounding * extent;
              }
          }
        const Iterator middle =
          std::stable_partition(begin, end, [&](const unsigned int i) {
            return elements[i].centre[direction] < cut;
          });
        return middle == begin || middle == end ? begin + (end - begin) / 2 :
                                                  middle;
      }

      unsigned int
      make_part_of_element(const unsigned int number)
      {
        const SubstructureElement &element = elements[number];
        Key        key = {0, element.kind, element.has_weight ? 1u : 0u};
        Tree::Part part;
        part.parts                           = {{number, number}};
        const std::vector<unsigned int> &own = element.unknowns;
        std::vector<unsigned int>        inner, outer;
        for (unsigned int row = 0; row < own.size(); ++row)
          {
            const bool is_inner =
              n_elements_with[own[row]] == 1 && is_kept[own[row]] == 0;
            key.push_back(is_inner ? 1 : 0);
            (is_inner ? inner : outer).push_back(row);
          }
        const auto [entry, is_new] = numbers.emplace(key, tree.kinds.size());
        part.kind                  = entry->second;
        if (is_new)
          {
            tree.kinds.push_back({true,
                                  element.has_weight,
                                  {{element.kind, element.kind}},
                                  {},
                                  static_cast<unsigned int>(inner.size()),
                                  static_cast<unsigned int>(own.size())});
            std::vector<unsigned int> &places = tree.kinds.back().places[0];
            places.resize(own.size());
            unsigned int next = 0;
            for (const std::vector<unsigned int> *rows : {&inner, &outer})
              for (const unsigned int row : *rows)
                places[row] = next++;
          }
        for (const std::vector<unsigned int> *rows : {&inner, &outer})
          for (const unsigned int row : *rows)
            part.unknowns.push_back(own[row]);
        tree.parts.push_back(std::move(part));
        return static_cast<unsigned int>(tree.parts.size() - 1);
      }

      /// The unknowns that it has in common with others.
      std::vector<unsigned int>
      boundary(const unsigned int number) const
      {
        const Tree::Part &part = tree.parts[number];
        return {part.unknowns.begin() + tree.kinds[part.kind].n_inner,
                part.unknowns.end()};
      }

      unsigned int
      join(const unsigned int one, const unsigned int other)
      {
        const std::array<unsigned int, 2> kinds = {
          {tree.parts[one].kind, tree.parts[other].kind}};
        const std::array<std::vector<unsigned int>, 2> own = {
          {boundary(one), boundary(other)}};

        // What both have, and in which places.
        Key key = {1, kinds[0], kinds[1]};
        for (unsigned int i = 0; i < own[0].size(); ++i)
          place[own[0][i]] = i + 1;
        std::vector<char> is_common(own[0].size(), 0);
        Tree::Part        part;
        part.parts = {{one, other}};
        std::vector<unsigned int> of_other;
        for (unsigned int j = 0; j < own[1].size(); ++j)
          {
            const unsigned int unknown = own[1][j];
            const unsigned int i       = place[unknown];
            if (i > 0)
              {
                key.insert(key.end(), {i, j, is_kept[unknown] ? 1u : 0u});
                if (is_kept[unknown] == 0)
                  {
                    is_common[i - 1] = 1;
                    part.unknowns.push_back(unknown);
                  }
              }
            else
              of_other.push_back(unknown);
          }
        const unsigned int n_inner =
          static_cast<unsigned int>(part.unknowns.size());
        for (unsigned int i = 0; i < own[0].size(); ++i)
          {
            place[own[0][i]] = 0;
            if (is_common[i] == 0)
              part.unknowns.push_back(own[0][i]);
          }
        part.unknowns.insert(part.unknowns.end(),
                             of_other.begin(),
                             of_other.end());

        const auto [entry, is_new] = numbers.emplace(key, tree.kinds.size());
        part.kind                  = entry->second;
        if (is_new)
          {
            const bool has_weight = tree.kinds[kinds[0]].has_weight ||
                                    tree.kinds[kinds[1]].has_weight;
            for (const unsigned int kind : kinds)
              if (has_weight)
                tree.kinds[kind].is_below_weight = true;
            tree.kinds.push_back(
              {false,
               has_weight,
               kinds,
               {},
               n_inner,
               static_cast<unsigned int>(part.unknowns.size())});
            for (unsigned int i = 0; i < part.unknowns.size(); ++i)
              place[part.unknowns[i]] = i;
            for (const unsigned int k : {0, 1})
              for (const unsigned int unknown : own[k])
                tree.kinds.back().places[k].push_back(place[unknown]);
            for (const unsigned int unknown : part.unknowns)
              place[unknown] = 0;
          }
        tree.parts.push_back(std::move(part));
        return static_cast<unsigned int>(tree.parts.size() - 1);
      }

      const std::vector<SubstructureElement> &elements;
      Tree                                   &tree;

      std::vector<unsigned int> order;
      std::vector<unsigned int> n_elements_with; ///< by unknown
      std::vector<char>         is_kept;         ///< the same
      std::vector<unsigned int> place;           ///< 0 but within a function

      std::unordered_map<Key, unsigned int, HashOfKey> numbers; ///< of kinds
    };



    /// Adds a lower triangle whose rows have these places to the matrix that a
    /// factor will be of.
    void
    add(const MatrixView                &matrix,
        const std::vector<unsigned int> &places,
        const double                     weight,
        Factor                          &factor)
    {
      const unsigned int n_inner = static_cast<unsigned int>(factor.L.rows());
      for (unsigned int j = 0; j < places.size(); ++j)
        for (unsigned int i = j; i < places.size(); ++i)
          {
            const unsigned int row    = std::max(places[i], places[j]);
            const unsigned int column = std::min(places[i], places[j]);
            const double       value  = weight * matrix(i, j);
            if (row < n_inner)
              factor.L(row, column) += value;
            else if (column < n_inner)
              factor.B(column, row - n_inner) += value;
            else
              factor.S(row - n_inner, column - n_inner) += value;
          }
    }



    /// Eliminates the inner unknowns. Throws std::runtime_error if their matrix
    /// is not positive definite.
    void
    eliminate(Factor &factor)
    {
      using Integer         = dealii::types::blas_int;
      const Integer n_inner = static_cast<Integer>(factor.L.rows());
      const Integer n_outer = static_cast<Integer>(factor.S.rows());
      if (n_inner == 0)
        return;
      Integer info;
      dealii::potrf("L", &n_inner, factor.L.data(), &n_inner, &info);
      AssertThrow(info >= 0, dealii::ExcInternalError());
      if (info > 0)
        throw std::runtime_error(
          "to rounding the matrix of the equilibrated stresses is not positive "
          "definite; try cells that are less flat, a Poisson ratio farther "
          "from its limit, or parts that differ less in stiffness");
      if (n_outer == 0)
        return;
      dealii::trtrs("L",
                    "N",
                    "N",
                    &n_inner,
                    &n_outer,
                    factor.L.data(),
                    &n_inner,
                    factor.B.data(),
                    &n_inner,
                    &info);
      AssertThrow(info == 0, dealii::ExcInternalError());
      const double minus_one = -1., one = 1.;
      dealii::syrk("L",
                   "T",
                   &n_outer,
                   &n_inner,
                   &minus_one,
                   factor.B.data(),
                   &n_inner,
                   &one,
                   factor.S.data(),
                   &n_outer);
    }
  } // namespace



  CondensedSubstructures::Tree::Tree(
    const std::vector<SubstructureElement> &elements,
    const unsigned int                      n_unknowns,
    const std::vector<unsigned int>        &kept)
    : n_unknowns(n_unknowns)
    , kept(kept)
  {
    TreeBuilder(elements, *this);
  }



  CondensedSubstructures::CondensedSubstructures(
    const std::shared_ptr<const Tree> &tree)
    : tree(tree)
  {}



  CondensedSubstructures::~CondensedSubstructures() = default;



  const Eigen::MatrixXd &
  CondensedSubstructures::schur_complement() const
  {
    return S;
  }



  const Eigen::VectorXd &
  CondensedSubstructures::load() const
  {
    return g;
  }



  double
  CondensedSubstructures::energy_at_zero() const
  {
    return c_0;
  }



  Eigen::VectorXd
  CondensedSubstructures::expand(const VectorView &s) const
  {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(tree->n_unknowns);
    x(tree->kept)     = s;
    for (unsigned int part = static_cast<unsigned int>(tree->parts.size());
         part-- > 0;)
      {
        const Factor                    &factor  = *factors[part];
        const Eigen::Index               n_inner = factor.L.rows();
        const std::vector<unsigned int> &own     = tree->parts[part].unknowns;
        Eigen::VectorXd inner(n_inner), outer(own.size() - n_inner);
        for (Eigen::Index i = 0; i < n_inner; ++i)
          inner(i) = y(own[i]);
        for (Eigen::Index i = 0; i < outer.size(); ++i)
          outer(i) = x(own[n_inner + i]);
        inner.noalias() -= factor.B * outer;
        factor.L.transpose().triangularView<Eigen::Upper>().solveInPlace(inner);
        for (Eigen::Index i = 0; i < n_inner; ++i)
          x(own[i]) = inner(i);
      }
    return x;
  }



  Substructures::Substructures(
    const std::vector<SubstructureElement>                  &elements,
    const unsigned int                                       n_unknowns,
    const std::vector<unsigned int>                         &kept,
    const std::function<Eigen::MatrixXd(unsigned int kind)> &matrix)
    : matrix(matrix)
    , tree(std::make_shared<Tree>(elements, n_unknowns, kept))
    , factors(tree->kinds.size())
  {}



  Substructures::~Substructures() = default;



  std::unique_ptr<CondensedSubstructures>
  Substructures::condense(const Eigen::VectorXd     &f,
                          const std::vector<double> &weights,
                          const double               constant)
  {
    const std::vector<Tree::Kind> &kinds = tree->kinds;
    const std::vector<Tree::Part> &parts = tree->parts;

    // Parts of a kind with the same weights are the same: these follow the
    // kinds.
    std::vector<unsigned int> number_of_part;
    std::vector<unsigned int> n_of_number(kinds.size(), 0);
    std::map<std::tuple<unsigned int, unsigned int, unsigned int, double>,
             unsigned int>
      numbers;
    for (const Tree::Part &part : parts)
      {
        const Tree::Kind &kind   = kinds[part.kind];
        unsigned int      number = part.kind;
        if (kind.has_weight)
          {
            const auto key =
              kind.is_element ?
                std::make_tuple(part.kind,
                                0u,
                                0u,
                                weights.empty() ? 1. : weights[part.parts[0]]) :
                std::make_tuple(part.kind,
                                number_of_part[part.parts[0]],
                                number_of_part[part.parts[1]],
                                0.);
            const auto [entry, is_new] =
              numbers.emplace(key,
                              static_cast<unsigned int>(n_of_number.size()));
            number = entry->second;
            if (is_new)
              n_of_number.push_back(0);
          }
        number_of_part.push_back(number);
        ++n_of_number[number];
      }

    std::unique_ptr<CondensedSubstructures> result(
      new CondensedSubstructures(tree));
    std::vector<std::shared_ptr<Factor>> own(factors);
    own.resize(n_of_number.size());
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        const Tree::Part        &part   = parts[i];
        const Tree::Kind        &kind   = kinds[part.kind];
        std::shared_ptr<Factor> &factor = own[number_of_part[i]];
        if (factor == nullptr)
          {
            const Eigen::Index n_outer = kind.size - kind.n_inner;
            auto               made    = std::make_shared<Factor>();
            made->L = Eigen::MatrixXd::Zero(kind.n_inner, kind.n_inner);
            made->B = Eigen::MatrixXd::Zero(kind.n_inner, n_outer);
            made->S = Eigen::MatrixXd::Zero(n_outer, n_outer);
            if (kind.is_element)
              add(matrix(kind.kinds[0]),
                  kind.places[0],
                  kind.has_weight && !weights.empty() ? weights[part.parts[0]] :
                                                        1.,
                  *made);
            else
              for (const unsigned int k : {0, 1})
                add(own[number_of_part[part.parts[k]]]->S,
                    kind.places[k],
                    1.,
                    *made);
            eliminate(*made);
            factor = made;
            if (!kind.has_weight)
              factors[part.kind] = made;
          }
        result->factors.push_back(factor);
        if (!kind.is_element)
          for (const unsigned int below : part.parts)
            {
              const Tree::Kind &its_kind = kinds[parts[below].kind];
              if (--n_of_number[number_of_part[below]] == 0 &&
                  (its_kind.has_weight || !its_kind.is_below_weight))
                own[number_of_part[below]]->S.resize(0, 0);
            }
      }

    result->c_0        = constant;
    result->y          = f;
    Eigen::VectorXd &y = result->y;
    for (unsigned int part = 0; part < parts.size(); ++part)
      {
        const Factor                    &factor   = *result->factors[part];
        const Eigen::Index               n_inner  = factor.L.rows();
        const std::vector<unsigned int> &unknowns = parts[part].unknowns;
        Eigen::VectorXd                  inner(n_inner);
        for (Eigen::Index i = 0; i < n_inner; ++i)
          inner(i) = y(unknowns[i]);
        factor.L.triangularView<Eigen::Lower>().solveInPlace(inner);
        const Eigen::VectorXd outer = factor.B.transpose() * inner;
        for (Eigen::Index i = 0; i < n_inner; ++i)
          y(unknowns[i]) = inner(i);
        for (Eigen::Index i = 0; i < outer.size(); ++i)
          y(unknowns[n_inner + i]) -= outer(i);
        result->c_0 -= 0.5 * inner.squaredNorm();
      }

    // In the order of the kept unknowns.
    const std::vector<unsigned int> &kept = tree->kept;
    result->g                             = y(kept);
    result->S.resize(kept.size(), kept.size());
    if (!parts.empty())
      {
        std::vector<unsigned int> place(tree->n_unknowns, 0);
        for (unsigned int i = 0; i < kept.size(); ++i)
          place[kept[i]] = i;
        const Factor                    &root     = *result->factors.back();
        const std::vector<unsigned int> &unknowns = parts.back().unknowns;
        for (Eigen::Index j = 0; j < root.S.rows(); ++j)
          for (Eigen::Index i = j; i < root.S.rows(); ++i)
            {
              const unsigned int row    = place[unknowns[root.L.rows() + i]];
              const unsigned int column = place[unknowns[root.L.rows() + j]];
              result->S(row, column)    = root.S(i, j);
              result->S(column, row)    = root.S(i, j);
            }
      }
    return result;
  }
} // namespace Debond
