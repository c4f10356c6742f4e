# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m debond COMMAND ...: what scripts/COMMAND does."""

import importlib
import sys

MODULES = {"study": "report", "picture": "picture", "paper": "paper",
           "benchmarks": "benchmarks"}
command = sys.argv.pop(1) if len(sys.argv) > 1 else None
if command not in MODULES:
    sys.exit("python3 -m debond COMMAND ...: COMMAND is " + ", ".join(MODULES))
sys.exit(importlib.import_module("debond." + MODULES[command]).main())
