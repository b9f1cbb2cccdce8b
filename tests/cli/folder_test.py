# SPDX-License-Identifier: Apache-2.0
"""Whose a dataset's folder is, builds of one folder at once, folders that were moved, and files that are edited."""
import json
import os
import pathlib
import shutil
import stat
import subprocess
import time

from harness import IMAGES, TinyCase, main

SLOW = ["--set", "engine.spp=64"]


def nobody():
    """For preexec_fn: permissions hold for whoever is not root."""
    os.setgid(65534)
    os.setuid(65534)


class FolderTest(TinyCase):
    def listed(self, out=None):
        lines = ((out or self.out) / "manifest/images.jsonl").read_text().splitlines()
        return {file["path"] for line in lines for file in json.loads(line)["files"]}

    def in_place(self, out=None):
        out = out or self.out
        return {path.relative_to(out).as_posix() for path in (out / "images").rglob("*") if path.is_file()}

    def at(self, folder, *arguments):
        done = subprocess.run(self.command(*arguments), cwd=folder, capture_output=True, text=True, timeout=600,
                              check=False)
        self.assertIn(done.returncode, (0, 1, 2), done)
        return done

    def test_check_reads_pictures_where_it_is_asked_to(self):
        self.build()
        plain = self.run_it("check", self.out, "--json").json
        self.assertEqual((plain["pictures_read"], plain["unreadable"]), (False, 0))
        run = self.run_it("check", self.out, "--json", "--pictures")
        self.assertEqual((run.json["pictures_read"], run.json["unreadable"]), (True, 0), run)
        run = self.run_it("check", self.out, "--only", "contrast", "--set", "check.contrast_least=1")
        self.assertEqual(run.code, 2, run)  # the folder keeps the settings it was built with
        run = self.run_it("check", self.recipe, "-o", self.out, "--only", "contrast", "--set", "check.contrast_least=1")
        self.assertEqual(run.code, 1, run)
        self.assertIn("pictures show their model less than 1 apart", run.out)
        (self.tiny / "recipe.toml").write_text(self.recipe.read_text() + "\n[check]\ncontrast_least = 1\n")
        self.assertEqual(self.run_it("check", self.recipe, "-o", self.out, "--only", "contrast").code, 1)
        self.assertEqual(self.run_it("check", self.out, "--only", "contrast").code, 0)  # not built since
        os.unlink(self.out / "images/box.off/2.png")
        run = self.run_it("check", self.out, "--json", "--only", "fireflies")
        self.assertEqual((run.code, run.json["unreadable"], run.json["errors"]), (1, 1, 0), run)
        self.assertIn("images/box.off/2.png", run.err)

    def test_a_folder_belongs_to_the_recipe_that_made_it(self):
        self.build()
        files = self.contents()
        other = self.folder / "other/recipe.toml"
        shutil.copytree(self.tiny, other.parent)
        for verb in (["build"], ["plan"], ["status"], ["build", "-n"], ["verify"]):
            run = self.run_it(*verb, other, "-o", self.out)
            self.assertEqual(run.code, 2, run)
            for said in (str(self.recipe), str(other), "-o", "dataset.name", "plan --adopt"):
                self.assertIn(said, run.err)
        self.assertEqual(self.contents(), files)
        self.assertEqual(self.run_it("models", other).code, 0, "this is not about the folder")
        self.assert_counts(self.build(), reused=IMAGES)
        run = self.run_it("plan", other, "-o", self.out, "--adopt")
        self.assertIn(f"{IMAGES} up to date", run.out)
        run = self.run_it("build", other, "-o", self.out, "--adopt")
        self.assertEqual(run.code, 0, run)
        self.assertEqual(self.run_it("build", other, "-o", self.out).code, 0, "it is the other one's now")
        self.assertEqual(self.run_it("build", self.recipe, "-o", self.out).code, 2)

    def test_a_project_moved_as_a_whole_is_still_the_owner(self):
        self.assertEqual(self.at(self.tiny, "build", "recipe.toml").returncode, 0)
        elsewhere = self.folder / "elsewhere"
        os.rename(self.tiny, elsewhere)
        run = self.at(elsewhere, "build", "recipe.toml", "--json")
        self.assert_counts(json.loads(run.stdout.splitlines()[-1]), built=0, reused=IMAGES)
        os.rename(elsewhere, self.tiny)
        for target in ("recipe.toml", "out/tiny"):
            run = self.at(self.tiny, "status", target)
            self.assertIn(f"{IMAGES} up to date", run.stdout, run)
        # A copy of the whole is the owner of its own folder.
        shutil.copytree(self.tiny, elsewhere)
        (elsewhere / "materials/red.mat").unlink()
        run = self.at(elsewhere, "status", "out/tiny")
        self.assertIn(f"recipe   {elsewhere}/recipe.toml", run.stdout)
        self.assertNotIn(f"{IMAGES} up to date", run.stdout)

    def test_the_same_dataset_from_wherever_it_is_asked_for(self):
        self.at(self.tiny, "build", "recipe.toml")
        for folder, recipe in ((self.folder, "tiny/recipe.toml"), ("/", self.recipe), (self.tiny / "models", self.recipe)):
            run = self.at(folder, "status", recipe)
            self.assertIn(f"folder   {self.tiny}/out/tiny", run.stdout)
            self.assertIn(f"{IMAGES} up to date", run.stdout)
            self.assertIn("reused", self.at(folder, "build", recipe).stdout)
        self.assertFalse((self.folder / "out").exists())
        # And from below where it was built from above.
        shutil.rmtree(self.tiny / "out")
        self.at(self.folder, "build", "tiny/recipe.toml")
        self.assertIn(f"folder   {self.folder}/out/tiny", self.at(self.tiny, "status", "recipe.toml").stdout)

    def test_a_moved_folder_takes_no_recipe_that_lies_there_by_chance(self):
        # recipe.toml is two folders above out/tiny, and so is another one above elsewhere/deep/tiny.
        self.assertEqual(self.at(self.tiny, "build", "recipe.toml").returncode, 0)
        other = self.folder / "elsewhere"
        shutil.copytree(self.tiny, other, ignore=shutil.ignore_patterns("out"))
        recipe = other / "recipe.toml"
        recipe.write_text(recipe.read_text() + "# another\n")
        (other / "deep").mkdir()
        os.rename(self.tiny / "out/tiny", other / "deep/tiny")
        self.assertEqual(self.at(other, "build", "recipe.toml", "-o", "deep/tiny").returncode, 2)
        self.assertIn(f"recipe   {self.tiny}/recipe.toml", self.at(other, "status", "deep/tiny").stdout)
        run = self.at(other, "verify", "deep/tiny")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_a_recipe_that_is_gone_is_named(self):
        self.build()
        moved = self.tiny / "elsewhere.toml"
        os.rename(self.recipe, moved)
        for verb in (["build"], ["build", "-n"], ["status"], ["plan"], ["models"], ["explain"]):
            run = self.run_it(*verb, self.out, *(["box.off/0"] if verb == ["explain"] else []))
            self.assertEqual((run.code, run.err.count("dsbuild: error: "), run.out), (2, 1, ""), run)
            self.assertIn(f"{self.out}: was built from the recipe {self.recipe}, which is no longer there", run.err)
            self.assertIn(f"dsbuild build RECIPE -o {self.out} --adopt", run.err)
        self.assertEqual(self.run_it("verify", self.out).code, 0)
        self.assertEqual(self.run_it("log", self.out).code, 0)
        # What it says to do does it.
        self.assert_counts(self.run_it("build", moved, "-o", self.out, "--adopt", "--json",
                                       "--set", "dataset.name=tiny").json, reused=IMAGES)
        self.assertEqual(self.run_it("status", self.out).code, 0)

    def test_a_folder_that_was_moved_is_asked_for(self):
        self.at(self.tiny, "build", "recipe.toml")
        os.rename(self.tiny / "out/tiny", self.folder / "elsewhere")
        said = self.at(self.tiny, "status", "recipe.toml").stdout
        self.assertIn(f"never in this folder; if it was moved: dsbuild status {self.tiny}/recipe.toml -o FOLDER", said)
        said = self.at(self.tiny, "status", "recipe.toml", "-o", self.folder / "elsewhere").stdout
        self.assertIn(f"{IMAGES} up to date", said)
        shutil.rmtree(self.folder / "elsewhere/.dsbuild")
        said = self.at(self.tiny, "status", "recipe.toml", "-o", self.folder / "elsewhere").stdout
        self.assertIn("a manifest lies there without its .dsbuild", said)

    def test_a_dataset_of_another_name_is_told_of(self):
        self.at(self.tiny, "build", "recipe.toml")
        self.edit("recipe.toml", 'name = "tiny"', 'name = "small"')
        before = f"{self.tiny}/out/tiny"
        for verb in ("plan", "status", "build"):
            said = self.at(self.tiny, verb, "recipe.toml").stderr
            self.assertEqual(said.count("built there as the dataset tiny"), 1, said)
            self.assertIn(f"give -o {before}", said)
            self.assertIn(f"{self.tiny}/out/small", said)
        self.assertNotIn("built there", self.at(self.tiny, "plan", "recipe.toml").stderr, "it has both now")
        # What it says to do keeps all that is made.
        run = self.at(self.tiny, "plan", "recipe.toml", "-o", before)
        self.assertIn(f"0 to make (0 to trace, 0 to develop, 0 to take from the store), {IMAGES} up to date", run.stdout)
        self.assertIn("name: tiny -> small", run.stdout)
        shutil.rmtree(self.tiny / "out/small")
        os.rename(before, self.tiny / "out/small")
        run = self.at(self.tiny, "build", "recipe.toml")
        self.assertIn(f"0 built, {IMAGES} reused", run.stdout)
        self.assertNotIn("built there", run.stderr)
        # A name for one command is a dataset beside it, whichever comes first.
        self.assertNotIn("built there", self.at(self.tiny, "build", "recipe.toml", "--set", "dataset.name=b").stderr)
        shutil.rmtree(self.tiny / "out/small")
        self.assertNotIn("built there", self.at(self.tiny, "plan", "recipe.toml").stderr)

    def test_files_that_no_build_made_are_not_written_over(self):
        for name in ("images/box.off/0.png", "manifest/dataset.json"):
            mine = self.folder / "mine" / name
            mine.parent.mkdir(parents=True)
            mine.write_text("precious")
            run = self.run_it("build", self.recipe, "-o", self.folder / "mine")
            self.assertEqual(run.code, 2, run)
            self.assertIn(str(mine.parents[len(name.split("/")) - 2]), run.err)
            self.assertIn("--adopt", run.err)
            self.assertEqual(mine.read_text(), "precious")
            self.assertFalse((self.folder / "mine/.dsbuild").exists())
            shutil.rmtree(self.folder / "mine")
        self.build()
        shutil.rmtree(self.out / ".dsbuild")
        self.assertEqual(self.run_it("build", self.recipe, "-o", self.out).code, 2)
        self.assert_counts(self.run_it("build", self.recipe, "-o", self.out, "--adopt", "--json").json, built=IMAGES)

    def test_a_folder_of_inputs_is_no_folder_for_outputs(self):
        (self.tiny / "train.cla").write_text("PSB 1\n1 2\n\nthing 0 2\nbox\ntetra\n")
        (self.tiny / "classes").mkdir()
        os.rename(self.tiny / "train.cla", self.tiny / "classes/train.cla")
        self.edit("recipe.toml", "[materials]", '[classes]\ntrain = "classes/train.cla"\n\n[materials]')
        (self.folder / "link").symlink_to(self.tiny / "models")
        before = self.contents(self.tiny)
        for name, what in (("", "the recipe"), ("models", "models"), ("materials/", "materials"), ("../link", "models"),
                           ("environments", "environments"), ("environments/plain", "an environment"),
                           ("classes/../classes", "class files")):
            for option in "-o", "--store":
                for verb in (["build"], ["build", "--adopt"], ["build", "-n"], ["plan"], ["status"]):
                    run = self.run_it(*verb, self.recipe, option, f"{self.tiny}/{name}")
                    self.assertEqual((run.code, run.err.count("\n"), run.out), (2, 1, ""), run)
                    self.assertIn(f"found that of {what} (", run.err)
                    self.assertIn(f"{option} ", run.err)
        # What a build owns of its folder holds no inputs.
        (self.folder / "set/images").mkdir(parents=True)
        shutil.copytree(self.tiny / "models", self.folder / "set/images/models")
        for verb in ("build", "plan"):
            run = self.run_it(verb, self.recipe, "-o", self.folder / "set", "--adopt", "--set",
                              f"models.dir={self.folder}/set/images/models")
            self.assertEqual(run.code, 2, run)
            self.assertIn("found that of models (", run.err)
        for path in "recipe.toml", "models/box.off", "classes/train.cla":
            run = self.run_it("accuracy", self.recipe, "-o", self.tiny / path)
            self.assertEqual(run.code, 2, run)
            self.assertIn("is read by the recipe and would be written over", run.err)
        self.assertEqual(self.contents(self.tiny), before)
        # Beside and below them there is room.
        for place in "out", "models/out":
            self.assertEqual(self.run_it("build", self.recipe, "-o", self.tiny / place).code, 0)

    def test_two_recipes_that_link_to_one_file_are_two(self):
        other = self.folder / "other"
        shutil.copytree(self.tiny, other)
        (other / "recipe.toml").unlink()
        (other / "recipe.toml").symlink_to(self.recipe)
        self.build()
        self.assertEqual(self.run_it("build", other / "recipe.toml", "-o", self.out).code, 2)

    def test_a_folder_of_an_older_dsbuild(self):
        self.build()
        pointer = self.out / ".dsbuild/dataset"
        lines = pointer.read_text().splitlines()
        pointer.write_text("\n".join(["dsbuild dataset 1", *lines[1:3]]) + "\n")
        other = self.folder / "other/recipe.toml"
        shutil.copytree(self.tiny, other.parent)
        self.assertEqual(self.run_it("build", other, "-o", self.out).code, 2, "its database names the recipe")
        self.assert_counts(self.build(), reused=IMAGES)
        self.assertEqual(pointer.read_text().splitlines(), lines)

    def test_builds_of_two_settings_at_once_take_turns(self):
        for _ in range(3):
            both = [self.start("build", self.recipe, "-o", self.out, *SLOW, *more)
                    for more in ([], ["--set", "camera.count=6"])]
            said = ""
            for process in both:
                _, err = process.communicate(timeout=300)
                self.assertEqual(process.returncode, 0, err)
                said += err
            self.assertEqual(self.in_place(), self.listed())
            self.assertEqual(self.run_it("verify", self.out).code, 0)
            shutil.rmtree(self.out)
        first = self.start("build", self.recipe, "-o", self.out, "--set", "engine.spp=2000")
        while not list(self.out.glob("images/*/*.png")):
            self.assertIsNone(first.poll(), "it ended by itself")
            time.sleep(0.02)
        builds = pathlib.Path(f"/proc/{first.pid}/task/{first.pid}/children").read_text().strip()
        second = self.run_it("build", self.recipe, "-o", self.out)
        first.communicate(timeout=300)
        self.assertRegex(second.err, rf"waiting for another build that makes something else: process {builds} on "
                                     r".*recipe\.toml --set engine\.spp=2000")
        self.assertEqual(self.in_place(), self.listed())
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_two_recipes_at_once(self):
        other = self.folder / "other/recipe.toml"
        shutil.copytree(self.tiny, other.parent)
        (other.parent / "models/tetra.ply").unlink()
        both = [self.start("build", recipe, "-o", self.out) for recipe in (self.recipe, other)]
        for process in both:
            process.communicate(timeout=300)
        self.assertEqual(sorted(process.returncode for process in both), [0, 2])
        self.assertEqual(self.in_place(), self.listed())
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_a_folder_is_verified_alone(self):
        self.at(self.tiny, "build", "recipe.toml", "--set", "models.dir=models")
        for name in ("whole", "damaged", "poor"):
            shutil.copytree(self.tiny / "out/tiny", self.folder / name)
        picture = self.folder / "damaged/images/box.off/1.png"
        picture.unlink()
        picture.write_bytes(b"no picture")
        (self.folder / "poor/manifest/dataset.json").unlink()
        # The recipe goes on; its copies are what they were.
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1")
        for gone in (False, True):
            if gone:
                shutil.rmtree(self.tiny)
            run = self.run_it("verify", "whole")
            self.assertEqual(run.code, 0, run)
            self.assertRegex(run.out, r"not checked: .*recipe\.toml")
            self.assertIn("recipe.toml", self.run_it("verify", "whole", "--json").json["not_checked"])
            run = self.run_it("verify", "damaged")
            self.assertEqual(run.code, 1, run)
            self.assertIn("changed: images/box.off/1.png", run.out)
            run = self.run_it("verify", "poor")
            self.assertEqual(run.code, 1, run)
            self.assertIn("missing: manifest/dataset.json", run.out)
        self.assertEqual(self.run_it("log", "whole", "--json").json["builds"][0]["built"], IMAGES)

    def test_a_folder_whose_assets_are_gone_is_verified(self):
        self.build()
        shutil.rmtree(self.tiny / "materials")
        run = self.run_it("verify", self.out)
        self.assertEqual(run.code, 0, run)
        self.assertRegex(run.out, r"not checked: .*materials\.dir")
        self.assertEqual(self.run_it("verify", self.recipe, "-o", self.out).code, 2)

    def test_an_edited_output_does_not_reach_the_store(self):
        self.build()
        files = self.contents()
        picture = self.out / "images/box.off/1.png"
        if os.geteuid() != 0:
            with self.assertRaises(PermissionError):
                picture.open("r+b")
            picture.chmod(0o644)
            self.assertEqual(self.run_it("status", self.out, "--json").json["stale"], 1)
            self.assert_counts(self.build(), built=1, traced=0, developed=0)
            return
        # Root writes to any file, whatever its mode.
        with picture.open("r+b") as file:
            file.write(b"scribble")
        self.assert_counts(self.build(), built=1, developed=0, traced=0)
        self.assertEqual(self.contents(), files)

    def test_a_dataset_that_one_may_only_read(self):
        """Another's, or on a disk that is mounted read-only: SQLite alone could not open its database there."""
        if os.geteuid() != 0:
            self.skipTest("this needs to be two users")
        self.build()
        os.chmod(self.folder, 0o755)
        other = {"preexec_fn": nobody}
        run = self.run_it("status", self.out, "--json", **other)
        if run.code != 0 and "ermission denied" in run.err and str(self.out) not in run.err:
            self.skipTest("others than root cannot read the sources here")
        self.assertEqual(run.json["up_to_date"], IMAGES, run)
        self.assertEqual(self.run_it("plan", self.recipe, "-o", self.out, "--json", **other).json["up_to_date"], IMAGES)
        run = self.run_it("verify", self.out, "--json", **other)
        self.assertEqual((run.code, run.json["not_checked"]), (0, None), run)
        self.assertIn(f"{IMAGES} built", self.run_it("log", self.out, **other).out)
        run = self.run_it("build", self.recipe, "-o", self.out, **other)
        self.assertEqual(run.code, 1, run)
        self.assertRegex(run.err, r"^dsbuild: error: \S+: cannot write there: Permission denied; [^\n]+\n$")

    def test_hard_links_are_read_only_to_others_than_root(self):
        if os.geteuid() != 0:
            self.skipTest("this is about another user than root's")
        os.chmod(self.folder, 0o777)
        mine = self.folder / "mine"
        mine.mkdir()
        os.chown(mine, 65534, 65534)
        cache = {"preexec_fn": nobody, "env": {**os.environ, "HOME": str(mine), "XDG_CACHE_HOME": str(mine / "cache")}}
        run = self.run_it("build", self.recipe, "-o", mine / "out", "--json", **cache)
        if run.code != 0 and "ermission denied" in run.err:
            self.skipTest("others than root cannot read the sources here")
        self.assertEqual(run.code, 0, run)
        picture = mine / "out/images/box.off/1.png"
        if picture.stat().st_nlink == 1:
            return  # a reflink
        self.assertFalse(picture.stat().st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH))
        scribble = ["python3", "-c", f"open({str(picture)!r}, 'r+b').write(b'scribble')"]
        done = subprocess.run(scribble, preexec_fn=nobody, capture_output=True, text=True, check=False)
        self.assertIn("PermissionError", done.stderr)
        # Made writable it is seen, and protected again.
        os.chmod(picture, 0o644)
        run = self.run_it("build", self.recipe, "-o", mine / "out", "--json", **cache)
        self.assert_counts(run.json, built=1, traced=0, developed=0)
        self.assertFalse(picture.stat().st_mode & stat.S_IWUSR)
        # --copy parts all of them from the store, and later builds leave them so.
        for more in (["--copy"], []):
            run = self.run_it("build", self.recipe, "-o", mine / "out", "--json", *more, **cache)
            self.assert_counts(run.json, reused=IMAGES)
            for path in (mine / "out/images").rglob("*.png"):
                self.assertEqual(path.stat().st_nlink, 1, path)
            self.assertTrue(picture.stat().st_mode & stat.S_IWUSR)
        self.assertEqual(self.run_it("status", mine / "out", "--json", **cache).json["up_to_date"], IMAGES)


if __name__ == "__main__":
    main()
