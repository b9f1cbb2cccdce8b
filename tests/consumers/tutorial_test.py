# SPDX-License-Identifier: Apache-2.0
"""The README's tutorial as it stands, under bash -e: the classifier beats chance by far."""
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from harness import TinyCase, main
from solids import KINDS, write_solids

# A pip without a network: it takes what ci/consumers installed, and of that the packages asked for and what those require
# alone, so that a package that the README forgets is not there.
PIP = '''
import importlib.metadata, pathlib, re, sys, sysconfig
sys.path.append({packages!r})
def key(name):
    return re.sub(r"[-_.]+", "-", name).lower()
assert sys.argv[1] == "install", sys.argv
have = {{key(d.metadata["Name"]): d for d in importlib.metadata.distributions(path=[{packages!r}])}}
wanted, to = [key(name) for name in sys.argv[2:]], pathlib.Path(sysconfig.get_path("purelib"))
taken = set()
while wanted:
    name = wanted.pop()
    if name in taken or name not in have:  # what another platform or Python would need is in no list here
        continue
    taken.add(name)
    wanted += [key(re.match(r"[\\w.-]+", line)[0]) for line in have[name].requires or [] if "extra ==" not in line]
for name in taken:
    for top in {{file.parts[0] for file in have[name].files if file.parts[0] not in ("..", "__pycache__")}}:
        if not (to / top).exists():
            (to / top).symlink_to(pathlib.Path({packages!r}) / top)
'''
# As Debian's, it has no pip outside a venv.
PYTHON = '''#!/bin/sh
[ "$1 $2" != "-m pip" ] || exit 1
[ "$1 $2" = "-m venv" ] || exec "{python}" "$@"
"{python}" -m venv --without-pip "$3" && for folder in "$3"/lib/python*/site-packages; do cp "{pip}" "$folder"; done
'''


class TutorialTest(TinyCase):
    def block(self, language):
        text = (self.source / "README.md").read_text()
        tutorial = text[text.index("## From a folder of meshes"):]
        return re.search(rf"^```{language}\n(.*?)^```$", tutorial, re.DOTALL | re.MULTILINE)[1]

    def test_the_commands_of_the_readme(self):
        write_solids(self.folder / "meshes", 6)
        (self.folder / "train.py").write_text(self.block("python"))
        (self.folder / "tutorial.sh").write_text(self.block("sh"))
        tools, pip = self.folder / "bin", self.folder / "pip.py"
        tools.mkdir()
        (tools / "dsbuild").symlink_to(self.dsbuild)
        import numpy
        pip.write_text(PIP.format(packages=str(pathlib.Path(numpy.__file__).parent.parent)))
        (tools / "python3").write_text(PYTHON.format(python=sys.executable, pip=pip))
        (tools / "python3").chmod(0o755)
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "HF_HUB_OFFLINE": "1",
                       "HF_HOME": str(self.folder / "hub")}
        environment.pop("PYTHONPATH", None)
        done = subprocess.run(["bash", "-e", "tutorial.sh"], cwd=self.folder, env=environment, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, f"{done.stdout}\n{done.stderr}")
        self.assertTrue((self.folder / "dataset/gallery/index.html").is_file())
        accuracy, chance = map(float, re.fullmatch(r"accuracy (\S+), by chance (\S+)", done.stdout.splitlines()[-1]).groups())
        print(f"accuracy {accuracy}, by chance {chance}")
        self.assertLess(chance, 1.5 / len(KINDS))
        self.assertGreater(accuracy, 2 * chance)


if __name__ == "__main__":
    main()
