#!/usr/bin/env python3
"""Fails where two source files of one CMake target have a local name in common, or a local constant
or type has the name of one that a header of the target declares in the same namespace.

The sources of a target are compiled in batches, several files as one translation unit, in which
equal functions of unnamed namespaces become overloads: a call may then take the other file's
function without a warning. Equal constants and types fail only in those batches that hold both,
or the header.
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
CONSTANT = re.compile(r"^(?:static |inline )?(?:constexpr|const) [\w:<>,&*\[\] ]*?[ &*](k[A-Z]\w*)(?=\s*[=({\[;])")
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


NAMESPACE = re.compile(r"^namespace (\w[\w:]*) {")


def namespace_of(lines):
    """The first one that is opened; None if there is none."""
    return next((match.group(1) for line in lines if (match := NAMESPACE.match(line))), None)


def declared_names(lines):
    """Namespace, name and kind of each constant and type of a header."""
    opened = []
    for line in lines:
        if match := NAMESPACE.match(line):
            opened.append(match.group(1))
        elif line.startswith("}  // namespace ") and opened:
            opened.pop()
        for pattern, kind in ((CONSTANT, "constant"), (TYPE, "type")):
            if match := pattern.match(line):
                yield "::".join(opened), match.group(1), kind


def target_of(file, root):
    """The nearest folder above with a CMakeLists.txt."""
    target = next(folder for folder in file.parents if (folder / "CMakeLists.txt").exists())
    return file.parent if target.relative_to(root).as_posix() in TARGET_PER_FOLDER else target


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-co", "--exclude-standard",
                             "*.cpp", "*.hpp"], capture_output=True, text=True, check=True).stdout.split()
    files = [root / name for name in listed if (root / name).exists()]
    if not files:
        sys.exit(f"{root}: no source files found")
    homes = collections.defaultdict(set)
    declared = collections.defaultdict(set)
    hidden = []
    # Headers first.
    for file in sorted(files, key=lambda file: file.suffix != ".hpp"):
        target = target_of(file, root)
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
        place = file.relative_to(target).as_posix()
        home = target.relative_to(root)
        if file.suffix == ".hpp":
            for namespace, name, kind in declared_names(lines):
                declared[home, namespace, name, kind].add(place)
            continue
        namespace = namespace_of(lines)
        for name, kind in local_names(lines):
            homes[home, name, kind].add(place)
            for header in declared.get((home, namespace, name, kind), ()):
                hidden.append(f"{home}: {name} is a local {kind} of {place}, and one of {header}")
    twice = {place: names for place, names in homes.items() if len(names) > 1}
    for (target, name, kind), names in sorted(twice.items()):
        print(f"{target}: {name} is a local {kind} of {', '.join(sorted(names))}")
    for text in sorted(hidden):
        print(text)
    sys.exit(1 if twice or hidden else 0)


if __name__ == "__main__":
    main()
