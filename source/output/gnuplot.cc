// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/child_process.h>
#include <debond/output/gnuplot.h>

#include <algorithm>
#include <filesystem>
#include <limits>

namespace Debond
{
  namespace
  {
    constexpr std::ptrdiff_t n_colours = 8; ///< gnuplot's own



    /// Text for gnuplot that it does not interpret.
    std::string
    quoted(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        result += c == '\'' ? "''" : std::string(1, c);
      return "'" + result + "' noenhanced";
    }



    /// Whether a point has logarithms where they are needed.
    bool
    is_drawn(const Plot &plot, const std::pair<double, double> &point)
    {
      return (!plot.log_x || point.first > 0.) &&
             (!plot.log_y || point.second > 0.);
    }



    void
    write_data(const Plot &plot, std::ostream &out)
    {
      out.precision(std::numeric_limits<double>::max_digits10);
      for (const Curve &curve : plot.curves)
        {
          out << "# " << curve.title << '\n';
          for (const auto &point : curve.points)
            if (is_drawn(plot, point))
              out << point.first << ' ' << point.second << '\n';
          // An empty block would not be counted.
          out << "nan nan\n\n\n";
        }
    }



    void
    write_script(const Plot &plot, std::ostream &out)
    {
      std::size_t longest_title = 0;
      for (const Curve &curve : plot.curves)
        longest_title = std::max(longest_title, curve.title.size());
      out << "# Draws " << plot.name << ".png and " << plot.name
          << ".svg: gnuplot " << plot.name << ".gp\n"
          << "set terminal pngcairo size 960,540 font 'sans,11'\n"
          << "set output '" << plot.name << ".png'\n"
          << "set grid lc 'gray80'\n"
          << "set key outside " << (longest_title > 20 ? "below" : "right top")
          << "\n"
          << "set xlabel " << quoted(plot.x_label) << '\n'
          << "set ylabel " << quoted(plot.y_label) << '\n';
      for (const auto &[axis, is_log] :
           {std::make_pair("x", plot.log_x), std::make_pair("y", plot.log_y)})
        if (is_log)
          out << "set logscale " << axis << "\nset format " << axis
              << " '10^{%L}'\n";
      // More than gnuplot's own colours: the rainbow in the order of the
      // curves.
      const auto n_of_their_own =
        std::count_if(plot.curves.begin(),
                      plot.curves.end(),
                      [](const Curve &curve) {
                        return !curve.belongs_to_previous;
                      });
      if (n_of_their_own > n_colours)
        out << "set palette rgbformulae 33,13,10\nunset colorbox\n";
      unsigned int colour = 0;
      for (std::size_t i = 0; i < plot.curves.size(); ++i)
        {
          const Curve &curve = plot.curves[i];
          if (!curve.belongs_to_previous)
            ++colour;
          out << (i == 0 ? "plot " : ", \\\n     ") << "'" << plot.name
              << ".dat' index " << i << " with " << curve.style << " lc ";
          if (n_of_their_own > n_colours)
            out << "palette frac "
                << (colour - 1.) / static_cast<double>(n_of_their_own - 1);
          else
            out << colour;
          if (curve.style == "points")
            out << " pt 7 ps 0.7";
          else
            out << " lw 1.5 dt " << (curve.belongs_to_previous ? 2 : 1);
          out << " title " << quoted(curve.title);
        }
      out
        << "\nset terminal svg size 960,540 dynamic font 'sans,11' background "
           "rgb 'white'\n"
        << "set output '" << plot.name << ".svg'\nreplot\n";
    }
  } // namespace



  std::vector<std::string>
  plot_files(const std::vector<std::string> &names)
  {
    std::vector<std::string> files;
    for (const std::string &name : names)
      for (const char *ending : {".dat", ".gp", ".png", ".svg", ".log"})
        files.push_back(name + ending);
    return files;
  }



  bool
  has_points(const Plot &plot)
  {
    for (const Curve &curve : plot.curves)
      for (const auto &point : curve.points)
        if (is_drawn(plot, point))
          return true;
    return false;
  }



  void
  write_gnuplot(const Plot &plot, const std::string &directory)
  {
    const std::string path = directory + "/" + plot.name;
    write_atomically(path + ".dat",
                     [&](std::ostream &out) { write_data(plot, out); });
    write_atomically(path + ".gp",
                     [&](std::ostream &out) { write_script(plot, out); });
  }



  std::string
  run_gnuplot(const Plot &plot, const std::string &directory)
  {
    const std::string path            = directory + "/" + plot.name;
    const auto        remove_pictures = [&path]() {
      std::filesystem::remove(path + ".png");
      std::filesystem::remove(path + ".svg");
    };
    // What an earlier run drew must not stand beside new data.
    remove_pictures();
    ChildProcess      gnuplot({"gnuplot", plot.name + ".gp"},
                         path + ".log",
                         directory);
    const std::string ending = gnuplot.wait();
    if (ending.empty())
      {
        std::filesystem::remove(path + ".log");
        return "";
      }
    // Gnuplot draws into the file itself.
    remove_pictures();
    if (ending == "exit code 127")
      return "gnuplot is not installed";
    return "gnuplot ended with " + ending + ", see " + path + ".log";
  }
} // namespace Debond
