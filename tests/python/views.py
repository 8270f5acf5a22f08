"""What the tests of the live view share: a program that shows something, and requests as bytes."""

import http.client
import json
import os
import socket
import subprocess
import tempfile
import time
from pathlib import Path

from pages import RING

KEELER = os.environ["KEELER_PROGRAM"]

SCENE = RING + "output = { snapshot_every = 0.2, series_every = 0.01 }\n"


class Viewed:
    """`keeler view ARGUMENT...`, which runs until it is left."""

    def __init__(self, *arguments, **options):
        self.process = subprocess.Popen(
            [KEELER, "view", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
        )
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise AssertionError(self.process.communicate()[1])
        self.host, self.token = self.address.split("/")[2:4]
        self.port = int(self.host.split(":")[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
        self.out, self.err = self.process.communicate(timeout=60)

    def connect(self, timeout=10):
        return socket.create_connection(("127.0.0.1", self.port), timeout)

    def request(self, path, method="GET", host=None, headers=(), token=None):
        """A well-formed request below the token, as bytes."""
        lines = [f"{method} /{self.token if token is None else token}/{path} HTTP/1.1",
                 f"Host: {self.host if host is None else host}", "Connection: close", *headers, "", ""]
        return "\r\n".join(lines).encode()

    def answer(self, data, timeout=10):
        """All that the server says to these bytes."""
        said = b""
        try:
            with self.connect(timeout) as connection:
                connection.sendall(data)
                while part := connection.recv(1 << 16):
                    said += part
        except (ConnectionError, TimeoutError):
            pass
        return said

    def get(self, path, method="GET"):
        """The body of a good answer."""
        said = self.answer(self.request(path, method))
        head, _, body = said.partition(b"\r\n\r\n")
        if not head.startswith(b"HTTP/1.1 200 "):
            raise AssertionError(said[:300])
        return body

    def state(self):
        return json.loads(self.get("state"))

    def frame(self, colour="speed", have=0):
        """The head of a frame, and its bytes."""
        body = self.get(f"frame?colour={colour}&have={have}")
        size = int.from_bytes(body[:4], "little")
        return json.loads(body[4 : 4 + size]), body[4 + size :]

    def shown(self, colour):
        """The head of a frame, asked for as a page does, until there is one: between two steps there may be none."""
        end = time.monotonic() + 60
        while "frame" not in (head := self.frame(colour)[0]):
            if time.monotonic() > end:
                raise AssertionError(f"no frame within 60 s: {head}")
            time.sleep(0.02)
        return head

    def wait_for(self, condition, seconds=60):
        """Returns the first state that meets the condition."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            state = self.state()
            if condition(state):
                return state
            time.sleep(0.02)
        raise AssertionError(f"not met within {seconds} s: {state}")


def in_folder(test):
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    (Path(folder.name) / "scene.toml").write_text(SCENE)
    return Path(folder.name)


def ask(view, path, method="GET"):
    """The answer to a page of sim.view()."""
    host, token = view.address.split("/")[2:4]
    connection = http.client.HTTPConnection(host, timeout=20)
    try:
        connection.request(method, f"/{token}/{path}")
        body = connection.getresponse().read()
    finally:
        connection.close()
    if path.startswith("frame"):
        return json.loads(body[4 : 4 + int.from_bytes(body[:4], "little")])
    return json.loads(body)
