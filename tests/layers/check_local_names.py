#!/usr/bin/env python3
"""Fails where two source files of one CMake target have a local name in common.

The sources of a target are compiled in batches, several files as one translation unit, in which
equal functions of unnamed namespaces become overloads: a call may then take the other file's
function without a warning. Equal constants and types fail only in those batches that hold both.
A target's sources are those below its CMakeLists.txt.
Usage: check_local_names.py SOURCE_ROOT
"""

import collections
import pathlib
import re
import subprocess
import sys

# Folders each of whose sub-folders is a separate target without a CMakeLists.txt.
TARGET_PER_FOLDER = ["tests/server"]
# The program of a shader, in a raw string.
SHADER_ENTRY = "main"
NO_FUNCTION = r"(?=[A-Za-z])(?!(using|struct|class|enum|namespace|template|return|static_assert|[A-Z_]+\())"
FUNCTION = re.compile(rf"^{NO_FUNCTION}[\w:<>,&*\[\] ]+?[ &*](\w+)\(")
CONSTANT = re.compile(r"^(?:static |inline )?(?:constexpr|const) [\w:<>,&*\[\] ]*?[ &*](k[A-Z]\w*)\b")
TYPE = re.compile(r"^(?:struct|class|enum class|enum) (\w+)\b(?!;)")


def local_names(lines):
    inside = False
    for line in lines:
        if line.startswith("namespace {"):
            inside = True
        elif line.startswith("}  // namespace\n"):
            inside = False
        elif inside:
            for pattern, kind in ((CONSTANT, "constant"), (TYPE, "type")):
                if match := pattern.match(line):
                    yield match.group(1), kind
            if (match := FUNCTION.match(line)) and match.group(2) != SHADER_ENTRY:
                yield match.group(2), "function"


def target_of(file, root):
    """The nearest folder above with a CMakeLists.txt."""
    target = next(folder for folder in file.parents if (folder / "CMakeLists.txt").exists())
    return file.parent if target.relative_to(root).as_posix() in TARGET_PER_FOLDER else target


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-co", "--exclude-standard",
                             "*.cpp"], capture_output=True, text=True, check=True).stdout.split()
    files = [root / name for name in listed if (root / name).exists()]
    if not files:
        sys.exit(f"{root}: no source files found")
    homes = collections.defaultdict(set)
    for file in files:
        target = target_of(file, root)
        with open(file, encoding="utf-8") as lines:
            for name, kind in local_names(lines):
                homes[target.relative_to(root), name, kind].add(
                    file.relative_to(target).as_posix())
    twice = {place: names for place, names in homes.items() if len(names) > 1}
    for (target, name, kind), names in sorted(twice.items()):
        print(f"{target}: {name} is a local {kind} of {', '.join(sorted(names))}")
    sys.exit(1 if twice else 0)


if __name__ == "__main__":
    main()
