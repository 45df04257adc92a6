"""Measures rays and distances against resolution by `svdag-verify trace`: the table "Rays" of docs/results/accuracy.md."""
import json
import subprocess

from bakes import Bakes, label
from bench_tables import table

# Scene (of bakes.py), rule, log2 of the resolutions.
SERIES = [("atrium", "conservative", range(9, 15)), ("sponza", "conservative", range(9, 15)),
          ("sponza", "thin", range(9, 15)), ("dragon", "conservative", range(9, 15)),
          ("city", "conservative", range(9, 15)), ("hairball", "conservative", range(9, 13))]
RAYS = "300000"
FREE = ["camera", "chord", "inside"]  # kinds of rays that do not depend on the size of voxels
BINS = ["< -1", "-1 .. 0", "0 .. 0.5", "0.5 .. 1", "1 .. 2", "2 .. 4", ">= 4"]


def measure(programs, folder):
    """A row per scene, rule and grid; missing scenes are skipped."""
    bakes, rows = Bakes(programs, folder), []
    for scene, rule, grids in SERIES:
        if bakes.scene(scene) is None:
            continue
        for log2 in grids:
            bakes.report(scene, log2, "--rule", rule)
            done = subprocess.run([programs / "svdag-verify", "trace", bakes.dag_file(), bakes.scene(scene), "--rays",
                                   RAYS, "--json"], stdout=subprocess.PIPE, text=True)
            answer = json.loads(done.stdout)
            free = [answer["one_side"][kind] for kind in FREE]
            rows.append({"scene": scene, "rule": rule, "grid": label(log2), "log2": log2,
                         **{k: answer[k] for k in ("rays", "both", "triangle_only", "dag_only", "judged", "late", "voxels",
                                                   "far", "doubtful", "points", "uncovered", "scene_to_voxels", "voxels_to_scene")},
                         "free_rays": sum(kind["rays"] for kind in free), "free_hits": sum(kind["hits"] for kind in free),
                         **{f"nearer {name}": answer["nearer"][name] for name in BINS}})
            print(f"{scene:>9} {rule:>12} {label(log2):>4} {answer['late']} late, {answer['far']} far, "
                  f"Hausdorff {answer['scene_to_voxels']:.3f} {answer['voxels_to_scene']:.3f}", flush=True)
    bakes.dag_file().unlink(missing_ok=True)
    return rows


def disagree(row):
    return 1e6 * row["free_hits"] / row["free_rays"]


def rays_table(rows):
    """The table: the coarsest and the finest grid of each series; the CSV file has all."""
    series = {}
    for row in rows:
        series.setdefault((row["scene"], row["rule"]), []).append(row)
    lines = []
    for row in [own[k] for own in series.values() for k in (0, -1)]:
        worst = max(row["scene_to_voxels"], row["voxels_to_scene"])
        lines.append([f"{row['scene']}, {row['rule']}", f"{row['grid']}³", f"{row['late']} / {row['judged']:,}",
                      f"{row['far']} / {row['voxels']:,}", f"{disagree(row):,.0f}", f"{row['scene_to_voxels']:.3f}",
                      f"{row['voxels_to_scene']:.3f}", f"{worst / 2**row['log2']:.1e}"])
    return table(["scene, rule", "grid", "late / judged", "far / voxels", "one side hits, per million rays", "scene to voxels",
                  "voxels to scene", "larger of both / N"], lines)
