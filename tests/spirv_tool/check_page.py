"""Runs the commands that a page shows and compares what they print with what the page says they do.

usage: check_page.py PAGE PROGRAM FOLDER [--update]

A command is a fenced block whose first line begins with "$ "; the lines below it are what it prints. A line of three dots
at the beginning or at the end stands for any number of lines. Commands run in FOLDER with PROGRAM in place of its name.
With --update the page is changed to what they print.
"""
import difflib
import os
import subprocess
import sys

DOTS = "..."


def shown_commands(lines):
    """The first and one past the last line of every block that shows a command."""
    first = None
    for number, line in enumerate(lines):
        if not line.startswith("```"):
            continue
        if first is None:
            first = number + 1
            continue
        if lines[first].startswith("$ "):
            yield first, number
        first = None


def shortened(printed, expected):
    """What is printed, without the lines that the page leaves out."""
    count = len(expected) - 1
    if expected and expected[0] == DOTS and len(printed) >= count:
        return [DOTS] + printed[len(printed) - count:]
    if expected and expected[-1] == DOTS and len(printed) >= count:
        return printed[:count] + [DOTS]
    return printed


def run(command, program, folder):
    """The exit code and the lines printed, without blank ends."""
    path = os.path.dirname(program) + os.pathsep + os.environ["PATH"]
    result = subprocess.run(["sh", "-c", command], cwd=folder, env=dict(os.environ, PATH=path), capture_output=True,
                            text=True)
    sys.stdout.write(result.stderr)
    return result.returncode, [line.rstrip() for line in result.stdout.rstrip().splitlines()]


def main():
    page_path, program, folder = sys.argv[1:4]
    update = sys.argv[4:] == ["--update"]
    with open(page_path, encoding="utf-8") as page:
        lines = page.read().splitlines()
    failures = 0
    blocks = list(shown_commands(lines))
    for first, end in reversed(blocks):
        command, expected = lines[first][2:], lines[first + 1:end]
        if os.path.basename(program) not in command:
            sys.exit(f"line {first + 1}: not a command of {program}: {command}")
        code, printed = run(command, os.path.abspath(program), folder)
        printed = shortened(printed, expected)
        if code != 0 or printed != expected:
            failures += 1
            print(f"$ {command}: exit code {code}")
            print("\n".join(difflib.unified_diff(expected, printed, "on the page", "printed", lineterm="")))
        lines[first + 1:end] = printed
    if update:
        with open(page_path, "w", encoding="utf-8") as page:
            page.write("\n".join(lines) + "\n")
    print(f"{len(blocks)} commands, {failures} not as shown")
    # A page without commands is not the page that is meant.
    return 1 if failures or not blocks else 0


sys.exit(main())
