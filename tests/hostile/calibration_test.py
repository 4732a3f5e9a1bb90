#!/usr/bin/env python3
"""Attacks by calibration files, which a scenario's camera may name.

Usage: calibration_test.py PROGRAM [unittest options]
"""

import json
import os

import attack
from attack import Attack

GOOD = {"format": "overfly-calibration", "format_version": 1, "width_px": 64, "height_px": 48,
        "fx_px": 60.0, "fy_px": 60.0, "cx_px": 31.5, "cy_px": 23.5,
        "distortion": {"model": "radtan", "coefficients": [-0.1, 0.01, 0.0, 0.0, 0.0]}}


def changed(field, text):
    """GOOD with one field, whose value is this JSON text."""
    return json.dumps({**GOOD, field: "HERE"}).replace('"HERE"', text)


class Calibration(Attack):
    """Every file is either a camera or an error that names the field or the file."""

    def camera(self, place):
        return {"camera": {"calibration": place, "rate_hz": 5}}

    def refused(self, text):
        (self.victim.data / "camera.json").write_text(text)
        words = self.assert_refused("listed", self.camera("camera.json"))
        self.assertIn("camera.", words)  # the field of the scenario

    def test_a_good_file_flies(self):
        (self.victim.data / "good.json").write_text(json.dumps(GOOD))
        self.assert_flies("listed", self.camera("good.json"))

    def test_numbers(self):
        sizes = ("-1", "0", "1e-320")
        for field, wrong in (("width_px", sizes), ("height_px", sizes), ("fx_px", sizes),
                             ("fy_px", sizes), ("cx_px", ("1e9",)), ("cy_px", ("-1e9",))):
            for number in ("1e999", "-1e999", "1e308", "-1e308", "NaN", "Infinity", "null", "true",
                           '"640"', "[640]", "{}", "9" * 400, "18446744073709551616", *wrong):
                with self.subTest(field=field, number=number[:20]):
                    self.refused(changed(field, number))

    def test_distortion(self):
        for lens in ("[]", '"radtan"', '{"model":"radtan"}', '{"coefficients":[0,0,0,0]}',
                     '{"model":"x","coefficients":[0,0,0,0]}',
                     '{"model":"radtan","coefficients":[1e308,1e308,1e308,1e308,1e308]}',
                     '{"model":"radtan","coefficients":[NaN,0,0,0,0]}',
                     '{"model":"equidistant","coefficients":[-1e9,0,0,0]}',
                     '{"model":"fov","coefficients":[1e308]}',
                     '{"model":"radtan","coefficients":[' + ",".join(["1"] * 100_000) + "]}"):
            with self.subTest(lens=lens[:60]):
                self.refused(changed("distortion", lens))

    def test_what_is_no_calibration(self):
        deep = 100_000
        for text in ("", "\0", "{", "[]", "null", "1", "{}", '"overfly-calibration"',
                     '{"format":"overfly-calibration"}', '{"format":1,"format_version":"1"}',
                     "[" * deep, '{"a":' * deep, "[" * deep + "]" * deep,
                     changed("views", "[" * deep + "]" * deep), changed("format_version", "2"),
                     json.dumps(GOOD) + json.dumps(GOOD), " " * (17 << 20) + json.dumps(GOOD)):
            with self.subTest(text=text[:40]):
                self.refused(text)

    def test_what_is_no_text(self):
        for value in (None, 1, True, [], {}, ["camera.json"], ""):
            with self.subTest(value=value):
                self.assert_refused("listed", self.camera(value))

    def test_places(self):
        outside = self.victim.outside
        (outside / "camera.json").write_text(json.dumps(GOOD))
        link = self.victim.data / "link_out.json"
        link.symlink_to(outside / "camera.json")
        folder = self.victim.data / "link_folder"
        folder.symlink_to(outside)
        for place in ("link_out.json", "link_folder/camera.json", "../../outside/camera.json",
                      str(outside / "camera.json"), "fifo", "sparse.txt", "loop", ".", "/dev/zero",
                      "/dev/stdin", "/proc/self/mem", "/proc/kmsg", "/etc/passwd", "link_out.txt",
                      "x" * 5000, "camera.json\0.txt"):
            with self.subTest(place=place[:60]):
                self.assert_refused("listed", self.camera(place))
        # A camera outside the data folders looks like one that is not there.
        for there, absent in ((str(outside / "camera.json"), str(outside / "absent.json")),
                              ("../../outside/camera.json", "../../outside/absent.json")):
            words = [self.assert_refused("listed", self.camera(place)).replace(place, "PLACE")
                     .replace(os.path.basename(place), "NAME") for place in (there, absent)]
            self.assertEqual(words[0], words[1])


if __name__ == "__main__":
    attack.main(__doc__)
