// SPDX-License-Identifier: LGPL-2.1-or-later
// Iterations as they come, in a log and on a terminal.

#include <debond/solve/minimum/progress.h>

#include <algorithm>
#include <iostream>
#include <sstream>

#include "../check.h"

using namespace Debond;

namespace
{
  void
  test_progress()
  {
    BundleIteration iteration = {
      0, -5.7774619650983e-4, -1.25e-8, 1., 1., 0, 0, StepKind::short_step};
    Progress log({&std::cout});
    for (unsigned int k = 1; k <= 23; ++k)
      {
        iteration.iteration   = k;
        iteration.bundle_size = k;
        log.report(iteration);
      }
    log.finish();
    log.finish();

    section("Progress on a terminal");
    std::ostringstream screen;
    Progress           terminal({&screen, true});
    for (unsigned int k = 1; k <= 1000; ++k)
      {
        iteration.iteration = k;
        terminal.report(iteration);
      }
    terminal.finish();
    const std::string text     = screen.str();
    const auto        rewrites = std::count(text.begin(), text.end(), '\r');
    check("it is rewritten a few times only", rewrites >= 2 && rewrites <= 10);
    check("the line is ended once, with the last iteration",
          std::count(text.begin(), text.end(), '\n') == 2 &&
            text.back() == '\n' && text.rfind("1000 ") > text.rfind('\r'));

    std::ostringstream silent;
    Progress({&silent, true}).finish();
    check("nothing is printed without an iteration", silent.str().empty());
  }
} // namespace



int
main()
{
  test_progress();
}
