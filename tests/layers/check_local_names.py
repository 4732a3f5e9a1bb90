#!/usr/bin/env python3
"""Fails where two source files of one folder have a local function of the same name.

A folder's files are compiled in batches as one unit, in which equal names in unnamed namespaces
become overloads: a call may then take the other file's function without a word.
Usage: check_local_names.py SOURCE_ROOT
"""

import collections
import pathlib
import re
import subprocess
import sys

# The program of a shader, in a raw string.
SHADER_ENTRY = "main"
NO_FUNCTION = r"(?=[A-Za-z])(?!(using|struct|class|enum|namespace|template|return|static_assert|[A-Z_]+\())"
FUNCTION = re.compile(rf"^{NO_FUNCTION}[\w:<>,&*\[\] ]+?[ &*](\w+)\(")


def local_functions(lines):
    inside = False
    for line in lines:
        if line.startswith("namespace {"):
            inside = True
        elif line.startswith("}  // namespace\n"):
            inside = False
        elif inside and (match := FUNCTION.match(line)) and match.group(2) != SHADER_ENTRY:
            yield match.group(2)


def main():
    root = pathlib.Path(sys.argv[1])
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-co", "--exclude-standard",
                             "*.cpp"], capture_output=True, text=True, check=True).stdout.split()
    files = [root / name for name in listed if (root / name).exists()]
    if not files:
        sys.exit(f"{root}: no source files found")
    homes = collections.defaultdict(set)
    for file in files:
        with open(file, encoding="utf-8") as lines:
            for name in local_functions(lines):
                homes[file.parent.relative_to(root), name].add(file.name)
    twice = {place: names for place, names in homes.items() if len(names) > 1}
    for (folder, name), names in sorted(twice.items()):
        print(f"{folder}: {name} is a local function of {', '.join(sorted(names))}")
    sys.exit(1 if twice else 0)


if __name__ == "__main__":
    main()
