# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of the program: which there are, whether they are done, and how they
are divided among processes."""

import csv
import fcntl
import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import time

import numpy

from . import prm

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(
    os.path.abspath(__file__))))
PROGRAM = os.path.join(SOURCE, "build", "debond")


def build():
    subprocess.run([os.path.join(SOURCE, "scripts", "build")], check=True)


def read_csv(path):
    """The columns of a table by their titles: arrays of numbers, or lists of
    words where not all are numbers; an empty cell is nan."""
    try:
        with open(path, newline="", encoding="utf8") as file:
            rows = list(csv.reader(line for line in file
                                   if line.strip() and line[0] != "#"))
    except OSError:
        return {}
    columns = {}
    for title, *cells in zip(*rows):
        numbers = [prm.number(cell or "nan") for cell in cells]
        columns[title] = cells if None in numbers else numpy.array(numbers)
    return columns


class Case:
    """One run. `values`: those of the sweeps, by which a table names it;
    `minimum`: the case that has the exact minimum of the same J, if it is
    wanted."""

    def __init__(self, label, values, scene, settings, directory):
        self.label = label
        self.values = values
        self.scene = scene
        self.settings = {**settings, "Output/Directory":
                         os.path.abspath(directory)}
        self.directory = directory
        self.minimum = None
        self.failure = "not run"

    @property
    def file(self):
        return os.path.join(self.directory, "case.prm")

    def text(self, defaults):
        """The scene, with a mark of all that it depends on: of another scene or
        other defaults the results are not those of this case."""
        text = prm.scene_text(self.scene, self.settings, self.directory)
        all_entries = sorted(prm.read(self.scene).items())
        mark = hashlib.sha256(repr((all_entries, defaults)).encode())
        return f"# {mark.hexdigest()}\n{text}"

    def summary(self):
        """summary.json, empty as long as there is none that counts."""
        try:
            with open(os.path.join(self.directory, "summary.json"),
                      encoding="utf8") as file:
                summary = json.load(file)
        except (OSError, ValueError):
            return {}
        return {} if summary.get("status") == "interrupted" else summary

    def status(self):
        return self.summary().get("status") or self.failure

    def table(self, name):
        return read_csv(os.path.join(self.directory, name))

    def parameters(self):
        """The effective scene."""
        return prm.read(os.path.join(self.directory, "parameters.prm"))


class Interrupted(Exception):
    pass


class Progress:
    """How far a study is, and how long the rest takes if the cases that are
    left take as long as the others on average. On a terminal one line that
    changes, else a line for each case."""

    def __init__(self, total, done, jobs):
        self.total, self.done, self.jobs = total, done, jobs
        self.first, self.start = done, time.time()
        self.terminal = sys.stdout.isatty()

    def show(self, text="", end="\n"):
        left = self.total - self.done
        words = f"{self.done} of {self.total} cases done"
        if left and self.done > self.first:
            seconds = ((time.time() - self.start) /
                       (self.done - self.first) * left)
            words += (f", about {seconds:.0f} s left" if seconds < 100 else
                      f", about {seconds / 60:.0f} min left")
        if self.terminal:
            print(f"\r{words:60}", end=end if not left else "", flush=True)
        elif text:
            print(f"{words}; {text}", flush=True)

    def add(self, case):
        self.done += 1
        self.show(f"{case.label}: {case.status()}")


class Process:
    """Several cases, one after the other."""

    def __init__(self, program, cases, log):
        self.cases, self.log = cases, log
        self.left = list(cases)  # that have no results yet
        with open(log, "w", encoding="utf8") as file:
            self.child = subprocess.Popen(
                [program, *(case.file for case in cases)], stdout=file,
                stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                start_new_session=True,  # Ctrl-C is for this program
                env={**os.environ, "OMP_NUM_THREADS": "1",
                     "OPENBLAS_NUM_THREADS": "1"})

    def finished(self):
        """The cases that have become finished since the last call."""
        found = [case for case in self.left if case.summary()]
        self.left = [case for case in self.left if case not in found]
        return found

    def end(self):
        """Gives each case its part of the log and, where it has no results, a
        reason. Returns those that a crash of another one kept from running."""
        with open(self.log, encoding="utf8", errors="replace") as file:
            text = file.read()
        os.remove(self.log)
        parts = re.split(r"^== (.*)\n", text, flags=re.M)
        logs = dict(zip(parts[1::2], parts[2::2]))
        if not logs:
            logs = {self.cases[0].file: text}
        not_begun = []
        for case in self.cases:
            if case.file not in logs:
                not_begun.append(case)
                continue
            log = logs[case.file]
            with open(os.path.join(case.directory, "log"), "w",
                      encoding="utf8") as file:
                file.write(log)
            said = re.findall(r"^debond: (.*)", log, flags=re.M)
            ending = self.child.returncode
            case.failure = (f"ended with {ending}" if ending < 0 else
                            "no results") + (f": {said[-1]}" if said else "")
        return not_begun


def run(program, cases, jobs=None, afresh=False):
    """Runs the cases that are not finished, as many processes at a time as there
    are cores, and returns how many that were. Throws Interrupted after Ctrl-C;
    what is finished then is not run again."""
    defaults = subprocess.run([program, "--print-parameters"], check=True,
                              capture_output=True, text=True).stdout
    waiting = []
    for case in cases:
        text = case.text(defaults)
        try:
            with open(case.file, encoding="utf8") as file:
                same = file.read() == text
        except OSError:
            same = False
        if afresh or not same or not case.summary():
            os.makedirs(case.directory, exist_ok=True)
            for name in ("summary.json", "case.prm"):
                if os.path.exists(os.path.join(case.directory, name)):
                    os.remove(os.path.join(case.directory, name))
            with open(case.file, "w", encoding="utf8") as file:
                file.write(text)
            waiting.append(case)
    jobs = jobs or len(os.sched_getaffinity(0))
    progress = Progress(len(cases), len(cases) - len(waiting), jobs)
    n_run, n_started, running = len(waiting), 0, []
    interrupted = []
    before = [(number, signal.signal(number, lambda *_: interrupted.append(1)))
              for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        while (waiting or running) and not interrupted:
            while waiting and len(running) < jobs:
                # Loading the program takes longer than a small scene, but at
                # the end no process should be left alone with many.
                share = max(1, len(waiting) // (3 * jobs))
                n_started += 1
                running.append(Process(
                    program, waiting[:share],
                    os.path.join(waiting[0].directory, f"log.{n_started}")))
                waiting = waiting[share:]
            time.sleep(0.02)
            for process in list(running):
                ended = process.child.poll() is not None
                for case in process.finished():
                    progress.add(case)
                if ended:
                    running.remove(process)
                    not_begun = process.end()
                    waiting = not_begun + waiting
                    for case in process.left:
                        if case not in not_begun:
                            progress.add(case)
        if interrupted:
            end_all(running)
            raise Interrupted
    finally:
        for number, handler in before:
            signal.signal(number, handler)
        progress.show()
    return n_run


def end_all(running):
    """Gives the cases time to write what they have."""
    for process in running:
        process.child.terminate()
    for process in running:
        try:
            process.child.wait(10)
        except subprocess.TimeoutExpired:
            process.child.kill()
            process.child.wait()
        process.end()


def lock(directory):
    """Keeps others from writing to a directory as long as the file that is
    returned is open."""
    os.makedirs(directory, exist_ok=True)
    file = open(os.path.join(directory, ".lock"), "w", encoding="utf8")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        raise prm.BadInput(f"{directory} is being written by another "
                           "process") from error
    return file
