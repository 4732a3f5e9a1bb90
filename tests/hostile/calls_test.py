#!/usr/bin/env python3
"""Attacks that try to make the server connect to an address.

Usage: calls_test.py PROGRAM [unittest options]
"""

import attack
from attack import Attack
from victim import SECRET


class Calls(Attack):
    """An address in a field must not make the server connect to it."""

    def addresses(self):
        host = f"127.0.0.1:{self.listener.port}"
        return [f"http://{host}/x.tif", f"/vsicurl/http://{host}/x.tif", f"/vsis3/{host}/x",
                f"/vsicurl_streaming/http://{host}/x.tif", f"/vsizip//vsicurl/http://{host}/x.zip/x",
                f"/vsicurl?url=http%3A%2F%2F{host}%2Fx.tif", f"/vsiwebhdfs/http://{host}/x",
                f"WMS:http://{host}/?SERVICE=WMS", f"WMTS:http://{host}/", f"WCS:http://{host}/",
                f"EEDAI:http://{host}", f"OGCAPI:http://{host}/", f"STACTA:http://{host}/x.json",
                f"ZARR:\"/vsicurl/http://{host}/\"", f"DAAS:http://{host}/", f"PLMOSAIC:base_url=http://{host}",
                f"<GDAL_WMS><Service name='TMS'><ServerUrl>http://{host}/${{z}}</ServerUrl></Service></GDAL_WMS>",
                f"<WCS_GDAL><ServiceURL>http://{host}/</ServiceURL></WCS_GDAL>", f"ftp://{host}/x",
                f"//{host}/share/x.tif", f"vrt:///vsicurl/http://{host}/x.tif"]

    def test_no_field_is_fetched(self):
        self.assert_fields_work()
        fields = [("listed", "world.imagery.0.crs"), ("listed", "world.imagery.0.file"),
                  ("listed", "world.elevation"), ("manifest", "world.manifest"),
                  ("logged", "flight.log.file"), ("listed", "data")]
        for address in self.addresses():
            for scenario, field in fields:
                with self.subTest(field=field, address=address[:60]):
                    value = [{"file": address}] if field == "world.elevation" else address
                    self.assert_refused(scenario, {field: value})
                    self.assertEqual(self.listener.calls, [])

    def test_no_estimator_is_reached(self):
        host = f"127.0.0.1:{self.listener.port}"
        for estimator in ({"type": "process", "command": ["/bin/sh", "-c", f"echo {SECRET}"]},
                          {"type": "process", "listen": f"tcp:{host}"},
                          {"type": "process", "listen": "unix:/tmp/overfly-hostile.sock"},
                          {"type": "ros1", "ros1": {"master_uri": f"http://{host}"}},
                          {"type": "lcm", "lcm": {"url": "udpm://239.255.76.67:7667?ttl=1"}}):
            with self.subTest(estimator=str(estimator)[:60]):
                answer = self.victim.launch("listed", {"estimators": [{"name": "e", **estimator}]})
                self.assertIn(answer.status, (400, 403), answer.text[:300])


if __name__ == "__main__":
    attack.main(__doc__)
