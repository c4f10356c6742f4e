#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_errors.py DEBOND ERRORS.txt: runs all scenes of the list, whose format
is told in it, in one process, and compares their messages and exit codes."""
import os
import re
import subprocess
import sys
import tempfile


class Case:
    def __init__(self, name, code):
        self.name = name
        self.code = int(code or 2)
        self.mark = "debond: " if self.code else "  note  "
        self.lines = []
        self.messages = []  # number of a line, path of its entry, words
        self.place = (None, "")

    def add_line(self, text, but=()):
        if text.startswith("|"):
            self.lines.append(text[1:])
            self.place = (len(self.lines), "")
            return
        for part in text.split(" | "):
            path, value = part.split("=", 1)
            if path.strip() in but:
                continue
            *sections, entry = path.strip().split("/")
            self.lines += ["subsection " + section for section in sections]
            self.lines.append(f"set {entry} ={value}")
            self.place = (len(self.lines), path.strip())
            self.lines += ["end"] * len(sections)

    def add_message(self, words):
        line, path = (None, "") if words.startswith("! ") else self.place
        words = words.removeprefix("! ")
        if re.match(r"[A-Z][\w ]*/", words):
            path = ""
        self.messages.append((line, path, words))

    def is_message(self, message, text):
        line, path, words = message
        if line and not text.startswith(f"debond: {self.name}.prm:{line}: "):
            return False
        pattern = ".*".join(re.escape(part) for part in words.split("..."))
        return path in text and re.search(pattern.replace(r"\ .*\ ", ".*"), text)


def paths(row):
    return [part.split("=")[0].strip() for part in row.split(" | ")]


def read_cases(file_name):
    """Of "each" the entries with a message are added to the others, or replace them. Files
    beside the scenes are written."""
    cases = []
    for block in re.split(r"^(?=\[)", open(file_name).read(), flags=re.M)[1:]:
        header, *rows = [row for row in block.split("\n") if row and row[0] != "#"]
        if "." in header:
            with open(header.strip("[]"), "w") as file:
                file.write("\n".join(rows) + "\n")
            continue
        name, each, code = re.fullmatch(r"\[(\w+)\]( each)? ?(\d*)", header).groups()
        scenes = [rows]
        if each:
            common = [row for row in rows if "  !" not in row]
            scenes = [[*common, row] for row in rows if "  !" in row]
        for k, scene in enumerate(scenes):
            case = Case(name + f"_{k}" * bool(each), code)
            own = paths(scene[-1]) if each else ()
            for row in scene:
                text, *words = re.split(r"(?:^|  )!(?=!? )", row, 1)
                if text:
                    case.add_line(text, () if row is scene[-1] else own)
                for message in words:
                    case.add_message(message.lstrip(" "))
            cases.append(case)
    return cases


def main(debond, file_name):
    cases = read_cases(file_name)
    for case in cases:
        with open(case.name + ".prm", "w") as scene:
            scene.write("\n".join(case.lines) + "\n")
    log = subprocess.run([debond] + [case.name + ".prm" for case in cases],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                         text=True).stdout
    *logs, codes = re.split(r"^== .*\n|\nexit code  scene\n", log, flags=re.M)[1:]
    codes = dict(reversed(line.split()) for line in codes.strip().split("\n"))

    n_failures = 0
    for case, text in zip(cases, logs, strict=True):
        left = [line for line in text.split("\n") if line.startswith(case.mark)]
        faults = []
        for message in case.messages:
            found = [line for line in left if case.is_message(message, line)]
            if found:
                left.remove(found[0])
            else:
                faults.append(f"no message {message}")
        faults += ["more than expected: " + line for line in left]
        if int(codes[case.name + ".prm"]) != case.code:
            faults.append("exit code " + codes[case.name + ".prm"])
        if case.code == 2 and os.path.exists("output/" + case.name):
            faults.append("files were written")
        n_failures += bool(faults)
        for fault in faults:
            print(f"{case.name}: {fault}")
    written = {name for name in os.listdir() if not name.endswith((".prm", ".geo"))}
    if written - {"output"}:
        print("written:", *written)
        n_failures += 1
    print(f"{len(cases)} scenes, {n_failures} with failures")
    return n_failures > 0


program, errors = map(os.path.abspath, sys.argv[1:])
with tempfile.TemporaryDirectory() as directory:
    os.chdir(directory)
    sys.exit(main(program, errors))
