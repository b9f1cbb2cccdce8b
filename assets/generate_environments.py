#!/usr/bin/env python3
# SPDX-License-Identifier: CC0-1.0
"""Writes the meshes of assets/environments. Python 3.9 or later, standard library only; the same bytes every time.

    python3 assets/generate_environments.py
"""
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # keeps the source tree clean

from modelling import stages
from modelling.mesh import write_ply

MESHES = {
    "studio/backdrop": stages.backdrop,
    "office/table": stages.table_top,
    "outdoor/terrace": stages.terrace,
    "outdoor/columns": stages.columns,
    "outdoor/meadow": stages.meadow,
}


def main():
    folder = Path(__file__).resolve().parent / "environments"
    for name, make in MESHES.items():
        mesh, normals = make()
        path = folder / f"{name}.ply"
        path.parent.mkdir(parents=True, exist_ok=True)
        comment = f"{name}, Z up, metres, CC0-1.0, made by assets/generate_environments.py"
        write_ply(path, mesh, comment, normals)
        print(f"{name:20} {len(mesh.faces):6} triangles {path.stat().st_size:8} bytes")


if __name__ == "__main__":
    main()
