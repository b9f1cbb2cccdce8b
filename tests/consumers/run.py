# SPDX-License-Identifier: Apache-2.0
"""run.py ENVIRONMENT SCRIPT...: the script by that environment's Python; skipped where ci/consumers could not make it."""
import os
import pathlib
import sys

folder, *script = sys.argv[1:]
if not pathlib.Path(folder, "requirements.txt").is_file():
    print(f"skipped: no packages in {folder} (ci/consumers installs them)")
    sys.exit(125)
python = os.path.join(folder, "bin", "python")
os.execv(python, [python, *script])
