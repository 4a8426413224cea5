#!/usr/bin/env python3
"""The pages of `etendue course` in a browser: what a student sees and what keys and the pointer do.

usage: test_course_pages.py ETENDUE [unittest option...]

Needs scripts/setup.sh browser; prints SKIPPED where there is no browser.
"""

import functools
import http.server
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import unittest

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

ETENDUE = ""
BROWSER, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"
SOLUTION = pathlib.Path(__file__).resolve().parent.parent / "course" / "light_integrator.cpp"


def browser(folder, width=1366, height=768):
    options = webdriver.ChromeOptions()
    options.binary_location = BROWSER
    for argument in ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
                     "--disable-background-networking", "--disable-component-update", f"--user-data-dir={folder}/profile"]:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=webdriver.chrome.service.Service(DRIVER), options=options)
    driver.set_window_size(width, height)
    return driver


def run(*arguments):
    return subprocess.run([ETENDUE, *map(str, arguments)], capture_output=True, text=True, timeout=300)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class CoursePages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.driver = browser(cls.folder)
        cls.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=cls.folder))
        threading.Thread(target=cls.server.serve_forever, daemon=True).start()

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.server.shutdown()
        cls.server.server_close()
        cls.temporary.cleanup()

    def open(self, page):
        self.driver.get(page if page.startswith("http") else f"http://127.0.0.1:{self.server.server_port}/{page}")

    def at(self, name):
        return self.driver.find_element(By.ID, name)

    def wait_for(self, condition, message, seconds=60):
        WebDriverWait(self.driver, seconds, 0.1).until(lambda _: condition(), message)

    def errors(self):
        return [entry["message"] for entry in self.driver.get_log("browser")
                if entry["level"] == "SEVERE" and "favicon" not in entry["message"]]

    def assert_fits(self, width):
        """No part of the page is beyond the right side of a window of that width."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": 800, "deviceScaleFactor": 1, "mobile": False})
        inside = self.driver.execute_script("return document.documentElement.scrollWidth <= window.innerWidth")
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        self.assertTrue(inside, f"the page is wider than {width} pixels")


class Lab(CoursePages):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        made = run("course", "lab", "--quick", "-o", cls.folder / "lab.html")
        assert made.returncode == 0, made.stderr

    def pictures(self):
        return self.driver.find_elements(By.CSS_SELECTOR, "#methods img")

    def sources(self):
        return [picture.get_attribute("src") for picture in self.pictures()]

    def cells(self):
        return [cell.text for cell in self.driver.find_elements(By.CSS_SELECTOR, "#methods td")]

    def test_each_method_has_a_picture_and_a_table(self):
        self.open("lab.html")
        self.assertEqual(len(self.pictures()), 4)
        for picture in self.pictures():
            self.assertTrue(self.driver.execute_script("return arguments[0].complete && arguments[0].naturalWidth > 0", picture))
        self.assertEqual(len(set(self.sources())), 4)
        self.assertEqual(len(self.cells()), 4 * 3 * 4)
        for text in self.cells():
            self.assertRegex(text, r"^(\?|[0-9.]+)$")
        self.assertEqual(self.errors(), [])

    def test_keys_and_pointer_move_sliders(self):
        self.open("lab.html")
        for name in ["plates", "lights", "samples"]:
            slider = self.at(name)
            most = int(slider.get_attribute("max"))
            slider.send_keys(Keys.HOME)
            low, low_sources, low_cells = self.at(name + "_are").text, self.sources(), self.cells()
            self.assertGreater(most, 0)
            slider.send_keys(Keys.ARROW_RIGHT)
            self.assertEqual(slider.get_attribute("value"), "1")
            self.assertNotEqual(self.at(name + "_are").text, low)
            self.assertEqual(slider.get_attribute("aria-valuetext"), self.at(name + "_are").text)
            for before, after in zip(low_sources, self.sources()):
                self.assertNotEqual(before, after)
            self.assertNotEqual(self.cells(), low_cells)
            webdriver.ActionChains(self.driver).move_to_element_with_offset(slider, slider.size["width"] // 2 - 2, 0).click().perform()
            self.assertEqual(slider.get_attribute("value"), str(most))
            slider.send_keys(Keys.HOME)
            self.assertEqual(self.sources(), low_sources)

    def test_more_samples_are_less_noise(self):
        self.open("lab.html")
        slider = self.at("samples")
        slider.send_keys(Keys.HOME)
        few = self.cells()
        slider.send_keys(Keys.END)
        ratio = (int(self.at("samples_are").text)) ** 0.5
        both = [(a, b) for a, b in zip(few, self.cells()) if "?" not in (a, b)]
        self.assertGreater(len(both), 10)
        for a, b in both:
            self.assertAlmostEqual(float(a) / float(b) / ratio, 1, delta=0.1)

    def test_alternative_texts_say_the_setting(self):
        self.open("lab.html")
        for picture in self.pictures():
            self.assertIn(self.at("samples_are").text + " samples", picture.get_attribute("alt"))

    def test_fits_small_windows_and_hints_open(self):
        self.open("lab.html")
        for width in [360, 768, 1366]:
            self.assert_fits(width)
        hint = self.driver.find_element(By.TAG_NAME, "summary")
        hint.send_keys(Keys.ENTER)
        self.assertTrue(self.driver.find_element(By.CSS_SELECTOR, "details p").is_displayed())


class CheckAndGrade(CoursePages):
    def test_a_wrong_hand_in(self):
        wrong = self.folder / "wrong"
        wrong.mkdir()
        text = SOLUTION.read_text()
        (wrong / "light_integrator.cpp").write_text(re.sub(r"GROUP_NUMBER \d+", "GROUP_NUMBER 7", text) + "\nsyntax <b>error</b>\n")
        empty = self.folder / "empty"
        self.assertEqual(run("course", "new", "ex3", empty).returncode, 0)
        self.assertEqual(run("course", "check", empty, "--no-scenes").returncode, 1)
        self.open("empty/build/check.html")
        self.assertIn("wrong", self.driver.find_element(By.TAG_NAME, "body").text)
        for picture in self.driver.find_elements(By.TAG_NAME, "img"):
            self.assertTrue(self.driver.execute_script("return arguments[0].complete && arguments[0].naturalWidth > 0", picture))
            self.assertTrue(picture.get_attribute("alt"))
        self.assert_fits(360)
        graded = run("course", "grade", wrong, empty, self.folder / "nowhere", "-o", self.folder / "grades")
        self.assertEqual(graded.returncode, 1, graded.stderr)
        self.open("grades/grades.html")
        self.assertEqual(len(self.driver.find_elements(By.XPATH, "//tr[td]")), 3)
        self.assertEqual(self.driver.find_elements(By.CSS_SELECTOR, "table b, pre b"), [], "text of a hand-in became markup")
        self.assert_fits(768)
        self.driver.find_element(By.CSS_SELECTOR, "table a").click()
        self.assertIn("check.html", self.driver.current_url)
        self.assertEqual(self.errors(), [])


class Watch(CoursePages):
    def test_the_picture_follows_what_is_saved(self):
        mine = self.folder / "mine"
        self.assertEqual(run("course", "new", "ex3", mine).returncode, 0)
        with subprocess.Popen([ETENDUE, "course", "watch", mine, "--port", "0", "--spp", "1"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True) as watch:
            try:
                address = None
                for line in watch.stdout:
                    address = re.search(r"http://\S+?(?=[\s,]|$)", line)
                    if address:
                        break
                threading.Thread(target=watch.stdout.read, daemon=True).start()
                self.open(address[0])
                self.wait_for(lambda: self.at("picture").get_attribute("src"), "no first picture")
                first = self.at("picture").get_attribute("src")
                (mine / "light_integrator.cpp").write_text(SOLUTION.read_text())
                self.wait_for(lambda: self.at("picture").get_attribute("src") != first, "no picture of what was saved")
                (mine / "light_integrator.cpp").write_text(SOLUTION.read_text() + "\n<b>x</b>\n")
                self.wait_for(lambda: "error" in self.at("messages").text, "nothing of the compiler's error")
                self.assertEqual(self.at("picture").get_attribute("class"), "old")
                self.assertIn("<b>", self.at("messages").text)
                self.assertEqual(self.errors(), [])
            finally:
                watch.terminate()
        self.wait_for(lambda: "ended" in self.at("status").text, "the page does not tell that the program has gone")


if __name__ == "__main__":
    ETENDUE = str(pathlib.Path(sys.argv.pop(1)).resolve())
    if not all(pathlib.Path(program).exists() for program in [BROWSER, DRIVER]):
        print(f"SKIPPED: no {BROWSER} with {DRIVER}; scripts/setup.sh browser installs them")
        sys.exit()
    unittest.main(verbosity=2)
