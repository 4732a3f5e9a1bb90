#!/usr/bin/env python3
"""Compares the options of every command with docs/COMMAND_LINE.md, and those that other files use.

Usage: command_line_docs_test.py OVERFLY_BINARY docs/COMMAND_LINE.md [FILE...]

Each option that a command's --help lists must occur in the command's rows of the table of commands or in
the text outside the table, and each option in the first cell of such a row must exist. Every option in a FILE must be one
of some command.
"""

import re
import subprocess
import sys

OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")


def help_of(binary, command):
    done = subprocess.run([binary, *command, "--help"], capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        sys.exit(f"overfly {' '.join(command)} --help ended with {done.returncode}: {done.stderr}")
    return done.stdout


def read_help(text):
    """Options at the beginning of a line, and the names of the subcommands."""
    options, subcommands = set(), []
    in_subcommands = False
    for line in text.splitlines():
        if re.match(r"\S.*:$", line):
            in_subcommands = line == "Subcommands:"
        elif in_subcommands and (name := re.match(r"  (\S+)", line)):
            subcommands.append(name[1])
        elif listed := re.match(r"  (-[^ ]+)", line):
            options.update(OPTION.findall(listed[1].replace(",", " ")))
    return options - {"--help"}, subcommands


def commands_of(binary, command=()):
    options, subcommands = read_help(help_of(binary, command))
    yield command, options
    for name in subcommands:
        yield from commands_of(binary, (*command, name))


def main():
    binary, document, *users = sys.argv[1:]
    with open(document, encoding="utf-8") as file:
        lines = file.read().splitlines()
    rows = [line for line in lines if line.startswith("| `overfly ")]
    in_prose = set(OPTION.findall("\n".join(line for line in lines if line not in rows)))
    commands = dict(commands_of(binary))
    problems = []
    rows_of = {command: [] for command in commands}
    for row in rows:
        # The longest command that the row begins with: "world build" before "world".
        words = tuple(re.match(r"\| `overfly ([a-z -]*[a-z])", row)[1].split())
        command = max((words[:n] for n in range(1, len(words) + 1) if words[:n] in commands),
                      key=len, default=None)
        if command is None:
            problems.append(f"{document} lists an unknown command: {row[:60]}")
        else:
            rows_of[command].append(row)
    for command, options in commands.items():
        name = " ".join(("overfly", *command))
        # The first cell is the usage; the second may name options of other commands too.
        usage = set()
        for row in rows_of[command]:
            usage.update(OPTION.findall(row.replace("\\|", " ").split(" | ")[0]))
        described = in_prose.union(*(OPTION.findall(row) for row in rows_of[command]))
        problems += [f"{name} {option}: is not in {document}"
                     for option in sorted(options - described)]
        if rows_of[command]:
            problems += [f"{name} {option}: is in {document} but not in --help"
                         for option in sorted(usage - options)]
    every = set().union(*commands.values())
    for user in users:
        with open(user, encoding="utf-8") as file:
            problems += [f"{user} uses {option}, which no command has"
                         for option in sorted(set(OPTION.findall(file.read())) - every)]
    print("\n".join(problems) or f"{document} has every option of {len(commands)} commands")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
