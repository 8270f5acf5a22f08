"""keeler view against those who should not look: nothing is served, nothing is changed, and the run goes on to the same
bits. With KEELER_TABLE set, the table of attacks is written there."""

import json
import os
import socket
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

from views import KEELER, SCENE, Viewed

LARGE = """
planet.preset = "saturn-a-ring"
box.size = [900.0, 900.0]
particles = { count = 100000, density = 450.0, sizes = { law = "equal", radius = 1.0 } }
time = { step = 1e-3, end = 100.0 }
"""


def fragments(view):
    """Bytes that only a page, a state or a frame has."""
    return [b"HTTP/1.1 200", b"HTTP/1.0 200", b"<canvas", b'"stage"', b'"snapshots"', b"THREE", view.token.encode(), b"root:"]


table = []  # attack, tries, answers that had something


def tearDownModule():
    if "KEELER_TABLE" in os.environ:
        rows = (f"| {what} | {tries} | {served} |\n" for what, tries, served in sorted(table))
        Path(os.environ["KEELER_TABLE"]).write_text("| attack | tries | served |\n|---|---|---|\n" + "".join(rows))


class Attacks(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.scene = Path(cls.folder.name) / "scene.toml"
        cls.scene.write_text(SCENE)
        cls.view = Viewed(cls.scene, "-o", Path(cls.folder.name) / "run")
        cls.view.wait_for(lambda state: state["stage"] == "running")
        cls.view.get("pause", "POST")
        time.sleep(0.2)

    @classmethod
    def tearDownClass(cls):
        with cls.view as view:
            before = view.state()
            view.get("resume", "POST")
            view.wait_for(lambda state: state["stage"] == "finished")
        cls.folder_hash = json.loads((Path(cls.folder.name) / "run/summary.json").read_text())["state_hash"]
        done = subprocess.run([KEELER, "run", cls.scene, "-o", Path(cls.folder.name) / "alone", "--json"], capture_output=True, text=True)
        cls.folder.cleanup()
        assert before["paused"] and before["stage"] == "running", before
        assert json.loads(done.stdout)["state_hash"] == cls.folder_hash

    def still(self):
        """What a command would change. The run is paused."""
        state = self.view.state()
        return {key: state[key] for key in ("stage", "orbits", "paused", "limit", "control")}

    def refused(self, what, requests, timeout=10):
        """Each of these requests gets nothing, and the run stays as it was."""
        before = self.still()
        served = []
        for data in requests:
            said = self.view.answer(data, timeout)
            if any(fragment in said for fragment in fragments(self.view)):
                served.append((data[:200], said[:200]))
        table.append((what, len(requests), len(served)))
        self.assertEqual(served, [])
        self.assertEqual(self.still(), before)
        self.assertEqual(self.view.frame()[0]["stage"], "running")

    def test_tokens(self):
        view = self.view
        wrong = ["", "0" * 32, view.token[:-1], view.token[1:], view.token + "0", view.token.upper(), "%00" * 32, "..", "*"]
        wrong += [view.token[:k] + ("1" if view.token[k] == "0" else "0") + view.token[k + 1 :] for k in range(32)]
        self.assertNotEqual(view.token, view.token.upper())
        self.refused("a wrong token", [view.request(path, token=token) for token in wrong for path in ("", "state", "frame")])
        paths = ["/", "/index.html", "/favicon.ico", "/state", "/frame", "/past?k=0", "/robots.txt", f"/{view.token}", "*", "//",
                 f"/?{view.token}", f"/state?token={view.token}", f"/x/{view.token}/"]
        self.refused("no token", [f"GET {path} HTTP/1.1\r\nHost: {view.host}\r\nConnection: close\r\n\r\n".encode() for path in paths])
        self.refused("a command with a wrong token", [view.request(what, "POST", token="0" * 32) for what in ("resume", "stop", "step")])

    def test_names(self):
        """A page of elsewhere whose name is made to point to this machine has the right token at most by a leak."""
        view, port = self.view, self.view.port
        hosts = [f"evil.example:{port}", "evil.example", "127.0.0.1", "localhost", f"[::1]:{port}", f"127.0.0.1:{port + 1}", "",
                 f"localhost.evil.example:{port}", f"127.0.0.1:{port}.evil.example", f"x@127.0.0.1:{port}", f"2130706433:{port}",
                 f"127.0.0.1:{port}\r\nHost: evil.example", f"evil.example\r\nHost: 127.0.0.1:{port}"]
        requests = [view.request(path, host=host) for host in hosts for path in ("", "state", "frame?colour=speed&have=0")]
        requests += [f"GET /{view.token}/ HTTP/1.{k}\r\nConnection: close\r\n\r\n".encode() for k in (0, 1)]
        self.refused("another Host (DNS rebinding)", requests)
        self.refused("another Host, commands", [view.request("resume", "POST", host=host) for host in hosts])
        origins = ["http://evil.example", "null", f"https://127.0.0.1:{port}", f"http://127.0.0.1:{port + 1}", "file://", ""]
        self.refused("an Origin of elsewhere", [view.request(path, method, headers=[f"Origin: {origin}"])
                                                for origin in origins for path, method in (("resume", "POST"), ("stop", "POST"), ("state", "GET"))])

    def test_files(self):
        view = self.view
        paths = ["../../../../etc/passwd", "..%2f..%2f..%2fetc%2fpasswd", "/etc/passwd", "scene.toml", "run/scene.toml", "series.csv",
                 "snap_000000.hdf", "live.js", "past?k=../../etc/passwd", "past?k=-1", "past?k=99999999999999999999", "past?k=1e3",
                 "past?k=%00", "past", "past?k=", "state/", "frame/..", "index.html", ".", "..", "%2e%2e/", "stop", "pause", "resume"]
        self.refused("paths that are no part of the page", [view.request(path) for path in paths])
        self.refused("no such command", [view.request(path, "POST") for path in ("", "state", "frame", "past?k=0", "delete", "../stop")])
        self.refused("other methods", [view.request(path, method) for method in
                                       ("PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "CONNECT", "get", "X" * 5000) for path in ("", "stop", "resume")])

    def test_sizes(self):
        view = self.view
        large = [b"GET /" + b"a" * (1 << 20) + b" HTTP/1.1\r\n\r\n",
                 view.request("", headers=["X-Long: " + "a" * (1 << 17)]),
                 view.request("", headers=[f"X-{k}: 1" for k in range(20000)]),
                 view.request("state?" + "a=1&" * 20000)]
        self.refused("long lines and many headers", large)
        bodies = [view.request("resume", "POST", headers=["Content-Length: 10000000"]) + b"x" * 10000000,
                  view.request("resume", "POST", headers=["Content-Length: 99999999999999"]),
                  view.request("resume", "POST", headers=["Transfer-Encoding: chunked"]) + b"ffffff\r\n" + b"x" * 0xFFFFFF,
                  view.request("", headers=["Content-Length: 4"]) + b"abcd"]
        self.refused("bodies", bodies, timeout=2)

    def test_malformed(self):
        view = self.view
        good = view.request("resume", "POST")
        requests = [bytes(range(256)) * 10, b"\0" * 1000 + b"\r\n\r\n", b"\r\n" * 1000, b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"HTTP/1.1 200 OK\r\n\r\n",
                    good.replace(b"Host:", b"Host"), good.replace(b"Host: ", b"Host : "), good.replace(b"\r\nHost", b"\r\n Host"),
                    good.replace(b"\r\n\r\n", b"\r\nContent-Length: -1\r\n\r\n"), good.replace(b"\r\n\r\n", b"\r\nContent-Length: 4, 5\r\n\r\n"),
                    good.replace(b"\r\n\r\n", b"\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"),
                    b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + b"\0" * 600,
                    b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", good.replace(b"HTTP/1.1", b"HTTP/1.1\0"),
                    view.request("resume", "POST\0", token="0" * 32)]  # libmicrohttpd takes it for POST
        self.refused("malformed requests", requests, timeout=0.5)

    def test_only_this_machine(self):
        with open("/proc/net/tcp") as table:
            listening = [line.split() for line in table if f":{self.view.port:04X} 00000000:0000 0A" in line]
        self.assertEqual([words[1] for words in listening], [f"0100007F:{self.view.port:04X}"])
        with open("/proc/net/tcp6") as table:
            self.assertFalse([line for line in table if f":{self.view.port:04X} 00000000000000000000000000000000:0000 0A" in line])

    def test_the_page_is_guarded(self):
        head = self.view.answer(self.view.request("")).partition(b"\r\n\r\n")[0].decode()
        for line in ("Cache-Control: no-store", "X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer",
                     "Cross-Origin-Resource-Policy: same-origin", "default-src 'none'"):
            self.assertIn(line, head)
        self.assertNotIn("Access-Control", head)
        page = self.view.get("").decode()
        self.assertIn("<h1>A ring of &lt;/script&gt; &amp; spins</h1>", page)


class Crowds(unittest.TestCase):
    """Many connections that never end their requests, or never read the answers."""

    def crowd(self, count, what, scene=SCENE, seconds=7):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "scene.toml").write_text(scene)
            with Viewed(Path(folder, "scene.toml"), "--set", "time.end=1000") as view:
                view.wait_for(lambda state: state["stage"] == "running")
                connections = []
                for _ in range(count):
                    connection = socket.socket()
                    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                    connection.settimeout(5)
                    connection.connect(("127.0.0.1", view.port))
                    connections.append(connection)
                cut = 0

                def go_on(seconds):
                    nonlocal cut
                    end = time.monotonic() + seconds
                    while time.monotonic() < end:
                        for connection in connections[:]:
                            try:
                                what(view, connection)
                            except (ConnectionError, BlockingIOError, TimeoutError):
                                connections.remove(connection)
                                connection.close()
                                cut += 1
                        time.sleep(0.2)

                before = view.state()["orbits"]
                go_on(1)
                view.wait_for(lambda state: state["orbits"] > before)  # the run goes on beside the crowd
                view.get("pause", "POST")  # other tests need the processor meanwhile
                go_on(seconds - 1)
                before = view.state()["orbits"]  # a page of a user is served
                view.get("resume", "POST")
                view.wait_for(lambda state: state["orbits"] > before)
                for connection in connections:
                    connection.close()
                table.append((f"connections {what.__name__.replace('_', ' ')}: still there after {seconds} s", count, count - cut))
                return cut, count

    def test_requests_that_never_end(self):
        def that_send_a_byte_now_and_then(view, connection):
            sent = getattr(self, "sent", {})
            self.sent = sent
            k = sent.get(connection, 0)
            connection.sendall(view.request("state")[k : k + 1])
            sent[connection] = min(k + 1, 30)
            connection.setblocking(False)
            try:
                if connection.recv(1) == b"":
                    raise ConnectionError
            except BlockingIOError:
                pass
            finally:
                connection.settimeout(5)

        cut, count = self.crowd(100, that_send_a_byte_now_and_then)
        self.assertEqual(cut, count)

    @unittest.skipUnless("KEELER_SLOW" in os.environ, "half a minute")
    def test_answers_that_are_not_read(self):
        asked = set()

        def that_do_not_read(view, connection):
            if connection not in asked:
                asked.add(connection)
                connection.sendall(view.request("frame?colour=speed&have=0").replace(b"Connection: close\r\n", b"") * 50)
            if not is_open(view, connection):
                raise ConnectionError

        cut, count = self.crowd(60, that_do_not_read, scene=LARGE, seconds=28)
        self.assertEqual(cut, count)


def socket_is_open(connection):
    with open("/proc/net/tcp") as table:
        name = "0100007F:%04X" % connection.getsockname()[1]
        return any(line.split()[1] == name and line.split()[3] == "01" for line in table if ":" in line.split()[1])


def is_open(view, connection):
    """Whether the server has this connection."""
    ends = ["0100007F:%04X" % port for port in (view.port, connection.getsockname()[1])]
    with open("/proc/net/tcp") as table:
        return any(line.split()[1:4] == [*ends, "01"] for line in table)


if __name__ == "__main__":
    unittest.main()
