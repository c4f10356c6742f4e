# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes and studies as text: reading .prm files, and writing those of cases."""

import os
import re


class BadInput(Exception):
    """What is wrong with what the user wrote."""


def read(path, entries=None, places=None):
    """The values of a file by 'Section/Entry', with what it includes, and in
    `places` where each is. Which entries there are is for others to say."""
    entries = {} if entries is None else entries
    places = {} if places is None else places
    try:
        with open(path, encoding="utf-8-sig") as file:
            lines = file.read().splitlines()
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    sections, text, begin = [], "", 1
    for number_of_line, line in enumerate(lines, 1):
        text += line.strip()
        if text.endswith("\\"):
            text = text[:-1]
            continue
        words = text.partition("#")[0].strip()
        where, text, begin = f"{path}:{begin}", "", number_of_line + 1
        keyword, _, rest = words.partition(" ")
        rest = rest.strip()
        if keyword == "subsection" and rest:
            sections.append(rest)
        elif keyword == "end" and not rest and sections:
            sections.pop()
        elif keyword == "set" and "=" in rest:
            name, _, value = rest.partition("=")
            entry = "/".join([*sections, name.strip()])
            entries[entry], places[entry] = value.strip(), where
        elif keyword == "include" and rest and not sections:
            read(os.path.join(os.path.dirname(path), rest), entries, places)
        elif words:
            raise BadInput(f"{where}: cannot read '{words}'")
    if sections or text:
        raise BadInput(f"{path}: {'/'.join(sections)} is not closed by 'end'")
    return entries


def items(text, separator="|"):
    """Those of 'a | b | c'. A separator counts only with blanks around it,
    since expressions may contain '||' and '&&'."""
    return [item.strip() for item in re.split(
        rf"\s{re.escape(separator)}(?=\s|$)", text)] if text.strip() else []


def pairs(text):
    """The settings in 'A/B = 1 | C = 2'."""
    result = {}
    for item in items(text):
        name, equals, value = item.partition("=")
        if not equals:
            raise ValueError(f"'{item}' has no '='")
        result[name.strip()] = value.strip()
    return result


def number(text):
    """A float, or None for what is none."""
    try:
        return float(text)
    except ValueError:
        return None


def scene_text(scene, settings, directory):
    """A scene with other values, as a file in a directory."""
    scene = os.path.abspath(scene)
    lines = [f"include {os.path.relpath(scene, os.path.abspath(directory))}"]
    mesh = settings.get("Mesh/File", read(scene).get("Mesh/File", ""))
    if mesh:  # which the program looks for beside the file that it is given
        mesh = {"Mesh/File": os.path.join(os.path.dirname(scene), mesh)}
    for path, value in {**settings, **(mesh or {})}.items():
        *sections, name = path.split("/")
        lines += ([f"subsection {section}" for section in sections] +
                  [f"set {name} = {value}"] + ["end"] * len(sections))
    return "\n".join(lines) + "\n"
