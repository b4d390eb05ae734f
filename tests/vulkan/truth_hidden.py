#!/usr/bin/env python3
"""Fails when the tests and scenes that truth.txt names for a feature do not notice that devices lack it.

usage: truth_hidden.py TABLE LAYERS PROGRAM... [--only FEATURE...] [--all]

TABLE    tests/vulkan/truth.txt
LAYERS   the folder of VK_LAYER_VERNIER_hiding (hiding_layer.cpp), which hides one feature from what devices are made with
PROGRAM  GoogleTest programs that use the driver; evidence in others does not count here
--all    tries all evidence of a feature, not only until the first that notices, and lists what notices

Each row's evidence runs with the row's feature hidden. It notices if it fails, or makes the validation layer complain of
anything but the device's making (features that ask for the hidden one); where none does, once more without the validation
layer, for tests that then have more to see. Rows marked `silent` must have evidence that does not notice.
Before that all evidence runs with nothing hidden: what does not pass then, or is skipped, does not count.
"""
import argparse
import collections
import concurrent.futures
import os
import re
import subprocess
import sys

LAYERS = {"validated": "VK_LAYER_VERNIER_hiding:VK_LAYER_KHRONOS_validation", "alone": "VK_LAYER_VERNIER_hiding"}
OF_MAKING_DEVICES = re.compile(r"VUID-(VkDeviceCreateInfo|vkCreateDevice|VkPhysicalDevice\w*)-")
SECONDS = 300  # for one process

Row = collections.namedtuple("Row", "feature evidence silent")


def rows_of(table):
    for line in open(table, encoding="utf-8"):
        columns = [column.strip() for column in line.split("|")]
        if columns[0].startswith("feature "):
            yield Row(columns[0].split()[1], [one.strip() for one in columns[1].split(",")], len(columns) > 2)


def tests_of(programs):
    """Evidence as truth.txt has it, to program and full name of the test."""
    found = {}
    for program in programs:
        listed = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
        for line in listed.splitlines():
            name = line.split("#")[0].strip()
            if not line.startswith(" "):
                suite = name
            elif suite == "Scenes/DriverBits.":
                found["scene " + name.split("/")[1]] = (program, suite + name)
            else:
                found[suite + name] = (program, suite + name)
    return found


def run(program, names, layers, feature, folder):
    """What became of each of these tests: `passed`, `skipped`, or what was wrong."""
    environment = dict(os.environ, VK_INSTANCE_LAYERS=LAYERS[layers], VK_ADD_LAYER_PATH=folder,
                       VERNIER_HIDDEN_FEATURE=feature)
    try:
        done = subprocess.run([program, "--gtest_filter=" + ":".join(names)], env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=SECONDS, text=True, errors="replace")
    except subprocess.TimeoutExpired:
        sys.exit("%s: %s takes more than %d s with %s hidden" % (program, ":".join(names), SECONDS, feature or "nothing"))
    outcomes = {}
    # Each test's output, up to the next.
    for part in done.stdout.split("[ RUN      ] ")[1:]:
        name = part.split("\n", 1)[0].strip()
        wrong = {vuid[0] for vuid in re.finditer(r"VUID[-_][\w-]+", part) if not OF_MAKING_DEVICES.match(vuid[0])}
        for failure in re.split(r": Failure\n", part)[1:]:
            if "VUID" not in failure:
                wrong.add(failure.strip().split("\n")[0])
        ended = re.search(r"\[ +(OK|FAILED|SKIPPED) +\] " + re.escape(name), part)
        if ended is None:
            wrong.add("ended with %d" % done.returncode)
        outcomes[name] = sorted(wrong) or ("skipped" if ended[1] == "SKIPPED" else "passed")
    for name in set(names) - set(outcomes):
        outcomes[name] = ["was not run"]
    return outcomes


class Judge:
    def __init__(self, tests, folder, workers, everything):
        self.tests, self.folder, self.workers, self.everything = tests, folder, workers, everything
        self.unhidden = {}  # by layers and evidence

    def run(self, evidence, layers, feature):
        """The outcomes by evidence, one process for each program."""
        names = collections.defaultdict(list)
        for one in evidence:
            names[self.tests[one][0]].append(one)
        outcomes = {}
        for program, ones in names.items():
            by_name = run(program, [self.tests[one][1] for one in ones], layers, feature, self.folder)
            outcomes.update((one, by_name[self.tests[one][1]]) for one in ones)
        return outcomes

    def run_unhidden(self, rows):
        evidence = sorted({one for row in rows for one in row.evidence if one in self.tests})
        self.unhidden = dict(zip(LAYERS, self.workers.map(lambda layers: self.run(evidence, layers, ""), LAYERS)))
        for layers, outcomes in self.unhidden.items():
            for one, outcome in outcomes.items():
                if isinstance(outcome, list):
                    print("%s (%s) does not count: %s" % (one, layers, "; ".join(outcome)))

    def noticing(self, row):
        """What notices, as evidence to what was wrong."""
        noticed = {}
        for layers in LAYERS:
            left = [one for one in row.evidence if self.unhidden[layers].get(one) == "passed" and one not in noticed]
            outcomes = self.run(left, layers, row.feature)
            noticed.update((one, outcome) for one, outcome in outcomes.items() if outcome != "passed")
            if noticed and not self.everything:
                break
        return noticed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("table")
    parser.add_argument("folder")
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--only", nargs="+")
    parser.add_argument("--all", action="store_true")
    options = parser.parse_args()
    rows = [row for row in rows_of(options.table) if not options.only or row.feature in options.only]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        judge = Judge(tests_of(options.programs), options.folder, workers, options.all)
        judge.run_unhidden(rows)
        good, counts = True, collections.Counter()
        for row, noticed in zip(rows, workers.map(judge.noticing, rows)):
            counts["noticed" if noticed else "silent"] += 1
            if bool(noticed) == row.silent:
                good = False
                print("%s: %s" % (row.feature, "marked as silent, but noticed" if noticed else
                                  "nothing notices that it is hidden: " + ", ".join(row.evidence)))
            if options.all or (noticed and row.silent):
                for one in row.evidence:
                    print("  %s, %s: %s" % (row.feature, one, "; ".join(noticed.get(one, ["does not notice"]))))
    print("%d features: %d noticed, %d silent" % (len(rows), counts["noticed"], counts["silent"]))
    sys.exit(0 if good and rows else 1)


main()
