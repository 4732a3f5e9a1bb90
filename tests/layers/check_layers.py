#!/usr/bin/env python3
"""Fails on an include or a call that docs/ARCHITECTURE.md forbids.

Three tables: calls that only some files may make, which rooms a room may include, and which rooms are the home of a third-party library
(and whether its headers may be reached from another room through the headers that it includes).
Usage: check_layers.py SOURCE_ROOT
"""

import pathlib
import re
import sys

# A file belongs to the room with the longest name that matches.
ROOMS = [
    "core", "terrain", "renderer", "flight", "odometry", "vo_bridges", "evaluation",
    "server/files", "server/timing", "server/scenario/document", "server/scenario",
    "server/record", "server/scoring", "server/worlds", "server/camera", "server/estimators",
    "server/dataset", "server/export", "server/run", "server/runs", "server/views",
    "server/net/http", "server/net/stream", "server/net/rest", "server/net", "server/app",
]

# room -> prefixes of project headers it may include besides its own.
MAY_INCLUDE = {
    "core": [],
    "terrain": ["core/"],
    "renderer": ["core/", "terrain/tile_source.hpp"],
    "flight": ["core/"],
    "odometry": ["core/", "vo_bridges/vo_port.hpp", "vo_bridges/parameter.hpp"],
    "vo_bridges": ["core/"],
    "evaluation": ["core/"],
    "server/files": ["core/"],
    "server/timing": ["core/"],
    "server/scenario": ["core/", "terrain/", "renderer/", "flight/", "vo_bridges/"],
    "server/scenario/document": ["core/", "terrain/", "renderer/", "flight/", "vo_bridges/",
                                 "server/files/", "server/scenario/"],
    "server/record": ["core/", "evaluation/", "server/files/", "server/timing/"],
    "server/scoring": ["core/", "evaluation/", "server/files/", "server/scenario/",
                       "server/record/"],
    "server/worlds": ["core/", "terrain/", "server/files/", "server/scenario/", "server/record/"],
    "server/camera": ["core/", "terrain/", "renderer/", "flight/", "server/timing/",
                      "server/scenario/", "server/record/", "server/worlds/"],
    "server/estimators": ["core/", "odometry/", "vo_bridges/", "server/timing/",
                          "server/scenario/", "server/record/"],
    "server/dataset": ["core/", "terrain/", "evaluation/", "vo_bridges/", "server/files/",
                       "server/timing/", "server/record/", "server/scoring/", "server/camera/"],
    "server/export": ["core/", "terrain/", "renderer/", "flight/", "vo_bridges/", "server/files/",
                      "server/timing/", "server/scenario/", "server/record/", "server/camera/"],
    "server/run": ["core/", "renderer/", "vo_bridges/", "server/files/", "server/timing/",
                   "server/scenario/", "server/record/", "server/scoring/", "server/worlds/",
                   "server/camera/", "server/estimators/"],
    "server/runs": ["core/", "terrain/", "server/files/", "server/timing/", "server/scenario/",
                    "server/record/", "server/worlds/", "server/camera/", "server/run/"],
    "server/views": ["core/", "renderer/", "server/files/", "server/timing/", "server/record/",
                     "server/scoring/", "server/camera/", "server/runs/"],
    "server/net/http": ["core/"],
    "server/net/stream": ["core/", "server/record/", "server/scoring/", "server/views/",
                          "server/net/http/"],
    "server/net/rest": ["core/", "server/scenario/", "server/record/", "server/scoring/",
                        "server/runs/", "server/views/", "server/net/http/",
                        "server/net/stream/"],
    "server/net": ["core/", "server/timing/", "server/record/", "server/runs/", "server/views/",
                   "server/net/http/", "server/net/stream/", "server/net/rest/"],
    "server/app": ["core/", "terrain/", "renderer/", "flight/", "odometry/", "vo_bridges/",
                   "evaluation/", "server/"],
}
# Folders that no other room may look into, even where the room itself is open to it.
PRIVATE = ["renderer/egl/"]

# pattern of a third-party include -> (rooms that may use it, may it stand in a public header).
THIRD_PARTY = [
    (r"(Eigen)/", ROOMS, True),
    (r"GeographicLib/", ["core"], False),
    (r"(gdal|ogr|cpl_|proj|vrt)[\w./]*\.h$", ["terrain"], False),
    (r"(epoxy|EGL|GL|GLES\d?)/", ["renderer"], False),
    # OpenCV's C headers have the names that upstream systems of its second version use.
    (r"opencv2/\w+/\w+_c\.h$", ["vo_bridges"], False),
    (r"opencv2/(?!\w+/\w+_c\.h$)", ["odometry"], False),
    (r"ceres/", ["odometry"], False),
    (r"boost/", ["server/net"], False),
    (r"openssl/", ["server/net"], False),
    (r"(turbojpeg|jpeglib)\.h$", ["server/files"], False),
    (r"libdeflate\.h$", ["server/files"], False),
    (r"vpx/", ["server/export"], False),
    (r"nlohmann/", ["terrain", "server"], None),
    (r"CLI/", ["server/app"], None),
    (r"spdlog/", ["server/app"], None),
    (r"(lcm|ros|rosbag|sensor_msgs|geometry_msgs|nav_msgs|std_msgs|tf2_msgs|rosgraph_msgs)/",
     ["vo_bridges"], False),
]
# nlohmann's documents may stand in the headers of the server's rooms, not in terrain's.
JSON_IN_HEADERS = "server/"

# pattern of a call -> (files that may make it, what all others use).
CALLS = [
    # Text in the program itself needs no guard; everything else may come from outside.
    (r"\b[Jj]son::(parse|sax_parse|from_\w+)\(",
     ["core/outside_json.hpp", "server/scenario/document/scenario_schema.cpp",
      "server/camera/camera_check.cpp"],
     "json_from_outside"),
    # It lets read errors out as exceptions, waits for FIFOs and knows no limit.
    (r"istreambuf_iterator", [], "read_file_text or read_file_bytes"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def room_of(path):
    return max((room for room in ROOMS if path.startswith(room + "/")), key=len, default=None)


def project_includes(text):
    for line in text.splitlines():
        match = INCLUDE.match(line)
        if match and match.group(1) == '"':
            yield match.group(2)


def headers_seen_from_other_rooms(sources):
    """Headers that a file of another room includes, and what those include in turn."""
    seen = set()
    waiting = [target for path, text in sources.items() for target in project_includes(text)
               if room_of(target) and room_of(target) != room_of(path)]
    while waiting:
        header = waiting.pop()
        if header not in seen and header in sources:
            seen.add(header)
            waiting += project_includes(sources[header])
    return seen


def is_open(target, prefix):
    """Whether `target` is the header `prefix`, or lies in that folder."""
    return target == prefix or (prefix.endswith("/") and target.startswith(prefix))


def fault_of_project_include(path, room, target):
    for private in PRIVATE:
        if target.startswith(private) and not path.startswith(private.rsplit("/", 2)[0] + "/"):
            return f"{private} is private to its room"
    if room_of(target) == room:
        return None
    if any(is_open(target, prefix) for prefix in MAY_INCLUDE[room]):
        return None
    return f"{room} may not include {target}"


def fault_of_library_include(room, target, public):
    for pattern, rooms, in_headers in THIRD_PARTY:
        if not re.match(pattern, target):
            continue
        if not any(room == home or room.startswith(home + "/") for home in rooms):
            return f"{target} is at home in {', '.join(rooms)}, not in {room}"
        allowed = room.startswith(JSON_IN_HEADERS) if in_headers is None else in_headers
        if not allowed and public:
            return f"{target} leaks out of {room}: another room includes this header"
    return None


def faults_of_calls(path, line):
    for pattern, files, instead in CALLS:
        if re.search(pattern, line) and path not in files:
            yield f"{instead} is the one way to do this"


def faults_of_file(path, text, public):
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
        if match.group(1) == '"' and room_of(target):
            fault = fault_of_project_include(path, room, target)
        elif match.group(1) == '"' and "/" not in target:
            fault = f'"{target}": project includes are written from the repository root'
        else:
            fault = fault_of_library_include(room, target, public)
        if fault:
            yield f"{path}:{number}: {fault}"


def faults_of_tree(sources):
    public = headers_seen_from_other_rooms(sources)
    return [fault for path, text in sorted(sources.items())
            for fault in faults_of_file(path, text, path in public)]


def self_test():
    """The checker itself must fail on what is forbidden."""
    forbidden = [
        {"flight/a.cpp": '#include "terrain/world.hpp"'},
        {"renderer/a.cpp": '#include "terrain/world.hpp"'},
        {"odometry/feature/a.cpp": '#include "core/x.hpp"\n#include "flight/flight.hpp"'},
        {"odometry/feature/a.cpp": '#include "vo_bridges/toy/toy_estimators.hpp"'},
        {"core/a.hpp": '#include "server/run/run.hpp"'},
        {"terrain/a.cpp": "  const Json json = Json::parse(text);"},
        {"server/net/a.cpp": '#include "renderer/renderer.hpp"'},
        {"server/camera/a.cpp": '#include "renderer/egl/context.hpp"'},
        {"server/record/a.cpp": '#include "server/run/run.hpp"'},
        {"server/scenario/a.cpp": '#include "server/scenario/document/scenario_file.hpp"'},
        {"server/net/http/a.cpp": '#include "server/net/server_context.hpp"'},
        {"flight/a.cpp": "#include <opencv2/core.hpp>"},
        {"core/a.cpp": '#include "pose.hpp"'},
        {"terrain/world.hpp": '#include "terrain/files.hpp"',
         "terrain/files.hpp": "#include <gdal_priv.h>",
         "server/camera/a.cpp": '#include "terrain/world.hpp"'},
        {"server/net/server.hpp": "#include <boost/asio.hpp>",
         "server/app/main.cpp": '#include "server/net/server.hpp"'},
    ]
    allowed = [
        {"terrain/world.cpp": '#include "terrain/files.hpp"\n#include "core/result.hpp"',
         "terrain/files.hpp": "#include <gdal_priv.h>"},
        {"renderer/egl/a.cpp": '#include <epoxy/gl.h>\n#include "renderer/egl/b.hpp"'},
        {"server/camera/truth.cpp": '#include "flight/flight.hpp"\n#include <vector>'},
        {"odometry/feature/map.hpp": "#include <opencv2/core.hpp>"},
    ]
    for sources in forbidden:
        assert faults_of_tree(sources), f"not caught: {sources}"
    for sources in allowed:
        assert not faults_of_tree(sources), f"wrongly caught: {sources}"


def main():
    self_test()
    root = pathlib.Path(sys.argv[1])
    sources = {f.relative_to(root).as_posix(): f.read_text()
               for room in ROOMS for f in (root / room).rglob("*.[ch]pp")}
    if len(sources) < 20:
        sys.exit(f"only {len(sources)} sources below {root}: wrong folder?")
    faults = faults_of_tree(sources)
    print("\n".join(faults) if faults else f"{len(sources)} sources keep the layers")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
