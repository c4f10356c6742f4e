# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m debond COMMAND ...: what scripts/COMMAND does."""

import importlib.util
import sys

MODULES = {"study": "report", "picture": "picture", "fit": "fit", "paper": "paper",
           "benchmarks": "benchmarks", "published": "published"}
# The last three need the source tree, and are not installed.
MODULES = {name: module for name, module in MODULES.items()
           if importlib.util.find_spec("debond." + module)}
command = sys.argv.pop(1) if len(sys.argv) > 1 else None
if command not in MODULES:
    sys.exit("python3 -m debond COMMAND ...: COMMAND is " + ", ".join(MODULES))
sys.exit(importlib.import_module("debond." + MODULES[command]).main())
