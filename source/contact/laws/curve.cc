// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/parameter_table.h>
#include <debond/base/tolerances.h>
#include <debond/contact/laws/curve.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace Debond
{
  const char *const traction_factor = "Contact law/Traction factor";



  namespace
  {
    const std::string curve_path = "Contact law/Curve";
    const std::string file_path  = "Contact law/Curve file";



    void
    require_curve(const bool holds, const std::string &reason)
    {
      if (!holds)
        throw std::invalid_argument("a curve of tractions " + reason);
    }



    void
    check(const TractionCurve &curve)
    {
      require_curve(!curve.empty() && curve[0].first == 0.,
                    "begins at the opening 0");
      for (std::size_t k = 0; k < curve.size(); ++k)
        {
          const auto [opening, traction] = curve[k];
          // Stiffnesses and energies are quotients and products of these
          // numbers, which neither overflow nor underflow in this range.
          for (const double number : {opening, traction})
            require_curve(number == 0. || (std::abs(number) >= 1e-100 &&
                                           std::abs(number) <= 1e100),
                          "has numbers from 1e-100 to 1e100, or 0");
          require_curve(traction >= 0.,
                        words("has no negative ones, as ",
                              traction,
                              " at the opening ",
                              opening));
          if (k == 0)
            continue;
          // A traction that jumped up would be a convex kink of j_1: there is
          // no quadratic that touches it from above, as a majorant has to. An
          // opening twice is a drop, which is allowed; openings that fall make
          // no function.
          require_curve(opening >= curve[k - 1].first,
                        words("has openings that do not fall, as from ",
                              curve[k - 1].first,
                              " to ",
                              opening));
          require_curve(opening > curve[k - 1].first ||
                          traction <= curve[k - 1].second,
                        words("does not jump up, as at the opening ",
                              opening,
                              " from ",
                              curve[k - 1].second,
                              " to ",
                              traction));
        }
      require_curve(std::any_of(curve.begin(),
                                curve.end(),
                                [](const auto &point) {
                                  return point.second > 0.;
                                }),
                    "has some that are not 0 (for no adhesion: Law = none)");
    }



    /// Two columns of numbers, with or without a line of titles.
    TractionCurve
    read_curve(const std::string &name)
    {
      std::ifstream file(name);
      if (!file)
        throw std::invalid_argument("cannot be read");
      TractionCurve curve;
      std::string   line;
      for (unsigned int number = 1; std::getline(file, line); ++number)
        {
          if (number == 1 && line.rfind("\xef\xbb\xbf", 0) == 0)
            line.erase(0, 3); // the mark of UTF-8
          // Commas and semicolons separate columns, as in exported tables; the
          // carriage return is what other systems end lines with.
          std::replace_if(
            line.begin(),
            line.end(),
            [](const char c) { return c == ',' || c == ';' || c == '\r'; },
            ' ');
          std::istringstream       text(line);
          std::vector<std::string> parts;
          for (std::string part; text >> part;)
            parts.push_back(part);
          double opening, traction;
          if (parts.size() == 2 && read_number(parts[0], opening) &&
              read_number(parts[1], traction))
            curve.emplace_back(opening, traction);
          // Only the first line may be a title. Any later line that is not
          // understood is an error, so that no point is lost in silence.
          else if (!parts.empty() && number > 1)
            throw std::invalid_argument("line " + std::to_string(number) +
                                        " is not an opening and a traction");
        }
      if (curve.empty())
        throw std::invalid_argument(
          "has no lines of an opening and a traction");
      return curve;
    }



    /// Returns the index behind the point from which on all tractions are zero.
    std::size_t
    end_of_tractions(const TractionCurve &curve)
    {
      std::size_t end = curve.size();
      // Zeros at the end are one last piece, however many points say so.
      while (end > 1 && curve[end - 1].second == 0. &&
             curve[end - 2].second == 0.)
        --end;
      return end;
    }



    /// Reads a list such as "0:0, 0.01:1.5".
    TractionCurve
    curve_of(const std::string &text)
    {
      using dealii::Utilities::split_string_list;
      TractionCurve curve;
      for (const std::string &point : split_string_list(text, ','))
        {
          const auto numbers = split_string_list(point, ':');
          double     opening, traction;
          if (numbers.size() != 2 || !read_number(numbers[0], opening) ||
              !read_number(numbers[1], traction))
            throw std::invalid_argument(
              "\"" + point + "\" is not OPENING:TRACTION" + number_hint(text));
          curve.emplace_back(opening, traction);
        }
      return curve;
    }
  } // namespace



  ContactLawParameters
  curve_law(const TractionCurve &curve)
  {
    check(curve);
    // Each part of the polygon between two openings is a piece of j_1, a
    // parabola; s = -p turns their order, so that the pieces follow each other
    // from 0 downwards and each ends at minus the opening of its second point.
    const auto           end      = end_of_tractions(curve);
    ContactLawParameters law      = {"curve", {}, ""};
    double               strength = 0., energy = 0.;
    unsigned int         n_drops   = 0;
    bool                 is_intact = true;
    for (std::size_t k = 0; k < curve.size(); ++k)
      strength = std::max(strength, curve[k].second);
    for (std::size_t k = 0; k + 1 < end; ++k)
      {
        const auto [p, t]       = curve[k];
        const auto [next, last] = curve[k + 1];
        // A drop is no piece: the two pieces beside it say it by their
        // tractions there.
        if (p == next)
          {
            n_drops += t != last;
            continue;
          }
        // The traction on this part is at_zero + rise p with the opening p =
        // -s. So j_1'(s) = rise s - at_zero, with the curvature and the slope
        // that a piece is described by.
        double rise = (last - t) / (next - p), at_zero = t - rise * p;
        // A part that goes through 0 but for rounding is a spring. Bonds return
        // along a piece if its slope is exactly zero; a remainder of rounding
        // would make them return along a secant instead.
        if (std::abs(at_zero) <= Tolerance::rounding_of_data * strength)
          {
            rise    = last / next;
            at_zero = 0.;
          }
        // The area below the curve.
        energy += 0.5 * (last + t) * (next - p);
        // Bonds are intact as long as the traction has only risen. What rises
        // again after a drop is what is left of them, by the number of drops.
        is_intact = is_intact && rise > 0. && n_drops == 0;
        law.pieces.push_back(
          {rise,
           -at_zero,
           -next,
           t == 0. && last == 0. ? "broken" :
           is_intact             ? "bonded" :
           rise > 0. && n_drops > 0 ?
                       "partly broken (" + std::to_string(n_drops) + ")" :
                       "softening"});
      }
    // The last traction holds from the last point on. If it is not zero, bonds
    // never break and their fracture energy is infinite.
    const double last = curve[end - 1].second;
    law.pieces.push_back(
      {0., -last, no_end, last == 0. ? "broken" : "holding"});
    law.data = words(curve.size(), " points, strength ", strength);
    law.data +=
      last == 0. ? words(", fracture energy ", energy) : ", pulls for ever";
    return law;
  }



  void
  add_traction_factor(const ParameterTable &table, ContactLawParameters &law)
  {
    law.stiffness       = table.get(traction_factor);
    law.stiffness_entry = traction_factor;
    if (!law.stiffness.empty())
      law.data += ", times " + law.stiffness;
  }



  LawKind
  curve_kind()
  {
    return {
      "curve",
      "has the tractions of Curve, or of Curve file, over the opening: bonds "
      "that soften, or break in steps",
      [](ParameterTable &table) -> LawMaker {
        struct Entries
        {
          std::string points, file;
        };
        // The table keeps references to the variables until the scene has been
        // read, and the maker uses them then.
        const auto entries = std::make_shared<Entries>();
        table.bind(
          curve_path,
          entries->points,
          text_with_numbers("nothing, or a list of OPENING:TRACTION"),
          "Tractions over the opening, straight between the points of the list; at an opening that is there twice the traction drops. The first opening is 0, the last traction, which holds from there on, mostly 0",
          "length:force per area");
        table.bind(
          file_path,
          entries->file,
          Pattern("nothing, or a file"),
          "A file with two columns, such as a CSV file, in place of Curve, relative to the folder of what sets it",
          "as Curve");
        // All laws with a Traction factor share this entry, which is read by
        // its name where a law is made.
        table.declare(
          traction_factor,
          "",
          Pattern("nothing, or an expression"),
          "What multiplies the tractions of Law = curve, bilinear or exponential, an expression in x, y (and z) as in Loads: 0 where there are no bonds, such as on a crack; 1 if empty",
          "none",
          [](const std::string &) {});
        return [entries](ParameterTable &all) {
          const bool        has_file = !entries->file.empty();
          const std::string path     = has_file ? file_path : curve_path;
          try
            {
              // Neither, or both.
              if (has_file == !entries->points.empty())
                throw std::invalid_argument(
                  "Law = curve needs a Curve or a Curve file, not both");
              // A file is named relative to the file in which it is named,
              // whose name stands before the line in the location.
              const std::string    set_at = all.locations().at(file_path);
              ContactLawParameters law    = curve_law(
                has_file ? read_curve((std::filesystem::path(
                                         set_at.substr(0, set_at.rfind(':')))
                                         .parent_path() /
                                       entries->file)
                                        .string()) :
                           curve_of(entries->points));
              add_traction_factor(all, law);
              if (law.pieces.back().slope != 0.)
                all.notes.push_back(path + " ends with a traction: bonds pull "
                                           "with it at any opening, and never "
                                           "break");
              return law;
            }
          catch (const std::invalid_argument &error)
            {
              all.reject(path, error.what(), {curve_path, file_path});
              return ContactLawParameters();
            }
        };
      },
      curve_path + ", " + file_path + ", " + traction_factor};
  }
} // namespace Debond
