"""The worlds that the risk model of `overfly predict` is fitted to, and others that judge it.

Built-in landscapes are synthesised by the program; photographs come from the data folder. A world
"x4" has the same imagery averaged to texels of four times the size, by a virtual raster. Patterns
are painted here: PNG files with a world file.
"""

import json
import pathlib
import random
import shutil
import struct
import subprocess
import zlib

# name -> how it is made. The sets share no imagery, landscape seed or pattern.
FITTING = {
    "land1": {"synthesize": {"seed": 1, "relief-m": 60}},
    "land2": {"synthesize": {"seed": 2, "relief-m": 15}},
    "land3": {"synthesize": {"seed": 3, "relief-m": 200, "texel-m": 0.6}},
    "land1x5": {"coarser": "land1", "factor": 5},
    "land2x12": {"coarser": "land2", "factor": 12},
    "land3x3": {"coarser": "land3", "factor": 3},
    "board": {"pattern": "board", "seed": 1},
    "rows": {"pattern": "rows", "seed": 2},
    "lake": {"pattern": "patches", "seed": 3, "bare": 0.7},
    "faint": {"pattern": "cloud", "seed": 4, "contrast": 10},
}
JUDGING = {
    "mcmillan": {"photo": "mcmillan/ortho_0.8m_utm10.tif", "ground_height_m": 250},
    "mcmillanx4": {"coarser": "mcmillan", "factor": 4},
    "autzen": {"photo": "autzen/ortho_0.3m_utm10.tif",
               "elevation": "autzen/dtm_3m_utm10.tif", "datum": "navd88", "geoid_m": -22.6},
    "autzenx8": {"coarser": "autzen", "factor": 8},
    "goleta": {"photo": "goleta/ortho_epsg4326.tif",
               "elevation": "goleta/elevation_epsg4326.tif", "datum": "ellipsoid"},
    "land21": {"synthesize": {"seed": 21, "relief-m": 100}},
    "land22x8": {"coarser": "land22", "factor": 8},
    "dots": {"pattern": "dots", "seed": 25},
    "islands": {"pattern": "patches", "seed": 26, "bare": 0.5},
    "haze": {"pattern": "cloud", "seed": 27, "contrast": 16},
}
# Made only for others.
HIDDEN = {"land22": {"synthesize": {"seed": 22, "relief-m": 40}}}
PHOTOGRAPHS = ("mcmillan", "mcmillanx4", "autzen", "autzenx8", "goleta")

PATTERN_PX = 2000
PATTERN_TEXEL_M = 1.0
# In UTM zone 16 north: the south-west corner of the patterns.
PATTERN_EAST_M, PATTERN_NORTH_M = 583000.0, 4355000.0


def tiff_size_and_place(file):
    """(width, height, left, top, pixel x, pixel y, EPSG code) of a north-up GeoTIFF."""
    data = file.read_bytes()
    order = "<" if data[:2] == b"II" else ">"
    formats = {1: "B", 2: "c", 3: "H", 4: "I", 12: "d"}
    sizes = {1: 1, 2: 1, 3: 2, 4: 4, 12: 8}
    start = struct.unpack(order + "I", data[4:8])[0]
    tags = {}
    for i in range(struct.unpack(order + "H", data[start:start + 2])[0]):
        entry = start + 2 + 12 * i
        tag, kind, count = struct.unpack(order + "HHI", data[entry:entry + 8])
        if kind not in formats:
            continue
        place = entry + 8
        if sizes[kind] * count > 4:
            place = struct.unpack(order + "I", data[place:place + 4])[0]
        tags[tag] = struct.unpack(order + formats[kind] * count,
                                  data[place:place + sizes[kind] * count])
    keys = tags[34735]
    codes = {keys[4 * i]: keys[4 * i + 3] for i in range(1, len(keys) // 4)}
    scale, tie = tags[33550], tags[33922]
    return (tags[256][0], tags[257][0], tie[3] - tie[0] * scale[0], tie[4] + tie[1] * scale[1],
            scale[0], scale[1], codes.get(3072, codes.get(2048)), tags[277][0])


def write_coarser(file, target, factor):
    """A virtual raster of the file's area averages, and the code of its reference system."""
    width, height, left, top, dx, dy, epsg, bands = tiff_size_and_place(file)
    columns, rows = width // factor, height // factor
    if file.is_relative_to(target.parent):
        inside = file.relative_to(target.parent)
    else:  # the parts of a virtual raster must lie in its folder
        inside = f"{target.stem}_source{file.suffix}"
        shutil.copyfile(file, target.parent / inside)
    frame = (f'<SrcRect xOff="0" yOff="0" xSize="{columns * factor}" ySize="{rows * factor}"/>'
             f'<DstRect xOff="0" yOff="0" xSize="{columns}" ySize="{rows}"/>')

    def band(number, source, colour):
        head = f'<VRTRasterBand dataType="Byte" band="{number}">' if number else \
            '<VRTRasterBand dataType="Byte">'
        return (head + (f"<ColorInterp>{colour}</ColorInterp>" if colour else "") +
                '<SimpleSource resampling="average">'
                f'<SourceFilename relativeToVRT="1">{inside}</SourceFilename>'
                f"<SourceBand>{source}</SourceBand>{frame}</SimpleSource></VRTRasterBand>\n")

    colours = ["Red", "Green", "Blue"] if bands >= 3 else ["Gray"]
    text = (f'<VRTDataset rasterXSize="{columns}" rasterYSize="{rows}">\n'
            f"<GeoTransform>{left!r}, {dx * factor!r}, 0, {top!r}, 0, {-dy * factor!r}"
            "</GeoTransform>\n" +
            "".join(band(i + 1, i + 1, colour) for i, colour in enumerate(colours)) +
            f'<MaskBand>{band(0, "mask,1", "")}</MaskBand></VRTDataset>\n')
    target.write_text(text)
    return f"EPSG:{epsg}"


def smooth_noise(rng, size, cell):
    """size x size values in [0, 1]: random ones every `cell` texels, bilinear between them."""
    n = size // cell + 2
    nodes = [[rng.random() for _ in range(n)] for _ in range(n)]
    rows = []
    for y in range(size):
        j, v = divmod(y, cell)
        v /= cell
        upper, lower = nodes[j], nodes[j + 1]
        edge = [(1 - v) * a + v * b for a, b in zip(upper, lower)]
        row = []
        for i in range(size // cell + 1):
            a, b = edge[i], edge[i + 1]
            row += [a + (b - a) * u / cell for u in range(cell)]
        rows.append(row[:size])
    return rows


def pattern_rows(recipe):
    """Rows of grey levels."""
    rng = random.Random(recipe["seed"])
    size, kind = PATTERN_PX, recipe["pattern"]
    if kind == "board":
        return [bytes(70 if (x // 12 + y // 12) % 2 else 180 for x in range(size))
                for y in range(size)]
    if kind == "rows":  # a vineyard
        wave = [[60, 90, 150, 160, 150, 90][x % 6] for x in range(size)]
        return [bytes(min(255, max(0, wave[x] + rng.randrange(-6, 7))) for x in range(size))
                for y in range(size)]
    if kind == "dots":  # an orchard: equal round trees on a grid
        def tree(x, y):
            return 60 if (x % 16 - 8) ** 2 + (y % 16 - 8) ** 2 < 25 else 170
        lines = [bytes(tree(x, y) for x in range(size)) for y in range(16)]
        return [lines[y % 16] for y in range(size)]
    if kind == "cloud":  # soft, with little contrast
        field = smooth_noise(rng, size, 24)
        fine = smooth_noise(rng, size, 4)
        return [bytes(int(120 + recipe["contrast"] * (a + 0.5 * b)) for a, b in zip(*rows))
                for rows in zip(field, fine)]
    # patches: rough ground with smooth areas
    field = smooth_noise(rng, size, 160)
    ordered = sorted(value for row in field[::20] for value in row[::20])
    limit = ordered[int(recipe["bare"] * (len(ordered) - 1))]
    rough = smooth_noise(rng, size, 3)
    return [bytes(64 if value < limit else int(60 + 160 * grain)
                  for value, grain in zip(values, grains))
            for values, grains in zip(field, rough)]


def write_pattern(recipe, target):
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    rows = pattern_rows(recipe)
    data = zlib.compress(b"".join(b"\0" + row for row in rows), 6)
    target.write_bytes(b"\x89PNG\r\n\x1a\n" +
                       chunk(b"IHDR", struct.pack(">IIBBBBB", PATTERN_PX, PATTERN_PX, 8, 0, 0, 0, 0)) +
                       chunk(b"IDAT", data) + chunk(b"IEND", b""))
    top = PATTERN_NORTH_M + PATTERN_PX * PATTERN_TEXEL_M
    target.with_suffix(".pgw").write_text(
        f"{PATTERN_TEXEL_M}\n0\n0\n{-PATTERN_TEXEL_M}\n"
        f"{PATTERN_EAST_M + 0.5 * PATTERN_TEXEL_M}\n{top - 0.5 * PATTERN_TEXEL_M}\n")


class WorldMaker:
    """Makes worlds in a folder, once each."""

    def __init__(self, binary, folder, data):
        self.binary, self.folder, self.data = binary, folder.resolve(), data.resolve()

    def world(self, name):
        """The `world` of a scenario."""
        stored = self.folder / f"{name}.json"
        if not stored.exists():
            self.folder.mkdir(parents=True, exist_ok=True)
            world = self.made(name, {**FITTING, **JUDGING, **HIDDEN}[name])
            stored.write_text(json.dumps(world))
        return json.loads(stored.read_text())

    def made(self, name, recipe):
        if "synthesize" in recipe:
            folder = self.folder / name
            command = [self.binary, "world", "synthesize", "--out", folder, "--size-m", 2400]
            for option, value in recipe["synthesize"].items():
                command += [f"--{option}", value]
            subprocess.run([str(part) for part in [*command, "--quiet"]], check=True)
            return {"imagery": [{"file": str(folder / "imagery.tif")}],
                    "elevation": [{"file": str(folder / "elevation.tif"),
                                   "vertical_datum": "ellipsoid"}]}
        if "photo" in recipe:
            world = {"imagery": [{"file": str(self.data / "terrain" / recipe["photo"])}]}
            if "elevation" in recipe:
                layer = {"file": str(self.data / "terrain" / recipe["elevation"]),
                         "vertical_datum": recipe["datum"]}
                if "geoid_m" in recipe:
                    layer["geoid_separation_m"] = recipe["geoid_m"]
                world["elevation"] = [layer]
            else:
                world["ground_height_m"] = recipe["ground_height_m"]
            return world
        if "coarser" in recipe:
            world = self.world(recipe["coarser"])
            target = self.folder / f"{name}.vrt"
            crs = write_coarser(pathlib.Path(world["imagery"][0]["file"]), target,
                                recipe["factor"])
            return {**world, "imagery": [{"file": str(target), "crs": crs}]}
        target = self.folder / f"{name}.png"
        write_pattern(recipe, target)
        return {"imagery": [{"file": str(target), "crs": "EPSG:32616"}], "ground_height_m": 200}
