# SPDX-License-Identifier: Apache-2.0
"""Datasets that are of no use are said to be so; cameras that fit leave no model cut off."""
import json
import re
import shutil
import struct
import zlib

from harness import IMAGES, TinyCase, main

NONE = {name: 0 for name in ("mask_empty", "mask_at_frame", "mask_small", "picture_black", "picture_white",
                             "models_absent", "models_unlisted", "entries_ambiguous", "classes_unshared",
                             "classes_empty", "splits_empty", "assets_unphysical", "assets_unlikely", "sizes_unlikely",
                             "names_by_case", "meshes_damaged", "models_unlikely", "own_materials_partial",
                             "distractors_unplaced", "draws_idle")}


def grey_png(path):
    """Rows of an 8 bit grey PNG, by the format's definition."""
    data = path.read_bytes()
    width, height, depth, colour = struct.unpack(">IIBB", data[16:26])
    assert (depth, colour) == (8, 0), (depth, colour)
    packed, at = b"", 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    raw = zlib.decompress(packed)
    rows, above = [], bytes(width)
    for y in range(height):
        kind, line = raw[y * (width + 1)], raw[y * (width + 1) + 1:(y + 1) * (width + 1)]
        row = bytearray()
        for x, value in enumerate(line):
            left, up = (row[x - 1] if x else 0), above[x]
            corner = above[x - 1] if x else 0
            paeth = min((left, up, corner), key=lambda one: abs(left + up - corner - one))
            row.append((value + (0, left, up, (left + up) // 2, paeth)[kind]) % 256)
        rows.append(bytes(row))
        above = rows[-1]
    return rows


class ConcernsTest(TinyCase):
    def concerns(self, *arguments, code=0):
        run = self.run_it("build", self.recipe, "-o", self.out, "--json", *arguments)
        self.assertEqual(run.code, code, run)
        described = json.loads((self.out / "manifest/dataset.json").read_text())["concerns"]
        self.assertEqual({name: one["count"] for name, one in described.items()}, run.json["concerns"])
        return run.json["concerns"], run.err

    def test_a_good_dataset_is_not_talked_about(self):
        concerns, err = self.concerns("--strict")
        self.assertEqual(concerns, NONE)
        self.assertNotIn("dsbuild:", err)

    def test_cameras_that_see_nothing(self):
        far = ["--set", "camera.distance_m=1000"]
        concerns, err = self.concerns(*far)
        self.assertEqual(concerns["mask_empty"], IMAGES)
        self.assertIn(f"dsbuild: warning: {IMAGES} of {IMAGES} images show nothing of their model", err)
        # A build that reuses everything says the same.
        again, err_again = self.concerns(*far)
        self.assertEqual(again, concerns)
        self.assertIn("images show nothing of their model", err_again)
        # With --strict it is an error, though all is made.
        _, strict = self.concerns(*far, "--strict", code=1)
        self.assertIn("dsbuild: error: ", strict)
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_what_is_not_checked_without_masks(self):
        far = ["--set", "camera.distance_m=1000", "--set", "outputs.mask=false"]
        concerns, err = self.concerns(*far, "--set", "outputs.depth=false")
        self.assertEqual(concerns["mask_empty"], 0)
        self.assertEqual(err.count("not checked: whether images show their model whole; outputs.mask = true"), 1)
        # Depth is traced with the mask, and so knows.
        concerns, err = self.concerns(*far, "--set", "outputs.depth=exr")
        self.assertEqual(concerns["mask_empty"], IMAGES)
        self.assertNotIn("not checked", err)
        self.assertIn("images show nothing of their model", err)

    def test_cameras_that_cut_off(self):
        concerns, err = self.concerns("--set", "camera.distance_m=0.15")
        touched = 0
        for path in self.out.glob("images/*/*.mask.png"):
            rows = grey_png(path)
            edge = rows[0] + rows[-1] + bytes(row[0] for row in rows) + bytes(row[-1] for row in rows)
            touched += any(edge)
        self.assertGreater(touched, 0)
        self.assertEqual(concerns["mask_at_frame"], touched)
        self.assertIn("the mask touches the frame", err)

    def test_rooms_without_light(self):
        for path in self.tiny.glob("environments/*/environment.scn"):
            lines = [line for line in path.read_text().splitlines() if not line.startswith("scene.lights")]
            path.write_text("\n".join(lines) + "\n")
        concerns, err = self.concerns()
        self.assertEqual(concerns["picture_black"], IMAGES)
        self.assertIn("pictures are black", err)

    def test_surfaces_that_make_light(self):
        self.edit("materials/red.mat", "0.7 0.1 0.1", "255 0 0")
        wanted = ("materials/red.mat:3: scene.materials.red.kd: wanted numbers in [0, 1], found 255 0 0: "
                  "it gives back more light than it gets\n")
        concerns, err = self.concerns()
        self.assertEqual(concerns["assets_unphysical"], 1)
        self.assertEqual(err.count("red.kd"), 1, err)
        self.assertIn(wanted, err)
        self.assertIn("dsbuild: warning: ", err[:err.index("red.kd")].splitlines()[-1])
        described = json.loads((self.out / "manifest/dataset.json").read_text())["concerns"]["assets_unphysical"]
        self.assertEqual(described, {"count": 1, "of": 4, "examples": ["red.mat"]})
        # Said again by a build with nothing to do, and beforehand.
        self.assertEqual(self.concerns()[0], concerns)
        self.assertIn(wanted, self.run_it("plan", self.recipe, "-o", self.out).err)
        _, err = self.concerns("--strict", code=1)
        self.assertIn("dsbuild: error: 1 of 4 materials and environments has values that no real surface has: red.mat", err)

    def test_a_bright_image_with_a_gain(self):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)) +
               chunk(b"IDAT", zlib.compress(b"\0\xff\x80\0")) + chunk(b"IEND", b""))
        (self.tiny / "materials/t.png").write_bytes(png)
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1",
                  "kd = t\nscene.materials.red.kd = t\nscene.textures.t.type = imagemap\n"
                  "scene.textures.t.file = t.png\nscene.textures.t.gain = 2\nscene.textures.t.colorspace = nop")
        text = (self.tiny / "materials/red.mat").read_text().splitlines()
        (self.tiny / "materials/red.mat").write_text("\n".join(text[4:] + text[:4]) + "\n")
        twice = "materials/red.mat:8: scene.materials.red.kd stands in line 7 already: the last one counts"
        bright = "red.mat:8: scene.materials.red.kd: wanted numbers in [0, 1], found a texture that goes up to 2 1.0"
        for _ in range(2):  # the second time out of the database's memory
            concerns, err = self.concerns()
            self.assertEqual((concerns["assets_unphysical"], concerns["assets_unlikely"]), (1, 1))
            self.assertEqual((err.count(twice), err.count(bright)), (1, 1), err)
        self.edit("materials/red.mat", "gain = 2", "gain = 1")
        concerns, err = self.concerns()
        self.assertEqual(concerns["assets_unphysical"], 0)
        self.assertNotIn("goes up to", err)

    def test_assets_that_say_what_is_hardly_meant(self):
        self.assertEqual(self.concerns()[0]["assets_unlikely"], 0)
        with open(self.tiny / "materials/red.mat", "a", encoding="utf-8") as file:
            file.write("scene.textures.stripes.type = checkerboard2d\n")
        scene = self.tiny / "environments/plain/environment.scn"
        before = scene.read_text()
        scene.write_text(before + "scene.materials.spare.type = matte\n")
        for _ in range(2):  # the second time out of the database's memory
            concerns, err = self.concerns()
            self.assertEqual(concerns["assets_unlikely"], 2, err)
        self.assertEqual(err.count("scene.textures.stripes is used by nothing"), 1, err)
        described = json.loads((self.out / "manifest/dataset.json").read_text())["concerns"]["assets_unlikely"]
        self.assertEqual((described["count"], sorted(described["examples"])), (2, ["plain", "red.mat"]))
        scene.write_text(before)
        self.assertEqual(self.concerns()[0]["assets_unlikely"], 1)

    def test_lengths_in_millimetres(self):
        large = ["--set", "models.size_m=160"]
        wanted = "the camera stands inside the model's bounding box: the model is 160 m long, the camera 0.4"
        # Known before anything is traced.
        self.assertIn(wanted, self.run_it("plan", self.recipe, "-o", self.out, *large).err)
        concerns, err = self.concerns(*large)
        self.assertEqual(concerns["sizes_unlikely"], IMAGES)
        self.assertEqual(err.count("is models.size_m = 160 in millimetres? lengths are in metres"), 1)
        self.assertIn(f"dsbuild: warning: {IMAGES} of {IMAGES} images (box.off/0, ", err)
        described = json.loads((self.out / "manifest/dataset.json").read_text())["concerns"]["sizes_unlikely"]
        self.assertEqual((described["count"], described["of"]), (IMAGES, IMAGES))
        _, err = self.concerns(*large, "--strict", code=1)
        self.assertIn("images are of lengths that hardly go together", err)

    def paint(self, name, head, values):
        """A tetrahedron of whose vertices these properties have these values."""
        points = ("0 0 0", "4 0 0", "0 4 0", "0 0 4")
        (self.tiny / f"models/{name}").write_text(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
            "".join(f"property {one}\n" for one in head) +
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n" +
            "".join(f"{point} {values}\n" for point in points) + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")

    def test_colours_of_another_range(self):
        self.paint("dark.ply", ("uchar Red", "uchar Green", "uchar Blue"), "1 0 1")
        self.paint("below.ply", ("float red", "float green", "float blue"), "-0.5 0.5 1")
        self.assertEqual(self.concerns()[0]["models_unlikely"], 0)  # nothing shows them
        for name in ("red", "green"):
            (self.tiny / f"materials/{name}.mat").write_text(
                f"scene.textures.paint.type = hitpointcolor\nscene.materials.{name}.kd = paint\n")
        for _ in range(2):
            concerns, err = self.concerns()
            self.assertEqual(concerns["models_unlikely"], 2)
            self.assertEqual(err.count("1 of 4 models (dark.ply): some of their colours are integers that use 1/255"), 1)
            self.assertEqual(err.count("1 of 4 models (below.ply): some of their colours have parts below 0"), 1)
        described = json.loads((self.out / "manifest/dataset.json").read_text())["concerns"]["models_unlikely"]
        self.assertEqual(described, {"count": 2, "of": 4, "examples": ["below.ply", "dark.ply"]})
        _, err = self.concerns("--strict", code=1)
        self.assertIn("dsbuild: error: 2 of 4 models have colours, uvs or normals that are hardly what is meant", err)

    def test_lost_faces(self):
        (self.tiny / "models/torn.off").write_text(
            "OFF 4 5 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 0 1 9\n")
        concerns, err = self.concerns()
        self.assertEqual(concerns["meshes_damaged"], 1)
        self.assertEqual(err.count("warning"), 1, err)
        _, err = self.concerns("--strict", code=1)
        self.assertIn("lost faces when they were read", err)
        # Indices from 1 are no damage: all faces are others.
        (self.tiny / "models/torn.off").write_text(
            "OFF 4 4 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 1 3 2\n3 1 2 4\n3 1 4 3\n3 2 3 4\n")
        run = self.run_it("build", self.recipe, "-o", self.out, "-k")
        self.assertEqual(run.code, 1, run)
        self.assertEqual(run.err.count("indices run from 1 to 4, the number of its vertices"), 1, run.err)

    def test_classes_of_one_file_only(self):
        (self.tiny / "train.cla").write_text("PSB 1\n1 1\nbox 0 1\nbox\n")
        (self.tiny / "test.cla").write_text("PSB 1\n1 1\ncrate 0 1\ntetra\n")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "train.cla"\ntest = "test.cla"\n\n[materials]')
        concerns, err = self.concerns()
        self.assertEqual(concerns["classes_unshared"], 2)
        self.assertIn("2 of 2 classes have models in one of the class files only: box (train), crate (test)", err)
        self.concerns("--strict", code=1)
        self.assertEqual(self.concerns("--set", "classes.unshared=keep", "--strict")[1].count("warning"), 0)

    def test_what_chance_dealt_out_unevenly_is_said_at_the_end(self):
        """Two models in two materials: one each is even, and of both in one the other is never shown."""
        told = {}
        for seed in range(12):
            out = self.folder / f"seed{seed}"
            args = ["--set", f"dataset.seed={seed}", "--set", "materials.assign=random", "--set", "camera.views=[0]"]
            run = self.run_it("build", self.recipe, "-o", out, "--json", *args)
            self.assertEqual(run.code, 0, run)
            lines = (out / "manifest/images.jsonl").read_text().splitlines()
            shown = {json.loads(line)["material"] for line in lines}
            told[len(shown)] = run
            self.assertEqual(len(run.json["uneven"]), 2 - len(shown), run)
            if len(told) == 2:
                break
        self.assertEqual(set(told), {1, 2})
        [uneven] = told[1].json["uneven"]
        self.assertEqual((uneven["kind"], uneven["most"]["share"], uneven["least"]["share"]), ("materials", 1, 0))
        self.assertIn("materials fall unevenly: 100 % ", told[1].err)
        self.assertIn('(50 % each would be even); materials.assign = "balanced" evens them out', told[1].err)
        self.assertNotIn("unevenly", told[2].err)

    def test_entries_that_mean_several_files(self):
        """box in one format is for training, in another for the test: whoever lists the stem says it of both."""
        shutil.copy(self.tiny / "models/tetra.ply", self.tiny / "models/box.ply")
        (self.tiny / "train.cla").write_text("PSB 1\n1 2\nsolid 0 2\nbox.off\ntetra\n")
        (self.tiny / "test.cla").write_text("PSB 1\n1 1\nsolid 0 1\nbox\n")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "train.cla"\ntest = "test.cla"\n\n[materials]')
        concerns, err = self.concerns()
        self.assertEqual(concerns, {**NONE, "entries_ambiguous": 1})
        self.assertIn("1 of 3 entries of the class files means several model files each", err)
        self.assertIn(": box (box.off, box.ply)", err)
        self.concerns("--strict", code=1)
        (self.tiny / "test.cla").write_text("PSB 1\n1 1\nsolid 0 1\nbox.ply\n")
        self.assertEqual(self.concerns("--strict")[0], NONE)

    def test_check_tells_what_misleads_a_training(self):
        """tetra is for training, the same mesh in another format for the test."""
        ply = (self.tiny / "models/tetra.ply").read_text()
        (self.tiny / "models/twin.ply").write_text(ply.replace("element vertex", "comment a copy\nelement vertex"))
        (self.tiny / "train.cla").write_text("PSB 1\n1 2\nsolid 0 2\ntetra\nbox\n")
        (self.tiny / "test.cla").write_text("PSB 1\n1 1\nsolid 0 1\ntwin\n")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "train.cla"\ntest = "test.cla"\n\n[materials]')
        self.build()
        run = self.run_it("check", self.out)
        self.assertEqual(run.code, 1, run)
        self.assertEqual(run.out.splitlines()[0], "error: leaks: 1 of 2 models is the same mesh in two splits: "
                         "twin.ply (test), tetra.ply (train) (keep all copies of a model in one split)")
        told = self.run_it("check", self.recipe, "-o", self.out, "--only", "leaks", "--json").json
        self.assertEqual((told["errors"], told["findings"][0]["count"]), (1, 1))
        (self.tiny / "test.cla").write_text("PSB 1\n1 0\nsolid 0 0\n")
        self.build("--set", "classes.unlisted=skip")
        self.assertEqual(self.run_it("check", self.out, "--only", "leaks").code, 0)
        run = self.run_it("check", self.out, "--only", "leak")
        self.assertEqual((run.code, "did you mean leaks?" in run.err), (2, True), run)

    def test_check_finds_copies_however_models_are_varied(self):
        """twin is tetra's file under another name and class, turned is box with its axes changed round."""
        shutil.copy(self.tiny / "models/tetra.ply", self.tiny / "models/twin.ply")
        lines = [line for line in (self.tiny / "models/box.off").read_text().splitlines() if line[:1] not in ("", "#")]
        corners = int(lines[1].split()[0])
        (self.tiny / "models/turned.off").write_text("\n".join(
            lines[:2] + [" ".join((line.split()[1], line.split()[2], line.split()[0])) for line in lines[2:2 + corners]]
            + lines[2 + corners:]) + "\n")
        (self.tiny / "all.cla").write_text("PSB 1\n2 4\nsolid 0 2\ntetra\nbox\n\nother 0 2\ntwin\nturned\n")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "all.cla"\n\n[materials]')
        for varied in ([], ["--set", 'models.turn={rotation="any"}'], ["--set", "models.size_m={uniform=[0.05,0.1]}"]):
            with self.subTest(varied):
                self.build("--set", "classes.split={folds=2,stratified=true}", *varied)
                told = self.run_it("check", self.out, "--only", "labels", "--only", "leaks", "--json").json["findings"]
                labels = [one for one in told if one["check"] == "labels"]
                self.assertEqual([(one["level"], one["count"]) for one in labels], [("error", 1), ("warning", 1)], told)
                self.assertIn("tetra.ply (solid)", labels[0]["examples"][0])
                self.assertIn("twin.ply (other)", labels[0]["examples"][0])
                self.assertIn("turned.off (other)", labels[1]["examples"][0])
                fold_of = {line["model"]: line["fold"] for line in map(
                    json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())}
                leaks = [(one["level"], one["what"].split(" in two ")[0]) for one in told
                         if one["check"] == "leaks" and one["level"] != "note"]
                wanted = []
                if fold_of["tetra.ply"] != fold_of["twin.ply"]:
                    wanted.append(("error", "models are the same mesh"))
                if fold_of["box.off"] != fold_of["turned.off"]:
                    wanted.append(("warning", "pairs of models"))
                self.assertEqual(leaks, wanted)

    def test_pictures_that_are_all_white(self):
        concerns, err = self.concerns("--set", "outputs.tone_map=linear", "--set", "outputs.tone_map_scale=1000")
        self.assertEqual(concerns["picture_white"], IMAGES)
        self.assertIn("pictures are clipped at white", err)

    def test_classes_that_do_not_fit_the_files(self):
        (self.tiny / "train.cla").write_text("PSB 1\n3 4\n\nthing 0 0\n\nbox thing 2\nbox\ngone\n\nship 0 2\nfar\nlost\n")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "train.cla"\n\n[materials]')
        for verb in (["plan"], ["build", "-n"]):  # before anything is traced
            run = self.run_it(*verb, self.recipe, "-o", self.out, "--json")
            self.assertEqual(run.json["concerns"], {**NONE, "models_absent": 3, "models_unlisted": 1, "classes_empty": 1})
            self.assertIn("warning: 3 of 4 models that the class files list have no file: far, gone, lost", run.err)
        concerns, err = self.concerns()
        self.assertEqual(concerns, {**NONE, "models_absent": 3, "models_unlisted": 1, "classes_empty": 1})
        self.assertIn("3 of 4 models that the class files list have no file: far, gone, lost", err)
        self.assertIn("1 of 2 model files stands in no class file: tetra.ply; built without a class: a line for each in ", err)
        self.assertIn("1 of 3 classes has no image: ship", err)
        self.concerns("--strict", code=1)
        # What the recipe itself allows is said, and no error.
        allowed = ["--set", "classes.missing=ignore", "--set", "classes.unlisted=skip"]
        _, err = self.concerns(*allowed)
        self.assertNotIn("warning: 3 of 4", err)
        self.assertNotIn("warning: 1 of 3", err)
        self.assertIn("3 of 4 models", err)
        skipped = r"1 of 2 model files stands in no class file: tetra.ply; left out: a line for each in \S+ mends it"
        self.assertRegex(err, skipped)
        self.assertEqual(json.loads((self.out / "manifest/dataset.json").read_text())["concerns"]["models_unlisted"]["count"], 1)
        for verb in (["plan"], ["build", "-n"], ["build"]):
            for how in ([], ["--json"]):
                run = self.run_it(*verb, self.recipe, "-o", self.out, *allowed, *how)
                self.assertEqual(len(re.findall(skipped, run.err)), 1, run)
                if how:
                    self.assertEqual(run.json["concerns"]["models_unlisted"], 1)
        run = self.run_it("check", self.out, "--only", "unused")
        self.assertIn("1 of 2 model files stand in no class file and are left out", run.out, run)
        self.assertEqual(run.code, 0, run)

    def test_a_build_that_is_cut_short_counts_what_it_made(self):
        (self.tiny / "train.cla").write_text("PSB 1\n3 2\n\nbox 0 1\nbox\n\nsolid 0 1\ntetra\n\nship 0 0\n")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "train.cla"\n\n[materials]')
        whole = (self.tiny / "models/box.off").read_text()
        (self.tiny / "models/box.off").write_text("OFF\nbroken\n")
        # It ends at the first failure: nobody knows yet that there is no tetra.
        concerns, err = self.concerns(code=1)
        self.assertEqual(concerns["classes_empty"], 2, err)  # box, which cannot be made, and ship
        self.assertIn("2 of 3 classes have no image: box, ship", err)
        self.assertIn(f"not looked at: {IMAGES} of {IMAGES} images, which this build did not make", err)
        concerns, err = self.concerns("-k", code=1)
        self.assertEqual(concerns["classes_empty"], 2, err)
        self.assertIn(f"not looked at: {IMAGES // 2} of {IMAGES} images", err)
        (self.tiny / "models/box.off").write_text(whole)
        concerns, err = self.concerns()
        self.assertEqual(concerns["classes_empty"], 1, err)
        self.assertNotIn("not looked at", err)
        # One shard after the other: what the second is to make is not missed by the first.
        self.out = self.folder / "shards"
        for shard in "1/8", "2/8":
            concerns, err = self.concerns("--shard", shard)
            self.assertEqual(concerns["classes_empty"], 1, err)

    def test_names_that_differ_in_case_only(self):
        (self.tiny / "models/Box.off").write_text((self.tiny / "models/box.off").read_text())
        concerns, err = self.concerns()
        self.assertEqual(concerns, {**NONE, "names_by_case": IMAGES})
        self.assertEqual(err.count("upper and lower case only"), 1)
        self.assertIn(f"{IMAGES} of {IMAGES * 3 // 2} images have a name that differs", err)
        self.assertRegex(err, "Box.off/0, Box.off/1, Box.off/2 and 5 more")
        self.concerns("--strict", code=1)
        # Materials are in an image's name where each is shown.
        (self.tiny / "models/Box.off").unlink()
        (self.tiny / "materials/RED.mat").write_text(
            (self.tiny / "materials/red.mat").read_text().replace("materials.red", "materials.RED"))
        self.assertEqual(self.concerns()[0]["names_by_case"], 0)
        every = self.concerns("--set", "materials.assign=all", "--set", "camera.views=[0]")[0]
        self.assertEqual(every["names_by_case"], 2 * 2)

    def test_cameras_that_fit_cut_nothing_off(self):
        wedge = self.tiny / "models/wedge.off"  # off its middle, and of another shape
        wedge.write_text("OFF\n4 4 0\n0 0 0\n9 0 0\n9 0 5\n2 4 1\n3 0 1 2\n3 0 3 1\n3 1 3 2\n3 2 3 0\n")
        fit = ["--set", "camera.distance_m=fit", "--set", "camera.set=half-dodecahedron", "--set", "engine.width=48"]
        concerns, err = self.concerns(*fit, "--strict")
        self.assertEqual(concerns, NONE, err)
        lines = [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]
        self.assertEqual(len(lines), 3 * 14)
        for line in lines:
            rows = grey_png(self.out / f"images/{line['id']}.mask.png")
            self.assertFalse(any(rows[0] + rows[-1]), line["id"])
            self.assertFalse(any(row[0] or row[-1] for row in rows), line["id"])
        # Nothing is stale, and a model that moves in its file moves nobody's camera.
        self.assert_counts(self.build(*fit), traced=0)
        wedge.write_text(wedge.read_text().replace("9 0 5", "9 1 5"))
        self.assert_counts(self.build(*fit), traced=14)

    def test_fit_wants_one_distance(self):
        run = self.run_it("plan", self.recipe, "--set", "camera.set=half-dodecahedron", "--set",
                          "camera.distance_m=fit", "--set", "camera.normalise=false")
        self.assertEqual(run.code, 2, run)
        self.assertIn('must be true with camera.distance_m = "fit"', run.err)
        run = self.run_it("plan", self.recipe, "--set", "camera.fit_margin=0.1")
        self.assertEqual(run.code, 2, run)


if __name__ == "__main__":
    main()
