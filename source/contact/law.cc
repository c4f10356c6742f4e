// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/parameter_table.h>
#include <debond/base/tolerances.h>
#include <debond/contact/laws/curve.h>
#include <debond/contact/laws/none.h>
#include <debond/contact/laws/softening.h>
#include <debond/contact/laws/winkler.h>

#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// AdhesiveLaw::broken_beyond(), of a law without it.
    double
    opening_of_broken(const AdhesiveLaw &law)
    {
      const PiecewiseEnergy::Piece &last =
        law.pieces()[law.pieces().size() - 1];
      double end = law.bond_threshold();
      if (last.decay == 0.)
        return last.is_flat() ? end : infinity;
      // Damage grows with the opening there, and is 1 but for rounding after 40
      // lengths of decay.
      double beyond = end + 40. / last.decay;
      for (unsigned int step = 0; step < 60; ++step)
        {
          // At `end` bonds are damaged by less, at `beyond` by more: 60
          // halvings leave nothing but rounding.
          const double middle = 0.5 * (end + beyond);
          (law.damage(-middle) < AdhesiveLaw::broken_damage ? end : beyond) =
            middle;
        }
      return beyond;
    }
  } // namespace



  AdhesiveLaw::AdhesiveLaw(const std::vector<EnergyPiece> &pieces)
    : energy_pieces(pieces)
  {
    for (unsigned int k = 0; k < energy_pieces.size(); ++k)
      {
        const PiecewiseEnergy::Piece &piece = energy_pieces[k];
        // A law pulls at all s < 0. The derivative of a piece is monotone, so
        // that its ends say it; of the last piece any point further down does.
        const double lower =
          std::isfinite(piece.lower) ? piece.lower : 2. * piece.upper;
        // Of steep pieces far from 0 the terms of the derivative cancel.
        const double rounding =
          Tolerance::rounding_of_data *
          (std::abs(piece.slope) + std::abs(piece.curvature * lower));
        if (piece.derivative(piece.upper) > rounding ||
            piece.derivative(lower) > rounding)
          throw std::invalid_argument("The piece \"" + pieces[k].name +
                                      "\" pushes");
        names.push_back(pieces[k].name);
      }
    largest_opening = opening_of_broken(*this);
  }



  template <typename Number>
  double
  AdhesiveLaw::on_piece(const double  s,
                        const double  reached,
                        const Number &number) const
  {
    // Without a memory there is no piece to be made.
    return reached != 0. ? number(energy_pieces.piece_at(s, reached)) :
           s > 0.        ? 0. :
                           number(energy_pieces[energy_pieces.index(s)]);
  }



  double
  AdhesiveLaw::value(const double s, const double reached) const
  {
    return on_piece(s, reached, [s](const auto &piece) {
      return piece.value(s);
    });
  }



  double
  AdhesiveLaw::derivative(const double s, const double reached) const
  {
    return on_piece(s, reached, [s](const auto &piece) {
      return piece.derivative(s);
    });
  }



  double
  AdhesiveLaw::curvature(const double s, const double reached) const
  {
    // Above 0 there is no law unless bonds have been stretched before.
    return s > 0. && reached == 0. ?
             0. :
             energy_pieces.majorant_curvature(s, reached);
  }



  double
  AdhesiveLaw::second_derivative(const double s, const double reached) const
  {
    return on_piece(s, reached, [s](const auto &piece) {
      return piece.second_derivative(s);
    });
  }



  Interval
  AdhesiveLaw::clarke_interval(const double s, const double reached) const
  {
    if (s > 0. && reached == 0.)
      return {0., 0.};
    // Away from kinks this is one point. At a kink it is (9), all that is
    // between the derivatives of both pieces. At s = 0 the other side is (10)
    // above 0, which is zero; bonds with a memory are springs there, without a
    // kink.
    const PiecewiseEnergy::Piece piece = energy_pieces.piece_at(s, reached);
    const double                 force = piece.derivative(s);
    // The other side, if s is a kink.
    const double other =
      s == 0. && reached == 0. ? 0. :
      s == piece.lower         ? energy_pieces[piece.number + 1].derivative(s) :
                                 force;
    return {std::min(force, other), std::max(force, other)};
  }



  Interval
  AdhesiveLaw::goldstein_interval(const double s,
                                  const double delta,
                                  const double reached) const
  {
    if (s + delta < 0.)
      {
        // All on one piece, whose derivative is monotone.
        const PiecewiseEnergy::Piece piece = energy_pieces.piece_at(s, reached);
        if (piece.lower < s - delta && s + delta < piece.upper)
          {
            const double a = piece.derivative(s - delta),
                         b = piece.derivative(s + delta);
            return {std::min(a, b), std::max(a, b)};
          }
      }
    Interval hull = clarke_interval(s, reached);
    if (!(delta > 0.))
      return hull;

    const auto extend = [&](const double t) {
      const Interval interval = clarke_interval(t, reached);
      hull.lower              = std::min(hull.lower, interval.lower);
      hull.upper              = std::max(hull.upper, interval.upper);
    };

    // The derivative is monotone between the kinks, so its extremes are at the
    // ends and at the kinks, whose intervals hold both one-sided values.
    extend(s - delta);
    extend(s + delta);
    for (const double kink : kinks())
      if (std::abs(kink - s) <= delta)
        extend(kink);
    // Where the memory ends the derivative is continuous, but it need not be
    // monotone: below it the law goes on, above it is the secant.
    if (reached < 0. && std::abs(reached - s) <= delta)
      extend(reached);
    return hull;
  }



  double
  AdhesiveLaw::damage(const double reached) const
  {
    // The secant stiffness at reached beside that at 0; bonds that are rigid at
    // first lose traction in place of stiffness.
    const PiecewiseEnergy::Piece first = energy_pieces[0];
    const double pull = energy_pieces.piece_at(reached, 0.).derivative(reached);
    if (!(reached < 0.) || first.is_flat())
      return 0.;
    // A curve may also become stiffer before it drops, which is no negative
    // damage.
    const double lost = first.slope == 0. ?
                          1. - pull / (first.curvature * reached) :
                          1. - pull / first.slope;
    return std::min(1., std::max(0., lost));
  }



  AdhesiveLaw
  AdhesiveLaw::with_tail(const double factor) const
  {
    // The traction at s is that of this law at first + (s - first) / factor,
    // first being the end of the first piece.
    std::vector<EnergyPiece> result;
    const double             first = energy_pieces[0].lower;
    for (unsigned int k = 0; k < energy_pieces.size(); ++k)
      {
        const PiecewiseEnergy::Piece &piece = energy_pieces[k];
        const double                  slope =
          piece.curvature * first * (1. - 1. / factor) + piece.slope;
        result.push_back(
          k == 0 ?
            EnergyPiece{piece.curvature, piece.slope, piece.lower, names[k]} :
            EnergyPiece{piece.curvature / factor,
                        slope,
                        first + (piece.lower - first) * factor,
                        names[k],
                        piece.decay / factor});
      }
    return AdhesiveLaw(result);
  }



  double
  AdhesiveLaw::reached_as(const AdhesiveLaw &other, const double reached) const
  {
    // Damage grows with the opening beyond the first piece, where both laws
    // begin to differ: it is bisected for.
    const double first = energy_pieces[0].lower;
    const double lost  = other.damage(reached);
    if (this == &other || !(reached < first) || lost == 0.)
      return reached;
    double inside = first, beyond = 2. * first;
    while (damage(beyond) < lost && std::isfinite(beyond))
      beyond *= 2.;
    for (unsigned int step = 0; step < 100; ++step)
      {
        const double middle                       = 0.5 * (inside + beyond);
        (damage(middle) < lost ? inside : beyond) = middle;
      }
    return beyond;
  }



  std::vector<double>
  AdhesiveLaw::kinks() const
  {
    // Pieces end where the second derivative may jump.
    std::vector<double> result;
    // From the last piece upwards; at 0 there is a kink if bonds pull or are
    // stiff there, for above it there is nothing.
    for (unsigned int k = energy_pieces.size() - 1; k > 0; --k)
      result.push_back(energy_pieces[k].upper);
    if (!is_loose(0))
      result.push_back(0.);
    return result;
  }



  double
  AdhesiveLaw::bond_threshold() const
  {
    return std::abs(energy_pieces[energy_pieces.size() - 1].upper);
  }



  double
  AdhesiveLaw::bond_strength() const
  {
    // Tractions rise to the kinks, as the pieces are monotone between them.
    double strength = 0.;
    // The derivative is minus the traction, and its lower end is the traction
    // before the drop.
    for (const double kink : kinks())
      strength = std::max(strength, -clarke_interval(kink).lower);
    return strength;
  }



  namespace
  {
    /// Returns the parts of a list with commas.
    std::set<std::string>
    names_in(const std::string &list)
    {
      std::set<std::string> names;
      for (const std::string &name :
           dealii::Utilities::split_string_list(list, ','))
        names.insert(name);
      return names;
    }



    const std::vector<LawKind> &
    kinds()
    {
      // The first is the law of a scene that names none.
      static const std::vector<LawKind> all = {winkler_kind(),
                                               bilinear_kind(),
                                               exponential_kind(),
                                               curve_kind(),
                                               no_adhesion_kind()};
      return all;
    }
  } // namespace



  std::vector<std::string>
  law_names()
  {
    std::vector<std::string> names;
    for (const LawKind &kind : kinds())
      names.push_back(kind.name);
    std::sort(names.begin(), names.end());
    return names;
  }



  LawSection::LawSection()
    : name(kinds()[0].name)
  {}



  void
  LawSection::bind(ParameterTable &table)
  {
    // Every kind binds its entries, whichever is chosen: what belongs to the
    // others is told in make_law().
    std::vector<std::string> descriptions;
    for (const LawKind &kind : kinds())
      descriptions.push_back(kind.name + " " + kind.description);
    table.bind("Contact law/Law",
               name,
               one_of(law_names()),
               "The adhesive law: " + join(descriptions, "; "));
    for (const LawKind &kind : kinds())
      makers[kind.name] = kind.bind(table);
  }



  ContactLawParameters
  LawSection::make_law(ParameterTable &table) const
  {
    // What the law has in common with others is its own. Without adhesion on
    // purpose.
    std::set<std::string> own;
    for (const LawKind &kind : kinds())
      if (kind.name == name)
        own = names_in(kind.entries);
    // Entries that only other kinds have, with these kinds: whoever gives one
    // expects an effect of it.
    std::map<std::string, std::vector<std::string>> laws_of;
    for (const LawKind &kind : kinds())
      for (const std::string &entry : names_in(kind.entries))
        if (own.count(entry) == 0)
          laws_of[entry].push_back(kind.name);
    for (const auto &[entry, laws] : laws_of)
      table.without_effect(entry,
                           "it belongs to Contact law/Law = " +
                             join(laws, " or ") + ", the law is " + name,
                           name == "none" ? "" : "Contact law/Law");
    return makers.at(name)(table);
  }
} // namespace Debond
