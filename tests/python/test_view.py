"""keeler view and Simulation.view(): what a browser makes of the page while a run goes on, and that the run has the bits of one
that nobody watches. The screenshots stand beside the tests that ran, to be looked at."""

import http.server
import json
import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

import keeler
from views import KEELER, SCENE, Viewed

SCREENSHOTS = Path(os.environ["KEELER_SCREENSHOTS"])


def in_folder(test):
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    (Path(folder.name) / "scene.toml").write_text(SCENE)
    return Path(folder.name)


def watch(view, frames):
    """Asks for frames of all fields and for the plots until the run has ended."""
    have = {}
    while True:
        for colour in ("height", "size", "speed", "spin", "cluster", "density"):
            head, data = view.frame(colour, have.get(colour, 0))
            if head["stage"] == "finished":
                return
            if "frame" in head:
                have[colour] = head["number"]
                frames.append((head["frame"], data))
        view.get("plots")


class Bits(unittest.TestCase):
    def test_a_watched_run_has_the_bits_of_another(self):
        folder = in_folder(self)
        done = subprocess.run([KEELER, "run", folder / "scene.toml", "-o", folder / "alone", "--json"], capture_output=True, text=True)
        frames = []
        with Viewed(folder / "scene.toml", "-o", folder / "watched") as view:
            watch(view, frames)
        self.assertEqual(view.process.returncode, 0, view.err)
        summary = json.loads((folder / "watched/summary.json").read_text())
        self.assertEqual(summary["state_hash"], json.loads(done.stdout)["state_hash"])
        self.assertEqual((folder / "watched/series.csv").read_text(), (folder / "alone/series.csv").read_text())
        self.assertEqual({frame["field"] for frame, _ in frames}, {"height", "size", "speed", "spin", "cluster", "density"})
        self.assertGreater(len({frame["orbits"] for frame, _ in frames}), 5)

    def test_a_paused_and_stopped_run_goes_on_to_the_same_bits(self):
        folder = in_folder(self)
        whole = keeler.Simulation(folder / "scene.toml").run().state_hash
        with Viewed(folder / "scene.toml", "-o", folder / "run") as view:
            view.wait_for(lambda state: state["orbits"] > 0.1)
            view.get("pause", "POST")
            time.sleep(0.2)
            before = view.state()["orbits"]
            for k in range(1, 4):
                view.get("step", "POST")
                state = view.wait_for(lambda state: state["orbits"] > before + 0.002 * (k - 0.5))
                self.assertAlmostEqual(state["orbits"], before + 0.002 * k)
            head, _ = view.frame("cluster")  # another colour, of a run that stands
            self.assertAlmostEqual(head["frame"]["orbits"], before + 0.006)
            view.get("limit?steps_per_second=20", "POST")
            view.get("resume", "POST")
            slow = view.state()["orbits"]
            time.sleep(1.0)
            self.assertAlmostEqual((view.state()["orbits"] - slow) / 0.002, 20, delta=8)
            view.get("stop", "POST")
            view.process.wait(30)
        self.assertEqual(view.process.returncode, 75, view.err)
        self.assertIn(f'continue with "keeler view {folder / "run"} --resume"', view.err)
        with Viewed(folder / "run", "--resume") as view:
            view.wait_for(lambda state: state["stage"] == "finished")
        self.assertEqual(json.loads((folder / "run/summary.json").read_text())["state_hash"], whole)

    def test_ctrl_c(self):
        """A pause does not keep a signal waiting. Without -o nothing is left."""
        folder = in_folder(self)
        places = {**os.environ, "TMPDIR": str(folder)}
        with Viewed(folder / "scene.toml", env=places) as view:
            view.wait_for(lambda state: state["stage"] == "running")
            view.get("pause", "POST")
            self.assertTrue(list(folder.glob("keeler-run-*/scene.toml")))
        self.assertEqual(view.process.returncode, 0, view.err)
        self.assertEqual([path.name for path in folder.iterdir()], ["scene.toml"])


class Files(unittest.TestCase):
    def test_snapshots(self):
        """The places of a frame are those of the file; a folder shows all its snapshots and its series."""
        folder = in_folder(self)
        run = keeler.run(folder / "scene.toml", folder / "run")
        with Viewed(folder / "run") as view:
            state = view.state()
            self.assertEqual((state["stage"], state["control"], len(state["snapshots"])), ("files", False, 6))
            newest, data = view.frame("spin")
            with h5py.File(folder / "run/snap_000005.hdf") as file:
                places, radii = file["PartType1/Coordinates"][:], file["PartType1/Radius"][:]
            numbers = np.frombuffer(data[: 8 * len(radii)], "<u2").reshape(-1, 4)
            about = newest["frame"]
            found = np.array(about["low_m"]) + numbers[:, :3] * np.array(about["unit_m"][:3])
            self.assertLessEqual(np.max(np.abs(found - places) / about["unit_m"][:3]), 0.6)
            self.assertLessEqual(np.max(np.abs(numbers[:, 3] * about["unit_m"][3] - radii) / about["unit_m"][3]), 0.6)
            body = view.get("past?k=0&colour=speed")
            first = json.loads(body[4 : 4 + int.from_bytes(body[:4], "little")])
            self.assertEqual(first["frame"]["orbits"], 0.0)
            plots = json.loads(view.get("plots"))["plots"]
            self.assertIn("Scale height", [plot["title"] for plot in plots])
        with Viewed(folder / "run/snap_000002.hdf") as view:
            self.assertAlmostEqual(view.frame()[0]["frame"]["orbits"], run.snapshots[2].orbits)

    def test_refusals(self):
        folder = in_folder(self)
        (folder / "empty").mkdir()
        for arguments, message in (
            ([folder / "absent.toml"], "absent.toml"),
            ([folder / "empty"], "log.jsonl is missing"),
            ([folder / "empty", "-o", folder / "x"], "--output is for a scene"),
            ([folder / "scene.toml", "--resume"], "--resume continues a run"),
            ([folder / "scene.toml", "--port", "99999"], "is not a port from 1 to 65535"),
            ([folder / "scene.toml", "-o", ""], "is empty"),
        ):
            done = subprocess.run([KEELER, "view", *map(str, arguments)], capture_output=True, text=True, timeout=60)
            self.assertIn(done.returncode, (2, 4), done)
            self.assertIn(message, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)

    def test_open(self):
        """The browser gets the address by a file that nobody else reads."""
        folder = in_folder(self)
        (folder / "xdg-open").write_text('#!/bin/sh\nstat -c %a "$(dirname "$1")" >"$0.mode"; cp "$1" "$0.page"\n')
        (folder / "xdg-open").chmod(0o755)
        with Viewed(folder / "scene.toml", "--open", env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}) as view:
            end = time.monotonic() + 10
            while not (folder / "xdg-open.page").exists() and time.monotonic() < end:
                time.sleep(0.05)
            time.sleep(0.2)
            self.assertIn(f"url={view.address}", (folder / "xdg-open.page").read_text())
            self.assertEqual((folder / "xdg-open.mode").read_text(), "700\n")


def ask(view, path, method="GET"):
    """The answer to a page of sim.view()."""
    import http.client

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


class InPython(unittest.TestCase):
    def test_bits_and_buttons(self):
        alone = keeler.Simulation(SCENE).run()
        sim = keeler.Simulation(SCENE)
        with sim.view() as view:
            self.assertEqual(sim.view().address, view.address)
            self.assertEqual(ask(view, "state")["stage"], "idle")
            self.assertEqual(ask(view, "frame?colour=speed")["frame"]["orbits"], 0.0)
            sim.step(3)
            self.assertAlmostEqual(ask(view, "frame?colour=density")["frame"]["orbits"], 0.006)
            seen, ends = set(), threading.Event()

            def look():
                while not ends.is_set():
                    head = ask(view, "frame?colour=speed")
                    ask(view, "plots")
                    seen.add(head.get("frame", {}).get("orbits"))

            thread = threading.Thread(target=look)
            thread.start()
            sim.run()
            ends.set()
            thread.join()
            self.assertGreater(len(seen), 4)
            self.assertGreater(len(ask(view, "plots")["plots"]), 5)
            with sim.edit() as state:
                state.velocities[:, 2] += 1e-6
            number = ask(view, "frame?colour=speed")["number"]
            self.assertGreater(ask(view, f"frame?colour=height&have={number}")["number"], number)
        self.assertEqual(keeler.Simulation(SCENE).run().state_hash, alone.state_hash)
        watched = keeler.Simulation(SCENE)
        watched.view()
        self.assertEqual(watched.run().state_hash, alone.state_hash)
        with self.assertRaises(ConnectionError):
            ask(view, "state")

    def test_pause_and_stop(self):
        sim = keeler.Simulation(SCENE)
        with sim.view() as view:
            ask(view, "pause", "POST")
            timer = threading.Timer(0.5, ask, (view, "stop", "POST"))
            timer.start()
            with self.assertRaisesRegex(KeyboardInterrupt, "stopped from the view"):
                sim.run()
            self.assertEqual(sim.orbits, 0.0)
            timer.join()
            timer = threading.Timer(0.3, view.close)  # a closed page keeps nothing waiting
            timer.start()
            sim.step()
            self.assertAlmostEqual(sim.orbits, 0.002)
            timer.join()

    def test_errors(self):
        sim = keeler.Simulation(SCENE)
        for arguments in ({"port": -1}, {"port": "x"}, {"port": 70000}):
            with self.assertRaises(keeler.UsageError):
                sim.view(**arguments)
        with self.assertRaises(keeler.UsageError):
            sim.widget(height=0)
        with sim.view() as view, self.assertRaisesRegex(keeler.RunError, "no view at port"):
            keeler.Simulation(SCENE).view(port=int(view.address.split(":")[2].split("/")[0]))

    def test_the_interpreter_ends_and_forks(self):
        """Also with an open page, and while another thread computes."""
        text = """
import os, threading, keeler
sim = keeler.Simulation({scene!r})
view = sim.view()
sim.step()
child = os.fork()
if child == 0:
    sim.view
    view.close()
    raise SystemExit(0)
assert os.waitpid(child, 0)[1] == 0
threading.Thread(target=sim.run, args=(1000,), daemon=True).start()
print(view.address)
"""
        for _ in range(3):
            done = subprocess.run(["/usr/bin/python3", "-c", text.format(scene=SCENE)], capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


class Browser(unittest.TestCase):
    def setUp(self):
        if not Path("/usr/bin/chromium").exists() or not Path("/usr/bin/chromedriver").exists():
            self.skipTest("no chromium; scripts/setup test installs it")

    def browser(self, *arguments):
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle",
                         "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1300,1000", *arguments):
            options.add_argument(argument)
        browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.addCleanup(browser.quit)
        return browser

    def lit(self, browser):
        """How many pixels of the view are not sky, and a number of all."""
        return browser.execute_script(
            "const from = document.querySelector('#stage canvas'), to = document.createElement('canvas');"
            "to.width = from.width; to.height = from.height;"
            "const pen = to.getContext('2d'); pen.drawImage(from, 0, 0);"
            "const all = pen.getImageData(0, 0, to.width, to.height).data;"
            "let lit = 0, sum = 0;"
            "for (let k = 0; k < all.length; k += 4) {"
            "  if (all[k] + all[k + 1] + all[k + 2] > 60) ++lit;"
            "  sum = (31 * sum + all[k] + 7 * all[k + 1] + 13 * all[k + 2]) % 1000003; }"
            "return [lit / (all.length / 4), sum];")

    def wait(self, browser, condition):
        from selenium.webdriver.support.ui import WebDriverWait

        return WebDriverWait(browser, 30).until(lambda _: condition())

    def test_the_page(self):
        from selenium.webdriver.common.by import By
        from selenium.webdriver.support.ui import Select

        browser = self.browser()
        folder = in_folder(self)
        with Viewed(folder / "scene.toml", "--set", "time.end=50", "-o", folder / "run") as view:
            browser.get(view.address)
            part = lambda name: browser.find_element(By.ID, name)
            orbits = lambda: float(part("orbits").text.split()[1])
            slide = lambda name, value: browser.execute_script(
                f"const it = document.getElementById('{name}'); it.value = {value}; it.dispatchEvent(new Event('input'));")
            self.wait(browser, lambda: part("orbits").text and part("shown").text)
            self.assertEqual(part("stage-name").text, "Running")
            self.wait(browser, lambda: orbits() > 1.2 and browser.find_elements(By.CSS_SELECTOR, ".chart canvas"))
            time.sleep(0.5)
            browser.save_screenshot(str(SCREENSHOTS / "view-running.png"))
            self.assertGreater(self.lit(browser)[0], 0.01)

            part("pause").click()
            self.wait(browser, lambda: part("stage-name").text == "Paused")
            time.sleep(0.7)
            stands = orbits()
            time.sleep(0.3)
            self.assertEqual(orbits(), stands)
            seen = {self.lit(browser)[1]}
            part("step").click()
            self.wait(browser, lambda: orbits() > stands)
            self.assertAlmostEqual(orbits(), stands + 0.002, places=6)
            for field in ("height", "cluster", "density", "spin", "size"):
                label = part("quantity").text
                Select(part("field")).select_by_visible_text(field)
                self.wait(browser, lambda: part("quantity").text != label)
                self.wait(browser, lambda: self.lit(browser)[1] not in seen)
                seen.add(self.lit(browser)[1])
            browser.find_element(By.CSS_SELECTOR, "[data-look=above]").click()
            self.wait(browser, lambda: self.lit(browser)[1] not in seen)
            browser.save_screenshot(str(SCREENSHOTS / "view-above.png"))
            slide("time", 0)  # the past
            self.wait(browser, lambda: part("moment").text == "orbit 0.00 (snap_000000.hdf)")
            slide("time", 1000)
            self.wait(browser, lambda: part("moment").text == "now")
            slide("limit", 4)
            self.wait(browser, lambda: part("limit-text").text == "10 steps/s")
            slide("limit", 12)
            part("pause").click()
            self.wait(browser, lambda: part("stage-name").text == "Running" and orbits() > stands + 0.1)
            browser.execute_script("document.getElementById('plots').scrollIntoView()")
            time.sleep(0.5)
            browser.save_screenshot(str(SCREENSHOTS / "view-plots.png"))
            self.assertEqual([line for line in browser.get_log("browser") if line["level"] != "INFO"], [])
            browser.execute_script("window.scrollTo(0, 0)")
            part("stop").click()
            self.wait(browser, lambda: part("stage-name").text == "Stopped")
            self.assertIn("with a checkpoint; continue with", part("message").text)
            self.assertFalse(part("control").is_displayed())
            browser.save_screenshot(str(SCREENSHOTS / "view-stopped.png"))
            self.assertEqual(view.process.wait(20), 75)
        browser.get("about:blank")
        with Viewed(folder / "run") as view:
            browser.get(view.address)
            self.wait(browser, lambda: part("moment").text.startswith("orbit "))
            self.assertFalse(part("control").is_displayed())
            slide("time", 1)
            self.wait(browser, lambda: part("moment").text == "orbit 0.20 (snap_000001.hdf)")
            self.wait(browser, lambda: browser.find_elements(By.CSS_SELECTOR, ".chart canvas"))
            browser.save_screenshot(str(SCREENSHOTS / "view-folder.png"))

    def test_other_pages(self):
        """A name that was made to point here gets nothing; a page of elsewhere can neither read nor command nor frame."""
        folder = in_folder(self)

        class Elsewhere(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "text/html")
                self.end_headers()
                self.wfile.write(b"<title>elsewhere</title><body></body>")

            def log_message(self, *_):
                pass

        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Elsewhere)
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser = self.browser("--host-resolver-rules=MAP evil.example 127.0.0.1")
        with Viewed(folder / "scene.toml", "--set", "time.end=50") as view:
            view.wait_for(lambda state: state["stage"] == "running")
            browser.get(f"http://evil.example:{view.port}/{view.token}/")
            self.assertFalse("stage-name" in browser.page_source)
            browser.get(f"http://evil.example:{server.server_port}/")
            self.assertEqual(browser.title, "elsewhere")
            browser.set_script_timeout(20)
            tries = "; ".join(f"await tell(fetch('{view.address}{path}', {{method: '{method}', mode: '{mode}'}}))"
                              for path, method, mode in (("state", "GET", "cors"), ("", "GET", "cors"), ("pause", "POST", "cors"),
                                                         ("pause", "POST", "no-cors"), ("stop", "POST", "no-cors")))
            told = browser.execute_async_script(
                "const done = arguments[arguments.length - 1], told = [];"
                "const tell = async (reply) => { try { told.push(await (await reply).text()); } catch (error) { told.push('refused'); } };"
                f"(async () => {{ {tries}; done(told); }})();")
            self.assertEqual(set(told) - {"refused", ""}, set())
            state = view.state()
            self.assertEqual((state["stage"], state["paused"]), ("running", False))
            frame = f"const it = document.createElement('iframe'); it.src = '{view.address}'; document.body.appendChild(it);"
            browser.execute_script(frame)
            time.sleep(1.5)
            browser.switch_to.frame(0)
            self.assertFalse("stage-name" in browser.page_source)
            browser.switch_to.default_content()
            browser.get(f"http://localhost:{server.server_port}/")  # a notebook of this machine may
            browser.execute_script(frame)
            self.wait(browser, lambda: browser.switch_to.default_content() or browser.switch_to.frame(0) or "stage-name" in browser.page_source)


class Notebook(unittest.TestCase):
    def test_a_real_kernel(self):
        """A cell shows the page in place, and another one runs while it is watched."""
        try:
            import jupyter_client
        except ImportError:
            self.skipTest("no jupyter_client; scripts/setup test installs it")
        manager, kernel = jupyter_client.manager.start_new_kernel(kernel_name="python3")
        self.addCleanup(manager.shutdown_kernel, now=True)

        def run_cell(code, meanwhile=None):
            shown = []

            def output(message):
                shown.append((message["msg_type"], message["content"]))
                if message["msg_type"] == "execute_input" and meanwhile:
                    meanwhile()

            reply = kernel.execute_interactive(code, timeout=60, output_hook=output)
            self.assertEqual(reply["content"]["status"], "ok", reply["content"])
            return shown

        shown = run_cell(f"import keeler\nsim = keeler.Simulation({SCENE!r})\nview = sim.widget()\nview")
        page = next(content["data"]["text/html"] for kind, content in shown if kind == "execute_result")
        address = page.split('src="')[1].split('"')[0]
        self.assertIn("<iframe", page)

        class Seen:
            pass

        Seen.address = address
        seen, ends = set(), threading.Event()

        def look():
            while not ends.is_set():
                head = ask(Seen, "frame?colour=speed")
                seen.add(head["frame"]["orbits"] if "frame" in head else None)

        thread = threading.Thread(target=look)
        run_cell("sim.run(); print(sim.state_hash)", thread.start)
        ends.set()
        thread.join()
        self.assertGreater(len(seen), 4)
        run_cell("view.close()")
        with self.assertRaises(ConnectionError):
            ask(Seen, "state")


if __name__ == "__main__":
    unittest.main()
