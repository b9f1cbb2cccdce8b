# SPDX-License-Identifier: Apache-2.0
"""Planes of images, from recipe to files, as a reader of the files and the manifest sees them."""
import json
import math
import pathlib
import re

import image_reader
from harness import IMAGES, TinyCase, main

def table():
    """The planes' table of the recipes' reference: encodings and convention by name."""
    text = pathlib.Path(__file__).parents[2].joinpath("recipes/README.md").read_text()
    return {name: (encodings.split(", "), convention) for name, encodings, convention in
            re.findall(r"^\| `(\w+)` \| \d+ \| ([a-z0-9, ]+) \| (.+) \|$", text, re.MULTILINE)}


PLANES = table()
# Parts that add up to the picture; of the rest what is asked by one ray, but for what materials are.
LIGHT = [name for name, (_, told) in PLANES.items() if "linear radiance before" in told and "premultiplied" not in told]
ALL = [name for name, (_, told) in PLANES.items()
       if "linear radiance before" not in told and "samples" not in told and name != "albedo"]
FLOATS = [name for name in ALL if PLANES[name][0][0] == "exr"]


def planes(*names):
    return ["--set", f"outputs.planes={json.dumps(list(names))}"]


class PlanesTest(TinyCase):
    def records(self, out=None):
        lines = (out or self.out).joinpath("manifest/images.jsonl").read_text().splitlines()
        return [json.loads(line) for line in lines]

    def values(self, record, kind, out=None):
        """Tuples of numbers, pixel by pixel."""
        path = next(file["path"] for file in record["files"] if file["kind"] == kind)
        path = (out or self.out) / path
        if path.suffix == ".png":
            width, height, channels, bits, samples = image_reader.read_png(path)
            rows = list(zip(*[iter(samples)] * channels))
        else:
            width, height, channels = image_reader.read_exr(path)
            rows = list(zip(*(channels[name] for name in (["Y"] if "Y" in channels else ["R", "G", "B"]))))
        self.assertEqual((width, height), (record["width"], record["height"]), path)
        self.assertEqual(len(rows), width * height, path)
        return rows

    def test_ids_that_no_file_can_hold_are_found_before_anything_is_traced(self):
        self.edit("environments/floor/environment.scn", "scene.objects.floor.material",
                  "scene.objects.floor.id = 70000\nscene.objects.floor.material")
        self.assertEqual(self.run_it("plan", self.recipe, "-o", self.out).code, 0)
        run = self.run_it("plan", self.recipe, "-o", self.out, *planes("object_id"))
        self.assertEqual(run.code, 1, run)
        self.assertIn("scene.objects.NAME.id must be at most 65535 for the plane object_id as png16, got 70000",
                      run.out)
        counts = self.build("-k", *planes("object_id"), code=1)
        self.assertEqual((counts["failed"], counts["built"]), (IMAGES // 2, IMAGES // 2), counts)
        self.edit("environments/floor/environment.scn", "70000", "256")
        self.assertEqual(self.build(*planes("object_id"))["failed"], 0)
        run = self.run_it("plan", self.recipe, "-o", self.out, *planes("object_id:png8"))
        self.assertIn("at most 255 for the plane object_id as png8, got 256", run.out)

    def test_planes_agree_with_each_other_and_with_the_manifest(self):
        self.edit("environments/floor/environment.scn", "scene.objects.floor.material",
                  "scene.objects.floor.id = 40000\nscene.objects.floor.material")
        self.build(*planes(*ALL))
        told = json.loads((self.out / "manifest/dataset.json").read_text())["planes"]
        self.assertEqual(set(told), set(ALL))
        self.assertEqual(told["depth"]["encoding"], "exr")
        self.assertIn("metres", told["depth"]["convention"])
        ids = set()
        for record in self.records():
            plane = {kind: self.values(record, kind) for kind in ALL}
            pose, k = record["camera_to_world"], record["intrinsics"]
            eye = [row[3] for row in pose[:3]]
            for i in range(record["width"] * record["height"]):
                depth, mask = plane["depth"][i][0], plane["mask"][i][0]
                self.assertEqual(mask, 255 if plane["object_id"][i][0] == 1 else 0)
                self.assertGreaterEqual(plane["amodal_mask"][i][0], mask)
                ids.add(plane["object_id"][i][0])
                if depth == 0:
                    for kind in FLOATS:
                        self.assertEqual(set(plane[kind][i]), {0}, kind)
                    continue
                x = (i % record["width"] + 0.5 - k[0][2]) / k[0][0]
                y = (i // record["width"] + 0.5 - k[1][2]) / k[1][1]
                way = [row[0] * x + row[1] * y + row[2] for row in pose[:3]]
                point = [e + depth * w for e, w in zip(eye, way)]
                for found, right in zip(plane["position"][i], point):
                    self.assertAlmostEqual(found, right, delta=1e-5)
                self.assertAlmostEqual(plane["distance"][i][0], math.dist(eye, point), delta=1e-5)
                for kind in ("geometry_normal", "shading_normal"):
                    normal = plane[kind][i]
                    self.assertAlmostEqual(sum(n * n for n in normal), 1, delta=1e-5)
                    self.assertLess(sum(n * w for n, w in zip(normal, way)), 1e-4, kind)
            counts = record["pixel_counts"]
            self.assertEqual(counts["amodal"], sum(v[0] == 255 for v in plane["amodal_mask"]))
            self.assertAlmostEqual(record["visible_fraction"], counts["model"] / counts["amodal"])
        self.assertEqual(ids, {0, 1, 40000})

    def test_check_finds_depths_and_poses_that_are_not_of_one_picture(self):
        def findings():
            run = self.run_it("check", self.out, "--pictures", "--only", "depths", "--only", "poses", "--json")
            return {one["check"] for one in run.json["findings"]}

        for encoding in ("depth", "depth:half", "depth:png16"):
            self.build(*planes("mask", encoding))
            self.assertEqual(findings(), set(), encoding)
        # Pictures are none of it, and what was there to look at is counted.
        no_picture = ["--set", "outputs.image=false"]
        self.build(*planes("mask"), *no_picture)
        run = self.run_it("check", self.out, "--pictures", "--json")
        self.assertEqual((run.json["pictures"], run.json["depths"]), (0, 0))
        self.assertIn("of 0 the picture was read, of 0 depth and mask (depths wants", self.run_it("check", self.out, "--pictures").out)
        self.build(*planes("mask", "depth"), *no_picture)
        run = self.run_it("check", self.out, "--pictures", "--json")
        self.assertEqual((run.json["pictures"], run.json["depths"]), (0, len(self.records())))
        self.assertEqual(findings(), set())
        records = self.records()
        one, other = (self.out / file["path"] for record in records[:2] for file in record["files"] if file["kind"] == "depth")
        one.chmod(0o644), other.chmod(0o644)
        first, second = one.read_bytes(), other.read_bytes()
        one.unlink(), other.unlink()
        one.write_bytes(second), other.write_bytes(first)
        self.assertEqual(findings(), {"depths"})
        one.write_bytes(first), other.write_bytes(second)
        self.assertEqual(findings(), set())
        lines = (self.out / "manifest/images.jsonl").read_text().splitlines()
        moved = json.loads(lines[0])
        moved["model_to_world"][0][3] += 0.1
        (self.out / "manifest/images.jsonl").unlink()
        (self.out / "manifest/images.jsonl").write_text("\n".join([json.dumps(moved), *lines[1:]]) + "\n")
        self.assertEqual(findings(), {"depths", "poses"})

    def test_encodings_hold_the_same_numbers(self):
        self.build(*planes(*FLOATS))
        other, deep = self.folder / "half", self.folder / "png"
        self.build(*planes(*(f"{name}:half" for name in FLOATS)), out=other)
        self.build(*planes("depth:png16", "distance:png16", "geometry_normal:png16", "shading_normal:png8",
                           "object_id:png8"), out=deep)
        whole = {"depth": 1000, "distance": 1000, "geometry_normal": 65535, "shading_normal": 255}
        for exact, half, png in zip(self.records(), self.records(other), self.records(deep)):
            for kind in FLOATS:
                for right, found in zip(self.values(exact, kind), self.values(half, kind, other)):
                    for a, b in zip(right, found):
                        self.assertAlmostEqual(a, b, delta=abs(a) / 2048 + 1e-7, msg=kind)
            for kind, most in whole.items():
                for right, found in zip(self.values(exact, kind), self.values(png, kind, deep)):
                    met = any(right)
                    for a, b in zip(right, found):
                        wanted = 0 if not met else a * most if most == 1000 else (a + 1) / 2 * most
                        self.assertLessEqual(abs(b - wanted), 0.51, kind)

    def test_light_adds_up_to_the_picture(self):
        linear = ["--set", "outputs.tone_map=linear", "--set", "outputs.tone_map_scale=0.5", "--set", "engine.spp=4"]
        wanted = [*linear, *planes(*(name.upper() for name in LIGHT))]
        self.assert_counts(self.build(*wanted), built=IMAGES, traced_samples=IMAGES * 32 * 32 * 4)
        lit = set()
        for record in self.records():
            shares = {kind: self.values(record, kind) for kind in LIGHT}
            for i, pixel in enumerate(self.values(record, "image")):
                for channel, sample in enumerate(pixel):
                    whole = sum(shares[kind][i][channel] for kind in LIGHT)
                    self.assertLessEqual(abs(min(1, whole * 0.5) ** (1 / 2.2) * 255 - sample), 0.51)
                    lit.update(kind for kind in LIGHT if shares[kind][i][channel] > 0)
        self.assertLessEqual({"emission", "direct_diffuse", "indirect_diffuse"}, lit)
        told = json.loads((self.out / "manifest/dataset.json").read_text())["planes"]
        self.assertIn("adds up to the picture", " ".join(told["emission"]["convention"].split()))
        verified = self.run_it("verify", self.recipe, "-o", self.out, "--rerender", 2, *wanted)
        self.assertEqual(verified.code, 0, verified)

    def test_pictures_on_a_transparent_background(self):
        linear = ["--set", "outputs.tone_map=linear", "--set", "outputs.tone_map_scale=0.5", "--set", "engine.spp=16"]
        wanted = [*linear, *planes("ALPHA", "foreground", "emission")]
        self.build(*wanted)
        exact = {record["id"]: record for record in self.records()}
        cut = self.folder / "cut"
        only = [*linear, *planes("foreground:rgba8")]
        run = self.run_it("build", self.recipe, "-o", cut, *only)
        self.assertEqual(run.code, 0, run)
        kinds = set()
        for record in self.records(cut):
            right = exact[record["id"]]
            alpha, front, behind, picture = (self.values(right, kind)
                                             for kind in ("alpha", "foreground", "emission", "image"))
            self.assertEqual(picture, self.values(record, "image", cut))
            for (a,), colour, sky, whole, found in zip(alpha, front, behind, picture,
                                                       self.values(record, "foreground", cut)):
                self.assertEqual(len(found), 4)
                self.assertLessEqual(abs(a * 255 - found[3]), 0.51)
                kinds.add(0 if a == 0 else 255 if a == 1 else 1)
                for channel in range(3):
                    # Over its own sky it is the picture, in linear light.
                    both = colour[channel] + sky[channel]
                    self.assertLessEqual(abs(min(1, both * 0.5) ** (1 / 2.2) * 255 - whole[channel]), 0.51)
                    straight = colour[channel] / a if a > 0 else 0
                    self.assertLessEqual(abs(min(1, straight * 0.5) ** (1 / 2.2) * 255 - found[channel]), 0.51)
        self.assertEqual(kinds, {0, 1, 255})
        told = json.loads((cut / "manifest/dataset.json").read_text())["planes"]["foreground"]
        self.assertEqual(told["encoding"], "rgba8")
        verified = self.run_it("verify", self.recipe, "-o", cut, "--rerender", 2, *only)
        self.assertEqual(verified.code, 0, verified)
        # It goes through the tone map; what is linear does not.
        brighter = ["--set", "outputs.tone_map_scale=0.25"]
        status = self.run_it("plan", self.recipe, "-o", cut, *only, *brighter, "--json").json
        self.assertEqual(status["stale"], IMAGES, status)
        self.run_it("build", self.recipe, "-o", cut, *only, *brighter)
        self.run_it("build", self.recipe, "-o", self.out, *wanted, *brighter)
        darker = {record["id"]: record for record in self.records()}
        for record in self.records(cut):
            self.assertNotEqual(record["files"], exact[record["id"]]["files"])
            same = {file["kind"]: file["sha256"] for file in darker[record["id"]]["files"]}
            was = {file["kind"]: file["sha256"] for file in exact[record["id"]]["files"]}
            self.assertEqual(same["foreground"], was["foreground"])
            self.assertNotEqual(same["image"], was["image"])

    def test_albedo_is_the_colour_of_the_materials(self):
        self.build(*planes("albedo", "mask", "object_id"))
        colours = {"red": (0.7, 0.1, 0.1), "green": (0.1, 0.6, 0.1)}
        for record in self.records():
            albedo, mask, ids = (self.values(record, kind) for kind in ("albedo", "mask", "object_id"))
            model = colours[record["material"]]
            for colour, on, other in zip(albedo, mask, ids):
                if on[0]:
                    right = model
                elif any(colour):
                    right = (0.5, 0.5, 0.5)  # the floor
                else:
                    right = (0, 0, 0)
                for a, b in zip(colour, right):
                    self.assertAlmostEqual(a, b, delta=1e-6)

    def test_a_plane_more_moves_no_other_file(self):
        self.build()
        before = self.contents()
        self.assert_counts(self.build(*planes("uv", "SHADING_NORMAL")), built=IMAGES, traced_samples=0)
        after = self.contents()
        self.assertEqual({name: after[name] for name in before if name.startswith("images")},
                         {name: data for name, data in before.items() if name.startswith("images")})
        self.assertEqual(len(after), len(before) + 2 * IMAGES)
        # And one less takes its files away.
        self.build(*planes("uv"))
        self.assertEqual(len(self.contents()), len(before) + IMAGES)

    def test_what_a_plane_does_not_read_leaves_it(self):
        wanted = planes(*ALL)
        self.build(*wanted)
        before = self.contents()
        self.edit("materials/red.mat", "scene.materials.red.type", "scene.materials.red.id = 9\nscene.materials.red.type")
        explained = self.run_it("explain", self.recipe, "-o", self.out, "box.off/0", "--json", *wanted).json
        self.assertIn(("files", "model.material.id"), [(c["part"], c["name"]) for c in explained["changes"]])
        self.assert_counts(self.build(*wanted), traced_samples=0)
        after = self.contents()
        changed = [name for name in before if before[name] != after[name] and name.startswith("images/")]
        self.assertTrue(changed)
        self.assertEqual([name for name in changed if not name.endswith(".material_id.png")], [])

    def test_without_picture_and_mask(self):
        counts = self.build("--set", "outputs.image=false", "--set", "outputs.mask=false", *planes("DEPTH"))
        self.assert_counts(counts, built=IMAGES, traced_samples=0)
        self.assertEqual({file["kind"] for record in self.records() for file in record["files"]}, {"distance"})
        verified = self.run_it("verify", self.recipe, "-o", self.out, "--rerender", IMAGES, "--set", "outputs.image=false",
                               "--set", "outputs.mask=false", *planes("DEPTH"))
        self.assertEqual(verified.code, 0, verified)

    def test_mistakes(self):
        for given, message in ((["dept"], 'wanted planes (mask, amodal_mask, depth, '),
                               (["dept"], "did you mean depth?"),
                               (["depth:png8"], 'wanted depth as exr, half, png16, got "png8"'),
                               (["uv", "UV:half"], "names uv twice"),
                               ([3], "outputs.planes: must be a list of strings, got 3")):
            run = self.run_it("plan", self.recipe, "-o", self.out, *planes(*given))
            self.assertEqual(run.code, 2, run)
            self.assertIn(message, run.err)
        self.edit("environments/floor/environment.scn", "scene.objects.floor.material",
                  "scene.objects.floor.id = 70000\nscene.objects.floor.material")
        run = self.run_it("build", self.recipe, "-o", self.out, *planes("object_id"))
        self.assertNotEqual(run.code, 0, run)
        self.assertIn("scene.objects.NAME.id must be at most 65535 for the plane object_id as png16, got 70000", run.err)


if __name__ == "__main__":
    main()
