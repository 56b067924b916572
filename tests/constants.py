#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The named numeric constants of core/, without core/scene/.

    tests/constants.py check TABLE
        Fails unless the table in a Markdown file lists all of them with their values.
    tests/constants.py vary [--names REGEX] [--methods METHOD,...] [--out FILE] DATASET...
        Builds a copy in build-sensitivity that reads constants from the environment, changes one at
        a time by 30 % (a count by at least 1), and judges data sets with ellipse-evaluate. Prints
        rows of that table: file, constant, value, and the largest change of F1 (or of the share of
        frames without a false target) at -30 % and at +30 %. Constants in array sizes, templates and
        other constant expressions are not varied.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = PROJECT / "build-sensitivity"
SOURCE = FOLDER / "source"
BUILD = FOLDER / "build"
MAX_ROUNDS = 30

DEFINITION = re.compile(
    r"^(?P<indent> *)(?P<static>(?:inline |static )?)constexpr "
    r"(?P<type>double|float|int|unsigned|std::size_t|std::ptrdiff_t|std::int64_t) "
    r"(?P<name>k\w+) =\s+(?P<value>[^;{]+);", re.MULTILINE)

KNOB = """#pragma once
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <type_traits>
namespace ellipse {
// The value, multiplied by FACTOR if the environment has ELLIPSE_KNOB=NAME=FACTOR.
template <class T>
T knob(const char* name, T value) {
  const char* setting = std::getenv("ELLIPSE_KNOB");
  const char* equals = setting != nullptr ? std::strchr(setting, '=') : nullptr;
  if (equals == nullptr || std::strlen(name) != static_cast<std::size_t>(equals - setting) ||
      std::strncmp(setting, name, std::strlen(name)) != 0) {
    return value;
  }
  const double factor = std::atof(equals + 1);
  const double changed = static_cast<double>(value) * factor;
  if constexpr (std::is_integral_v<T>) {
    const double rounded = std::round(changed);
    if (rounded == static_cast<double>(value)) return static_cast<T>(value + (factor > 1.0 ? 1 : -1));
    return static_cast<T>(rounded);
  }
  return static_cast<T>(changed);
}
}  // namespace ellipse
"""


class Constant:
    def __init__(self, file, match):
        self.file = file
        self.name = match["name"]
        self.value = " ".join(match["value"].split())
        self.is_fixed = False

    @property
    def key(self):
        return f"{self.file}:{self.name}"


def core_files():
    names = (str(path.relative_to(PROJECT)) for path in PROJECT.glob("core/**/*.[ch]pp"))
    return sorted(name for name in names if not name.startswith("core/scene/"))


def find_constants(files):
    return [Constant(file, match) for file in files
            for match in DEFINITION.finditer((PROJECT / file).read_text())]


def transformed(file, constants):
    """The text of a file in which varied constants are read from the environment."""
    varied = {c.name for c in constants if c.file == file and not c.is_fixed}
    if not varied:
        return (PROJECT / file).read_text()

    def replace(match):
        if match["name"] not in varied:
            return match[0]
        kind = {"": "const", "inline ": "inline const", "static ": "static inline const"}
        return (f"{match['indent']}{kind[match['static']]} {match['type']} {match['name']} = "
                f"ellipse::knob<{match['type']}>(\"{file}:{match['name']}\", {match['value']});")

    text = DEFINITION.sub(replace, (PROJECT / file).read_text())
    first, rest = text.split("\n", 1)
    return f'{first}\n#include "core/knob.hpp"\n{rest}'


def write(files, constants):
    for file in files:
        text = transformed(file, constants)
        target = SOURCE / file
        if not target.exists() or target.read_text() != text:
            target.write_text(text)


def fix_what_fails(output, constants):
    """Fixes the constants on lines that do not compile. @return their number."""
    count = 0
    for file, line in set(re.findall(r"(core/[\w/]+\.[ch]pp):(\d+):\d+: error", output)):
        text = (SOURCE / file).read_text().split("\n")[int(line) - 1]
        names = set(re.findall(r"\bk\w+", text))
        for name in re.findall(r"value of ‘(?:\w+::|\(anonymous namespace\)::)*(k\w+)’", output):
            names.add(name)
        for constant in constants:
            if constant.name in names and not constant.is_fixed:
                constant.is_fixed = True
                count += 1
    return count


def fix_as_before(constants):
    """Fixes the constants that an earlier copy left unvaried, which saves failed builds."""
    for constant in constants:
        copy = SOURCE / constant.file
        if copy.exists():
            constant.is_fixed = f"constexpr {constant.name} =" in re.sub(
                r"constexpr [\w:]+ (?=k)", "constexpr ", copy.read_text())


def build(files, constants):
    fix_as_before(constants)
    tracked = subprocess.run([PROJECT / "examples/packaging/list_files.sh"], check=True,
                             capture_output=True).stdout
    SOURCE.mkdir(parents=True, exist_ok=True)
    for name in tracked.decode().split("\0"):
        if name and name not in files:
            (SOURCE / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(PROJECT / name, SOURCE / name)
    (SOURCE / "core/knob.hpp").write_text(KNOB)
    for file in files:
        (SOURCE / file).parent.mkdir(parents=True, exist_ok=True)
    for _ in range(MAX_ROUNDS):
        write(files, constants)
        if not (BUILD / "build.ninja").exists():
            subprocess.run(["meson", "setup", BUILD, SOURCE, "-Dtests=disabled", "-Dlive=disabled"],
                           check=True, stdout=subprocess.DEVNULL)
        result = subprocess.run(["ninja", "-C", BUILD, "-k", "0", "examples/ellipse-evaluate"],
                                capture_output=True, text=True)
        if result.returncode == 0:
            return
        if fix_what_fails(result.stdout, constants) == 0:
            sys.exit("constants.py: the copy does not compile:\n" + result.stdout[-3000:] + result.stderr)
    sys.exit("constants.py: the copy does not compile after many attempts")


def grades(arguments, knob=None):
    """F1, or the share of frames without a false target, by data set and method."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        environment = dict(os.environ, LD_LIBRARY_PATH=str(BUILD / "core"))
        if knob:
            environment["ELLIPSE_KNOB"] = knob
        result = subprocess.run(
            [BUILD / "examples/ellipse-evaluate", *arguments.dataset, "--methods", arguments.methods,
             "--json", out.name], env=environment, capture_output=True, text=True)
        if result.returncode != 0:
            return None
        return {(row["dataset"], row["method"]): row["grade"] for row in json.load(out)["sources"]}


def largest_change(before, after):
    if after is None:
        return "fails"
    changes = {key: after[key] - before[key] for key in before if after.get(key) is not None}
    key = max(changes, key=lambda k: abs(changes[k]))
    if abs(changes[key]) < 0.0005:
        return "-"
    return f"{changes[key]:+.3f} {key[0]} {key[1]}"


def vary(arguments):
    files = core_files()
    constants = find_constants(files)
    build(files, constants)
    before = grades(arguments)
    if before is None:
        sys.exit("constants.py: ellipse-evaluate fails without any change")
    chosen = [c for c in constants if re.search(arguments.names, c.key)]

    def row(constant):
        if constant.is_fixed:
            return [constant.file, constant.name, constant.value, "not varied", ""]
        changes = [largest_change(before, grades(arguments, f"{constant.key}={factor}"))
                   for factor in (0.7, 1.3)]
        return [constant.file, constant.name, constant.value, *changes]

    print("| file | constant | value | -30 % | +30 % |\n|---|---|---|---|---|", file=arguments.out)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for cells in pool.map(row, chosen):
            print("| " + " | ".join(cells) + " |", file=arguments.out, flush=True)


def sentences_of(text):
    """The sentences of the document that count rows of its table."""
    rows = [[cell.strip() for cell in line.split(" | ")] for line in text.splitlines() if "` | `k" in line]
    sources = [row[4] for row in rows]
    varied = [row for row in rows if row[-1].rstrip(" |") not in ("fixed", "n/a", "not varied")]
    idle = [row for row in varied if row[-2] == "-" and row[-1].rstrip(" |") == "-"]
    chosen = sum(row[4].startswith(("experiment", "calibrated")) for row in idle)
    undocumented = sum("not documented" in source for source in sources)
    return [
        f"{len(idle)} of the {len(varied)} varied constants show no effect, among them {chosen} that were chosen",
        f"For {undocumented} constants no document shows the choice",
    ]


def check(arguments):
    """Compares rows "| `file` | `kName` | value | ..." with the code, in any order, and with the text."""
    text = arguments.table.read()
    rows = re.findall(r"^\| `([\w/.]+)` \| `(k\w+)` \| ([^|]+) \|", text, re.MULTILINE)
    missing = [sentence for sentence in sentences_of(text) if sentence not in text]
    listed = {f"{file} {name} = {value.strip()}" for file, name, value in rows}
    actual = {f"{c.file.removeprefix('core/')} {c.name} = {c.value}" for c in find_constants(core_files())}
    for line in sorted(actual - listed):
        print("constants.py: not in the table:", line)
    for line in sorted(listed - actual):
        print("constants.py: not in core/:", line)
    for sentence in missing:
        print("constants.py: the text should say:", sentence)
    print(f"{len(actual)} constants")
    return listed != actual or bool(missing)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    commands = parser.add_subparsers(required=True)
    checking = commands.add_parser("check")
    checking.add_argument("table", type=argparse.FileType())
    checking.set_defaults(run=check)
    varying = commands.add_parser("vary")
    varying.add_argument("dataset", nargs="+", metavar="DATASET")
    varying.add_argument("--names", default="", help="only constants FILE:NAME that match")
    varying.add_argument("--methods", default="arcs+none,arcs+edges")
    varying.add_argument("--out", type=argparse.FileType("w"), default=sys.stdout)
    varying.set_defaults(run=vary)
    arguments = parser.parse_args()
    return arguments.run(arguments)


if __name__ == "__main__":
    sys.exit(main())
