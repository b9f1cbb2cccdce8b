# SPDX-License-Identifier: Apache-2.0
"""Exit codes and messages of wrong commands."""
import os
import re
import shutil

from harness import IMAGES, TinyCase, main


class UsageTest(TinyCase):
    def rows(self, title):
        """Names that the help's table of this title has."""
        table = self.run_it("--help").out.split(f"\n{title}:\n")[1].split("\n\n")[0]
        return re.findall(r"^  ([a-z]+) ", table, re.MULTILINE)

    def operands(self):
        """What each verb that answers in JSON takes beside its options: "DATASET [IMAGE]"."""
        helps = {verb: self.run_it(verb, "--help").out for verb in self.rows("Verbs")}
        return {verb: re.search(rf"Usage: dsbuild {verb} \[OPTIONS\] ?(.*)", text)[1]
                for verb, text in helps.items() if "--json" in text}

    def test_help_and_version(self):
        self.assertRegex(self.run_it("--version").out, r"^dsbuild \d+\.\d+\.\d+ \(commit ")
        overview = self.run_it("--help")
        self.assertEqual(overview.code, 0)
        self.assertIn("Exit codes: 0", overview.out)
        self.assertIn("build", self.rows("Verbs"))
        for verb in self.rows("Verbs"):
            run = self.run_it(verb, "--help")
            self.assertEqual(run.code, 0, run)
            self.assertIn("Usage: dsbuild " + verb, run.out)

    def test_help_fits_the_narrowest_terminal(self):
        texts = [self.run_it("help"), self.run_it("--help")]
        self.assertEqual(texts[0].out, texts[1].out)
        for verb in self.rows("Verbs"):
            texts += [self.run_it("help", verb), self.run_it(verb, "-h")]
            self.assertEqual(texts[-1].out, texts[-2].out)
        texts += [self.run_it("help", topic) for topic in self.rows("Topics of dsbuild help")]
        for run in texts:
            self.assertEqual((run.code, run.err), (0, ""), run)
            for line in run.out.splitlines():
                self.assertLessEqual(len(line), 80, line)

    def test_alone_it_prints_help_and_fails(self):
        for arguments in ([], ["-C", self.folder]):
            run = self.run_it(*arguments)
            self.assertEqual((run.code, run.err), (2, ""), run)
            self.assertEqual(run.out, self.run_it("--help").out)

    def test_an_error_is_an_answer_in_json(self):
        self.edit("recipe.toml", "fov_deg = 49", "fov_deg = 490\nfovv = 1")
        operands = self.operands()
        self.assertIn("build", operands)
        # What an export wants besides is looked for first.
        of_recipe = [verb for verb, wanted in operands.items() if wanted == "DATASET" and verb != "export"]
        wrong = {
            "usage": [[verb, "--json"] for verb, wanted in operands.items() if wanted] + [
                      ["build", "--json", "--colour"], ["bulid", "--json"], ["--json"], ["devices", "--json", "all"], ["help", "--json"],
                      ["plan", self.folder, "--json"], ["build", self.recipe, "--shard", "9/2", "--json"],
                      ["-C", self.folder / "none", "status", self.recipe, "--json"]],
            "recipe": [[verb, self.recipe, "--json"] for verb in of_recipe]
                      + [["explain", self.recipe, "box.off/0", "--json"],
                         ["status", self.folder / "none.toml", "--json"]]}
        for kind, commands in wrong.items():
            for command in commands:
                run = self.run_it(*command)
                self.assertEqual(run.code, 2, run)
                self.assertEqual(len(run.out.splitlines()), 1, run)
                self.assertEqual((run.json["kind"], run.json["exit_code"]), (kind, 2), run)
                said = [line.removeprefix("dsbuild: error: ") for line in run.err.splitlines()]
                self.assertEqual(run.json["error"].splitlines(), said)
                self.assertEqual(len(run.json["failures"]), len(said))
                self.assertEqual(self.run_it(*[word for word in command if word != "--json"]).out.count("{"), 0)
        lines = self.recipe.read_text().splitlines()
        failures = self.run_it("build", self.recipe, "--json").json["failures"]
        self.assertEqual({(one["file"], lines[one["line"] - 1].split(" ")[0]) for one in failures},
                         {(str(self.recipe), "fov_deg"), (str(self.recipe), "fovv")})
        for one in failures:
            self.assertEqual(one["what"], f"{one['file']}:{one['line']}:{one['column']}")
            self.assertRegex(one["why"], "^camera.fov")
        # What is no fault of a line, and no mistake of the command line.
        self.edit("recipe.toml", "fov_deg = 490\nfovv = 1", "fov_deg = 49")
        (self.folder / "file").write_text("in the way")
        run = self.run_it("build", self.recipe, "-o", self.folder / "file/out", "--json")
        self.assertEqual((run.code, run.json["kind"], run.json["exit_code"]), (1, "io", 1), run)
        self.assertIsNone(run.json["failures"][0]["line"])

    def test_help_tells_types_and_keys(self):
        glass = self.run_it("help", "materials", "glass").out
        self.assertRegex(glass, r"interiorior +a number >= 0.01 or a texture's name \[1.5\]")
        self.assertNotIn("uroughness", glass)
        self.assertIn("uroughness", self.run_it("help", "materials").out)
        self.assertRegex(self.run_it("help", "lights", "spot").out, r"coneangle +a number in \(0, 90\) \[30\]")
        self.assertRegex(self.run_it("help", "recipe", "camera.fov_deg").out,
                         r"^\[camera\]:\n  fov_deg  a number in \(0, 180\) \(degree\) \[49\]: ")
        camera = self.run_it("help", "recipe", "camera").out
        self.assertIn("lens_radius_m", camera)
        self.assertNotIn("[engine]", camera)

    def test_shipped_schemas_are_those_it_prints(self):
        for what in "recipe", "images", "dataset":
            shipped = self.source / f"recipes/schemas/{what}.schema.json"
            self.assertEqual(shipped.read_text(), self.run_it("schema", what).out,
                             f"dsbuild schema {what} > {shipped}")
        self.assertIn("wanted recipe, images, dataset, got image, did you mean images?", self.run_it("schema", "image").err)

    def test_help_of_what_a_recipe_holds(self):
        for section in "dataset", "environments", "camera", "engine", "outputs":
            run = self.run_it("help", section)
            self.assertEqual((run.code, run.out), (0, self.run_it("help", "recipe", section).out), run)
        for verb in "models", "classes":  # sections, too
            self.assertIn(f"dsbuild help recipe {verb}", self.run_it("help", verb).out)
        self.assertEqual(self.run_it("help", "models", "dir").out, self.run_it("help", "recipe", "models.dir").out)
        one = self.run_it("help", "recipe", "camera.fov_deg").out
        self.assertEqual(self.run_it("help", "camera.fov_deg").out, one)
        self.assertEqual(self.run_it("help", "camera", "fov_deg").out, one)
        materials = self.run_it("help", "materials").out
        self.assertIn("uroughness", materials)
        self.assertIn("dsbuild help recipe materials", materials)
        self.assertEqual(self.run_it("help", "materials", "assign").out,
                         self.run_it("help", "recipe", "materials.assign").out)
        self.assertEqual(self.run_it("help", "glass").out, self.run_it("help", "materials", "glass").out)
        mix = self.run_it("help", "mix").out
        self.assertIn("scene.textures.NAME.type = mix", mix)
        self.assertIn("scene.materials.NAME.type = mix", mix)
        overview = self.run_it("help").out
        for topic in self.rows("Topics of dsbuild help"):
            self.assertRegex(overview, rf"\n  {topic} ")
        # What it refers to has the name of its file.
        self.assertIn("recipes/README.md", " ".join(self.run_it("help", "camera").out.split()))

    def test_misspelt_words_get_the_right_one(self):
        for arguments, message in (
                (["bulid", self.recipe], "bulid is no verb of dsbuild, did you mean build?"),
                (["paint"], "paint is no verb of dsbuild; there are build, plan, status,"),
                ([self.recipe], f"to make its images: dsbuild build {self.recipe}"),
                (["build", self.recipe, "--josn"], "build has no option --josn, did you mean --json?"),
                (["build", "--josn"], "build has no option --josn, did you mean --json?"),
                (["build", self.recipe, "--keep-goin", "-n"], "did you mean --keep-going?"),
                (["build", self.recipe, "-nx"], "build has no option -x; there are"),
                (["status", self.recipe, "--force"], "status has no option --force; build has it"),
                (["--json", "plan", self.recipe], "--json stands before the verb: write dsbuild VERB --json"),
                (["build"], "build: wanted a DATASET"),
                (["diff"], "diff: wanted A"),
                (["diff", self.recipe], "diff: wanted B, what A is to be compared with: another dataset, or an image file"),
                (["build", self.recipe, "other"], "build: does not know what to do with other; it takes DATASET"),
                (["explain", self.recipe, "box.off/0", "three", "four", "five"],
                 "explain: does not know what to do with three four five; it takes DATASET and IMAGE"),
                (["devices", "cpu"], "devices: does not know what to do with cpu; it takes options only"),
                (["build", self.recipe, "--set", "engine.width", "64"],
                 "build --set: wanted KEY=VALUE, found engine.width 64; write --set engine.width=64"),
                (["build", self.recipe, "--set", "engine.width"], "build --set: wanted KEY=VALUE, found engine.width; "),
                (["build", "--set", "engine.width", "--json", self.recipe], "wanted KEY=VALUE, found engine.width; "),
                (["build", self.recipe, "--device"], "build: wanted --device NAME, found nothing behind it"),
                (["build", "--store", "--json", self.recipe], "build: wanted --store DIR, found --json behind it"),
                (["build", self.recipe, "-o"], "build: wanted -o DIR, found nothing behind it"),
                (["build", self.recipe, "--spp", "8"],
                 "build has no option --spp: it is the recipe's engine.spp; write --set engine.spp=VALUE"),
                (["plan", self.recipe, "--fov=40"], "it is the recipe's camera.fov_deg; write --set camera.fov_deg=VALUE"),
                (["models", self.recipe, "--lens-radius-m", "1"], "write --set camera.lens_radius_m=VALUE"),
                (["status", self.recipe, "--seed", "1"], "status has no option --seed: it is the recipe's dataset.seed; "),
                (["models", self.tiny / "models/box.off"],
                 "box.off: must be a recipe (.toml), found a model, which models.dir or models.files of a recipe names"),
                (["build", self.tiny / "materials/red.mat"], "found a material, which materials.dir or materials.files"),
                (["plan", self.tiny / "environments/floor/environment.scn"], "found a scene, whose folder environments.dir"),
                (["build", self.recipe, "--device", ""], "build: wanted --device NAME, found nothing in its quotes"),
                (["build", self.recipe, "--device="], "build: wanted --device NAME, found nothing in its quotes"),
                (["build", self.recipe, "-o", ""], "build: wanted -o DIR, found nothing in its quotes"),
                (["-C", "", "build", self.recipe], "dsbuild: wanted -C DIR, found nothing in its quotes"),
                (["build", ""], "build: wanted DATASET, found nothing in its quotes"),
                (["build", self.recipe, "--json=yes"], "build --json: takes no value, got yes"),
                (["build", self.recipe, "-o", "a", "-o", "b"], "build -o: wanted once, found again"),
                (["build", self.recipe, "-o", "a", "--output=b"], "build --output: wanted once, found again"),
                (["verify", self.recipe, "--rerender", "some"], "verify --rerender: wanted a whole number in [0, "),
                (["verify", self.recipe, "--rerender=1.5"], ", got 1.5"),
                (["verify", self.recipe, "--seed", "-1"], "verify --seed: wanted a whole number in [0, "),
                (["accuracy", self.recipe, "--seeds", "1"], "accuracy --seeds: wanted a whole number in [2, 64], got 1"),
                (["accuracy", self.recipe, "--against", "minuets"],
                 "accuracy --against: wanted minutes or spp, got minuets, did you mean minutes?"),
                (["plan", self.recipe, "--error", "two"], "plan --error: wanted a number in [1e-06, 1], got two"),
                (["plan", self.recipe.with_suffix("")], "found no file, did you mean "),
                (["plan", self.tiny], "wanted a recipe or a folder that dsbuild built, did you mean " + str(self.recipe)),
                (["plan", self.tiny / "recpie.toml"], "found no file, did you mean recipe.toml?"),
                (["explain", self.recipe, "box.of/0"], "no such image, did you mean box.off/0?"),
                (["explain", self.recipe, "human"], "no such image; there are box.off/0, box.off/1,"),
                (["explain", self.recipe, "box/2"], "no such image, did you mean box.off/2?"),
                (["explain", self.recipe, "out/tiny/images/tetra.ply/1.mask.png"], "no such image, did you mean tetra.ply/1?"),
                (["help", "material"], "did you mean materials?"),
                (["help", "cheese"], "help: cheese is no verb or topic; there are"),
                (["help", "materials", "galss"], "galss is no type of materials, did you mean glass?"),
                (["help", "lights", "area"], "area is no type of lights; there are point, spot,"),
                (["help", "recipe", "camera.fov"], "did you mean camera.fov_deg?"),
                (["help", "recipe", "camra"], "did you mean camera?"),
                (["help", "fov_deg"], "help: fov_deg is no verb or topic, did you mean camera.fov_deg?"),
                (["help", "camera", "fov"], "did you mean camera.fov_deg?"),
                (["help", "engine", "spp", "64"], "help: does not know what to do with 64"),
                (["plan", self.recipe, "--set", "camera.set=orbti"], 'did you mean "orbit"?'),
                (["plan", self.recipe, "--set", "camra.set=orbit"], "camra is no section of a recipe, did you mean camera?"),
                (["plan", self.recipe, "--set", "lens.sharp=1"], "lens is no section of a recipe; there are dataset,"),
                (["plan", self.recipe, "--set", "camera.shutter=1"], "is no key of a recipe; camera has set,"),
                (["plan", self.recipe, "--set", "models.dir=tiny/modles"], "did you mean models?"),
                (["plan", self.recipe, "--set", "models.files=[\"tiny/models/box.of\"]"], "did you mean box.off?")):
            run = self.run_it(*arguments)
            self.assertEqual(run.code, 2, (arguments, str(run)))
            self.assertIn(message, run.err)
            self.assertEqual(run.err.count("\n"), 1, run)
            self.assertEqual(run.out.count("\n"), 1 if "--json" in arguments else 0, run)

    def test_a_folder_that_is_no_dataset(self):
        other = self.folder / "other"
        other.mkdir()
        for verb in (["verify"], ["gallery"], ["check"], ["export", "--format", "csv", "-o", self.folder / "csv"],
                     ["diff", other]):
            run = self.run_it(*verb, other)
            self.assertEqual(run.code, 2, run)
            self.assertIn(f"{other}: wanted ", run.err)
        # One whose manifest is lost is a dataset, and something failed.
        self.build()
        (self.out / "manifest/images.jsonl").unlink()
        self.assertEqual(self.run_it("check", self.out).code, 1)
        # An imported folder's recipe is named whatever else lies beside it.
        (self.tiny / "other.toml").write_text("")
        self.assertIn(f"did you mean {self.recipe}?", self.run_it("build", self.tiny).err)

    def test_one_mistake_in_a_recipe_is_one_error(self):
        whole = self.recipe.read_text()
        for before, after in (("[camera]", "[camra]"), ("[models]", "[modles]"), ('dir = "models"', 'dri = "models"'),
                              ('set = "orbit"', 'sett = "orbit"'), ('set = "orbit"', 'set = "orbti"'),
                              ('dir = "materials"', 'dir = "materails"'), ("[engine]", "[engine")):
            self.recipe.write_text(whole)
            self.edit("recipe.toml", before, after)
            run = self.run_it("plan", self.recipe)
            self.assertEqual((run.code, run.err.count("dsbuild: error: ")), (2, 1), run)
        self.recipe.write_text(whole)
        self.edit("recipe.toml", 'dir = "models"', 'dir = "modles"\n[classes]\ntrain = "{models.dir}/a.cla"')
        run = self.run_it("plan", self.recipe)
        self.assertEqual(run.err.count("dsbuild: error: "), 1, run)

    def test_a_plan_groups_by_reason_and_names_all_where_asked(self):
        new = self.run_it("plan", self.recipe).out
        self.assertEqual(new.splitlines()[:-1], ["box.off/0 and 7 more: trace: new"])
        lines = self.run_it("plan", self.recipe, "-v").out.splitlines()
        self.assertEqual(lines[0], "box.off/0 and 7 more: trace: new")
        self.assertEqual(len([line for line in lines if line.startswith("  ")]), IMAGES)
        self.assertEqual(self.run_it("build", "-n", self.recipe).out, new)
        (self.tiny / "materials/red.mat").write_text("scene.materials.red.type = galss\n")
        lines = self.run_it("plan", self.recipe).out.splitlines()
        self.assertEqual(len(lines), 3, lines)
        self.assertRegex(lines[1], r"^\S+ and 3 more: cannot be made: .*red.mat:1: .*did you mean glass\?$")

    def test_a_plan_groups_by_property_where_each_image_has_its_values(self):
        fit = ["--set", "camera.distance_m=fit", "--set", "camera.count=12"]
        self.assertEqual(self.run_it("build", self.recipe, *fit).code, 0)
        lines = self.run_it("plan", self.recipe, *fit, "--set", "camera.elevation_deg=25").out.splitlines()
        self.assertEqual(len(lines), 2, lines)
        self.assertRegex(lines[0], r"^box.off/0 and 23 more: trace: camera changed: position$")

    def test_wrong_command_lines_are_exit_code_2(self):
        for arguments in (["no-such-verb"], ["build"], ["build", self.recipe, "--no-such-option"],
                          ["build", self.folder / "absent.toml"], ["status", self.tiny],
                          ["-C", self.folder / "absent", "build", self.recipe],
                          ["build", self.recipe, "--set", "engine.spp=0"],
                          ["build", self.recipe, "--set", "engine.ssp=4"],
                          ["verify", self.recipe, "--rerender", "some"],
                          ["verify", self.recipe, "--rerender", "-1"],
                          ["accuracy", self.recipe, "--against", "hours"], ["accuracy", self.recipe, "--spp", "1"],
                          ["accuracy", self.recipe, "-o", "report.csv"],
                          ["plan", self.recipe, "--error", "0"], ["plan", self.recipe, "--error", "two"],
                          ["plan", self.recipe, "--budget", "8"], ["plan", self.recipe, "--budget", "-1h"],
                          ["plan", self.recipe, "--budget", "8h", "--error", "0.02"],
                          ["plan", self.recipe, "--recalibrate"]):
            run = self.run_it(*arguments)
            self.assertEqual(run.code, 2, (arguments, str(run)))
            self.assertTrue(run.err.startswith("dsbuild: error: "), run)
            self.assertEqual(run.out, "")

    def test_a_wrong_device_or_shard_is_said_before_any_work(self):
        name = self.run_it("devices", "--json").json["devices"][0]["name"]
        word = max("".join(c if c.isalnum() else " " for c in name.lower()).split(), key=len)
        for verb in ["build"], ["build", "-n"], ["build", "-k"], ["plan", "--time"], ["verify"], ["accuracy"]:
            run = self.run_it(*verb, self.recipe, "--device", "abacus")
            self.assertEqual((run.code, run.err.count("dsbuild: error: ")), (2, 1), run)
            self.assertIn('--device: no OpenCL device has "abacus" in its name', run.err)
            self.assertIn(f"0: {name}", run.err)
            self.assertEqual(run.out, "")
        self.assertIn(f", did you mean {word}?", self.run_it("build", self.recipe, "--device", word + "x").err)
        self.assertIn("has the number 99; there", self.run_it("build", self.recipe, "--device", "99").err)
        for shard in "0/4", "5/4", "2", "2/", "a/b", "2-4", "2/4/8", "-1/4", "1/99999":
            run = self.run_it("build", self.recipe, f"--shard={shard}")
            self.assertEqual((run.code, run.err.count("\n")), (2, 1), run)
            self.assertIn("--shard: wanted I/N", run.err)
            self.assertIn(shard, run.err)
        self.assertFalse((self.folder / "out").exists())

    def test_accuracy_wants_pictures(self):
        run = self.run_it("accuracy", self.recipe, "--set", "outputs.image=false")
        self.assertEqual(run.code, 2, run)
        self.assertIn("found outputs.image = false; measure it with --set outputs.image=true", run.err)
        self.assertEqual(run.out, "")
        self.assertEqual(list(self.folder.glob("*accuracy*")), [])

    def test_a_string_without_quotes_is_said_to_be_one(self):
        whole = self.recipe.read_text()
        line = whole.splitlines().index('name = "tiny"') + 1
        for value, wanted in (("my", '"my"'), ("my data  # the data", '"my data"'), ("models/a", '"models/a"'),
                              ("~/x", '"~/x"'), ("True", "true"), ("yes", "true"), ("OFF", "false")):
            self.recipe.write_text(whole.replace('name = "tiny"', f"name = {value}"))
            run = self.run_it("plan", self.recipe)
            self.assertEqual((run.code, run.err.count("dsbuild: error: ")), (2, 1), run)
            self.assertIn(f"recipe.toml:{line}:", run.err)
            self.assertIn(wanted, run.err)
            if wanted.startswith('"'):
                self.assertIn(f"must be TOML: a string wants quotes: {wanted}, got {wanted[1:-1]}\n", run.err)
        self.recipe.write_text(whole.replace('dir = "models"', 'files = ["models/box.off", models/tetra.ply]'))
        self.assertIn('a string wants quotes: "models/tetra.ply"', self.run_it("plan", self.recipe).err)
        # Other faults of the text are told as they were.
        self.recipe.write_text(whole.replace("seed = 7", "seed = "))
        self.assertNotIn("quotes", self.run_it("plan", self.recipe).err)

    def test_a_wrong_recipe_names_each_place(self):
        self.edit("recipe.toml", "spp = 1", "spp = -1\nunknown = 3")
        run = self.run_it("plan", self.recipe)
        self.assertEqual(run.code, 2, run)
        self.assertEqual(run.err.count("recipe.toml:"), 2, run)

    def test_a_missing_asset_is_exit_code_1(self):
        (self.tiny / "materials/red.mat").write_text("scene.materials.red.type = no-such-type\n")
        run = self.run_it("plan", self.recipe)
        self.assertEqual(run.code, 1, run)
        self.assertIn("red.mat:1", run.out)

    def test_images_are_loaded_where_they_are_needed(self):
        alone = self.folder / "alone/bin/dsbuild"  # what it would load lies in ../lib
        alone.parent.mkdir(parents=True)
        shutil.copy(self.dsbuild, alone)
        self.dsbuild = alone
        for verb in (["--version"], ["plan", self.recipe], ["status", self.recipe], ["devices"]):
            run = self.run_it(*verb)
            self.assertEqual(run.code, 0, run)
        run = self.run_it("build", self.recipe)
        self.assertEqual(run.code, 1, run)
        self.assertIn("cannot load what reads and writes images", run.err)
        self.assertIn("dsbuild_images.so", run.err)

    def test_looking_needs_no_device_and_writes_nothing(self):
        # An empty folder of vendors leaves the OpenCL loader nothing to find.
        vendors = self.folder / "vendors"
        vendors.mkdir()
        environment = dict(os.environ, OCL_ICD_VENDORS=str(vendors), OPENCL_VENDOR_PATH=str(vendors))
        for verb in (["plan"], ["status"], ["log"], ["models"], ["build", "-n"]):
            run = self.run_it(*verb, self.recipe, env=environment)
            self.assertEqual(run.code, 0, run)
        self.assertFalse((self.folder / "out").exists())
        run = self.run_it("build", self.recipe, "--json", env=environment)
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, built=0, images=IMAGES)
        # It is no fault of an image.
        for more in ([], ["-k"]):
            run = self.run_it("build", self.recipe, *more, env=environment)
            self.assertEqual(run.err.count("dsbuild: error: "), 1, run)
            self.assertIn("dsbuild: error: tracing: no OpenCL device found", run.err)
        self.assertEqual(self.run_it("devices", env=environment).code, 1)


if __name__ == "__main__":
    main()
