# SPDX-License-Identifier: Apache-2.0
"""scene.json of render_bench as a Mitsuba scene. What is the same and what is not stands in README.md beside this."""
import math
import pathlib

import numpy as np

# Standard deviation of the four-term Blackman-Harris window as a part of its full width (numerical integral).
BLACKMAN_HARRIS_DEVIATION = 0.13851


def rgb(value) -> dict:
    return {"type": "rgb", "value": [float(v) for v in value]}


def bsdf(material: dict, varying: dict) -> dict:
    """`varying` holds the inputs that stand at the mesh's vertices, three floats each."""
    inputs = material["inputs"]

    def color(name: str) -> dict:
        if name in varying:
            return {"type": "mesh_attribute", "name": f"vertex_{name}"}
        return rgb(inputs[name])

    def mean_color(name: str) -> dict:
        """roughplastic takes no mesh attribute (it asks its texture for a mean)."""
        return rgb(varying[name].reshape(-1, 3).mean(axis=0) if name in varying else inputs[name])

    kind = material["type"]
    if kind == "matte":
        inner = {"type": "diffuse", "reflectance": color("kd")}
    elif kind == "glossy2":
        root = math.sqrt(np.mean(inputs["ks"]))  # reflectance at normal incidence = ((n - 1) / (n + 1))^2
        inner = {"type": "roughplastic", "distribution": "ggx", "alpha": inputs["uroughness"][0],
                 "int_ior": (1 + root) / (1 - root), "ext_ior": 1.0, "nonlinear": False,
                 "diffuse_reflectance": mean_color("kd")}
    elif kind == "metal2":
        inner = {"type": "roughconductor", "distribution": "ggx", "alpha": inputs["uroughness"][0],
                 "eta": rgb(inputs["n"]), "k": rgb(inputs["k"])}
    else:
        raise SystemExit(f"material type {kind} has no counterpart in this translation")
    return {"type": "twosided", "bsdf": inner}


def shape(mi, entry: dict, materials: list, folder: pathlib.Path):
    varying = {name: np.fromfile(folder / file, np.float32) for name, file in entry["varying"].items()}
    mesh = mi.load_dict({"type": "ply", "filename": str(folder / entry["file"]),
                         "bsdf": bsdf(materials[entry["material"]], varying)})
    for name, values in varying.items():
        mesh.add_attribute(f"vertex_{name}", 3, values)
    return mesh


def lat_long(mi, light: dict, folder: pathlib.Path) -> dict:
    """dsbuild has the pole at +z and the image's middle column at +x; Mitsuba +y and +z."""
    image = light["image"]
    pixels = np.fromfile(folder / image["file"], np.float32).reshape(image["height"], image["width"], 3)
    axes = np.array([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]], dtype=float)
    to_world = np.array(light["light_to_world"]).reshape(4, 4) @ axes
    return {"type": "envmap", "bitmap": mi.Bitmap(pixels * np.array(light["color"], np.float32)),
            "to_world": mi.ScalarTransform4f(to_world)}


def emitter(mi, light: dict, folder: pathlib.Path) -> dict:
    kind, color = light["kind"], np.array(light["color"])
    position, direction = (np.array(light.get(name, [0, 0, 0])) for name in ("position", "direction"))
    if kind == "point":
        return {"type": "point", "position": position.tolist(), "intensity": rgb(color)}
    if kind == "spot":
        up = [0, 0, 1] if abs(direction[2]) < 0.9 else [1, 0, 0]
        return {"type": "spot", "intensity": rgb(color),
                "cutoff_angle": math.degrees(math.acos(light["cos_total"])),
                "beam_width": math.degrees(math.acos(light["cos_falloff"])),
                "to_world": mi.ScalarTransform4f().look_at(origin=position, target=position + direction, up=up)}
    if kind == "sun":  # irradiance of the disc on a surface that faces it
        irradiance = color * math.pi * (1 - light["cos_total"] ** 2)
        return {"type": "directional", "direction": (-direction).tolist(), "irradiance": rgb(irradiance)}
    if kind == "constant_infinite":
        return {"type": "constant", "radiance": rgb(color)}
    return lat_long(mi, light, folder)


def checked_lights(exported: dict) -> list:
    """Mitsuba takes one environment only."""
    distant = [light for light in exported["lights"] if light["kind"] in ("constant_infinite", "infinite")]
    if len(distant) > 1:
        raise SystemExit("two lights without a place have no counterpart in Mitsuba")
    return exported["lights"]


def reconstruction_filter(width: float) -> dict:
    if width == 0:
        return {"type": "box"}
    return {"type": "gaussian", "stddev": width * BLACKMAN_HARRIS_DEVIATION}


def sensor(mi, exported: dict, width: int, height: int) -> dict:
    camera = exported["camera"]
    return {"type": "perspective", "fov": camera["fov_deg"], "fov_axis": "larger", "near_clip": 1e-3,
            "to_world": mi.ScalarTransform4f().look_at(origin=camera["position"], target=camera["target"],
                                                       up=camera["up"]),
            "sampler": {"type": "independent"},
            "film": {"type": "hdrfilm", "width": width, "height": height, "component_format": "float32",
                     "rfilter": reconstruction_filter(exported["engine"]["filter_width"])}}


def integrator(engine: dict) -> dict:
    """Mitsuba has one depth for all kinds of bounces and counts edges, not vertices: as many as make the longest path
    have as many light samples and the same last ray. No material of these scenes is specular."""
    depth = min(engine["depth_total"] + 1, engine["depth_diffuse"] + 2, engine["depth_glossy"] + 2)
    return {"type": "path", "max_depth": depth, "rr_depth": engine["roulette_depth"]}


def load(mi, exported: dict, folder: pathlib.Path):
    scene = {"type": "scene", "integrator": integrator(exported["engine"])}
    for i, light in enumerate(checked_lights(exported)):
        scene[f"light-{i}"] = emitter(mi, light, folder)
    for i, entry in enumerate(exported["objects"]):
        scene[f"object-{i}"] = shape(mi, entry, exported["materials"], folder)
    return mi.load_dict(scene)
