# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of the program: which there are, whether they are done, and how they
are divided among processes."""

import functools
import hashlib
import os
import re
import signal
import subprocess
import sys
import time

from . import prm
from .runs import SOURCE, program, read_summary


def build(targets="debond"):
    """Builds the program in the source tree, if it is there and $DEBOND is not
    set; returns the program."""
    script = os.path.join(SOURCE, "scripts", "build")
    if os.path.exists(script) and "DEBOND" not in os.environ:
        subprocess.run([script], check=True,
                       env={**os.environ, "DEBOND_TARGETS": targets})
    return program()


@functools.cache
def defaults_of(program):
    return subprocess.run([program, "--print-parameters"], check=True,
                          capture_output=True, text=True).stdout


class Case:
    """One run, `values` those of the sweeps, `minimum` the case with the exact
    minimum of the same J."""

    def __init__(self, label, values, scene, settings, directory):
        self.label, self.values, self.scene = label, values, scene
        self.directory = directory
        self.settings = {**settings,
                         "Output/Directory": os.path.abspath(directory)}
        self.minimum, self.failure = None, "not run"

    def path(self, name="case.prm"):
        return os.path.join(self.directory, name)

    def summary(self):
        """summary.json, empty as long as there is none that counts."""
        summary = read_summary(self.directory)
        return {} if summary.get("status") == "interrupted" else summary

    def status(self):
        return self.summary().get("status") or self.failure

    def prepare(self, defaults, afresh):
        """Writes the scene, with a mark of all that it depends on: of another
        scene or other defaults the results are not those of this case. Returns
        False if they are."""
        mark = repr((sorted(prm.read(self.scene).items()), defaults))
        text = (f"# {hashlib.sha256(mark.encode()).hexdigest()}\n" +
                prm.scene_text(self.scene, self.settings, self.directory))
        if os.path.exists(self.path()) and self.summary() and not afresh:
            with open(self.path(), encoding="utf8") as file:
                if file.read() == text:
                    return False
        os.makedirs(self.directory, exist_ok=True)
        if os.path.exists(self.path("summary.json")):
            os.remove(self.path("summary.json"))
        with open(self.path(), "w", encoding="utf8") as file:
            file.write(text)
        return True


class Process:
    """Several cases, one after the other, in one process of the program."""

    def __init__(self, program, cases):
        self.cases, self.left = cases, list(cases)
        self.log = cases[0].path("log.all")
        with open(self.log, "w", encoding="utf8") as file:
            self.child = subprocess.Popen(
                [program, *(case.path() for case in cases)], stdout=file,
                stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                start_new_session=True,  # Ctrl-C is for this program
                env={"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
                     **os.environ})

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
        logs = dict(zip(parts[1::2], parts[2::2])) or {
            self.cases[0].path(): text}
        code = self.child.returncode
        for case in self.cases:
            log = logs.get(case.path(), "")
            with open(case.path("log"), "w", encoding="utf8") as file:
                file.write(log)
            said = re.findall(r"^debond: (.*)", log, flags=re.M)
            case.failure = ": ".join([f"ended with {code}" if code < 0 else
                                      "no results", *said[-1:]])
        return [case for case in self.cases if case.path() not in logs]


def run(program, cases, jobs=None, afresh=False):
    """Runs the cases that are not finished, as many processes at a time as there
    are cores, and returns how many that were. Throws KeyboardInterrupt after
    Ctrl-C or SIGTERM; what is finished then is not run again."""
    waiting = [case for case in cases if case.prepare(defaults_of(program), afresh)]
    jobs = jobs or len(os.sched_getaffinity(0))
    n_run, n_done, running, signals = len(waiting), 0, [], []
    start = time.time()

    def tell(case):
        """How far this is, and how long the rest takes if it takes as long as
        what is done: on a terminal in one line that changes."""
        left = (time.time() - start) / n_done * (n_run - n_done)
        words = (f"{n_done} of {n_run} cases done, about " +
                 (f"{left:.0f} s" if left < 100 else f"{left / 60:.0f} min") +
                 " left")
        if sys.stdout.isatty():
            end = "\n" if n_done == n_run else ""
            print(f"\r{words:60}", end=end, flush=True)
        else:
            print(f"{words}; {case.label}: {case.status()}", flush=True)

    before = {number: signal.signal(number, lambda *_: signals.append(1))
              for number in (signal.SIGINT, signal.SIGTERM)}
    while (waiting or running) and not signals:
        while waiting and len(running) < jobs:
            # Loading the program takes longer than a small scene: a process gets
            # as many as take two seconds. But at the end none should be left alone
            # with many that take long.
            seconds = jobs * (time.time() - start) / n_done if n_done else 2.
            share = max(1, len(waiting) // (3 * jobs),
                        min(int(2. / seconds), -(-len(waiting) // jobs)))
            running.append(Process(program, waiting[:share]))
            waiting = waiting[share:]
        time.sleep(0.02)
        for process in list(running):
            ended = process.child.poll() is not None
            done = process.finished()
            if ended:
                running.remove(process)
                not_begun = process.end()
                waiting = not_begun + waiting
                done += [case for case in process.left
                         if case not in not_begun]
            for case in done:
                n_done += 1
                tell(case)
    for process in running:
        process.child.terminate()
    for process in running:
        try:  # they write what they have
            process.child.wait(10)
        except subprocess.TimeoutExpired:
            process.child.kill()
            process.child.wait()
        process.end()
    for number, handler in before.items():
        signal.signal(number, handler)
    if signals:
        raise KeyboardInterrupt
    return n_run
