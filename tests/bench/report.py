# SPDX-License-Identifier: Apache-2.0
"""The table of ci/bench and what it says of the goals."""
from statistics_of_runs import Spread

LABELS = {"dsbuild": "dsbuild", "luxcore": "LuxCore PATHCPU", "mitsuba": "Mitsuba"}
LEAST_OVER_LUXCORE, LEAST_OVER_MITSUBA, LEAST_OVER_EMBREE, MOST_ERROR = 8.0, 1.5, 1.0, 1.0


def plain(value):
    """With named fields in the JSON."""
    if isinstance(value, Spread):
        return value._asdict()
    if isinstance(value, dict):
        return {key: plain(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [plain(inner) for inner in value]
    return value


def label_of(scene: dict, label: str) -> str:
    return scene["names"].get(label, LABELS[label]).split(" on ")[0]


def render_rows(results: dict) -> list:
    rows = []
    for name, scene in results["scenes"].items():
        for label in LABELS:
            who = label_of(scene, label)
            if label in scene["notes"] or label not in scene["rates"]:
                rows.append([name, who, scene["notes"].get(label, "not measured")] + [""] * 6)
                continue
            rate, error = scene["rates"][label], scene["errors"].get(label)
            own = label == "dsbuild"
            rows.append([name, who, rate["msamples_per_second"].text(),
                         "" if own else rate["dsbuild_over_it"].text(),
                         "" if own else f"{rate['dsbuild_over_it_by_cpu_time'].median:.2f}",
                         error_text(error, "relmse_trimmed"), "" if own else ratio_text(error, "relmse_trimmed"),
                         error_text(error, "relmse"), "" if own else ratio_text(error, "relmse")])
    return rows


def error_text(error, name: str) -> str:
    return f"{error[name].median:.3g} [{error[name].least:.3g}, {error[name].most:.3g}]" if error else ""


def ratio_text(error, name: str) -> str:
    return error[f"dsbuild_over_it_{name}"].text() if error else ""


def ray_rows(results: dict) -> list:
    names = {"camera": "camera-like", "bounce": "incoherent (cosine bounce)"}
    return [[names[kind], rays["dsbuild"].text(), rays["embree"].text(), rays["dsbuild_over_embree"].text(),
             f"{100 * rays['same_triangle']:.3f} %"]
            for kind, rays in results["rays"].items() if kind in names]


def table(head: list, rows: list) -> str:
    widths = [max(len(str(row[i])) for row in [head] + rows) for i in range(len(head))]
    lines = [head, ["-" * w for w in widths]] + rows
    return "\n".join("| " + " | ".join(str(cell).ljust(w) for cell, w in zip(line, widths)) + " |" for line in lines)


def goal(name: str, figure, wanted: str, met) -> dict:
    return {"goal": name, "wanted": wanted, "figure": figure, "met": met}


def goals(results: dict) -> list:
    """met is None where a peer was not measured."""
    found = []
    for name, scene in results["scenes"].items():
        for label, least in (("luxcore", LEAST_OVER_LUXCORE), ("mitsuba", LEAST_OVER_MITSUBA)):
            who = label_of(scene, label)
            rate = scene["rates"].get(label)
            figure = rate["dsbuild_over_it"].median if rate else None
            found.append(goal(f"{name}: samples a second over {who}", figure, f">= {least:g}",
                              None if figure is None else figure >= least))
            error = scene["errors"].get(label)
            figure = error["dsbuild_over_it_relmse_trimmed"].median if error else None
            found.append(goal(f"{name}: error over {who} after the same seconds", figure, f"< {MOST_ERROR:g}",
                              None if figure is None else figure < MOST_ERROR))
    figure = results["rays"]["bounce"]["dsbuild_over_embree"].median
    found.append(goal("incoherent closest hits over Embree rtcIntersect1", figure, f">= {LEAST_OVER_EMBREE:g}",
                      figure >= LEAST_OVER_EMBREE))
    return found


def goal_line(entry: dict) -> str:
    if entry["met"] is None:
        return f"  not measured  {entry['goal']} (wanted {entry['wanted']})"
    return f"  {'met    ' if entry['met'] else 'NOT MET'}  {entry['figure']:.3g} (wanted {entry['wanted']})  {entry['goal']}"


def brightness_lines(results: dict) -> list:
    lines = []
    for name, scene in results["scenes"].items():
        for label in ("luxcore", "mitsuba"):
            if label in scene["errors"]:
                ratio = scene["errors"][label]["dsbuild_mean_luminance_over_it"]
                lines.append(f"  {name}: dsbuild / {label_of(scene, label)} = {ratio:.3f}")
    return lines


def text(results: dict) -> str:
    m, s = results["machine"], results["settings"]
    parts = [
        f"machine: {m['cpu']}, {m['cores']} cores, {m['system']}; load before: {m['load_before']:.2f}",
        f"{s['repeats']} repeats ({s['ray_repeats']} for rays), renderers by turns; figures are median [least, most]; "
        f"ratios are of neighbours in time; {results['wall_seconds'] / 60:.1f} minutes in all",
        f"samples a second: {s['size']}x{s['size']}, {s['spp']} spp; error: {s['error_size']}x{s['error_size']} after "
        f"{s['error_seconds']:g} s, relMSE against the renderer's own picture of {s['reference']} times the samples, "
        f"without the worst 0.1 % of pixels and plain",
        "",
        table(["scene", "renderer", "Msamples/s", "dsbuild / it", "by CPU time", "relMSE trimmed", "dsbuild / it",
               "relMSE plain", "dsbuild / it"], render_rows(results)),
        "",
        table([f"closest hits, {results['rays']['triangles']} triangles", "dsbuild Mrays/s", "Embree Mrays/s",
               "dsbuild / Embree", "same triangle"], ray_rows(results)),
        "", "mean luminance (how equivalent the pictures are):", *brightness_lines(results),
        "", "goals:", *[goal_line(entry) for entry in results["goals"]]]
    if m["load_before"] > 0.5 * m["cores"]:
        parts.insert(1, "WARNING: other work was running; ratios may hold, figures do not")
    return "\n".join(parts)
