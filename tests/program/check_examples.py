#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_examples.py DEBOND FILE.md...: does what the documents show.

A comment before an indented block of a document says what the block is:

  <!-- example: file NAME -->      its lines are the file NAME
  <!-- example: run -->            its lines are commands, which have to succeed
  <!-- example: printed -->        its lines were printed by the last commands,
                                   in this order
  <!-- example: not run: WHY -->   commands that are left to the reader

and without a block

  <!-- example: run COMMAND -->    is a command beside the text
  <!-- example: prints TEXT -->    a line that the last commands printed has TEXT

Every block with a command of the program or of Python needs one of them. Words are compared
to the letter, numbers to their printed digits, those below 1e-8 only by size:
they are rounding.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

MARK = re.compile(r"<!-- example: (.*?) -->")
COMMAND = re.compile(r"scripts/(run|python|fit)|^(\S*/)?debond\b")
SCRIPTS = {"scripts/run": "debond", "scripts/python": "/usr/bin/python3",
           "scripts/study": "/usr/bin/python3 -m debond study",
           "scripts/fit": "/usr/bin/python3 -m debond fit",
           "scripts/picture": "/usr/bin/python3 -m debond picture"}
NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?$")
ROUNDING = 1e-8


def equal(shown, printed):
    """Whether two words are equal, as numbers to the digits of the first."""
    shown_number, printed_number = (
        NUMBER.match(word.strip("(),[]")) for word in (shown, printed))
    if not (shown_number and printed_number):
        return shown == printed
    text, x, y = (shown_number.group(), float(shown_number.group()),
                  float(printed_number.group()))
    if abs(x) < ROUNDING and abs(y) < ROUNDING:
        return True
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    unit = 10.0 ** (int(exponent or 0) - decimals)
    return abs(x - y) <= (1.5 * unit if decimals else 0.0)


def line_has(line, text):
    """Whether the words of a text stand side by side in a line."""
    line, text = line.split(), text.split()
    return any(
        all(equal(a, b) for a, b in zip(text, line[k:k + len(text)]))
        for k in range(len(line) - len(text) + 1))


class Document:
    def __init__(self, path, debond, root, directory):
        self.path = path
        self.debond = debond
        self.environment = {
            **os.environ, "DEBOND": str(debond), "MPLBACKEND": "Agg",
            "PYTHONPATH": str(root / "scripts")}
        self.directory = directory
        self.output = ""
        self.mark = None
        self.faults = []
        for name in ("prm", "doc", "scripts"):
            (directory / name).symlink_to(root / name)

    def fault(self, number, text):
        self.faults.append(f"{self.path.name}:{number}: {text}")

    def run(self, number, commands):
        for script, command in SCRIPTS.items():
            commands = re.sub(rf"{script}\b", command, commands)
        result = subprocess.run(
            ["bash", "-euc",
             f'debond() {{ "{self.debond}" "$@"; }}\n{commands}'],
            cwd=self.directory, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, check=False, env=self.environment)
        self.output = result.stdout
        if result.returncode:
            self.fault(number, f"exit code {result.returncode} of\n{commands}\n"
                       + result.stdout[-2000:])

    def printed(self, number, block):
        lines = iter(self.output.splitlines())
        for text in filter(str.strip, block):
            if not any(line_has(line, text) for line in lines):
                self.fault(number, f"not printed (in this order): {text}\n"
                           + self.output[-4000:])
                return

    def comment(self, number, mark):
        verb, _, rest = mark.partition(" ")
        if verb == "run" and rest:
            self.run(number, rest)
        elif verb == "prints":
            if not any(line_has(line, rest)
                       for line in self.output.splitlines()):
                self.fault(number, f"not printed: {rest}\n"
                           + self.output[-4000:])
        elif verb == "file" or mark in ("run", "printed") or \
                mark.startswith("not run:"):
            self.mark = mark
        else:
            self.fault(number, f"no such example: {mark}")

    def block(self, number, lines):
        mark, self.mark = self.mark, None
        if mark is None:
            if any(COMMAND.search(line) for line in lines):
                self.fault(number, "a command that nothing checks")
        elif mark == "run":
            self.run(number, "\n".join(lines))
        elif mark == "printed":
            self.printed(number, lines)
        elif mark.startswith("file "):
            (self.directory / mark[5:]).write_text("\n".join(lines) + "\n")

    def check(self):
        block, start = [], 0
        lines = self.path.read_text().splitlines() + ["end"]
        for number, line in enumerate(lines, 1):
            if line.startswith("    "):
                start = start or number
                block.append(line[4:])
            elif block and not line.strip():
                block.append("")
            else:
                if block:
                    self.block(start, block)
                    block, start = [], 0
                found = MARK.search(line)
                if found:
                    self.comment(number, found.group(1))
        return self.faults


def main():
    debond = pathlib.Path(sys.argv[1]).resolve()
    root = pathlib.Path(__file__).resolve().parents[2]
    faults = []
    for name in sys.argv[2:]:
        with tempfile.TemporaryDirectory() as directory:
            faults += Document(pathlib.Path(name).resolve(), debond, root,
                               pathlib.Path(directory)).check()
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
