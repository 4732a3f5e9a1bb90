#!/usr/bin/env python3
"""Attacks without the token, and under names of other sites.

Usage: access_test.py PROGRAM [unittest options]
"""

import subprocess

import attack
from attack import Attack, handshake


class WithoutTheToken(Attack):
    ROUTES = ["/", "/index.html", "/assets/none.js", "/api/v1/health", "/api/v1/openapi.json",
              "/api/v1/scenarios", "/api/v1/scenarios/listed", "/api/v1/scenario-schema",
              "/api/v1/runs", "/api/v1/runs/x", "/api/v1/runs/x/metrics", "/api/v1/stream",
              "/no/such/page", "/../../etc/passwd"]

    def without(self, method, path, **headers):
        return self.victim.ask(method, path, headers={"Host": f"127.0.0.1:{self.victim.port}",
                                                      **headers})

    def test_every_route_is_closed(self):
        for path in self.ROUTES:
            for method in ("GET", "HEAD", "POST", "DELETE", "OPTIONS", "PUT", "BREW"):
                with self.subTest(method=method, path=path):
                    answer = self.without(method, path)
                    self.assertEqual(answer.status, 401)
                    self.assertNotIn("<title>page</title>", answer.text)

    def test_wrong_keys_open_nothing(self):
        token = self.victim.token
        self.assertTrue(token, "the server printed no token")
        self.assertGreaterEqual(len(token), 22, "shorter than 128 bit in base 64")
        wrong = ["", "x", token[:-1], token + "x", token.swapcase(), token[::-1], "\x00", "*" * 4000]
        for key in wrong:
            for headers in ({"Authorization": f"Bearer {key}"}, {"Authorization": key},
                            {"Authorization": f"Basic {key}"}, {"Cookie": f"token={key}"}):
                if "\x00" in key:
                    continue
                with self.subTest(key=key[:50], headers=list(headers)):
                    self.assertEqual(self.without("GET", "/api/v1/runs", **headers).status, 401)
            query = "".join(f"%{ord(c):02x}" for c in key)
            self.assertEqual(self.without("GET", f"/api/v1/runs?token={query}").status, 401)

    def test_upgrade_is_closed(self):
        answer = handshake(self.victim, token=None)
        self.assertIn(b" 401 ", answer.split(b"\r\n")[0])

    def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(self):
        answer = self.without("GET", f"/?token={self.victim.token}")
        cookie = answer.headers.get("Set-Cookie", "")
        self.assertIn("HttpOnly", cookie)
        self.assertIn("SameSite=Strict", cookie)
        pair = cookie.split(";")[0]
        self.assertEqual(self.without("GET", "/api/v1/runs", Cookie=pair).status, 200)

    def test_no_token_needs_loopback(self):
        done = subprocess.run([attack.PROGRAM, "serve", "--port", "0", "--address", "0.0.0.0", "--no-token",
                               "--runs", str(self.victim.folder / "other_runs")],
                              capture_output=True, text=True, timeout=30, check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("token", done.stderr + done.stdout)


class Names(Attack):
    """Pages of other sites that use other names for this machine."""

    def test_loopback_answers_to_its_own_names_only(self):
        check_names(self)


class NamesOnAllAddresses(Attack):
    arguments = ("--address", "0.0.0.0")

    def test_all_addresses_answer_to_their_own_names_only(self):
        check_names(self)


def check_names(test):
    victim = test.victim
    port = victim.port
    good = [f"127.0.0.1:{port}", f"localhost:{port}"]
    evil = ["evil.example", f"evil.example:{port}", "127.0.0.1.evil.example", f"localhost.evil:{port}",
            "", "10.1.2.3", "[::2]", "127.0.0.1@evil.example", "evil.example#127.0.0.1", "x" * 3000]
    for host in good:
        test.assertEqual(victim.get("/runs", headers=victim.headers(Host=host)).status, 200, host)
        test.assertIn(b" 101 ", handshake(victim, host=host).split(b"\r\n")[0])
    for host in evil:
        with test.subTest(host=host[:40]):
            for method, path in (("GET", "/api/v1/runs"), ("POST", "/api/v1/runs"), ("GET", "/")):
                answer = victim.ask(method, path, headers=victim.headers(Host=host))
                test.assertIn(answer.status, (400, 403, 421), f"{method} {path}")
            if host:
                test.assertNotIn(b" 101 ", handshake(victim, host=host).split(b"\r\n")[0])
    for origin in ("http://evil.example", f"http://evil.example:{port}", "null", "file://",
                   f"http://localhost.evil.example:{port}", "http://"):
        with test.subTest(origin=origin):
            answer = victim.ask("POST", "/api/v1/runs", {"scenario": "listed"},
                                headers=victim.headers(Origin=origin))
            test.assertEqual(answer.status, 403, answer.text[:200])
            test.assertIn(b" 403 ", handshake(victim, origin=origin).split(b"\r\n")[0])


if __name__ == "__main__":
    attack.main(__doc__)
