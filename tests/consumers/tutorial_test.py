# SPDX-License-Identifier: Apache-2.0
"""The README's tutorial, its commands one after the other, with small pictures: the classifier beats chance by far."""
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from harness import TinyCase, main
from solids import KINDS, write_solids


class TutorialTest(TinyCase):
    def blocks(self, language):
        text = (self.source / "README.md").read_text()
        tutorial = text[text.index("## From a folder of meshes"):]
        return re.findall(rf"^```{language}\n(.*?)^```$", tutorial, re.DOTALL | re.MULTILINE)

    def test_the_commands_of_the_readme(self):
        write_solids(self.folder / "meshes", 6)
        [script], [program] = self.blocks("sh"), self.blocks("python")
        (self.folder / "train.py").write_text(program)
        commands = script.splitlines()
        self.assertEqual(len(commands), 10)
        tools = self.folder / "bin"
        tools.mkdir()
        (tools / "dsbuild").symlink_to(self.dsbuild)
        (tools / "python3").symlink_to(sys.executable)
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "HF_HUB_OFFLINE": "1",
                       "HF_HOME": str(self.folder / "hub"), "PYTHONPATH": os.pathsep.join(sys.path)}
        for command in commands:
            if " -m pip install " in command:
                continue  # ci/consumers did
            if " -o dataset " in command:
                for size, small in (("=64", "=24"), ("error=0.1", "error=0.3")):
                    self.assertIn(size, command)
                    command = command.replace(size, small)
                command += " --set 'camera.views=[1,4,8,11]'"
            if " -o preview " in command:
                command += " --set engine.width=16 --set engine.height=16"
            done = subprocess.run(["sh", "-c", command], cwd=self.folder, env=environment, capture_output=True, text=True,
                                  check=False)
            # What check warns of is for people to look at.
            self.assertIn(done.returncode, (0, 1) if command.startswith("dsbuild check") else (0,),
                          f"{command}\n{done.stdout}{done.stderr}")
            print(command, done.stdout[-400:], sep="\n")
        accuracy, chance = map(float, re.fullmatch(r"accuracy (\S+), by chance (\S+)", done.stdout.splitlines()[-1]).groups())
        self.assertLess(chance, 1.5 / len(KINDS))
        self.assertGreater(accuracy, 2 * chance)


if __name__ == "__main__":
    main()
