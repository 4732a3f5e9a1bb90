#!/usr/bin/env python3
"""Fails on an include or a call that docs/ARCHITECTURE.md forbids.

Tables: which rooms a room may include, which rooms are the home of a third-party library (and whether its headers may be reached from
a library of the program without a home of it through the headers that it includes), and calls that only some files may make. No circle of includes may
join units, where a unit is a .cpp with its .hpp.
Usage: check_layers.py SOURCE_ROOT
"""

import collections
import pathlib
import re
import sys

from layer_tables import (
    LIBRARIES, MAY_INCLUDE, WHOLE, PRIVATE, THIRD_PARTY, JSON_IN_HEADERS, CALLS,
)

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def longest_prefix(path, folders):
    return max((f for f in folders if path.startswith(f + "/")), key=len, default=None)


def library_of(path):
    return longest_prefix(path, LIBRARIES)


def room_of(path):
    """The room of a file; of a folder without an entry, that folder, which no room may include."""
    library = library_of(path)
    if library is None or library in WHOLE:
        return library
    return path.rpartition("/")[0]


def project_includes(text):
    for line in text.splitlines():
        match = INCLUDE.match(line)
        if match and match.group(1) == '"':
            yield match.group(2)


def headers_seen_from_other_libraries(sources):
    """header -> the other libraries that include it, directly or through headers."""
    seen = collections.defaultdict(set)
    waiting = [(target, library_of(path)) for path, text in sources.items()
               for target in project_includes(text) if library_of(path) and library_of(target)]
    visited = set()
    while waiting:
        header, library = waiting.pop()
        if (header, library) in visited or header not in sources:
            continue
        visited.add((header, library))
        if library_of(header) != library:
            seen[header].add(library)
        waiting += [(target, library) for target in project_includes(sources[header])]
    return seen


def allows(entry, target):
    if entry.endswith("/"):
        return target.startswith(entry)
    return target == entry or room_of(target) == entry


def fault_of_project_include(path, room, target):
    for private in PRIVATE:
        if target.startswith(private) and library_of(path) != library_of(target):
            return f"{private} is private to {library_of(target)}"
    if room not in MAY_INCLUDE:
        return f"{room} is a folder without an entry in this test's table"
    if room_of(target) == room or any(allows(entry, target) for entry in MAY_INCLUDE[room]):
        return None
    return f"{room} may not include {target}"


def circles(sources):
    """Units that include each other, directly or by others: each a sorted list of paths without
    extension (the strongly connected components, Tarjan 1972)."""
    unit_of = {path: path.rpartition(".")[0] for path in sources}
    edges = collections.defaultdict(set)
    for path, text in sources.items():
        edges[unit_of[path]].update(
            unit_of[target] for target in project_includes(text) if target in sources)
    order, low, stack, found = {}, {}, [], []

    def visit(unit):
        order[unit] = low[unit] = len(order)
        stack.append(unit)
        for other in edges[unit]:
            if other not in order:
                visit(other)
                low[unit] = min(low[unit], low[other])
            elif other in stack:
                low[unit] = min(low[unit], order[other])
        if low[unit] == order[unit]:
            place = stack.index(unit)
            if len(stack) - place > 1:
                found.append(sorted(stack[place:]))
            del stack[place:]

    for unit in sorted(set(unit_of.values())):
        if unit not in order:
            visit(unit)
    return found


def faults_of_circles(sources):
    for units in circles(sources):
        yield f"these include each other: {', '.join(units)}"


def fault_of_library_include(path, target, viewers):
    for pattern, rooms, in_headers in THIRD_PARTY:
        if not re.match(pattern, target):
            continue
        if not path.startswith(tuple(home + "/" for home in rooms)):
            return f"{target} is at home in {', '.join(rooms)}"
        if in_headers is None:
            strangers = set() if path.startswith(JSON_IN_HEADERS) else viewers
        else:
            strangers = set() if in_headers else viewers - {library_of(f"{room}/") for room in rooms}
        if strangers:
            return f"{target} leaks into {', '.join(sorted(strangers))}, which include this header"
    return None


def faults_of_calls(path, line):
    for pattern, files, instead in CALLS:
        if re.search(pattern, line) and path not in files:
            yield f"{instead} is the one way to do this"


def faults_of_file(path, text, viewers):
    room = room_of(path)
    if room is None:
        return
    for number, line in enumerate(text.splitlines(), 1):
        for fault in faults_of_calls(path, line):
            yield f"{path}:{number}: {fault}"
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(2)
        if match.group(1) == '"' and library_of(target):
            fault = fault_of_project_include(path, room, target)
        elif match.group(1) == '"' and "/" not in target:
            fault = f'"{target}": project includes are written from the repository root'
        else:
            fault = fault_of_library_include(path, target, viewers)
        if fault:
            yield f"{path}:{number}: {fault}"


def faults_of_tree(sources):
    viewers = headers_seen_from_other_libraries(sources)
    faults = [fault for path, text in sorted(sources.items())
              for fault in faults_of_file(path, text, viewers.get(path, set()))]
    return [*faults, *faults_of_circles(sources)]


def self_test():
    """The checker itself must fail on what is forbidden."""
    forbidden = [
        {"flight/a.cpp": '#include "terrain/world.hpp"'},
        {"renderer/a.cpp": '#include "terrain/world.hpp"'},
        {"terrain/raster/a.cpp": '#include "terrain/place/map_plane.hpp"'},
        {"terrain/new_room/a.cpp": '#include "terrain/world.hpp"'},
        {"odometry/image/a.cpp": '#include "odometry/feature/map/map.hpp"'},
        {"sensor/a.cpp": '#include "renderer/renderer.hpp"'},
        {"odometry/feature/a.cpp": '#include "core/x.hpp"\n#include "flight/flight.hpp"'},
        {"odometry/feature/a.cpp": '#include "vo_bridges/toy/toy_estimators.hpp"'},
        {"core/a.hpp": '#include "server/run/run.hpp"'},
        {"terrain/a.cpp": "  const Json json = Json::parse(text);"},
        {"server/net/a.cpp": '#include "renderer/renderer.hpp"'},
        {"server/camera/a.cpp": '#include "renderer/egl/context.hpp"'},
        {"server/record/a.cpp": '#include "server/run/run.hpp"'},
        {"server/scenario/a.cpp": '#include "server/scenario/document/scenario_file.hpp"'},
        {"server/net/http/a.cpp": '#include "server/net/server_context.hpp"'},
        {"vo_bridges/lcm/a.cpp": '#include "vo_bridges/process/link/wire.hpp"'},
        {"middleware/lcm/a.cpp": '#include "vo_bridges/vo_port.hpp"'},
        {"vo_bridges/a.cpp": '#include "vo_bridges/toy/toy_estimators.hpp"'},
        {"flight/a.cpp": "#include <opencv2/core.hpp>"},
        {"flight/logs/dataflash/a.cpp": '#include "flight/mavlink/frame.hpp"'},
        {"flight/mavlink/a.cpp": '#include "flight/logs/log_sink.hpp"'},
        {"core/a.cpp": '#include "pose.hpp"'},
        {"terrain/world.hpp": '#include "terrain/files.hpp"',
         "terrain/files.hpp": "#include <gdal_priv.h>",
         "server/camera/a.cpp": '#include "terrain/world.hpp"'},
        {"server/net/server.hpp": "#include <boost/asio.hpp>",
         "server/app/main.cpp": '#include "server/net/server.hpp"'},
        {"middleware/lcm/messages.hpp": "#include <overfly_lcm/image_t.hpp>",
         "server/export/a.cpp": '#include "middleware/lcm/messages.hpp"'},
        {"vo_bridges/ros1/ros1_options.hpp": '#include "middleware/ros1/types.hpp"',
         "middleware/ros1/types.hpp": "#include <ros/time.h>",
         "server/scenario/a.cpp": '#include "vo_bridges/ros1/ros1_options.hpp"'},
        # Circles: of two headers, by a .cpp, of three units, and in tests.
        {"core/a.hpp": '#include "core/b.hpp"', "core/b.hpp": '#include "core/a.hpp"'},
        {"core/a.hpp": "", "core/a.cpp": '#include "core/b.hpp"',
         "core/b.hpp": '#include "core/a.hpp"'},
        {"core/a.hpp": '#include "core/b.hpp"', "core/b.cpp": '#include "core/c.hpp"',
         "core/b.hpp": "", "core/c.hpp": '#include "core/a.hpp"'},
        {"tests/core/a.hpp": '#include "tests/core/b.hpp"',
         "tests/core/b.hpp": '#include "tests/core/a.hpp"'},
    ]
    allowed = [
        {"terrain/world/a.cpp": '#include "terrain/raster/b.hpp"\n#include "core/result.hpp"',
         "terrain/raster/b.hpp": "#include <gdal_priv.h>"},
        {"core/a.hpp": "", "core/a.cpp": '#include "core/a.hpp"\n#include "core/b.hpp"',
         "core/b.hpp": "", "core/b.cpp": '#include "core/b.hpp"'},
        {"renderer/egl/a.cpp": '#include <epoxy/gl.h>\n#include "renderer/egl/b.hpp"'},
        {"server/camera/truth.cpp": '#include "flight/flight.hpp"\n#include <vector>'},
        {"odometry/feature/map/map.hpp": "#include <opencv2/core.hpp>"},
        {"middleware/lcm/messages.hpp": "#include <overfly_lcm/image_t.hpp>",
         "vo_bridges/lcm/a.cpp": '#include "middleware/lcm/messages.hpp"'},
    ]
    for sources in forbidden:
        assert faults_of_tree(sources), f"not caught: {sources}"
    for sources in allowed:
        assert not faults_of_tree(sources), f"wrongly caught: {sources}"


def main():
    self_test()
    root = pathlib.Path(sys.argv[1])
    sources = {f.relative_to(root).as_posix(): f.read_text()
               for folder in [*LIBRARIES, "tests"] for f in (root / folder).rglob("*.[ch]pp")}
    if len(sources) < 20:
        sys.exit(f"only {len(sources)} sources below {root}: wrong folder?")
    faults = faults_of_tree(sources)
    print("\n".join(faults) if faults else f"{len(sources)} sources keep the layers")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
