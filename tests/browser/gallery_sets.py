# SPDX-License-Identifier: Apache-2.0
"""Datasets for the gallery's tests: lines of a real manifest, repeated under other names and with other numbers."""
import json
import os
import random
import shutil
import subprocess

HOSTILE = ["<img src=x onerror=alert(1)>", "quote\"and'", "per%20cent#hash?q&a=b", "Gr\u00fc\u00dfe \u65e5\u672c",
           "-a b", "__proto__", "</script><script>alert(1)</script>"]


def build_tiny(dsbuild, source, folder):
    """Eight images of 32x32 with classes and planes; the dataset's folder."""
    tiny = folder / "tiny"
    shutil.copytree(source / "tests/data/tiny", tiny)
    (tiny / "train.cla").write_text("PSB 1\n2 1\nsolid 0 0\nbox solid 1\nbox\n")
    (tiny / "test.cla").write_text("PSB 1\n2 1\nsolid 0 0\nspike solid 1\ntetra\n")
    recipe = (tiny / "recipe.toml").read_text()
    recipe = recipe.replace("[materials]", '[classes]\ntrain = "train.cla"\ntest = "test.cla"\n\n[materials]')
    recipe = recipe.replace("spp = 1", "spp = 4")
    (tiny / "recipe.toml").write_text(recipe + '\n[outputs]\nplanes = ["depth", "shading_normal", "amodal_mask"]\n')
    out = folder / "out"
    subprocess.run([dsbuild, "build", tiny / "recipe.toml", "-o", out], check=True, capture_output=True, timeout=600)
    return out


def make_set(real, folder, count, hostile=False):
    """A dataset of `count` images whose files are links to those of `real`."""
    lines = [json.loads(line) for line in (real / "manifest/images.jsonl").read_text().splitlines()]
    random_numbers = random.Random(7)
    (folder / "manifest").mkdir(parents=True)
    records, names = [], HOSTILE if hostile else []
    for k in range(count):
        line = json.loads(json.dumps(lines[k % len(lines)]))
        model = names[k % len(names)] + ".ply" if names else f"m{k // 10:05}.ply"
        line["model"], line["view"] = model, f"{k % 10 if not names else k}"
        line["id"] = f"{model}/{line['view']}"
        line["class_path"] = names[k % len(names)] if names else f"group{k % 4}/class{k // 10 % 50:02}"
        line["material"] = names[(k + 1) % len(names)] if names else f"material-{random_numbers.randrange(20)}"
        line["environment"] = names[(k + 2) % len(names)] if names else f"place{random_numbers.randrange(6)}"
        line["split"] = "test" if k // 10 % 5 == 0 else "train"
        line["relative_error"] = round(random_numbers.uniform(0.01, 0.05), 6)
        line["render_key"] = f"{k:032x}"
        kept = []
        for file in line["files"]:
            if count > 1000 and file["kind"] not in ("image", "mask"):
                continue
            path = f"images/{line['id']}{'.' + file['kind'] if file['kind'] != 'image' else ''}{os.path.splitext(file['path'])[1]}"
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            os.link(real / file["path"], folder / path)
            kept.append(dict(file, path=path))
        line["files"] = kept
        records.append(line)
    records.sort(key=lambda line: line["id"].encode())
    (folder / "manifest/images.jsonl").write_text(
        "".join(json.dumps(line, sort_keys=True, separators=(",", ":"), ensure_ascii=False) + "\n" for line in records))
    dataset = json.loads((real / "manifest/dataset.json").read_text())
    dataset["counts"]["images"] = count
    dataset["class_paths"] = sorted({line["class_path"] for line in records})
    if hostile:
        dataset["name"] = HOSTILE[0]
    (folder / "manifest/dataset.json").write_text(json.dumps(dataset))
    return records
