#!/usr/bin/env python3
"""Fails on an include that docs/ARCHITECTURE.md forbids.

Two tables: which rooms a room may include, and which rooms are the home of a third-party library
(and whether its headers may stand in the room's own public headers, which other rooms include).
Usage: check_layers.py SOURCE_ROOT
"""

import pathlib
import re
import sys

# Longest prefix first: a file belongs to the first room that matches.
ROOMS = [
    "core", "terrain", "renderer", "flight", "odometry", "vo_bridges", "evaluation",
    "server/engine", "server/net", "server/app",
]

# room -> prefixes of project headers it may include besides its own.
MAY_INCLUDE = {
    "core": [],
    "terrain": ["core/"],
    "renderer": ["core/", "terrain/tile_source.hpp"],
    "flight": ["core/"],
    "odometry": ["core/", "vo_bridges/vo_port.hpp"],
    "vo_bridges": ["core/"],
    "evaluation": ["core/"],
    "server/engine": ["core/", "terrain/", "renderer/", "flight/", "odometry/", "vo_bridges/",
                      "evaluation/"],
    "server/net": ["core/", "server/engine/"],
    "server/app": ["core/", "terrain/", "renderer/", "flight/", "odometry/", "vo_bridges/",
                   "evaluation/", "server/engine/", "server/net/"],
}
# Folders that no other room may look into, even where the room itself is open to it.
PRIVATE = ["renderer/egl/"]

# pattern of a third-party include -> (rooms that may use it, may it stand in a public header).
THIRD_PARTY = [
    (r"(Eigen)/", ROOMS, True),
    (r"GeographicLib/", ["core"], False),
    (r"(gdal|ogr|cpl_|proj|vrt)[\w./]*\.h$", ["terrain"], False),
    (r"(epoxy|EGL|GL|GLES\d?)/", ["renderer"], False),
    (r"opencv2/", ["odometry"], False),
    (r"ceres/", ["odometry"], False),
    (r"boost/", ["server/net"], False),
    (r"openssl/", ["server/net"], False),
    (r"(turbojpeg|jpeglib)\.h$", ["server/engine"], False),
    (r"nlohmann/", ["terrain", "server/engine", "server/net", "server/app"], None),
    (r"CLI/", ["server/app"], None),
    (r"spdlog/", ["server/app"], None),
    (r"(lcm|ros)/", ["vo_bridges"], False),
]
# nlohmann's documents are the engine's vocabulary and may stand in its headers, not in terrain's.
JSON_IN_HEADERS = ["server/engine", "server/net", "server/app"]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def room_of(path):
    return next((room for room in ROOMS if path.startswith(room + "/")), None)


def is_public_header(path, room):
    return path.endswith(".hpp") and not any(path.startswith(p) for p in PRIVATE) and (
        "/" not in path[len(room) + 1:])


def fault_of_project_include(path, room, target):
    for private in PRIVATE:
        if target.startswith(private) and not path.startswith(private.rsplit("/", 2)[0] + "/"):
            return f"{private} is private to its room"
    if target.startswith(room + "/"):
        return None
    if any(target.startswith(prefix) for prefix in MAY_INCLUDE[room]):
        return None
    return f"{room} may not include {target}"


def fault_of_library_include(path, room, target):
    for pattern, rooms, in_headers in THIRD_PARTY:
        if not re.match(pattern, target):
            continue
        if room not in rooms:
            return f"{target} is at home in {', '.join(rooms)}, not in {room}"
        allowed = room in JSON_IN_HEADERS if in_headers is None else in_headers
        if not allowed and is_public_header(path, room):
            return f"{target} leaks through a public header of {room}"
    return None


def faults_of_file(path, text):
    room = room_of(path)
    if room is None:
        return
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(2)
        if match.group(1) == '"' and room_of(target):
            fault = fault_of_project_include(path, room, target)
        elif match.group(1) == '"' and "/" not in target:
            fault = f'"{target}": project includes are written from the repository root'
        else:
            fault = fault_of_library_include(path, room, target)
        if fault:
            yield f"{path}:{number}: {fault}"


def self_test():
    """The checker itself must fail on what is forbidden."""
    forbidden = [
        ("flight/a.cpp", '#include "terrain/world.hpp"'),
        ("renderer/a.cpp", '#include "terrain/world.hpp"'),
        ("odometry/feature/a.cpp", '#include "core/x.hpp"\n#include "flight/flight.hpp"'),
        ("odometry/feature/a.cpp", '#include "vo_bridges/toy/toy_estimators.hpp"'),
        ("core/a.hpp", '#include "server/engine/run.hpp"'),
        ("server/net/a.cpp", '#include "renderer/renderer.hpp"'),
        ("server/engine/a.cpp", '#include "renderer/egl/context.hpp"'),
        ("terrain/world.hpp", "#include <gdal_priv.h>"),
        ("flight/a.cpp", "#include <opencv2/core.hpp>"),
        ("server/net/server.hpp", "#include <boost/asio.hpp>"),
        ("core/a.cpp", '#include "pose.hpp"'),
    ]
    allowed = [
        ("terrain/world.cpp", '#include <gdal_priv.h>\n#include "core/result.hpp"'),
        ("renderer/egl/a.cpp", '#include <epoxy/gl.h>\n#include "renderer/egl/b.hpp"'),
        ("server/engine/run.cpp", '#include "flight/flight.hpp"\n#include <vector>'),
        ("odometry/feature/map.hpp", "#include <opencv2/core.hpp>"),
    ]
    for path, text in forbidden:
        assert list(faults_of_file(path, text)), f"not caught: {path}: {text}"
    for path, text in allowed:
        assert not list(faults_of_file(path, text)), f"wrongly caught: {path}: {text}"


def main():
    self_test()
    root = pathlib.Path(sys.argv[1])
    files = [f for room in ROOMS for f in (root / room).rglob("*.[ch]pp")]
    if len(files) < 20:
        sys.exit(f"only {len(files)} sources below {root}: wrong folder?")
    faults = [fault for file in sorted(files)
              for fault in faults_of_file(file.relative_to(root).as_posix(), file.read_text())]
    print("\n".join(faults) if faults else f"{len(files)} sources keep the layers")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
