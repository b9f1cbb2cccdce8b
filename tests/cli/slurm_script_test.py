# SPDX-License-Identifier: Apache-2.0
"""`dsbuild slurm` without Slurm: its script, its mark, its refusals; a few lines of bash stand for sbatch and squeue."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time

from harness import IMAGES, SAMPLES, TinyCase, main

# Jobs 101, 102, ... run at once and to their end, shards one after the other; squeue knows the ids in $FAKE/known.
SBATCH = r"""#!/bin/bash
set -euo pipefail
printf '%s\n' "$*" >>"$FAKE/calls"
id=$((100 + $(wc -l <"$FAKE/calls")))
array=
while [[ $1 == -* ]]; do
  case $1 in --array=*) array=${1#--array=1-}; array=${array%%%*} ;; esac
  shift
done
[ ! -e "$FAKE/refuse" ] || { echo "sbatch: error: invalid partition" >&2; exit 1; }
echo $id
[ ! -e "$FAKE/hold" ] || exit 0
for task in ${array:+$(seq $array)} ${array:-1}; do
  [ -z "$array" ] || [ ! -e "$FAKE/done-$task" ] || continue
  if [ -n "$array" ]; then touch "$FAKE/done-$task"; fi
  SLURM_JOB_ID=$id SLURM_ARRAY_TASK_ID=$task bash "$@" >>"$FAKE/log-$id" 2>&1 || true
done
rm -f "$FAKE"/done-*
"""
SQUEUE = r"""#!/bin/bash
while [ $# -gt 0 ]; do if [ "$1" = --jobs ]; then id=$2; fi; shift; done
[ ! -e "$FAKE/mute" ] || { echo "slurm_load_jobs error: Unable to contact slurm controller" >&2; exit 1; }
if grep -qx "$id" "$FAKE/known" 2>/dev/null; then echo RUNNING; exit 0; fi
echo "slurm_load_jobs error: Invalid job id specified" >&2
exit 1
"""


class SlurmScriptTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.fake = self.folder / "fake"
        self.fake.mkdir()
        for name, text in (("sbatch", SBATCH), ("squeue", SQUEUE), ("scancel", "#!/bin/bash\necho scancel $* >>$FAKE/calls\n")):
            (self.fake / name).write_text(text)
            (self.fake / name).chmod(0o755)
        (self.folder / "local").mkdir()
        self.environment = {**os.environ, "PATH": f"{self.fake}:/usr/bin:/bin", "FAKE": str(self.fake),
                            "TMPDIR": str(self.folder / "local")}
        self.store = self.folder / "it's a store"

    def slurm(self, *arguments, recipe=None, code=0, environment=None):
        form = [] if "--print" in arguments else ["--json"]
        run = self.run_it("slurm", recipe or self.recipe, "-o", self.out, "--store", self.store, *form, *arguments,
                          env=environment or self.environment)
        self.assertEqual(run.code, code, run)
        return run

    def status(self):
        run = self.run_it("status", self.recipe, "-o", self.out, "--json", env=self.environment)
        self.assertEqual(run.code, 0, run)
        return run.json

    def answers(self, job):
        """What the builds of a job said of themselves."""
        lines = [line for line in (self.fake / f"log-{job}").read_text().splitlines() if line.startswith("{")]
        return [answer for answer in map(json.loads, lines) if "traced" in answer]

    def marks(self):
        return [path for path in (self.store / "slurm").iterdir() if path.name.isdigit()]

    def assert_as_on_one_machine(self, *settings):
        self.build(*settings, out=self.folder / "one")
        self.assertEqual(self.contents(), self.contents(self.folder / "one"))
        # As after a build on one machine: nothing is left to do, and the folder alone is enough.
        self.assertEqual(self.run_it("verify", self.out).code, 0)
        run = self.run_it("build", self.out, "--json")
        self.assert_counts(run.json, images=IMAGES, built=0, reused=IMAGES)

    def test_shards_and_a_last_job(self):
        run = self.slurm("--shards", "3", "--nodes", "2")
        self.assertEqual(run.json["jobs"], ["101", "102"])
        self.assertEqual((run.json["images"], run.json["trace"], run.json["shards"]), (IMAGES, IMAGES, 3))
        shards = self.answers(101)
        self.assertEqual(len(shards), 3)
        self.assertEqual(sum(one["traced"] for one in shards), IMAGES)
        last = self.answers(102)
        self.assert_counts(last[0], images=IMAGES, built=IMAGES, traced=0, traced_samples=0)
        self.assertEqual(self.marks(), [])
        self.assert_as_on_one_machine()
        self.assertIsNone(self.status()["slurm"])
        # Nothing but what is to last is left, on either disk.
        self.assertEqual(list((self.folder / "local").glob("dsbuild.*")), [])
        names = {path.name for path in self.store.iterdir()} - {"lock", "dsbuild.sqlite-checked"}
        self.assertEqual(names, {"objects", "records", "slurm", "dsbuild.sqlite", "datasets"})
        self.assertEqual(len(list((self.store / "datasets").iterdir())), 1)
        calls = (self.fake / "calls").read_text().splitlines()
        self.assertIn("--array=1-3%2 ", calls[0])
        self.assertIn("--dependency=afterany:101 ", calls[1])
        self.assertTrue(all("--requeue" in call for call in calls))

    def test_what_shards_left_the_last_job_makes(self):
        (self.fake / "done-2").touch()  # never run
        self.slurm("--shards", "2")
        traced = [one["traced"] for one in self.answers(101) + self.answers(102)]
        self.assertEqual(sum(traced), IMAGES)
        self.assertGreater(traced[-1], 0)
        self.assert_as_on_one_machine()

    def test_a_shard_may_run_twice(self):
        script = self.slurm("--print", "--shards", "2").out
        (self.folder / "job.sh").write_text(script)
        traced = []
        for task in ("1", "2", "1"):
            run = subprocess.run(["bash", self.folder / "job.sh", "shard"], env={**self.environment, "SLURM_ARRAY_TASK_ID": task},
                                 capture_output=True, text=True, check=True)
            traced.append(json.loads(run.stdout.splitlines()[-1])["traced"])
        self.assertEqual((sum(traced), traced[2]), (IMAGES, 0))
        self.assertFalse(self.out.exists())
        self.assertFalse((self.store / "dsbuild.sqlite").exists())

    def own_store(self, place):
        stores = list(place.glob("dsbuild-*-*"))
        self.assertLessEqual(len(stores), 1)
        return [path for store in stores for path in store.rglob("*") if path.is_file()]

    def test_nodes_with_stores_of_their_own(self):
        node = self.folder / "a node's disk"
        self.slurm("--shards", "3", "--local", node)
        shards = self.answers(101)
        self.assertEqual(sum(one["gathered"]["records"]["files"] for one in shards), IMAGES)
        self.assert_counts(self.answers(102)[0], images=IMAGES, built=IMAGES, traced=0)
        self.assertEqual(self.own_store(node), [])
        self.assert_as_on_one_machine()

    def test_a_variable_of_the_job_names_the_place(self):
        self.slurm("--shards", "2", "--local", "$TMPDIR/kept here")
        self.assertEqual(sum(one["gathered"]["records"]["files"] for one in self.answers(101)), IMAGES)
        self.assertTrue((self.folder / "local/kept here").is_dir())
        self.assert_as_on_one_machine()
        for place in ("scratch", "./scratch", "$", "$(id)", "$A B/x", "~/x"):
            self.assertIn("slurm --local: wanted a folder that every node has", self.slurm("--local", place, code=2).err)

    def test_a_killed_build_of_a_node_loses_only_what_was_under_way(self):
        node = self.folder / "node"
        (self.fake / "hold").touch()
        slow = ["--set", "engine.spp=3000"]
        script = self.slurm("--shards", "1", "--local", node, *slow).json["script"]
        job = subprocess.Popen(["bash", script, "shard"], env={**self.environment, "SLURM_ARRAY_TASK_ID": "1"},
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        records = lambda: [path for path in self.own_store(node) if "records" in path.parts and path.name[0] != "."]
        deadline = time.monotonic() + 60
        while len(records()) < 2:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        build = subprocess.run(["pgrep", "-P", str(job.pid), "dsbuild"], capture_output=True, text=True, check=True).stdout
        os.kill(int(build.split()[0]), signal.SIGKILL)
        said = job.communicate(timeout=60)[0]
        self.assertNotEqual(job.returncode, 0)
        kept = len([path for path in (self.store / "records").rglob("*") if path.is_file()])
        self.assertGreaterEqual(kept, 2, said)
        subprocess.run(["bash", script, "last"], env=self.environment, check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(self.marks(), [])
        self.assert_as_on_one_machine(*slow)

    def test_print_makes_nothing_and_its_script_submits_itself(self):
        run = self.slurm("--print", "--nodes", "5", "--", "--time=2:00:00", "-p", "long")
        self.assertFalse(self.store.exists() or self.out.exists() or (self.fake / "calls").exists())
        lines = run.out.splitlines()
        self.assertEqual(lines[0], "#!/bin/bash")
        self.assertIn("set -euo pipefail", lines)
        self.assertIn("array=1-20%5", lines)
        self.assertIn("options=('--time=2:00:00' '-p' 'long')", lines)
        (self.folder / "job.sh").write_text(run.out)
        subprocess.run(["bash", "-n", self.folder / "job.sh"], check=True)
        (self.fake / "hold").touch()
        run = subprocess.run(["bash", self.folder / "job.sh"], env=self.environment, capture_output=True, text=True, check=True)
        self.assertEqual(run.stdout, "101\n102\n")
        calls = (self.fake / "calls").read_text()
        self.assertEqual(calls.count("--time=2:00:00 -p long "), 2)

    def test_the_printed_script_may_be_piped(self):
        script = self.slurm("--print", "--shards", "2").out
        for piped in (["bash"], ["bash", "-s"]):
            run = subprocess.run(piped, input=script, env=self.environment, cwd=self.folder, capture_output=True, text=True,
                                 check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ""), run)
            self.assertEqual(len(run.stdout.split()), 2, run)
        self.assertEqual([one["traced"] > 0 for one in self.answers(101)], [True, True])
        self.assert_as_on_one_machine()
        self.assertEqual(list((self.folder / "local").glob("dsbuild*")), [])
        # One of its jobs by hand, too.
        run = subprocess.run(["bash", "-s", "shard"], input=script, env={**self.environment, "SLURM_ARRAY_TASK_ID": "1"},
                             capture_output=True, text=True, check=True)
        self.assertEqual(json.loads(run.stdout.splitlines()[-1])["traced"], 0)
        (self.fake / "refuse").touch()
        run = subprocess.run(["bash"], input=script, env=self.environment, capture_output=True, text=True, check=False)
        self.assertEqual((run.returncode, run.stdout), (1, ""), run)

    def test_a_time_limit_that_is_near_ends_no_verification(self):
        script, fake = self.folder / "script.sh", self.folder / "dsbuild"
        fake.write_text("#!/bin/bash\n[ $1 != verify ] || { kill -USR1 $PPID; sleep 1; }\necho {}\n")
        fake.chmod(0o755)
        text = self.slurm("--print").out
        script.write_text("".join(f"dsbuild='{fake}'\n" if line.startswith("dsbuild=") else line + "\n"
                                  for line in text.splitlines()))
        run = subprocess.run(["bash", script, "last"], capture_output=True, text=True, check=False, timeout=60,
                             env={**self.environment, "SLURM_JOB_ID": "1"})
        self.assertEqual(run.returncode, 0, run)
        self.assertNotIn("requeued", run.stdout)

    def test_any_path_and_value(self):
        odd = self.folder / "a 'b' $(touch no) %j \"c\""
        odd.mkdir()
        shutil.copytree(self.tiny, odd / "tiny")
        self.out = odd / "o u't"
        self.store = odd / "store"
        settings = ["--set", 'dataset.description="it\'s $HOME `no` \\"x\\""']
        self.slurm("--shards", "2", *settings, recipe=odd / "tiny/recipe.toml")
        self.assertEqual(list(self.folder.rglob("no")), [])
        self.recipe = odd / "tiny/recipe.toml"
        self.assertEqual(self.marks(), [])
        self.assert_as_on_one_machine(*settings)

    def test_status_meanwhile(self):
        (self.fake / "hold").touch()
        script = pathlib.Path(self.slurm("--shards", "2").json["script"])
        (self.fake / "known").write_text("102\n")
        database = (self.store / "dsbuild.sqlite").read_bytes()
        files = {path for path in self.store.rglob("*")}
        status = self.status()
        self.assertEqual((status["kept"], status["trace"], status["slurm"]["state"], status["slurm"]["jobs"],
                          status["slurm"]["shards"]), (0, IMAGES, "running", ["101", "102"], 2))
        self.assertEqual({path for path in self.store.rglob("*")}, files)
        subprocess.run(["bash", script, "shard"], env={**self.environment, "SLURM_ARRAY_TASK_ID": "1"}, check=True,
                       stdout=subprocess.DEVNULL)
        status = self.status()
        self.assertTrue(0 < status["kept"] < IMAGES)
        self.assertEqual((status["kept"], status["trace"]), (status["place"], IMAGES - status["kept"]))
        text = self.run_it("status", self.recipe, "-o", self.out, env=self.environment).out
        self.assertIn(f"in 2 shares, make it now; {status['kept']} of {IMAGES} images are kept", text)
        self.assertEqual((self.store / "dsbuild.sqlite").read_bytes(), database)
        (self.fake / "known").unlink()
        self.assertEqual(self.status()["slurm"]["state"], "gone")
        (self.fake / "mute").touch()
        self.assertEqual(self.status()["slurm"]["state"], "unknown")

    def test_two_coordinators(self):
        (self.fake / "hold").touch()
        self.slurm()
        (self.fake / "known").write_text("101\n")
        calls = (self.fake / "calls").read_text()
        run = self.slurm(code=2)
        self.assertIn("jobs 101, 102 of ", run.err)
        self.assertIn("fill this store now", run.err)
        (self.fake / "mute").touch()
        self.assertIn("squeue does not say", self.slurm(code=1).err)
        self.assertEqual((self.fake / "calls").read_text(), calls)
        # Ended, however it ended: taken over, and said.
        (self.fake / "mute").unlink()
        (self.fake / "known").unlink()
        (self.fake / "hold").unlink()
        run = self.slurm("--shards", "2")
        self.assertIn("jobs 101, 102 of ", run.err)
        self.assertIn("this goes on where they were", run.err)
        self.assertEqual(self.marks(), [])
        self.assert_as_on_one_machine()

    def test_many_at_once_one_wins(self):
        (self.fake / "hold").touch()
        for jobs in ("101\n102\n", "103\n104\n"):  # the second time over a mark of jobs that are gone
            (self.fake / "known").write_text(jobs)
            processes = [self.start("slurm", self.recipe, "-o", self.out, "--store", self.store, env=self.environment)
                         for _ in range(4)]
            codes = []
            for process in processes:
                process.communicate(timeout=300)
                codes.append(process.returncode)
            self.assertEqual(sorted(codes), [0, 2, 2, 2])
            self.assertEqual(len(self.marks()), 1)

    def test_upkeep_and_plain_builds_keep_away(self):
        (self.fake / "hold").touch()
        script = pathlib.Path(self.slurm("--shards", "2").json["script"])
        (self.fake / "known").write_text("101\n")
        subprocess.run(["bash", script, "shard"], env={**self.environment, "SLURM_ARRAY_TASK_ID": "1"}, check=True,
                       stdout=subprocess.DEVNULL)
        files = {path: path.read_bytes() for path in self.store.rglob("*") if path.is_file()}
        there = [self.recipe, "-o", self.out, "--store", self.store]
        self.build("--set", "engine.spp=2", out=self.folder / "else", code=0)
        away = (["build", *there], ["clean", self.recipe, "-o", self.out], ["store", "gc", self.store],
                ["store", "gc", "-n", self.store], ["store", "gather", self.folder / "else", self.store])

        def refused(why):
            for command in away:
                run = self.run_it(*command, env=self.environment)
                self.assertEqual((run.code, len(run.err.splitlines())), (2, 1), run)
                self.assertIn("jobs 101, 102 of ", run.err)
                self.assertIn(why, run.err)

        refused("fill this store now")
        (self.fake / "mute").touch()
        refused(f"remove {self.store}/slurm/1 if not")
        (self.fake / "mute").unlink()
        # What only looks is welcome, and what keeps no database there.
        self.assertEqual(self.run_it("store", "stats", self.store, "--json", env=self.environment).code, 0)
        self.assertEqual(self.run_it("store", "verify", self.store, "--json", env=self.environment).json["damaged"], 0)
        self.assertEqual({path: path.read_bytes() for path in self.store.rglob("*") if path.is_file()}, files)
        run = self.run_it("store", "gather", self.folder / "else", self.store, "--database", self.folder / "db", "--json",
                          env=self.environment)
        self.assertEqual((run.code, run.json["records"]["files"]), (0, IMAGES), run)
        # The jobs have ended, however they did: gc would take what no dataset names yet, a build may go on.
        (self.fake / "known").unlink()
        run = self.run_it("store", "gc", self.store, env=self.environment)
        self.assertEqual(run.code, 2, run)
        self.assertIn("ended before the dataset was whole, and gc would remove what they made", run.err)
        run = self.run_it("build", *there, "--json", env=self.environment)
        self.assertTrue(0 < run.json["traced"] < IMAGES, run)
        self.assertEqual(self.marks(), [])
        self.assertEqual(self.run_it("store", "gc", self.store, env=self.environment).code, 0)
        self.assert_as_on_one_machine()

    def test_refused_jobs_leave_no_mark(self):
        (self.fake / "refuse").touch()
        run = self.slurm(code=1)
        self.assertIn("sbatch: error: invalid partition", run.err)
        self.assertIn("sbatch takes the jobs", run.err)
        self.assertEqual(self.marks(), [])

    def test_wrong_usage(self):
        nowhere = {**self.environment, "PATH": str(self.folder)}
        run = self.slurm(code=1, environment=nowhere)
        self.assertEqual(run.err, "dsbuild: error: slurm: no sbatch on PATH, so no Slurm; --print writes the script\n")
        self.assertFalse(self.store.exists() or self.out.exists())
        self.assertEqual(self.slurm("--print", environment=nowhere).err, "")
        # Who asks for JSON gets that.
        script = self.slurm("--print", "--shards", "3", environment=nowhere).out
        told = self.slurm("--print", "--shards", "3", "--json", environment=nowhere).json
        self.assertEqual((told["script_text"], told["shards"]), (script, 3))
        self.assertEqual({"logs", "folder", "store"} - told.keys(), set())
        for arguments in (["--nodes", "0"], ["--shards", "x"], ["--shards", "70000"]):
            self.assertIn(f"slurm {arguments[0]}: wanted a whole number", self.slurm(*arguments, code=2).err)
        # What would take away what it gives sbatch itself, however it is spelt.
        for words, name in ((["--array=1-3"], "array"), (["--array", "1-3"], "array"), (["-a1-3"], "array"), (["-Ha", "1"], "array"),
                            (["--arr=1"], "array"), (["--output=foo"], "output"), (["-o", "foo"], "output"),
                            (["--time", "1:00", "-d", "afterok:1"], "dependency"), (["--dependency=singleton"], "dependency"),
                            (["--parsable"], "parsable"), (["--wait"], "wait"), (["-W"], "wait"), (["--wrap=true"], "wrap"),
                            (["--test-only"], "test-only"), (["--help"], "help"), (["-vV"], "version"), (["--usage"], "usage"),
                            (["--no-requeue"], "no-requeue"), (["--no-r"], "no-requeue"), (["-k"], "no-kill"), (["-Hk"], "no-kill"),
                            (["--open-mode=truncate"], "open-mode"), (["--clusters=a"], "clusters"), (["-M", "a"], "clusters"),
                            (["--nodes=2"], "nodes"), (["-N2"], "nodes"), (["-HN", "2"], "nodes"), (["--ntasks", "4"], "ntasks"),
                            (["-n4"], "ntasks"), (["--ntasks-per-node=2"], "ntasks-per-node")):
            for also in ([], ["--print"]):
                run = self.slurm(*also, "--", *words, code=2)
                self.assertIn(f"slurm: sbatch's --{name} is not to be given, got ", run.err)
        for words in (["job.sh"], ["--time=1:00", "job.sh"], ["-p", "short", "job.sh"], ["--", "job.sh"]):
            self.assertIn("sbatch would run it in place of the script", self.slurm("--", *words, code=2).err)
        self.assertFalse((self.fake / "calls").exists())
        self.assertFalse(self.store.exists() or self.out.exists())
        self.assertIn("(dsbuild slurm --nodes N: shares made at once;", self.slurm("--", "--nodes=2", code=2).err)
        for words in (["--signal=USR1@60"], ["--signal=B:TERM@60"], ["--signal", "R:USR1"], ["--sig=10"], ["--signal"]):
            self.assertIn("slurm: sbatch's --signal must be B:USR1@SECONDS", self.slurm("--", *words, code=2).err)
        self.assertFalse((self.fake / "calls").exists())
        others = ["--wait-all-nodes=1", "-p", "dear", "--exclude=a,o", "-Hp", "array", "--export=NONE", "--nodelist=a", "-w", "b",
                  "--requeue", "--kill-on-invalid-dep=yes", "--chdir=/", "-D", "/tmp", "--nodefile=f", "-c4", "--ni=3"]
        for signal in (["--signal=B:USR1@600"], ["--signal", "B:SIGUSR1"], ["--sig=B:10@5"]):
            self.assertIn("--wait-all-nodes=1", self.slurm("--print", "--", *others, *signal).out)
        run = self.run_it("slurm", self.tiny, env=self.environment)
        self.assertEqual((run.code, run.err), (2, f"dsbuild: error: slurm: wanted a recipe, found the folder {self.tiny}\n"))


class DatabaseTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.store = self.folder / "store"
        self.local = self.folder / "local"

    def test_a_database_elsewhere(self):
        here = ["--store", self.store, "--database", self.local]
        self.assert_counts(self.build(*here), built=IMAGES, traced=IMAGES)
        self.assertFalse((self.store / "lock").exists() or (self.out / ".dsbuild/build").exists())
        self.assert_counts(self.build(*here), built=0, reused=IMAGES)
        # The whole copy in the store serves whoever works there, and the next machine.
        self.assert_counts(self.build(), built=0, reused=IMAGES)
        shutil.rmtree(self.local)
        self.assert_counts(self.build(*here), built=0, reused=IMAGES)
        self.assertEqual(len(self.run_it("log", self.out, "--json").json["builds"]), 4)

    def test_an_empty_database_is_filled_from_records(self):
        self.build("--store", self.store, "--database", self.local)
        shutil.rmtree(self.local)
        (self.store / "dsbuild.sqlite").unlink()
        (self.out / "images/box.off/0.png").unlink()
        counts = self.build("--store", self.store, "--database", self.local)
        self.assert_counts(counts, built=IMAGES, traced=0, traced_samples=0)
        # What another machine made since is known, too.
        other = ["--store", self.store, "--database", self.folder / "other"]
        self.build(*other, "--set", "engine.spp=2", "--shard", "1/1", out=self.folder / "passing")
        counts = self.build("--store", self.store, "--database", self.local, "--set", "engine.spp=2", "-n")
        self.assert_counts(counts, stale=IMAGES, traced_samples=0)
        self.assert_counts(self.build("--store", self.store, "--database", self.local, "--set", "engine.spp=2"), traced=0)

    def test_a_killed_processes_log_is_not_taken_for_the_new_databases(self):
        self.build("--store", self.store)
        (self.store / "dsbuild.sqlite-wal").write_bytes(b"not a log of this database" * 100)
        self.build("--store", self.store, "--database", self.local, "--set", "engine.spp=2")
        self.assertFalse((self.store / "dsbuild.sqlite-wal").exists())
        self.assert_counts(self.build("--set", "engine.spp=2"), built=0, reused=IMAGES)


if __name__ == "__main__":
    main()
