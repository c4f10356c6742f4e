# SPDX-License-Identifier: LGPL-2.1-or-later
"""Studies and pictures; installs what they need if it is missing."""
import os
import subprocess

subprocess.run([os.path.join(os.path.dirname(__file__), "../install"),
                "python3-numpy", "python3-matplotlib", "python3-meshio"],
               check=True)
