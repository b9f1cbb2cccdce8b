# SPDX-License-Identifier: Apache-2.0
"""dsbuild gallery in a real browser, opened from the disk: with 0, 1 and a few images and hostile names."""
import base64
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import gallery_sets
from devtools import Browser, find_browser

IMAGES = 40

# WCAG 2.1 contrast of a text with the nearest ground behind it, of every visible text of the page.
CONTRAST = """
(() => {
  const numbers = color => color.match(/[\\d.]+/g).map(Number);
  const share = v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  const luminance = c => c.slice(0, 3).map(v => share(v / 255)).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const bad = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node; node = walker.nextNode();) {
    const element = node.parentElement;
    if (!node.textContent.trim() || !element.checkVisibility({checkOpacity: true}) || element.closest('svg, option, script, style, :disabled')) continue;
    let behind = element, ground = [0, 0, 0, 0];
    while (behind && (ground.length === 4 && ground[3] === 0)) {
      const c = numbers(getComputedStyle(behind).backgroundColor);
      ground = c.length === 3 ? c.concat(1) : c;
      behind = behind.parentElement;
    }
    const [low, high] = [luminance(numbers(getComputedStyle(element).color)), luminance(ground)].sort((a, b) => a - b);
    const contrast = (high + 0.05) / (low + 0.05);
    if (contrast < 4.5) bad.push(node.textContent.trim().slice(0, 30) + ' ' + contrast.toFixed(2));
  }
  return bad;
})()"""

# Things to press that are smaller than 24 pixels, but those within a line of text and the thumbs of sliders.
SMALL = """
[...document.querySelectorAll('button, select, input[type=search], summary, .values label')]
  .filter(node => node.checkVisibility() && node.getBoundingClientRect().height < 23.5)
  .map(node => node.textContent.slice(0, 30) + ' ' + node.getBoundingClientRect().height)"""


class GalleryPage(unittest.TestCase):
    dsbuild = ""
    source = pathlib.Path()
    browser_path = None

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="dsbuild-gallery-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.real = gallery_sets.build_tiny(cls.dsbuild, cls.source, cls.folder)
        cls.sets = {}
        for name, count, hostile in (("none", 0, False), ("one", 1, False), ("some", IMAGES, False), ("hostile", 21, True)):
            cls.sets[name] = gallery_sets.make_set(cls.real, cls.folder / name, count, hostile)
            subprocess.run([cls.dsbuild, "gallery", cls.folder / name], check=True, capture_output=True, timeout=300)

    def setUp(self):
        self.browser = Browser(self.browser_path, "--enable-precise-memory-info")
        self.addCleanup(self.browser.close)
        self.look("light")

    def look(self, scheme, width=1400, height=900):
        self.browser.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.browser.call("Emulation.setEmulatedMedia", media="", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def open(self, name="some", hash=""):
        page = (self.folder / name / "gallery/index.html").as_uri()
        self.browser.open("about:blank")
        self.browser.open(page + ("#" + hash if hash else ""))
        self.wait("data.meta && !data.chunks.includes(false) && !document.getElementById('app').hidden")

    def value(self, expression):
        return self.browser.value(expression)

    def wait(self, expression, seconds=20):
        deadline = time.monotonic() + seconds
        while not self.value(f"Boolean({expression})"):
            self.assertLess(time.monotonic(), deadline, expression)
            time.sleep(0.05)

    def press(self, *keys):
        for key in keys:
            self.browser.press(key)

    def shown(self):
        return self.value("[...shown.order].map(i => data.ids[i])")

    def assert_quiet(self):
        trouble = self.browser.seen("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded", "Network.loadingFailed")
        self.assertEqual(trouble, [])

    def test_no_image_and_one(self):
        self.open("none")
        self.assertIn("no images yet", self.value("document.getElementById('none').textContent"))
        self.press("ArrowRight", "Enter", "End", "p", "m", "b", "+", "p")
        self.assert_quiet()
        self.open("one")
        self.assertEqual(self.value("document.getElementById('count').textContent"), "1 image")
        self.press("Enter")
        self.wait("document.querySelector('#facts table')")
        self.press("[", "]", "Escape")
        self.wait("!document.getElementById('picture').open")
        self.assert_quiet()

    def test_the_grid_shows_pictures_and_asks_for_nothing_else(self):
        self.open()
        self.wait("[...document.querySelectorAll('.cell img:first-child')].every(i => i.complete && i.naturalWidth === 32)")
        self.assertEqual(self.shown(), [line["id"] for line in self.sets["some"]])
        first = self.value("document.querySelector('.cell img').alt")
        line = self.sets["some"][0]
        self.assertEqual(first, f"{line['class_path']}, {line['material'].replace('-', ' ')}, {line['environment']}, view {line['view']}")
        # Classes that end alike are told apart by what is above; of others the last name is enough.
        captions = self.value("[...document.querySelectorAll('.cell .caption')].map(node => node.textContent.split('\\n')[0])")
        paths = [other["class_path"] for other in self.sets["some"]]
        self.assertEqual(captions, paths[:len(captions)])
        self.assertGreater(len(captions), 4)
        self.assertEqual(self.value("[...shortNames(['a/leaf', 'b/leaf', 'leaf', 'x/a/leaf', 'b/stem'])]"),
                         [["a/leaf", "a/leaf"], ["b/leaf", "b/leaf"], ["leaf", "leaf"], ["x/a/leaf", "x/a/leaf"], ["b/stem", "stem"]])
        urls = {event["request"]["url"] for event in self.browser.seen("Network.requestWillBeSent")}
        self.assertTrue(all(url.startswith(("file:", "data:")) for url in urls), urls)
        self.assert_quiet()

    def test_keys(self):
        self.open()
        at = lambda: self.value("document.activeElement.place")
        columns = self.value("grid.columns")
        self.press("ArrowRight")
        self.assertEqual(at(), 1)
        for key, place in (("ArrowDown", 1 + columns), ("ArrowLeft", columns), ("ArrowUp", 0), ("End", IMAGES - 1), ("Home", 0), ("PageDown", None), ("PageUp", 0)):
            self.press(key)
            if place is not None:
                self.assertEqual(at(), place, key)
            else:
                self.assertGreater(at(), columns)
        self.press("ArrowRight", "Enter")
        self.wait("document.getElementById('picture').open && document.querySelector('#facts table')")
        title = lambda: self.value("document.getElementById('picture-title').textContent")
        ids = [line["id"] for line in self.sets["some"]]
        self.assertEqual(title(), ids[1])
        self.press("]")
        self.assertEqual(title(), ids[2])
        self.press("[", "[")
        self.assertEqual(title(), ids[0])
        self.wait("picture.line && picture.line.id === " + repr(ids[0]))
        for key, selector in (("m", ".layers .mask"), ("c", ".layers .cut"), ("d", ".layers .base[src*=depth]"), ("n", ".layers .base[src*=normal]")):
            self.press(key)
            self.assertTrue(self.value(f"Boolean(document.querySelector({selector!r}))"), key)
            self.press(key)
            self.assertFalse(self.value(f"Boolean(document.querySelector({selector!r}))"), key)
        self.assertTrue(self.value("Boolean(document.querySelector('.layers rect.box'))"))
        self.press("b")
        self.assertFalse(self.value("Boolean(document.querySelector('.layers rect.box'))"))
        self.press("Escape")
        self.wait("!document.getElementById('picture').open")
        self.assertEqual(at(), 0, "the focus is back in the grid")
        self.press("m", "b", "+")
        self.assertEqual(self.value("[state.mask, state.boxes, state.size]"), [True, True, 256])
        self.press("-", "-")
        self.assertEqual(self.value("state.size"), 64)
        self.press("?")
        self.assertTrue(self.value("document.getElementById('words').open"))
        self.press("Escape")
        self.wait("!document.getElementById('words').open")
        self.press("/")
        self.assertEqual(self.value("document.activeElement.id"), "text")
        self.press("m")
        self.assertEqual(self.value("[state.text, state.mask]"), ["m", True], "a letter in a field is a letter")
        self.assert_quiet()

    def test_filters_are_what_python_says(self):
        self.open()
        lines = self.sets["some"]
        number = "data.columns.get('error')"
        cases = {
            "split=test": lambda line: line["split"] == "test",
            "split=test&material=material-1,material-2": lambda line: line["split"] == "test" and line["material"] in ("material-1", "material-2"),
            "error=0.02..0.03": lambda line: 0.02 <= line["relative_error"] <= 0.03,
            "q=0002": lambda line: "0002" in line["id"],
            "q=none+at+all": lambda line: False,
        }
        for hash, takes in cases.items():
            self.value(f"location.hash = {hash!r}")
            time.sleep(0.1)
            self.assertEqual(self.shown(), [line["id"] for line in lines if takes(line)], hash)
            counts = self.value("(() => { const c = data.columns.get('split'), n = countsOf(c); return Object.fromEntries(c.values.map((v, k) => [v, n[k]])); })()")
            if "split" not in hash:
                self.assertEqual(counts, {name: sum(takes(line) and line["split"] == name for line in lines) for name in ("test", "train")}, hash)
            elif "material" not in hash:
                self.assertEqual(counts["train"], sum(line["split"] == "train" for line in lines), "a list's own filter hides none of its counts")
        self.value("location.hash = 'sort=error&desc'")
        time.sleep(0.1)
        self.assertEqual(self.shown(), [line["id"] for line in sorted(lines, key=lambda line: -line["relative_error"])])
        self.value("location.hash = 'group=environment&sort=error'")
        time.sleep(0.1)
        self.assertEqual(self.shown(), [line["id"] for line in sorted(lines, key=lambda line: (line["environment"], line["relative_error"]))])
        headings = self.value("[...document.querySelectorAll('.group')].map(node => node.textContent)")
        some = sorted({line["environment"] for line in lines})[0]
        self.assertIn(f"{some}  ({sum(line['environment'] == some for line in lines)})", headings)
        self.value("location.hash = 'sample=7&seed=3'")
        time.sleep(0.1)
        drawn = self.shown()
        self.assertEqual(len(drawn), 7)
        self.open(hash="sample=7&seed=3")
        self.assertEqual(self.shown(), drawn)
        self.open(hash="sample=7&seed=4")
        self.assertNotEqual(self.shown(), drawn)
        self.assertTrue(self.value(number + ".type === 'number'"))

    def test_a_click_on_a_value_and_the_address(self):
        self.open()
        self.value("document.querySelector('[data-key=split] input').click()")
        self.assertEqual(len(self.shown()), sum(line["split"] == "test" for line in self.sets["some"]))
        self.assertEqual(self.value("location.hash"), "#split=test")
        self.assertIn(f"of {IMAGES} images", self.value("document.getElementById('count').textContent"))
        self.value("document.querySelector('.chip').click()")
        self.assertEqual((len(self.shown()), self.value("location.hash")), (IMAGES, ""))
        slider = "document.querySelector('[data-key=error] input[type=range]')"
        self.value(f"({slider}.value = 500, {slider}.dispatchEvent(new Event('input')))")
        low = self.value("state.ranges.get('error')[0]")
        self.assertEqual(self.shown(), [line["id"] for line in self.sets["some"] if line["relative_error"] >= low])
        self.assertGreater(IMAGES, len(self.shown()))
        # What an address says is what one gets, and says again.
        hash = "class=group0%2Fclass00,group2%2Fclass00&error=0.01..0.04&sort=azimuth&desc&group=split&show=error&size=64&mask&box&plots"
        self.open(hash=hash)
        self.assertEqual(self.value("hashOf()"), hash)
        self.open(hash="i=3")
        self.wait("document.querySelector('#facts table')")
        self.assertEqual(self.value("document.getElementById('picture-title').textContent"), self.sets["some"][3]["id"])
        self.open(hash="class=nothing&nonsense&error=a..b&size=7&i=9999&sort=none&check=99&%E0%A4%A")
        self.assertEqual((len(self.shown()), self.value("hashOf()")), (IMAGES, ""))
        self.assert_quiet()

    def test_findings_are_filters(self):
        """Every picture is that of five images: the check of duplicates says so of all, and names them."""
        self.open()
        findings = self.value("data.meta.checks.map(c => [c.check, c.level, c.count])")
        at = next(k for k, (check, _, _) in enumerate(findings) if check == "duplicates")
        pixels = [next(file["pixels_xxh128"] for file in line["files"] if file["kind"] == "image") for line in self.sets["some"]]
        self.assertEqual(findings[at][1:], ["error", IMAGES - len(set(pixels))])
        self.value(f"document.querySelector('[data-finding=\"{at}\"]').click()")
        self.assertEqual(self.shown(), [line["id"] for line, own in zip(self.sets["some"], pixels) if pixels.count(own) > 1])
        self.assertEqual(self.value("location.hash"), f"#check={at}")
        self.assertEqual(self.value(f"document.querySelector('[data-finding=\"{at}\"]').ariaPressed"), "true")

    def test_the_box_in_space_is_where_the_model_is(self):
        """A corner of the model's box, by the line's own matrices, against what is drawn."""
        self.open(hash="i=0")
        self.wait("document.querySelector('#facts table')")
        line = self.sets["some"][0]
        if "model_box" not in line:
            self.skipTest("the manifest has no poses")
        self.press("x")
        to_world, to_camera = line["model_to_world"], line["camera_to_world"]
        corner = [line["model_box"][0][c] for c in range(3)] + [1]
        world = [sum(to_world[r][c] * corner[c] for c in range(4)) for r in range(3)]
        eye = [sum(to_camera[r][c] * (world[r] - to_camera[r][3]) for r in range(3)) for c in range(3)]
        k = line["intrinsics"]
        pixel = [k[0][0] * eye[0] / eye[2] + k[0][2], k[1][1] * eye[1] / eye[2] + k[1][2]]
        drawn = self.value("[...document.querySelectorAll('.layers .box3')].map(path => path.getAttribute('d').match(/-?[\\d.]+/g).map(Number))")
        self.assertEqual(len(drawn), 12)
        self.assertAlmostEqual(drawn[0][0], pixel[0], 1)
        self.assertAlmostEqual(drawn[0][1], pixel[1], 1)
        # The whole of the model is in its box: so is the mask's box in that of the corners.
        xs, ys = [x for edge in drawn for x in edge[::2]], [y for edge in drawn for y in edge[1::2]]
        x, y, width, height = self.value("[...boxOf(0)]")
        self.assertLessEqual(min(xs), x + 1)
        self.assertGreaterEqual(max(xs), x + width - 1)
        self.assertLessEqual(min(ys), y + 1)
        self.assertGreaterEqual(max(ys), y + height - 1)
        self.assertEqual(self.value("document.querySelectorAll('.pose .box3').length"), 12)
        self.assertEqual(self.value("document.querySelectorAll('.layers .axis').length"), 3)
        before = self.value("document.querySelector('.pose').innerHTML")
        self.value("document.querySelector('.pose').focus()")
        self.press("ArrowLeft")
        self.assertNotEqual(self.value("document.querySelector('.pose').innerHTML"), before)
        self.assertEqual(self.value("picture.image"), 0, "the arrows turn the view, and no page")

    def test_hostile_names(self):
        self.open("hostile")
        lines = self.sets["hostile"]
        self.assertEqual(self.value("document.getElementById('name').textContent"), gallery_sets.HOSTILE[0])
        self.wait("[...document.querySelectorAll('.cell img:first-child')].every(i => i.complete && i.naturalWidth === 32)")
        self.press("+", "m", "b", "p")
        self.wait("[...document.querySelectorAll('.cell img')].every(i => i.complete && i.naturalWidth === 32)")
        for k, line in enumerate(lines[:8]):
            self.value(f"openPicture({k})")
            self.wait(f"picture.line && picture.image === {k} && [...document.querySelectorAll('.layers img')].every(i => i.complete && i.naturalWidth > 0)")
            self.assertEqual(self.value("document.getElementById('picture-title').textContent"), line["id"])
            self.assertIn(line["material"], self.value("document.getElementById('facts').textContent"))
            explain = self.value("document.getElementById('facts').innerText").split("dsbuild explain ")[1].split("\nin the dataset's")[0]
            self.assertEqual(shlex.split(explain), [".", *(["--"] if line["id"].startswith("-") else []), line["id"]])
        self.press("Escape")
        for line in lines:
            self.value(f"(clearFilters(), toggleValue('model', data.columns.get('model').values.indexOf({line['model']!r})), changed())")
            hash = self.value("location.hash.slice(1)")
            self.open("hostile", hash)
            self.assertEqual(self.shown(), [other["id"] for other in lines if other["model"] == line["model"]])
        self.assertEqual(self.value("document.querySelectorAll('script').length"), 1)
        self.assert_quiet()

    def test_a_missing_file_is_said(self):
        for victim, words in (("data/meta.js", "meta.js cannot be read"), ("data/grid-0.js", "grid-0.js cannot be read"), ("data/image-000.js", "image-000.js cannot be read")):
            copy = self.folder / "some/broken"
            shutil.copytree(self.folder / "some/gallery", copy)
            (copy / victim).unlink()
            self.browser.open("about:blank")
            self.browser.open((copy / "index.html").as_uri() + "#i=1")
            self.wait("!document.getElementById('trouble').hidden")
            self.assertIn(words, self.value("document.getElementById('trouble').textContent"))
            (copy / victim).write_text("gallery.")
            self.browser.open("about:blank")
            self.browser.open((copy / "index.html").as_uri() + "#i=1")
            self.wait("!document.getElementById('trouble').hidden")
            self.assertIn("damaged", self.value("document.getElementById('trouble').textContent"))
            shutil.rmtree(copy)

    def test_light_and_dark_can_be_read(self):
        for scheme, is_dark in (("light", False), ("dark", True)):
            self.look(scheme)
            for hash in ("", "plots&group=class&class=group0%2Fclass00", "i=2"):
                self.open(hash=hash)
                if hash == "i=2":
                    self.wait("document.querySelector('#facts table')")
                self.assertEqual(self.value(CONTRAST), [], (scheme, hash))
                self.assertEqual(self.value(SMALL), [], hash)
            ground = self.value("getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)[0]")
            self.assertEqual(ground < 60, is_dark)
        self.value("(ACTIONS.theme(), ACTIONS.theme())")  # light, dark
        self.assertEqual(self.value("document.documentElement.dataset.theme"), "dark")
        self.open()
        self.assertEqual(self.value("document.documentElement.dataset.theme"), "dark", "it is kept")

    def test_roles_and_names(self):
        self.open()
        tree = self.browser.call("Accessibility.getFullAXTree")["nodes"]
        of_role = lambda role: [node for node in tree if node.get("role", {}).get("value") == role and not node.get("ignored")]
        self.assertEqual(len(of_role("grid")), 1)
        self.assertGreater(len(of_role("row")), 1)
        self.assertGreater(len(of_role("gridcell")), 5)
        for role in ("button", "gridcell", "combobox", "searchbox", "slider", "checkbox"):
            for node in of_role(role):
                self.assertTrue(node.get("name", {}).get("value", "").strip(), (role, node))
        self.assertEqual(self.value("document.querySelectorAll('#canvas [tabindex=\"0\"]').length"), 1)
        rows = self.value("[document.getElementById('canvas').ariaRowCount, document.querySelector('.row').ariaRowIndex]")
        self.assertEqual(rows, [str(self.value("grid.rows")), "1"])

    def test_narrow(self):
        self.look("light", width=420, height=800)
        for hash in ("", "plots", "i=1"):
            self.open(hash=hash)
            self.assertLessEqual(self.value("document.documentElement.scrollWidth"), 420)

    def test_print(self):
        self.open(hash="split=train")
        pdf = base64.b64decode(self.browser.call("Page.printToPDF", preferCSSPageSize=True)["data"])
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertLess(pdf.count(b"/Type /Page\n"), 8)
        self.value("fillSheet()")
        self.assertEqual(self.value("document.querySelectorAll('.prints img').length"), len(self.shown()))
        self.assertIn("split: train", self.value("document.getElementById('sheet').textContent"))
        self.browser.call("Emulation.setEmulatedMedia", media="print")
        self.assertEqual(self.value("[document.getElementById('app').checkVisibility(), document.getElementById('sheet').checkVisibility()]"), [False, True])


if __name__ == "__main__":
    GalleryPage.browser_path = find_browser()
    if GalleryPage.browser_path is None:
        print("skipped: no chromium; ci/setup --browser installs it")
        sys.exit(125)
    GalleryPage.dsbuild = os.path.abspath(sys.argv.pop(1))
    GalleryPage.source = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
