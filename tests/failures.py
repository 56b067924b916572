#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the failures of the last `meson test` of a build folder: failures.py BUILD_FOLDER.

Lists each failed test with the messages in gtest's report. For a suite without a report, because it
crashed or does not use gtest, prints the test that was running and the last lines of output.
"""
import json
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

LAST_LINES = 20
LONGEST_LINE = 300


def failed_cases(report):
    """Name and messages of each failed test of one suite."""
    for case in ElementTree.parse(report).iter("testcase"):
        messages = [child.get("message") for child in case if child.tag in ("failure", "error")]
        if messages:
            yield f"{case.get('classname')}.{case.get('name')}", messages


def last_words(suite):
    """The failed and unfinished tests in a suite's output, and its last lines."""
    began = re.findall(r"\[ RUN      \] (\S+)", suite.get("stdout", ""))
    ended = re.findall(r"\[ +(OK|FAILED|SKIPPED) +\] (\S+) \(", suite.get("stdout", ""))
    yield from (f"failed: {case}" for verdict, case in ended if verdict == "FAILED")
    if began and began[-1] not in [case for _, case in ended]:
        yield f"died in {began[-1]}"
    said = suite.get("stderr") or suite.get("stdout", "")
    yield from said.splitlines()[-LAST_LINES:]


def failures(folder):
    with open(folder / "meson-logs" / "testlog.json", encoding="utf-8") as log:
        suites = [json.loads(line) for line in log]
    for suite in suites:
        if suite["result"] in ("OK", "SKIP", "EXPECTEDFAIL"):
            continue
        name = suite["name"].split(" / ")[-1].split(":")[-1]
        report = folder / f"{name}.xml"
        cases = list(failed_cases(report)) if report.exists() else []
        for case, messages in cases or [(suite["result"].lower(), ["\n".join(last_words(suite))])]:
            yield f"FAILED {name}: {case}"
            for message in messages:
                yield "\n".join(f"    {line[:LONGEST_LINE]}" for line in message.splitlines())


if __name__ == "__main__":
    print("\n".join(failures(pathlib.Path(sys.argv[1]))))
