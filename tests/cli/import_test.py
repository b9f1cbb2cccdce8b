# SPDX-License-Identifier: Apache-2.0
"""dsbuild import: folders of models and the Princeton benchmark's layout become recipes that plan and build."""
import csv
import json
import shutil
import struct
import zlib

from harness import TinyCase, main

SMALL = ["--set", "camera.views=[0]", "--set", "engine.width=16", "--set", "engine.height=16", "--set",
         "engine.error=false", "--set", "engine.spp=1"]


def cla(*classes):
    """A .cla file of (name, parent, models)."""
    lines = ["PSB 1", f"{len(classes)} {sum(len(models) for _, _, models in classes)}"]
    for name, parent, models in classes:
        lines += [f"{name} {parent} {len(models)}", *models]
    return "\n".join(lines) + "\n"


class ImportTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.box = (self.tiny / "models/box.off").read_text()
        self.tetra = (self.tiny / "models/tetra.ply").read_text()
        self.models = self.folder / "shapes"
        self.to = self.folder / "project"

    def put(self, files):
        for path, text in files.items():
            file = self.models / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)

    def take_in(self, *arguments, code=0):
        run = self.run_it("import", *arguments, "-o", self.to, "--json")
        self.assertEqual(run.code, code, run)
        return run.json

    def rows(self, file="classes.csv"):
        return list(csv.reader((self.to / file).read_text().splitlines()))

    def built(self):
        run = self.run_it("build", self.to / "recipe.toml", "-o", self.out, "--json", *SMALL)
        self.assertEqual(run.code, 0, run)
        return {(r["model"], r["class_path"], r["split"], r["class_id"]) for r in
                map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())}

    def test_folders_are_classes(self):
        self.put({"car/suv/a.off": self.box, "car/b.off": self.box, "chair/c.ply": self.tetra, "loose.off": self.box,
                  "chair/bad.off": "OFF\n3 1 0\n0 0 0\n", "chair/notes.txt": "-"})
        told = self.take_in(self.models)
        self.assertEqual((told["models"], told["classes"]), (4, ["car", "car/suv", "chair"]))
        self.assertEqual([entry["model"] for entry in told["broken"]], ["chair/bad.off"])
        self.assertIn("bad.off", told["broken"][0]["error"])
        self.assertEqual(told["unclassified"], ["loose.off"])
        self.assertEqual(self.rows(), [["name", "class", "split"], ["b.off", "car", ""], ["a.off", "car/suv", ""],
                                       ["c.ply", "chair", ""], ["loose.off", "", ""]])
        self.assertEqual((self.to / "ids.txt").read_text(), "car\ncar/suv\nchair\n")
        self.assertEqual({(m, c, i) for m, c, _, i in self.built()},
                         {("b.off", "car", 0), ("a.off", "car/suv", 1), ("c.ply", "chair", 2), ("loose.off", "", None)})

    def test_a_blank_at_a_folders_end_is_none_of_its_class(self):
        self.put({"chair /a.off": self.box, "chair /b.off": self.box, "table/c.ply": self.tetra, " big  cup/d.ply": self.tetra})
        self.assertEqual(self.take_in(self.models)["classes"], ["big  cup", "chair", "table"])
        self.assertEqual((self.to / "ids.txt").read_text(), "big  cup\nchair\ntable\n")
        self.assertEqual({(m, c, i) for m, c, _, i in self.built()},
                         {("d.ply", "big  cup", 0), ("a.off", "chair", 1), ("b.off", "chair", 1), ("c.ply", "table", 2)})
        ids = self.run_it("classes", self.to / "recipe.toml", "--ids")
        self.assertEqual((ids.code, ids.out), (0, "big  cup\nchair\ntable\n"))

    def test_what_is_wrong_is_said_of_the_folder(self):
        self.models.mkdir()
        run = self.run_it("import", self.models, "-o", self.to)
        self.assertEqual(run.code, 2, run)
        self.assertIn(f"{self.models}: must hold a .ply", run.err)
        self.assertNotIn("--set", run.err)

    def test_a_folder_of_two_lines_is_no_class(self):
        self.put({"two\nlines/a.off": self.box, "box/b.off": self.box})
        recipe = self.tiny / "recipe.toml"
        recipe.write_text(recipe.read_text().replace('[models]\ndir = "models"', f'[models]\ndir = "{self.models}"\nrecursive = true\nup = "y"\n\n'
                                                     '[classes]\nfrom = "folder"'))
        run = self.run_it("classes", recipe)
        self.assertEqual(run.code, 2, run)
        self.assertIn('a folder whose name is a class must have no control character, got "two\\nlines"', run.err)

    def test_materials_of_their_own_are_proposed_and_copied(self):
        square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        faces = "usemtl paint\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
        # One red pixel: PNG by the format's definition.
        chunks = [(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(b"\0\xff\0\0")), (b"IEND", b"")]
        png = b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
                                             for kind, data in chunks)
        self.put({"a/one.obj": "mtllib one.mtl\n" + square + faces, "a/one.mtl": "newmtl paint\nmap_Kd ../maps/red.png\n",
                  "b/two.obj": "mtllib gone.mtl\n" + square + faces, "c/plain.off": self.box})
        (self.models / "maps").mkdir()
        (self.models / "maps/red.png").write_bytes(png)
        told = self.take_in(self.models, "--copy")
        self.assertEqual(told["own_materials"], ["a/one.obj"])
        self.assertEqual([entry["model"] for entry in told["own_materials_broken"]], ["b/two.obj"])
        self.assertIn("gone.mtl", told["own_materials_broken"][0]["error"])
        recipe = (self.to / "recipe.toml").read_text()
        line = '# 1 of 3 models have materials of their own: assign = "own" in place of these two lines shows them\n'
        self.assertIn('dir = "materials"\nassign = "random"\n' + line, recipe)
        shutil.rmtree(self.models)  # the copy is whole
        (self.to / "recipe.toml").write_text(recipe.replace('dir = "materials"\nassign = "random"\n' + line, 'assign = "own"\n'))
        run = self.run_it("build", self.to / "recipe.toml", "-o", self.out, "--json", "-k", *SMALL)
        self.assertEqual((run.code, run.json["built"], run.json["failed"]), (1, 2, 1), run)
        self.assertIn("gone.mtl", run.err)

    def test_a_folder_for_each_model(self):
        files = {f"{kind}/{number}/model.off": self.box for kind in ("big car", "mug") for number in ("one", "two")}
        self.put(files)
        run = self.run_it("import", self.models, "-o", self.to)
        self.assertEqual(run.code, 0, run)
        self.assertIn("4 of 4 classes have one model, as big car/one: all folders that a model lies in are its class; "
                      "with --classes folder the first of them is", run.err)
        shutil.rmtree(self.to)
        run = self.run_it("import", self.models, "-o", self.to, "--classes", "folder", "--json")
        self.assertEqual((run.code, run.err, run.json["classes"]), (0, "", ["big car", "mug"]), run)
        self.assertEqual({row[1] for row in self.rows()[1:]}, {"big car", "mug"})
        # Classes below others that have several models are what was meant.
        shutil.rmtree(self.to)
        shutil.rmtree(self.models)
        self.put({f"car/{kind}/{number}.off": self.box for kind in ("suv", "van") for number in ("one", "two")})
        run = self.run_it("import", self.models, "-o", self.to)
        self.assertEqual((run.code, "one model" in run.err), (0, False), run)

    def test_names_that_repeat_are_paths(self):
        self.put({"mug/1/model.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
                  "mug/2/model.obj": "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"})
        self.take_in(self.models, "--copy")
        self.assertIn('names = "path"', (self.to / "recipe.toml").read_text())
        shutil.rmtree(self.models)  # the copy stands alone
        moved = self.folder / "elsewhere"
        self.to.rename(moved)
        self.to = moved
        self.assertEqual({m for m, _, _, _ in self.built()}, {"mug/1/model.obj", "mug/2/model.obj"})

    def test_folders_train_and_test_are_splits(self):
        self.put({"train/car/a.off": self.box, "test/car/b.off": self.box})
        told = self.take_in(self.models)
        self.assertEqual((told["splits"], told["classes"]), ({"test": 1, "train": 1}, ["car"]))
        self.assertNotIn("split =", (self.to / "recipe.toml").read_text())
        self.assertEqual({(m, s) for m, _, s, _ in self.built()}, {("a.off", "train"), ("b.off", "test")})

    def test_folders_of_splits_by_all_their_names(self):
        for names in (("train", "val", "test"), ("training", "validation", "testing"), ("Train", "dev", "eval")):
            self.put({f"{name}/{kind}/{i}{name}.off": self.box for i, name in enumerate(names) for kind in ("car", "mug")})
            run = self.run_it("import", self.models, "-o", self.to, "--classes", "folders")
            self.assertEqual(run.code, 0, run)
            self.assertIn("splits are from the folders", run.out)
            for name, split in zip(names, ("train", "val", "test")):
                self.assertIn(name if name == split else f"{name} ({split})", run.out)
                self.assertIn(f"2 {split}", run.err + run.out)
            self.assertEqual({(c, s) for _, c, s in self.rows()[1:]}, {(c, s) for c in ("car", "mug") for s in ("train", "val", "test")})
            self.assertNotIn("split =", (self.to / "recipe.toml").read_text())
            self.assertEqual({s for _, _, s, _ in self.built()}, {"train", "val", "test"})
            shutil.rmtree(self.models)
            shutil.rmtree(self.to)
            shutil.rmtree(self.out)

    def test_folders_that_are_no_splits(self):
        self.put({"car/a.off": self.box, "dev/b.off": self.box, "test/c.off": self.box})
        told = self.take_in(self.models)
        self.assertEqual((told["classes"], told["splits"]), (["car", "dev"], {"": 2, "test": 1}))
        self.assertEqual((told["split_folders"], told["class_folders"]), ({"test": "test"}, ["dev"]))
        shutil.rmtree(self.to)
        told = self.take_in(self.models, "--no-split-folders")
        self.assertEqual((told["classes"], told["splits"]), (["car", "dev", "test"], {"": 3}))
        self.assertEqual((told["split_folders"], told["class_folders"]), ({}, ["dev", "test"]))

    def test_what_is_new_is_added_and_nothing_else_touched(self):
        self.put({"car/a.off": self.box, "car/b.off": self.box, "mug/c.ply": self.tetra, "mug/bad.off": "OFF\nbroken\n"})
        self.take_in(self.models)
        again = self.run_it("import", self.models, "-o", self.to)
        self.assertEqual(again.code, 2, again)
        self.assertIn("--update", again.err)
        # By hand: a comment in the recipe, another class, a model taken out, a column more, a licence.
        recipe = (self.to / "recipe.toml").read_text() + "# mine\n"
        (self.to / "recipe.toml").write_text(recipe)
        (self.to / "classes.csv").write_text("name,note,class,split\na.off,red,fast car,\nc.ply,,mug,")
        (self.to / "ids.txt").write_text("mug\nfast car\n")
        materials = sorted((self.to / "materials").iterdir())
        (self.models / "mug/c.ply").unlink()
        self.put({"boat/d.off": self.box, "car/e.off": self.box, "mug/bad.off": self.box})
        told = self.take_in(self.models, "--update")
        self.assertEqual((told["models"], told["kept"], told["classes"]), (3, 1, ["boat", "car", "mug"]))
        self.assertEqual((told["new_classes"], told["taken_out"], told["gone"]), (["boat", "car"], ["car/b.off"], ["c.ply"]))
        self.assertEqual((self.to / "classes.csv").read_text(),
                         "name,note,class,split\na.off,red,fast car,\nc.ply,,mug,\nd.off,,boat,\ne.off,,car,\nbad.off,,mug,\n")
        self.assertEqual((self.to / "ids.txt").read_text(), "mug\nfast car\nboat\ncar\n")
        self.assertEqual(((self.to / "recipe.toml").read_text(), sorted((self.to / "materials").iterdir())), (recipe, materials))
        self.assertEqual({(m, c, i) for m, c, _, i in self.built()},
                         {("a.off", "fast car", 1), ("d.off", "boat", 2), ("e.off", "car", 3), ("bad.off", "mug", 0)})
        before = (self.to / "classes.csv").read_bytes()
        told = self.take_in(self.models, "--update")
        self.assertEqual((told["models"], told["kept"], told["new_classes"]), (0, 4, []))
        self.assertEqual((self.to / "classes.csv").read_bytes(), before)

    def test_an_update_of_copies_and_of_splits(self):
        self.put({"train/car/a.off": self.box, "test/car/b.off": self.box})
        self.take_in(self.models, "--copy")
        self.put({"val/car/c.off": self.box, "test/mug/d.off": self.box})
        self.assertEqual(self.take_in(self.models, "--update")["splits"], {"test": 1, "val": 1})
        shutil.rmtree(self.models)
        self.assertEqual({(m, c, s) for m, c, s, _ in self.built()},
                         {("a.off", "car", "train"), ("b.off", "car", "test"), ("c.off", "car", "val"), ("d.off", "mug", "test")})

    def test_an_update_that_cannot_be(self):
        self.put({"car/a.off": self.box})
        run = self.run_it("import", self.models, "-o", self.to, "--update")
        self.assertEqual(run.code, 2)
        self.assertIn("--update wants the folder of an import, found no recipe.toml in it", run.err)
        self.take_in(self.models)
        other = self.folder / "other"
        (other / "car").mkdir(parents=True)
        (other / "car/z.off").write_text(self.box)
        run = self.run_it("import", other, "-o", self.to, "--update")
        self.assertEqual(run.code, 2)
        self.assertIn("takes its models from another folder (models.dir)", run.err)
        self.put({"mug/a.off": self.box})
        run = self.run_it("import", self.models, "-o", self.to, "--update")
        self.assertEqual(run.code, 2)
        self.assertIn('models.names = "path"', run.err)

    def test_the_benchmark_as_published(self):
        for number in (0, 7, 101, 1298):
            self.put({f"db/{number // 100}/m{number}/m{number}.off": self.box,
                      f"db/{number // 100}/m{number}/m{number}_info.txt": "mesh"})
        base = "classification/v1/base"
        self.put({"db/3/m300/m300.off": "OFF\nbroken\n",
                  f"{base}/baseTrain.cla": cla(("vehicle", "0", []), ("car", "vehicle", ["7", "300"]), ("cup", "0", ["101"])),
                  f"{base}/baseTest.cla": cla(("vehicle", "0", []), ("car", "vehicle", ["1298", "762"])),
                  "classification/v1/coarse1/coarse1Train.cla": cla(("moves", "0", ["7", "300"]), ("stands", "0", ["101"])),
                  "classification/v1/coarse1/coarse1Test.cla": cla(("moves", "0", ["1298", "762"]))})
        told = self.take_in("psb", self.models)
        self.assertEqual((told["models"], told["classes"], told["hierarchies"]), (4, ["cup", "vehicle/car"], ["coarse1"]))
        self.assertEqual(told["splits"], {"": 1, "test": 1, "train": 2})
        self.assertEqual(told["missing"], ["762"])
        self.assertEqual([entry["model"] for entry in told["broken"]], ["db/3/m300/m300.off"])
        self.assertEqual(self.rows("more/coarse1.csv")[1:], [["m7.off", "moves"], ["m101.off", "stands"], ["m1298.off", "moves"]])
        self.assertEqual(self.built(), {("m7.off", "vehicle/car", "train", 1), ("m101.off", "cup", "train", 0),
                                        ("m1298.off", "vehicle/car", "test", 1), ("m0.off", "", "", None)})

    def test_names_with_commas_and_quotes(self):
        self.models = self.folder / "two\nlines"  # in a comment of the recipe
        self.put({'a, "b"/x,y.off': self.box})
        self.take_in(self.models)
        self.assertEqual(self.rows()[1], ["x,y.off", 'a, "b"', ""])
        self.assertEqual({(m, c) for m, c, _, _ in self.built()}, {("x,y.off", 'a, "b"')})

    def test_what_is_in_the_way_stays(self):
        self.put({"car/a.off": self.box})
        self.to.mkdir()
        (self.to / "recipe.toml").write_text("mine")
        run = self.run_it("import", self.models, "-o", self.to)
        self.assertEqual(run.code, 2)
        self.assertIn("holds a recipe.toml already", run.err)
        (self.to / "classes.csv").write_text("name,class\n")
        self.assertIn("or --update, which adds new models to its classes.csv",
                      self.run_it("import", self.models, "-o", self.to).err)
        (self.to / "classes.csv").unlink()
        self.assertEqual((self.to / "recipe.toml").read_text(), "mine")
        (self.to / "recipe.toml").unlink()
        # An import that was cut short is done again.
        (self.to / ".dsbuild-import").write_text("")
        (self.to / "classes.csv").write_text("na")
        self.take_in(self.models)
        self.assertEqual(sorted(path.name for path in self.to.iterdir()),
                         [".dsbuild-imported", "classes.csv", "environments", "ids.txt", "materials", "recipe.toml"])

    def test_nothing_to_import(self):
        self.models.mkdir()
        for arguments, why in (([self.folder / "none"], "wanted a folder of models, found none"),
                               ([self.models], "found none in"), (["bop", self.models], "wanted DIR or psb DIR")):
            run = self.run_it("import", *arguments, "-o", self.to)
            self.assertEqual(run.code, 2, run)
            self.assertIn(why, run.err)
        self.put({"a.off": "OFF\n"})
        run = self.run_it("import", self.models, "-o", self.to)
        self.assertEqual(run.code, 1, run)
        self.assertIn("none of 1 models can be used", run.err)
        self.assertFalse(self.to.exists())


if __name__ == "__main__":
    main()
