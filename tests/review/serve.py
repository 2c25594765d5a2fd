#!/usr/bin/env python3
"""Tries `spawnfield review --serve` as a browser and as an attacker: serve.py PROGRAM SOURCE. Exit status 77: the
program was built without the page.
"""
import http.client
import json
import math
import re
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

PROGRAM, SOURCE = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
HUSKY = str(SOURCE / "maps/robots/husky.yaml")


class Page:
    """A served page."""

    def __init__(self, folder, *options):
        self.process = subprocess.Popen([PROGRAM, "review", "map", "--robot", HUSKY, "--raster", "1", "--serve",
                                         *options], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True)
        line = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)(/[0-9a-f]{32}/)", line)
        assert found, (line, self.process.stderr.read())
        self.port, self.path = int(found.group(1)), found.group(2)

    def ask(self, method, path, body=None, **headers):
        """Returns (status, bytes)."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        try:
            connection.request(method, path, body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def query(self, what, body):
        return self.ask("POST", self.path + what, json.dumps(body))

    def pack(self, what, body):
        status, answer = self.query(what, body)
        assert status == 200, answer
        assert answer[:8] == b"SPAWNRV1"
        length = struct.unpack("<I", answer[8:12])[0]
        return json.loads(answer[12:12 + length])

    def message(self, what, body):
        status, answer = self.query(what, body)
        assert status == 400, (status, answer)
        return json.loads(answer)["message"]

    def end(self):
        """Returns (exit status, standard error)."""
        self.process.send_signal(signal.SIGTERM)
        _, err = self.process.communicate(timeout=30)
        return self.process.returncode, err


def check(what, is_true):
    if not is_true:
        sys.exit(f"serve.py: {what}")


def tries_queries(page):
    status, html = page.ask("GET", page.path)
    check("the page is served", status == 200 and b"spawnfield-data" in html)
    coarse, fine = page.pack("layers", {"--raster": 1}), page.pack("layers", {"--raster": 0.5})
    check("a finer raster has more poses", fine["layers"][0]["count"] > 3 * coarse["layers"][0]["count"])
    check("the answer has the command line of the layer", "--raster 0.5" in fine["command"])
    check("the answer has the time of the query", fine["seconds"] > 0)
    valid = 7
    flat = page.pack("layers", {"--raster": 0.5, "--max-slope": 1})
    check("a lower limit leaves fewer valid poses",
          flat["layers"][0]["counts"][valid] < fine["layers"][0]["counts"][valid])
    box = page.pack("layers", {"--raster": 0.5, "--robot": "box:0.1,0.1,0.1"})
    check("a smaller robot has more valid poses",
          box["layers"][0]["counts"][valid] > fine["layers"][0]["counts"][valid])
    triangle = {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 0]]]}
    region = page.pack("layers", {"--raster": 0.5, "--region": [json.dumps(triangle)]})
    check("a region leaves fewer poses", 0 < region["layers"][0]["count"] < 100)
    headings = page.pack("layers", {"--headings": 3})
    check("each heading is a layer", len(headings["layers"]) == 3)

    corners = [[round(3 * math.cos(k / 3), 15), round(3 * math.sin(k / 3), 15)] for k in range(19)]
    polygon = json.dumps({"type": "Polygon", "coordinates": [corners + corners[:1]]})
    inside = page.pack("spawns", {"-n": 5, "--region": polygon})
    check("a region may have many corners", inside["spawns"][0]["verdicts"] == [valid] * 5)

    spawns = page.pack("spawns", {"-n": 7, "--seed": 3, "--min-distance": 1})
    again = page.pack("spawns", {"-n": 7, "--seed": 3, "--min-distance": 1})
    check("the same seed has the same spawns", spawns["spawns"] == again["spawns"])
    check("all spawns are valid", spawns["spawns"][0]["verdicts"] == [valid] * 7)
    check("the command is sample's", spawns["command"].startswith("spawnfield sample map "))

    status, answer = page.query("pose", {"options": {}, "pose": [1.67, -3.01, 0.5, 0, 0, 0]})
    pose = json.loads(answer)
    check("a pose has its reason", status == 200 and pose["verdict"] == "off_terrain" and
          pose["reason"] == "off_terrain: the ground is large_ball")


def keeps_the_command_line(folder):
    """Queries of the page have the options of the command line, and a region of the page replaces that of it."""
    page = Page(folder, "--bounds", "-4,-4,4,4", "--region", "-2,-2,2,2", "--without", "large_ball", "--max-slope",
                "20")
    try:
        whole = page.pack("layers", {"--raster": 0.5})
        check("the region of the command line holds", whole["layers"][0]["count"] == 81)
        check("the command has all options", all(words in whole["command"] for words in (
            "--bounds=-4,-4,4,4", "--region=-2,-2,2,2", "--without large_ball")) or
            all(words in whole["command"] for words in ("--bounds -4,-4,4,4", "--region -2,-2,2,2",
                                                        "--without large_ball")))
        other = page.pack("layers", {"--raster": 0.5, "--region": "0,0,8,1"})
        check("a region of the page replaces it", other["layers"][0]["count"] == 27)
        check("and bounds remain", "--region 0,0,8,1" in other["command"])
        html = page.ask("GET", page.path)[1]
        check("the first page is served", b"spawnfield-data" in html)
    finally:
        page.end()


def refuses(page):
    for what, body, words in (
            ("layers", {"--raster": -1}, "--raster is -1, needs > 0"),
            ("layers", {"--raster": 1e-5}, "(--raster)"),
            ("layers", {"--max-slope": "x"}, "needs degrees"),
            ("layers", {"--out": "x.html"}, "--out is not a control of the page"),
            ("layers", {"--spawns": "/etc/passwd"}, "--spawns is not a control of the page"),
            ("layers", {"--robot": "/etc/passwd"}, "needs box:LX,LY,LZ"),
            ("layers", {"--region": "/etc/passwd"}, "not the name of a file"),
            ("layers", {"--region": ['{"type": "Point"}']}, "--region"),
            ("layers", [1], "not a JSON object"),
            ("pose", {"pose": [1, 2]}, "pose needs six numbers"),
            ("pose", {"pose": [0, 0, "x", 0, 0, 0]}, "pose needs six numbers"),
            ("spawns", {"-n": 0}, "-n is 0"),
            ("layers", {"--region": "12"}, "not the name of a file"),
            ("layers", {"--region": "-"}, "not the name of a file"),
            ("layers", {"--robot": 5}, "type"),
            ("layers", {"--yaw": [[[1]]]}, "--yaw needs a text or a number"),
            ("pose", {"pose": [0, 0, 0, 0, 0, 0], "options": 5}, "")):
        message = page.message(what, body)
        check(f"{what} {body} says \"{words}\", said \"{message}\"", words in message)
    check("the page lives", page.ask("GET", page.path)[0] == 200)


def keeps_strangers_out(page):
    host = f"127.0.0.1:{page.port}"
    for name, method, path, headers in (
            ("no token", "GET", "/", {}),
            ("no token", "POST", "/layers", {}),
            ("a wrong token", "GET", "/" + "0" * 32 + "/", {}),
            ("a part of the token", "GET", page.path[:-2] + "/", {}),
            ("another host, as after a DNS rebinding", "GET", page.path, {"Host": "attacker.example"}),
            ("a page of another origin", "POST", page.path + "layers", {"Origin": "http://attacker.example"}),
            ("a page of another port", "POST", page.path + "layers", {"Origin": "http://127.0.0.1:1"})):
        status, answer = page.ask(method, path, "{}" if method == "POST" else None, **headers)
        check(f"{name} gets {status}", status == 403 and b"spawnfield-data" not in answer)
    own = page.ask("POST", page.path + "layers", '{"--raster": 2}', Origin=f"http://{host}")
    check("the page's own origin is served", own[0] == 200)
    for name, headers in (("chunks", {"Transfer-Encoding": "chunked"}), ("gzip", {"Content-Encoding": "gzip"})):
        check(f"a body in {name} is refused", page.ask("POST", page.path + "layers", b"", **headers)[0] == 411)
        check("and without the token", page.ask("POST", "/layers", b"", **headers)[0] == 403)
    check("a body of 2 MB is refused", page.ask("POST", page.path + "layers", b"x" * (2 << 20))[0] == 413)
    check("other methods are refused", page.ask("PUT", page.path, "x")[0] in (400, 404))
    check("other paths are refused", page.ask("GET", page.path + "../etc/passwd")[0] in (403, 404))


def answers_in_turn(page):
    """Several queries at once: all are answered, as one after the other."""
    answers = []
    threads = [threading.Thread(target=lambda: answers.append(page.pack("layers", {"--raster": 0.2})))
               for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    check("six queries at once have one answer", len(answers) == 6)
    check("and the same", all(answer["layers"] == answers[0]["layers"] for answer in answers))


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([PROGRAM, "bake", SOURCE / "maps/training/scene.yaml", "-o", "map", "--resolution", "0.2",
                        "--quiet"], cwd=folder, check=True)
        probe = subprocess.run([PROGRAM, "review", "map", "--robot", HUSKY, "--raster", "2", "-o", "page.html"],
                               cwd=folder, capture_output=True, text=True, check=False)
        if "without the review page" in probe.stderr:
            print(probe.stderr)
            return 77
        page = Page(folder)
        try:
            tries_queries(page)
            refuses(page)
            keeps_strangers_out(page)
            answers_in_turn(page)
            second = subprocess.run([PROGRAM, "review", "map", "--robot", HUSKY, "--raster", "2", "--serve", "--port",
                                     str(page.port)], cwd=folder, capture_output=True, text=True, check=False)
            check("a port in use is named", second.returncode == 1 and f"port {page.port} cannot be used" in
                  second.stderr)
            keeps_the_command_line(folder)
            files = {path.name for path in Path(folder).iterdir()}
            check(f"no file is left: {files}", files == {"map", "page.html"})
            start = time.monotonic()
            status, err = page.end()
            check(f"Ctrl-C ends it with 0: {status} {err}", status == 0 and time.monotonic() - start < 5)
        finally:
            page.process.kill()
    return 0


if __name__ == "__main__":
    sys.exit(main())
