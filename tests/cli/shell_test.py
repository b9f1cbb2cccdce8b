# SPDX-License-Identifier: Apache-2.0
"""dsbuild completions, init and --version."""
import json
import os
import re
import shutil
import subprocess

from harness import TinyCase, main


class ShellTest(TinyCase):
    def text(self, kind):
        run = self.run_it("completions", kind)
        self.assertEqual(run.code, 0, run)
        return run.out

    def verbs(self):
        """From the help's own list."""
        listed = self.run_it("--help").out.split("Verbs:\n")[1].split("\n\n")[0]
        return re.findall(r"^  (\w+) ", listed, re.MULTILINE)

    def complete(self, *words):
        script = (f"source {self.folder}/bash\nCOMP_WORDS=(\"$@\")\nCOMP_CWORD=$(($# - 1))\n_dsbuild\n"
                  "printf '%s\\n' \"${COMPREPLY[@]}\"\n")
        run = subprocess.run(["bash", "-c", script, "bash", "dsbuild", *words], capture_output=True, text=True, check=True)
        return run.stdout.split()

    def test_bash(self):
        (self.folder / "bash").write_text(self.text("bash"))
        self.assertEqual([w for w in self.complete("") if not w.startswith("-")], self.verbs())
        self.assertEqual(self.complete("bui"), ["build"])
        self.assertEqual(self.complete("build", "--ke"), ["--keep-going"])
        self.assertEqual(self.complete("-C", "/tmp", "sta"), ["status"])
        self.assertEqual(self.complete("export", "x", "--format", "co"), ["coco"])
        self.assertEqual(self.complete("store", ""), self.store_tasks())
        self.assertEqual(self.complete("store", "--older", "3d", "ga"), ["gather"])
        self.assertEqual(self.complete("store", "gather", "ga"), [], "a store is a folder")
        self.assertEqual(self.complete("import", "--classes", ""), ["folder", "folders"])
        self.assertEqual(self.complete("schema", ""), ["recipe", "images", "dataset"])
        self.assertIn("help", self.complete("help", ""))
        self.assertEqual(self.complete("build", ""), [], "file names, which bash adds")
        self.assertEqual(self.complete("build", "x", "-o", ""), [])

    def store_tasks(self):
        """From what the program says it wants."""
        run = self.run_it("store", "nothing", self.folder)
        self.assertEqual(run.code, 2, run)
        names = re.search(r"wanted ([a-z, ]+), got", run.err).group(1).split(", ")
        self.assertIn("gather", names)
        return names

    def test_what_a_store_may_be_asked_is_in_each(self):
        names = " ".join(self.store_tasks())
        self.assertIn(f"':WHAT:({names})'", self.text("zsh"))
        self.assertIn(f"-f -a '{names}'", self.text("fish"))
        for name in names.split():
            self.assertRegex(self.text("man"), rf"\b{name} \(")
        if shutil.which("fish") is None:
            return
        (self.folder / "fish").write_text(self.text("fish"))
        for line, wanted in (("store ", names.split()), ("store ga", ["gather"]), ("schema im", ["images"]), ("help ver", ["verify"]),
                             ("store gc te", ["tetra.ply"])):
            run = subprocess.run(["fish", "-c", f"source {self.folder}/fish; complete -C 'dsbuild {line}'"], capture_output=True,
                                 text=True, check=True, env={**os.environ, "HOME": str(self.folder)}, cwd=self.tiny / "models")
            self.assertEqual(sorted(word.split("\t")[0] for word in run.stdout.splitlines()), sorted(wanted), line)

    def test_every_verb_and_option_is_in_each(self):
        for kind in ("bash", "zsh", "fish", "man"):
            text = self.text(kind).replace("\\-", "-")
            for verb in self.verbs():
                self.assertIn(verb, text)
                for option in re.findall(r"--([a-z-]+)", self.run_it("help", verb).out.split("Options:")[1].split("\n\n")[0]):
                    self.assertIn(f"-l {option} " if kind == "fish" else f"--{option}", text, (kind, verb))

    def test_shells_read_them(self):
        for kind in ("zsh", "fish"):
            if shutil.which(kind) is None:
                continue
            file = self.folder / kind
            file.write_text(self.text(kind))
            run = subprocess.run([kind, "-n", file], capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ""), kind)

    def test_init(self):
        run = self.run_it("init", self.tiny / "models", "--json")
        self.assertEqual(run.code, 0, run)
        recipe = self.folder / "models.toml"
        self.assertEqual(run.json, {"recipe": "models.toml", "name": "models"})
        text = recipe.read_text()
        for section in ("dataset", "models", "camera", "engine", "outputs"):
            self.assertIn(f"\n[{section}]\n", text)
        sections = json.loads(self.run_it("schema", "recipe").out)["properties"]
        keys = [key for section in sections.values() for key in section.get("properties", {})]
        self.assertGreater(len(keys), 50)
        for key in keys:
            self.assertRegex(text, rf"(?m)^#?{key}[ .]")
        lists = [name for name, section in sections.items() if section.get("items")]
        self.assertEqual(lists, ["lights"])
        for name in lists:
            self.assertIn(f"\n#[[{name}]]\n", text)
        self.assertLessEqual(max(map(len, text.splitlines())), 130)
        small = ["--set", "camera.views=[1, 2]", "--set", "engine.width=16", "--set", "engine.height=16", "--set",
                 "engine.spp=1", "-o", self.out]
        run = self.run_it("build", recipe, *small, "--json")
        self.assertEqual((run.code, run.json["built"]), (0, 4), run)
        self.assertIn("is there already", self.run_it("init", self.tiny / "models").err)
        self.assertIn("found nothing at", self.run_it("init", self.folder / "no").err)
        self.assertIn("found none", self.run_it("init", self.tiny / "materials").err)

    def test_version(self):
        run = self.run_it("--version")
        self.assertRegex(run.out, r"^dsbuild \d+\.\d+\.\d+ \(commit \S+\)\nprocessor: \S+.*\nOpenCL: .+\n$")


if __name__ == "__main__":
    main()
