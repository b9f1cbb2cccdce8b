#!/usr/bin/env python3
# SPDX-License-Identifier: CC0-1.0
"""Writes assets/models/*.ply. Python 3.9 or later, standard library only; the same bytes every time.

    python3 assets/generate_models.py [NAME ...]     all models, or those named ("mug-1")
"""
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # keeps the source tree clean

from modelling import buildings, furniture, living, things, vehicles, vessels
from modelling.mesh import cleaned, problems, write_ply

MODELS = {
    "mug-1": vessels.mug_straight,
    "mug-2": vessels.mug_round,
    "teapot-1": vessels.teapot_round,
    "teapot-2": vessels.teapot_tall,
    "vase-1": vessels.vase_amphora,
    "vase-2": vessels.vase_twisted,
    "bottle-1": vessels.bottle_wine,
    "bottle-2": vessels.bottle_square,
    "chair-1": furniture.chair_slats,
    "chair-2": furniture.chair_shell,
    "table-1": furniture.table_farm,
    "table-2": furniture.table_round,
    "lamp-1": furniture.lamp_desk,
    "lamp-2": furniture.lamp_table,
    "aeroplane-1": vehicles.airliner,
    "aeroplane-2": vehicles.biplane,
    "car-1": vehicles.car_saloon,
    "car-2": vehicles.car_van,
    "boat-1": vehicles.boat_sailing,
    "boat-2": vehicles.boat_tug,
    "fish-1": living.fish_carp,
    "fish-2": living.fish_angel,
    "tree-1": living.tree_fir,
    "tree-2": living.tree_broadleaf,
    "chess-1": things.chess_pawn,
    "chess-2": things.chess_king,
    "snowman-1": things.snowman_hat,
    "snowman-2": things.snowman_scarf,
    "guitar-1": things.guitar_acoustic,
    "guitar-2": things.guitar_electric,
    "house-1": buildings.house_cottage,
    "house-2": buildings.house_tower,
}


def main(names):
    folder = Path(__file__).resolve().parent / "models"
    folder.mkdir(exist_ok=True)
    failed = False
    for name in names or MODELS:
        mesh = cleaned(MODELS[name]())
        path = folder / f"{name}.ply"
        write_ply(path, mesh, f"{name}, Y up, CC0-1.0, made by assets/generate_models.py")
        wrong = problems(mesh)
        failed = failed or bool(wrong)
        print(f"{path.name:20} {len(mesh.faces):6} triangles {path.stat().st_size:8} bytes", *wrong)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
