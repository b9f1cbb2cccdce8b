# SPDX-License-Identifier: Apache-2.0
"""`dsbuild build --shard I/N`: together the shards make what one build makes, to the byte."""
import json
import os
import shutil
import subprocess

from harness import SAMPLES, TinyCase, main

SHARDS = 4
VIEWS = ["--set", "camera.count=8"]
IMAGES = 16  # two models
COUNTERS = ["images", "built", "reused", "failed", "not_reached", "traced", "traced_samples"]


class ShardsTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.one = self.folder / "one"
        self.whole = self.build(*VIEWS, out=self.one)
        self.wanted = self.contents(self.one)

    def shard(self, number, *arguments, **options):
        return self.build(*VIEWS, "--shard", f"{number}/{SHARDS}", *arguments, **options)

    def in_turn(self, *arguments, order=range(1, SHARDS + 1)):
        """The shards' counters, added up."""
        return self.sum([self.shard(number, *arguments) for number in order])

    @staticmethod
    def sum(runs):
        return {name: sum(run[name] for run in runs) for name in COUNTERS}

    def at_once(self, *arguments):
        processes = [self.start("build", self.recipe, "-o", self.out, "--json", *VIEWS, "--shard", f"{i}/{SHARDS}",
                                *arguments) for i in range(1, SHARDS + 1)]
        runs = []
        for process in processes:
            out, err = process.communicate(timeout=300)
            self.assertEqual(process.returncode, 0, err)
            runs.append(json.loads(out.splitlines()[-1]))
        return self.sum(runs)

    def listed(self):
        return {json.loads(line)["id"] for line in (self.out / "manifest/images.jsonl").read_text().splitlines()}

    def in_place(self):
        names = [path.relative_to(self.out / "images").as_posix() for path in self.out.glob("images/*/*.mask.png")]
        return {name.removesuffix(".mask.png") for name in names}

    def assert_whole(self):
        """As one build makes it, so that another one has nothing to do."""
        self.assertEqual(self.contents(), self.wanted)
        self.assertEqual(self.run_it("verify", self.out).code, 0)
        self.assert_counts(self.build(*VIEWS), images=IMAGES, built=0, reused=IMAGES)
        self.assertEqual(self.contents(), self.wanted)

    def test_plan_and_status_are_of_the_shard(self):
        self.shard(1)
        for verb in ("plan", "status"):
            runs = [self.run_it(verb, self.recipe, "-o", self.out, *VIEWS, "--shard", f"{number}/{SHARDS}", "--json").json
                    for number in range(1, SHARDS + 1)]
            self.assertEqual(runs[0]["stale"], 0, verb)
            self.assertEqual(sum(run["images"] for run in runs), IMAGES)
            whole = self.run_it(verb, self.recipe, "-o", self.out, *VIEWS, "--json").json
            self.assertEqual(sum(run["stale"] for run in runs), whole["stale"])
            self.assertEqual(sum(run["stale"] for run in runs), IMAGES - runs[0]["images"])
        self.assertEqual(self.run_it("plan", self.recipe, "--shard", "5/4").code, 2)

    def test_in_turn(self):
        images = 0
        for number in (3, 1, 4, 2):
            counts = self.shard(number)
            self.assert_counts(counts, built=counts["images"], reused=0, traced_samples=counts["images"] * SAMPLES)
            images += counts["images"]
            self.assertEqual(self.listed(), self.in_place())
            self.assertEqual(len(self.listed()), images)
        self.assert_whole()
        self.assert_counts(self.in_turn(), images=IMAGES, built=0, reused=IMAGES)
        self.assert_whole()

    def test_at_once(self):
        for arguments in ([], [], [], ["--store", self.folder / "store"]):
            self.assertEqual(self.at_once(*arguments), {name: self.whole[name] for name in COUNTERS})
            self.assert_whole()
            shutil.rmtree(self.out)

    def test_at_once_over_an_older_dataset(self):
        self.build(*VIEWS)
        self.edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1")
        self.build(*VIEWS, out=self.one)
        self.wanted = self.contents(self.one)
        counts = self.at_once()
        self.assert_counts(counts, images=IMAGES, failed=0)
        self.assertTrue(0 < counts["reused"] < IMAGES, counts)
        self.assert_whole()
        self.at_once("--force")
        self.assert_whole()

    def test_machines_that_share_no_disk(self):
        # Each has a store of its own; the files of all stores, but for the databases, may simply be put together.
        for number in range(1, SHARDS + 1):
            store = self.folder / f"store-{number}"
            self.shard(number, "--store", store, out=self.folder / f"out-{number}")
            for kind in ("objects", "records"):
                shutil.copytree(store / kind, self.folder / "store" / kind, dirs_exist_ok=True)
        self.assert_counts(self.build(*VIEWS, "--store", self.folder / "store"), built=IMAGES, traced=0, developed=0)
        self.assert_whole()

    def test_a_store_with_a_database_learns_what_builds_with_their_own_made(self):
        store = ("--store", self.folder / "store")
        self.build("--set", "engine.spp=1", *store, out=self.folder / "other")
        for number in (1, 2):
            self.build(*VIEWS, *store, "--no-files", "--database", self.folder / f"db-{number}", "--shard", f"{number}/2")
        planned = self.run_it("plan", self.recipe, "-o", self.out, *VIEWS, *store, "--json").json
        self.assertEqual((planned["stale"], planned["trace"]), (IMAGES, 0), planned)
        self.assert_counts(self.build(*VIEWS, *store), built=IMAGES, traced=0, developed=0)
        self.assertEqual(self.contents(), self.wanted)

    def test_the_documented_line_of_gnu_parallel(self):
        version = shutil.which("parallel") and subprocess.run(["parallel", "--version"], capture_output=True, text=True, check=False)
        if not version or "GNU parallel" not in version.stdout:
            self.skipTest("no GNU parallel here")
        text = (self.source / "recipes/README.md").read_text().split("GNU parallel does the same by ssh:\n\n")[1].split("\n\n")[0]
        # The hosts are this one, by a shell in ssh's place; paths and numbers are this test's, the words are the page's.
        # As sshd does, it sets SHELL: where that is missing, parallel's wrapper runs nothing and exits with 0.
        hosts = self.folder / "hosts"
        (self.folder / "bin").mkdir()
        ssh = f'while [[ $1 == -* ]]; do shift; done\necho "$1" >>{hosts}\nshift\n[ "$1" != -- ] || shift\nSHELL=/bin/bash exec bash -c "$*"'
        for name, lines in (("ssh", ssh), ("dsbuild", f'exec {self.dsbuild} "$@"')):
            (self.folder / "bin" / name).write_text(f"#!/bin/bash\n{lines}\n")
            (self.folder / "bin" / name).chmod(0o755)
        for before, after in (("/tmp/", f"{self.folder}/tmp-"), ("recipe.toml", "tiny/recipe.toml"), ("/16", f"/{SHARDS}"),
                              ("seq 16", f"seq {SHARDS}"), (" -k ", f" -k {' '.join(VIEWS)} "),
                              ("-o out", f"-o out {' '.join(VIEWS)}")):
            self.assertIn(before, text)
            text = text.replace(before, after)
        environment = {**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}", "HOME": str(self.folder)}
        run = subprocess.run(["bash", "-euc", text], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=300,
                             check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertIn("16 built from the store", run.stdout)
        self.assertEqual(set(hosts.read_text().split()), {"host1", "host2"})
        self.assert_whole()

    @staticmethod
    def named(text):
        """Images of a plan told with -v: one alone in its line, those with one reason below it."""
        lines = text.splitlines()
        return [line.strip() for line in lines if line.startswith("  ")] + [
            line.split(":")[0] for line in lines if ": trace: new" in line and " more: " not in line]

    def test_dry_run_and_explain_tell_of_the_share(self):
        stale = []
        for number in range(1, SHARDS + 1):
            run = self.run_it("build", self.recipe, "-o", self.out, *VIEWS, "--shard", f"{number}/{SHARDS}", "-nv")
            stale += self.named(run.out)
        self.assertEqual(len(stale), IMAGES)
        self.assertEqual(len(set(stale)), IMAGES)
        self.assertFalse(self.out.exists())
        run = self.run_it("build", self.recipe, "-o", self.out, *VIEWS, "--shard", f"1/{SHARDS}", "--explain", "-v")
        self.assertEqual(set(self.named(run.out)), self.listed())
        self.assertIn(f"tiny: {len(self.listed())} images: {len(self.listed())} built, 0 reused", run.out)
        self.assertIn(f"[{len(self.listed())}/{len(self.listed())}] 100% ", run.err)

    def test_force_makes_the_share_again(self):
        self.build(*VIEWS)
        counts = self.in_turn("--force")
        self.assertEqual(counts, {name: self.whole[name] for name in COUNTERS})
        self.assert_whole()

    def test_keep_going(self):
        (self.tiny / "models/bad.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
        runs = [self.run_it("build", self.recipe, "-o", self.out, "--json", *VIEWS, "-k", "--shard", f"{i}/{SHARDS}")
                for i in range(1, SHARDS + 1)]
        for run in runs:
            self.assertEqual(run.code, 1 if run.json["failed"] else 0, run)
        self.assert_counts(self.sum([run.json for run in runs]), images=IMAGES + 8, built=IMAGES, failed=8)
        (self.tiny / "models/bad.ply").unlink()
        self.assert_counts(self.in_turn(), images=IMAGES, built=0, reused=IMAGES)
        self.assert_whole()

    def test_what_the_recipe_no_longer_names_goes_with_its_share(self):
        self.build(*VIEWS)
        box = self.tiny / "models/box.off"
        box.rename(self.folder / "box.off")
        left = self.in_place()
        for number in range(1, SHARDS + 1):
            dry = self.shard(number, "-n")
            self.assert_counts(dry, built=0, stale=0)
            self.shard(number)
            self.assertEqual(len(self.listed()), IMAGES // 2)
            self.assertTrue(self.in_place() <= left)
            left = self.in_place()
        self.assertEqual(self.in_place(), self.listed())
        self.build(*VIEWS, out=self.one)
        self.assertEqual(self.contents(), self.contents(self.one))

    def test_a_removed_file_is_its_shares_to_place(self):
        self.build(*VIEWS)
        (self.out / "images/box.off/2.png").unlink()
        built = []
        for number in range(1, SHARDS + 1):
            built.append(self.shard(number)["built"])
            self.assertEqual(len(self.listed()), IMAGES - 1 + sum(built))
        self.assertEqual(sorted(built), [0] * (SHARDS - 1) + [1])
        self.assert_whole()

    def test_other_values_are_wrong_usage(self):
        for value in ("0/4", "5/4", "a/b", "1", "1/0", "-1/2", "1/2x", "1/2/3", "/", "1/65537",
                      "1/99999999999999999999"):
            run = self.run_it("build", self.recipe, "-o", self.out, f"--shard={value}")
            self.assertEqual(run.code, 2, (value, str(run)))
            self.assertEqual(run.err, "dsbuild: error: --shard: wanted I/N with 1 <= I <= N <= 65536, such as 2/4, "
                                      f"got {value}\n")
            self.assertEqual(run.out, "")
        for command in (["build", self.recipe, "--shard", "-1/2"], ["build", self.recipe, "--shard"],
                        ["build", self.recipe, "--shard="], ["verify", self.recipe, "--shard", "1/2"]):
            run = self.run_it(*command, "-o", self.out)
            self.assertEqual(run.code, 2, (command, str(run)))
            self.assertEqual(len(run.err.splitlines()), 1, run)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    main()
