#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the rules of docs/contributing.md for the includes of core/."""

import pathlib
import re
import sys

CORE = pathlib.Path(__file__).resolve().parent.parent / "core"


def sources_in_order():
    """The paths in core_sources without ending, relative to core/."""
    text = (CORE / "meson.build").read_text()
    block = re.search(r"core_sources = files\((.*?)\)", text, re.DOTALL).group(1)
    return re.findall(r"'([\w/]+)\.cpp'", block)


def violations(rank):
    for path in sorted(CORE.rglob("*.[ch]pp")):
        name = path.relative_to(CORE).with_suffix("").as_posix()
        for include in re.findall(r'^#include ["<]([\w./-]+)[">]', path.read_text(), re.MULTILINE):
            if re.match(r"(glib|gst|gio)\b", include):
                yield f"{path}: includes {include}"
            other = include.removeprefix("core/").removesuffix(".hpp")
            is_later = rank.get(other, -1) > rank.get(name, len(rank))
            is_beside = path.suffix == ".cpp" and pathlib.Path(other).parent == pathlib.Path(name).parent
            if is_later and not is_beside:
                yield f"{path}: includes {include}, which is listed below it in core/meson.build"


def main():
    rank = {name: i for i, name in enumerate(sources_in_order())}
    found = list(violations(rank))
    print("\n".join(found) or f"{len(rank)} sources in order")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
