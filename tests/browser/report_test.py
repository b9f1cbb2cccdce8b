# SPDX-License-Identifier: Apache-2.0
"""dsbuild accuracy on the tiny dataset; its page in a real browser, in light, in dark and in print."""
import base64
import csv
import io
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from devtools import Browser, find_browser

PAIRS = 4  # of tests/data/tiny: two environments, two materials
METRICS = 6

# Every text's box in the picture's own units, grown by nothing; pairs that overlap by more than a hair.
OVERLAPS = """
[...document.querySelectorAll('main svg')].flatMap(svg => {
  const frame = svg.getBoundingClientRect();
  const texts = [...svg.querySelectorAll('text')].filter(t => t.textContent.trim() != '')
    .map(t => ({words: t.textContent, box: t.getBoundingClientRect()}));
  const bad = texts.filter(t => t.box.left < frame.left - 0.5 || t.box.right > frame.right + 0.5 ||
                                t.box.top < frame.top - 1 || t.box.bottom > frame.bottom + 1)
    .map(t => 'outside: ' + t.words);
  for (let i = 0; i < texts.length; ++i) for (let j = 0; j < i; ++j) {
    const a = texts[i].box, b = texts[j].box;
    const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
    const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    if (across > 1 && down > 3) bad.push(texts[i].words + ' / ' + texts[j].words);
  }
  return bad.map(words => svg.querySelector('title').textContent + ': ' + words);
})"""

# WCAG 2.1 contrast of the text with the ground it stands on.
CONTRAST = """
(() => {
  const numbers = color => color.match(/[\\d.]+/g).slice(0, 3).map(Number);
  const luminance = color => numbers(color).map(v => v / 255)
    .map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const contrast = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  const style = selector => getComputedStyle(document.querySelector(selector));
  const ground = style('body').backgroundColor;
  const panel = style('figure .plots > svg').backgroundColor;
  const out = {ground: luminance(ground), body: contrast(style('body').color, ground),
               note: contrast(style('p.note').color, ground),
               tick: contrast(style('svg text.tick').fill, panel)};
  for (const i of [0, 1]) out['series' + i] = contrast(style('.mark.s' + i).fill, panel);
  return out;
})()"""


class ReportTest(unittest.TestCase):
    dsbuild = ""
    source = pathlib.Path()
    browser_path = None

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dsbuild-report-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.page = cls.folder / "report.html"
        subprocess.run(
            [cls.dsbuild, "accuracy", cls.source / "tests/data/tiny/recipe.toml", "-o", cls.page, "--spp", "8",
             "--seeds", "2", "--set", "camera.lens_radius_m=0.002"],
            cwd=cls.folder, check=True, capture_output=True, timeout=600)

    def setUp(self):
        self.browser = Browser(self.browser_path)
        self.addCleanup(self.browser.close)

    def open(self, scheme, media="", width=1180):
        self.browser.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1,
                          mobile=False)
        self.browser.call("Emulation.setEmulatedMedia", media=media,
                          features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.browser.open(self.page.as_uri())

    def assert_readable(self):
        self.assertEqual(self.browser.value(OVERLAPS), [])
        contrast = self.browser.value(CONTRAST)
        for what in ("body", "note", "tick"):
            self.assertGreaterEqual(contrast[what], 4.5, (what, contrast))
        for what in ("series0", "series1"):  # WCAG 1.4.11: graphics
            self.assertGreaterEqual(contrast[what], 3, (what, contrast))
        return contrast

    def test_it_shows_everything_and_asks_for_nothing(self):
        self.open("light")
        errors = self.browser.seen("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded",
                                   "Network.loadingFailed")
        self.assertEqual(errors, [])
        requests = {event["request"]["url"] for event in self.browser.seen("Network.requestWillBeSent")}
        self.assertEqual({url for url in requests if not url.startswith("data:")}, {self.page.as_uri()})
        self.assertEqual(self.browser.value("document.scripts.length"), 0)
        environments = 2
        charts = environments * (2 * METRICS + 2 * 3 + 3) + PAIRS
        self.assertEqual(self.browser.value("document.querySelectorAll('.plots > svg').length"), charts)
        self.assertEqual(self.browser.value("document.querySelectorAll('#summary tbody tr').length"), PAIRS)
        text = self.browser.value("document.body.innerText")
        for words in ("What accuracy costs: tiny", "time to 5 %", "time to 1 %", "Path depth", "no lens", "math: fast", "Sums: plain floats",
                      "plain", "floor", "green", "red"):
            self.assertIn(words, text + self.browser.value("document.body.textContent"))
        self.assertGreater(self.browser.value("document.querySelectorAll('.plots .mark').length"), 10 * PAIRS)
        self.assertGreater(self.browser.value("document.querySelectorAll('.plots .bar').length"), PAIRS)

    def test_the_numbers_in_the_page_are_those_beside_it(self):
        self.open("light")
        link = self.browser.value("document.querySelector('a[download]').href")
        held = base64.b64decode(link.split("base64,")[1])
        self.assertEqual(held, (self.folder / "report.csv").read_bytes())
        rows = list(csv.DictReader(io.StringIO(held.decode())))
        self.assertEqual({(row["environment"], row["material"]) for row in rows},
                         {(e, m) for e in ("floor", "plain") for m in ("green", "red")})
        # Pictures this small may all be too quick for the time of a sample to be seen.
        self.assertEqual({row["section"] for row in rows} - {"target"},
                         {"ladder", "reference", "fit", "geometry", "choice"})
        for row in rows:
            if row["low"] and row["high"]:
                self.assertLessEqual(float(row["low"]), float(row["value"]), row)
                self.assertLessEqual(float(row["value"]), float(row["high"]), row)
        errors = [float(row["value"]) for row in rows if row["section"] == "ladder" and row["metric"] == "error"]
        self.assertTrue(all(0 < error < 10 for error in errors), errors)

    def test_light(self):
        self.open("light")
        self.assertGreater(self.assert_readable()["ground"], 0.8)

    def test_dark(self):
        self.open("dark")
        self.assertLess(self.assert_readable()["ground"], 0.1)

    def test_a_narrow_window_scrolls_tables_only(self):
        self.open("light", width=420)
        self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), 420)

    def test_print(self):
        self.open("dark", media="print")
        self.assertEqual(self.assert_readable()["ground"], 1)
        self.browser.call("Emulation.setEmulatedMedia", media="")
        pdf = base64.b64decode(self.browser.call("Page.printToPDF", preferCSSPageSize=True)["data"])
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertLess(pdf.count(b"/Type /Page\n") or pdf.count(b"/Type /Page"), 40)


if __name__ == "__main__":
    ReportTest.browser_path = find_browser()
    if ReportTest.browser_path is None:
        print("skipped: no chromium; ci/setup --browser installs it")
        sys.exit(125)
    ReportTest.dsbuild = os.path.abspath(sys.argv.pop(1))
    ReportTest.source = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
