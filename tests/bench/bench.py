#!/usr/bin/env python3
"""`make bench`: bakes scenes at rising resolutions and writes down what that took.

For each scene and resolution: build/bench/bakes.csv (one row) and levels.csv (one row per level),
the plots docs/images/*.svg, and the tables between the markers in docs/performance.md. Scenes are
generated, and taken from SVDAG_SCENES where that is set.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OUT = ROOT / "build" / "bench"
PAGE = ROOT / "docs" / "performance.md"
README = ROOT / "README.md"
RESOLUTIONS = ["512", "1K", "2K", "4K", "8K", "16K"]
GENERATED = {"atrium": [], "scan": []}
SHARED = {"sponza": "crytek_sponza.glb", "dragon": "stanford_dragon.ply"}
PHASES = ["bounds", "split", "voxelize", "sort", "merge", "write"]


def scenes(programs, wanted):
    """{name: path}, made or found."""
    found = {}
    for name, options in GENERATED.items():
        found[name] = OUT / f"{name}.ply"
        if not found[name].exists():
            subprocess.run([programs / "svdag-scene", name, *options, "-q", "-o", found[name]], check=True)
    if "SVDAG_SCENES" in os.environ:
        found |= {name: pathlib.Path(os.environ["SVDAG_SCENES"], file) for name, file in SHARED.items()}
    return {name: path for name, path in found.items() if not wanted or name in wanted}


def bake(programs, name, path, resolution):
    """(row of bakes.csv, rows of levels.csv)"""
    dag, report_file = OUT / "bench.svdag", OUT / f"{name}-{resolution}.json"
    subprocess.run([programs / "svdag", "build", path, "-r", resolution, "-o", dag, "-q", "--report", report_file],
                   check=True)
    report = json.loads(report_file.read_text())
    info = json.loads(subprocess.run([programs / "svdag", "info", "--json", dag], check=True,
                                     capture_output=True).stdout)
    dag.unlink()
    seconds = report["seconds"]
    row = {"scene": name, "resolution": resolution, "triangles": report["triangles"], "voxels": report["voxels"],
           "svo_nodes": info["svo_nodes"], "svo_mb": info["svo_nodes"] / 1e6,
           "dag_nodes_bricks": info["dag_nodes"], "dag_nodes_paper": info["paper_dag_nodes"],
           "bytes": report["file_bytes"], "bits_per_voxel": report["bits_per_voxel"],
           **{f"s_{phase}": seconds[phase] for phase in PHASES}, "s_total": seconds["total"],
           "s_cpu": seconds["cpu"], "sort_share": seconds["sort"] / max(seconds["total"], 1e-9),
           "threads": report["threads"], "peak_mib": report["memory"]["peak_resident"] / 2**20}
    table = info["level_table"] + [{**info["blocks"], "bytes": 0}]
    levels = [{"scene": name, "resolution": resolution, "level": k, "svo_nodes": level["svo_nodes"],
               "dag_nodes": level["dag_nodes"], "bytes": level["bytes"]} for k, level in enumerate(table)]
    return row, levels


def write_csv(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def table(head, rows):
    lines = [head, ["---"] + ["--:"] * (len(head) - 1)] + rows
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def bake_tables(rows):
    sizes = table(
        ["scene", "grid", "triangles", "voxels", "SVO nodes", "SVO MB", "DAG nodes, 4³ leaves", "DAG nodes, 2³ leaves",
         "MB", "bits/voxel"],
        [[r["scene"], r["resolution"], f"{r['triangles']:,}", f"{r['voxels']:,}", f"{r['svo_nodes']:,}",
          f"{r['svo_mb']:.1f}", f"{r['dag_nodes_bricks']:,}", f"{r['dag_nodes_paper']:,}", f"{r['bytes'] / 1e6:.2f}",
          f"{r['bits_per_voxel']:.3f}"] for r in rows])
    times = table(
        ["scene", "grid", *PHASES, "total", "CPU", "sorting share", "peak MiB"],
        [[r["scene"], r["resolution"], *[f"{r['s_' + p]:.2f}" for p in PHASES], f"{r['s_total']:.2f}",
          f"{r['s_cpu']:.2f}", f"{r['sort_share']:.0%}", f"{r['peak_mib']:.0f}"] for r in rows])
    return sizes, times


def level_table(levels):
    """Nodes per level at the highest resolution of each scene."""
    parts = []
    for name in dict.fromkeys(r["scene"] for r in levels):
        last = [r for r in levels if r["scene"] == name][-1]["resolution"]
        rows = [r for r in levels if (r["scene"], r["resolution"]) == (name, last)]
        marks = {len(rows) - 2: " (4³ bricks)", len(rows) - 1: " (2³ blocks, inside the bricks)"}
        parts.append(f"{name}, {last}³:\n\n" + table(
            ["level", "SVO nodes", "DAG nodes", "bytes"],
            [[f"{r['level']}{marks.get(r['level'], '')}", f"{r['svo_nodes']:,}", f"{r['dag_nodes']:,}",
              f"{r['bytes']:,}"] for r in rows]))
    return "\n\n".join(parts)


def figures(rows):
    """The rows of the highest resolution, for the README."""
    last = {r["scene"]: r for r in rows}.values()
    return table(
        ["scene", "grid", "triangles", "voxels", "as SVO", "DAG nodes", "file", "bits per voxel", "seconds", "peak memory"],
        [[r["scene"], f"{r['resolution']}³", f"{r['triangles']:,}", f"{r['voxels']:,}", f"{r['svo_mb']:.0f} MB",
          f"{r['dag_nodes_bricks']:,}", f"{r['bytes'] / 1e6:.1f} MB", f"{r['bits_per_voxel']:.3f}", f"{r['s_total']:.1f}",
          f"{r['peak_mib']:.0f} MiB"] for r in last])


def machine():
    """Processor and compiler, for people who compare times."""
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True).stdout.splitlines()[0]
    return (f"{model.group(1) if model else 'unknown processor'}, {os.cpu_count()} cores, all used. "
            f"Compiler: {compiler}, release build, baseline x86-64 (SSE2, two doubles wide).")


def fill(text, marker, content):
    pattern = re.compile(rf"(<!-- {marker} -->\n).*?(<!-- end {marker} -->)", re.S)
    if not pattern.search(text):
        sys.exit(f"the markers of \"{marker}\" are missing in a page")
    return pattern.sub(lambda m: m.group(1) + content + "\n" + m.group(2), text)


def plot(rows, name, value, label):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "svdag"
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6, 4))
    for scene in dict.fromkeys(r["scene"] for r in rows):
        own = [r for r in rows if r["scene"] == scene]
        axes.plot([r["resolution"] for r in own], [value(r) for r in own], marker="o", label=scene)
    axes.set_yscale("log")
    axes.set_xlabel("resolution")
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.legend()
    figure.tight_layout()
    folder = ROOT / "docs" / "images"
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    pyplot.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--up-to", default=RESOLUTIONS[-1], choices=RESOLUTIONS)
    parser.add_argument("--csv-only", action="store_true", help="leave docs/ alone")
    parser.add_argument("scenes", nargs="*", help="only these")
    options = parser.parse_args()
    programs = options.programs.resolve()
    OUT.mkdir(parents=True, exist_ok=True)
    rows, levels = [], []
    for name, path in scenes(programs, options.scenes).items():
        for resolution in RESOLUTIONS[:RESOLUTIONS.index(options.up_to) + 1]:
            row, own = bake(programs, name, path, resolution)
            print(f"{name:>8} {resolution:>4} {row['dag_nodes_bricks']:>12,} nodes {row['s_total']:8.2f} s "
                  f"{row['peak_mib']:7.0f} MiB", flush=True)
            rows.append(row)
            levels += own
    write_csv(OUT / "bakes.csv", rows)
    write_csv(OUT / "levels.csv", levels)
    if options.csv_only:
        return
    sizes, times = bake_tables(rows)
    text = PAGE.read_text()
    for marker, content in [("machine", machine()), ("sizes", sizes), ("times", times), ("levels", level_table(levels))]:
        text = fill(text, marker, content)
    PAGE.write_text(text)
    README.write_text(fill(README.read_text(), "figures", figures(rows)))
    plot(rows, "seconds", lambda r: r["s_total"], "seconds")
    plot(rows, "nodes", lambda r: r["dag_nodes_bricks"], "DAG nodes (4³ leaves)")


if __name__ == "__main__":
    main()
