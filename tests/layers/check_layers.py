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

# Rooms whose sources make one library of the program each, with all their sub-rooms.
LIBRARIES = [
    "core", "terrain", "renderer", "sensor", "flight", "middleware", "odometry", "vo_bridges",
    "evaluation",
    "server", "server/net", "server/app",
]

# Headers of the terrain's sub-rooms by what they build on.
TERRAIN_FILES = ["core/", "terrain", "terrain/files"]
TERRAIN_RASTER = [*TERRAIN_FILES, "terrain/raster"]
TERRAIN_PLACE = [*TERRAIN_RASTER, "terrain/place"]
TERRAIN_LAYERS = [*TERRAIN_PLACE, "terrain/elevation", "terrain/imagery"]
TERRAIN_WORLD = [*TERRAIN_LAYERS, "terrain/cache", "terrain/world"]
TILES = "terrain/tile_source.hpp"
RENDERER_CAMERA = ["core/", TILES, "renderer", "renderer/camera", "renderer/ground",
                   "renderer/tiles"]
RAYCAST = [*RENDERER_CAMERA, "renderer/raycast"]
ODOMETRY = ["core/", "vo_bridges/vo_port.hpp", "vo_bridges/parameter.hpp"]
ODOMETRY_SHARED = [*ODOMETRY, "odometry/image", "odometry/geometry", "odometry/adjustment",
                   "odometry/shell"]

# room -> what it may include in addition to itself: a room (the files directly in that folder), a folder
# with all below it ("core/"), or one file.
MAY_INCLUDE = {
    "core": [],
    "core/outside": ["core"],
    "core/text": ["core", "core/outside"],
    "core/motion": ["core", "core/text"],
    "core/earth": ["core", "core/motion"],
    "core/sensors": ["core", "core/earth"],
    "core/camera": ["core", "core/motion"],
    "core/measure": ["core", "core/camera"],
    "terrain": ["core/"],
    "terrain/files": TERRAIN_FILES,
    "terrain/raster": TERRAIN_FILES,
    "terrain/place": TERRAIN_RASTER,
    "terrain/elevation": TERRAIN_PLACE,
    "terrain/imagery": TERRAIN_PLACE,
    "terrain/cache": TERRAIN_LAYERS,
    "terrain/world": [*TERRAIN_LAYERS, "terrain/cache"],
    "terrain/build": TERRAIN_WORLD,
    "terrain/decoration": TERRAIN_RASTER,
    "terrain/download": TERRAIN_PLACE,
    "terrain/synthesis": [*TERRAIN_PLACE, "terrain/synthesis/landscape",
                          "terrain/decoration/noise.hpp"],
    "terrain/synthesis/landscape": ["core/", "terrain/decoration/noise.hpp"],
    "renderer": RENDERER_CAMERA,
    "renderer/tiles": ["core/", TILES, "renderer"],
    "renderer/ground": ["core/", TILES, "renderer"],
    "renderer/camera": RENDERER_CAMERA,
    "renderer/scene": ["core/", TILES, "renderer", "renderer/ground"],
    "renderer/egl": [*RENDERER_CAMERA, "renderer/scene"],
    "renderer/raycast": [*RAYCAST, "renderer/raycast/ground", "renderer/raycast/paint"],
    "renderer/raycast/ground": RAYCAST,
    "renderer/raycast/paint": RAYCAST,
    "renderer/probes": [*RENDERER_CAMERA, "renderer/egl"],
    "sensor": ["core/"],
    "flight": ["core/"],
    "flight/mavlink": ["core/"],
    "flight/mavlink/link": ["core/", "flight/mavlink"],
    "flight/mavlink/vehicle": ["core/", "flight/mavlink", "flight/mavlink/link",
                               "flight/logs/mode_names.hpp"],
    "flight/mavlink/feedback": ["core/", "flight/mavlink", "flight/mavlink/link",
                                "flight/mavlink/vehicle", "flight/logs/local_grid.hpp",
                                "flight/logs/ned_attitude.hpp"],
    "flight/autopilot": ["core/", "flight", "flight/dynamics",
                         "flight/mavlink/vehicle/mission.hpp"],
    "flight/vehicle": ["core/", "flight/autopilot", "flight/dynamics", "flight/mavlink",
                       "flight/mavlink/link", "flight/mavlink/vehicle/mission.hpp"],
    "flight/playback": ["core/", "flight/logs/tlog", "flight/mavlink", "flight/mavlink/link"],
    "flight/live": ["core/", "flight/mavlink", "flight/mavlink/link", "flight/mavlink/vehicle",
                    "flight/mavlink/feedback",
                    "flight/logs", "flight/logs/tlog"],
    "flight/ros": ["core/", "flight/live", "flight/logs", "flight/logs/ros",
                   "middleware/ros1/topic_listener.hpp"],
    "flight/logs": ["core/", "flight/logs/tlog", "flight/logs/dataflash", "flight/logs/ulog",
                    "flight/logs/mcap", "flight/logs/rosbag", "flight/logs/lcm",
                    "flight/logs/csv", "flight/logs/index"],
    "flight/logs/tlog": ["core/", "flight/logs", "flight/mavlink"],
    "flight/logs/dataflash": ["core/", "flight/logs"],
    "flight/logs/ulog": ["core/", "flight/logs"],
    "flight/logs/ros": ["core/", "flight/logs"],
    "flight/logs/mcap": ["core/", "flight/logs", "flight/logs/ros"],
    "flight/logs/rosbag": ["core/", "flight/logs", "flight/logs/ros"],
    "flight/logs/lcm": ["core/", "flight/logs"],
    "flight/logs/images": ["core/", "flight/logs", "flight/logs/ros", "flight/logs/mcap",
                           "flight/logs/rosbag", "flight/logs/lcm"],
    "flight/logs/index": ["core/", "flight/logs"],
    "flight/logs/series": ["core/", "flight/logs"],
    "flight/logs/probes": ["core/", "flight/logs", "flight/mavlink"],
    "flight/logs/csv": ["core/", "flight/logs"],
    "flight/smoothing": ["core/"],
    "flight/replay": ["core/", "flight/pose_flight.hpp", "flight/known_flight.hpp", "flight/logs", "flight/smoothing"],
    "flight/dynamics": ["core/", "flight/gravity.hpp", "flight/normal_noise.hpp"],
    "flight/sensors": ["core/", "flight/normal_noise.hpp", "flight/dynamics/environment.hpp"],
    "middleware/lcm": ["core/"],
    "middleware/lcm/absent": ["core/", "middleware/lcm"],
    "middleware/ros1": ["core/"],
    "middleware/ros1/absent": ["core/", "middleware/ros1"],
    "odometry/image": ODOMETRY,
    "odometry/geometry": ODOMETRY,
    "odometry/adjustment": [*ODOMETRY, "odometry/geometry"],
    "odometry/shell": ODOMETRY,
    "odometry/feature": [*ODOMETRY_SHARED, "odometry/feature/start", "odometry/feature/map"],
    "odometry/feature/start": [*ODOMETRY_SHARED, "odometry/feature", "odometry/feature/map"],
    "odometry/feature/map": [*ODOMETRY_SHARED, "odometry/feature"],
    "vo_bridges": ["core/"],
    "vo_bridges/process": ["core/", "vo_bridges", "vo_bridges/process/child", "vo_bridges/process/link"],
    "vo_bridges/process/child": ["core/", "vo_bridges"],
    "vo_bridges/process/link": ["core/", "vo_bridges", "vo_bridges/process/child"],
    "vo_bridges/lcm": ["core/", "middleware/lcm", "vo_bridges"],
    "vo_bridges/lcm/absent": ["core/", "vo_bridges", "vo_bridges/lcm"],
    "vo_bridges/ros1": ["core/", "middleware/ros1", "vo_bridges"],
    "vo_bridges/ros1/absent": ["core/", "vo_bridges", "vo_bridges/ros1"],
    "vo_bridges/toy": ["core/", "vo_bridges"],
    "vo_bridges/client": [],
    "vo_bridges/examples": ["vo_bridges/client"],
    "vo_bridges/adapters": ["vo_bridges/client"],
    "vo_bridges/adapters/opencv2_names": [],
    "vo_bridges/adapters/orbslam2": ["vo_bridges/adapters"],
    "vo_bridges/adapters/dso": ["vo_bridges/adapters"],
    "vo_bridges/adapters/svo": ["vo_bridges/adapters"],
    "evaluation": ["core/"],
    "evaluation/images": ["core/"],
    "server/files": ["core/"],
    "server/timing": ["core/"],
    "server/scenario": ["core/", "terrain/", "renderer/", "sensor/", "flight/",
                        "vo_bridges/"],
    "server/scenario/document": ["core/", "terrain/", "renderer/", "flight/",
                                 "middleware/lcm/network.hpp", "vo_bridges/", "server/files/",
                                 "server/scenario/", "server/record/run_folder.hpp",
                                 "server/scenario/document/flight"],
    "server/scenario/document/flight": ["core/", "terrain/", "renderer/", "flight/",
                                 "middleware/lcm/network.hpp", "vo_bridges/", "server/files/",
                                 "server/scenario/",
                                 "server/scenario/document"],
    "server/record": ["core/", "evaluation/", "server/files/", "server/timing/"],
    "server/scoring": ["core/", "evaluation/", "server/files/", "server/scenario/",
                       "server/record/"],
    "server/timeline": ["core/", "evaluation/", "server/files/", "server/timing/",
                        "server/record/", "server/scoring/"],
    "server/worlds": ["core/", "terrain/", "server/files/", "server/scenario/", "server/record/"],
    "server/camera": ["core/", "terrain/", "renderer/", "sensor/", "flight/", "server/timing/",
                      "server/scenario/", "server/record/", "server/worlds/", "server/imagery/"],
    "server/imagery": ["core/", "flight/logs", "flight/logs/images", "server/files/",
                       "server/scenario/", "server/camera/camera_shot.hpp",
                       "server/dataset/open_dataset.hpp", "server/dataset/grey_image.hpp"],
    "server/imagery/video": ["core/", "server/imagery/"],
    "server/imagery/absent": ["core/", "server/imagery/"],
    "server/estimators": ["core/", "odometry/", "vo_bridges/", "server/timing/",
                          "server/scenario/", "server/record/"],
    "server/dataset": ["core/", "terrain/", "evaluation/", "vo_bridges/", "server/files/",
                       "server/timing/", "server/record/", "server/scoring/", "server/camera/",
                       "server/estimators/"],
    "server/export": ["core/", "terrain/", "renderer/", "sensor/", "flight/", "middleware/",
                      "server/files/", "server/timing/", "server/scenario/", "server/record/",
                      "server/camera/", "server/scoring/", "server/export/video/",
                      "server/export/mcap/"],
    "server/export/mcap": ["core/", "server/files/"],
    "server/export/video": ["core/", "renderer/", "server/files/", "server/camera/"],
    "server/logs": ["core/", "flight/logs", "flight/logs/series", "server/files/"],
    "server/run": ["core/", "renderer/", "sensor/", "vo_bridges/", "evaluation/", "server/files/", "server/timing/",
                   "server/scenario/", "server/record/", "server/scoring/", "server/timeline/",
                   "server/worlds/", "server/camera/", "server/estimators/"],
    "server/runs": ["core/", "terrain/", "server/files/", "server/timing/", "server/scenario/",
                    "server/record/", "server/scoring/", "server/timeline/", "server/worlds/",
                    "server/camera/", "server/run/"],
    "server/views": ["core/", "renderer/", "server/files/", "server/timing/", "server/record/",
                     "server/scoring/", "server/timeline/", "server/camera/", "server/runs/"],
    "server/net/http": ["core/"],
    "server/net/stream": ["core/", "server/record/", "server/scoring/", "server/timeline/",
                          "server/views/", "server/net/http/"],
    "server/net/rest": ["core/", "flight/logs", "server/logs/", "server/scenario/",
                        "server/record/", "server/scoring/",
                        "server/timeline/", "server/runs/", "server/views/", "server/net/http/",
                        "server/net/stream/"],
    "server/net": ["core/", "server/logs/", "server/timing/", "server/record/", "server/timeline/",
                   "server/runs/", "server/views/", "server/net/http/", "server/net/stream/", "server/net/rest/"],
    "server/app": ["core/", "terrain/", "renderer/", "flight/", "middleware/", "odometry/",
                   "vo_bridges/", "evaluation/", "server/"],
}
# Rooms whose sub-folders have no entry above: their files belong to the room itself.
WHOLE = ["server/app"]
# Folders that no other library may look into, even where the room itself is open to it.
PRIVATE = ["renderer/egl/"]

# pattern of a third-party include -> (rooms that may use it, may it stand in a header that a library
# without such a room sees; None: in JSON_IN_HEADERS only, and there no matter who sees it).
THIRD_PARTY = [
    (r"(Eigen)/", LIBRARIES, True),
    (r"GeographicLib/", ["core"], False),
    (r"(gdal|ogr|cpl_|proj|vrt)[\w./]*\.h$", ["terrain"], False),
    (r"(epoxy|EGL|GL|GLES\d?)/", ["renderer"], False),
    # OpenCV's C headers have the names that upstream systems of its second version use.
    (r"opencv2/\w+/\w+_c\.h$", ["vo_bridges/adapters"], False),
    (r"opencv2/(?!\w+/\w+_c\.h$)", ["odometry", "evaluation/images"], False),
    (r"ceres/", ["odometry", "flight/smoothing"], False),
    (r"boost/", ["server/net"], False),
    (r"openssl/", ["server/net"], False),
    (r"(turbojpeg|jpeglib)\.h$", ["server/files"], False),
    (r"libdeflate\.h$", ["server/files", "flight/logs/mcap", "flight/logs/probes", "server/export/mcap"], False),
    (r"(lz4frame|zstd|bzlib)\.h$", ["flight/logs/ros"], False),
    (r"vpx/", ["server/export/video"], False),
    (r"lib(av|sw)\w+/", ["server/imagery/video"], False),
    (r"nlohmann/", ["terrain", "flight", "server"], None),
    (r"CLI/", ["server/app"], None),
    (r"spdlog/", ["server/app"], None),
    (r"(overfly_)?lcm/", ["middleware/lcm", "vo_bridges/lcm"], False),
    (r"(ros|rosbag|xmlrpcpp|sensor_msgs|geometry_msgs|nav_msgs|std_msgs|tf2_msgs|rosgraph_msgs)/",
     ["middleware/ros1", "vo_bridges/ros1"], False),
]
# nlohmann's documents may stand in the headers of the server's rooms, not in terrain's.
JSON_IN_HEADERS = "server/"

# pattern of a call -> (files that may make it, what all others use).
CALLS = [
    # Text in the program itself needs no guard; everything else may come from outside.
    (r"\b[Jj]son::(parse|sax_parse|from_\w+)\(",
     ["core/outside/outside_json.hpp", "server/scenario/document/scenario_schema.cpp",
      "server/camera/camera_check.cpp"],
     "json_from_outside"),
    # It lets read errors out as exceptions, waits for FIFOs and knows no limit.
    (r"istreambuf_iterator", [], "read_file_text or read_file_bytes"),
]

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
