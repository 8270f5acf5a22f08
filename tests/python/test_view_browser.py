"""The live view's page in a browser and in a notebook's kernel. The screenshots stand beside the tests that ran, to be looked at."""

import http.server
import os
import threading
import time
import unittest
from pathlib import Path

from pages import lit
from views import SCENE, Viewed, ask, in_folder

SCREENSHOTS = Path(os.environ["KEELER_SCREENSHOTS"])


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

    def wait(self, browser, condition):
        from selenium.webdriver.support.ui import WebDriverWait

        return WebDriverWait(browser, 60).until(lambda _: condition())

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
            self.assertGreater(lit(browser)[0], 0.01)

            part("pause").click()
            self.wait(browser, lambda: part("stage-name").text == "Paused")
            time.sleep(0.7)  # until the step that was in work is done
            stands = round(view.state()["orbits"], 3)
            self.wait(browser, lambda: round(orbits(), 3) == stands)
            time.sleep(0.3)
            self.assertEqual(round(view.state()["orbits"], 3), stands)
            seen = {lit(browser)[1]}
            part("step").click()
            self.wait(browser, lambda: orbits() > stands + 0.001)
            self.assertAlmostEqual(orbits(), stands + 0.002, places=6)
            for field in ("height", "cluster", "density", "spin", "size"):
                label = part("quantity").text
                Select(part("field")).select_by_visible_text(field)
                self.wait(browser, lambda: part("quantity").text != label)
                self.wait(browser, lambda: lit(browser)[1] not in seen)
                seen.add(lit(browser)[1])
            browser.find_element(By.CSS_SELECTOR, "[data-look=above]").click()
            self.wait(browser, lambda: lit(browser)[1] not in seen)
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
            self.assertEqual(view.process.wait(60), 75)
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
