"""The tables of `make bench`, from the rows of its CSV files."""
from bakes import label


def table(head, rows):
    lines = ["| " + " | ".join(line) + " |" for line in [head, *rows]]
    return "\n".join([lines[0], "|" + "|".join(["---"] + ["--:"] * (len(head) - 1)) + "|", *lines[1:]])


def shown(rows):
    """Every other resolution from 4K on, and the highest of each scene; the CSV files have all."""
    last = {r["scene"]: r["log2"] for r in rows}
    return [r for r in rows if (r["log2"] % 2 == 0 and r["log2"] >= 12) or r["log2"] == last[r["scene"]]]


def bakes(rows):
    """Bits per voxel and peak memory of each bake; an SVO node is counted as one byte, its child mask."""
    return table(
        ["scene", "grid", "voxels", "SVO nodes", "DAG nodes", "MB", "bits/voxel", "seconds", "CPU", "peak MiB"],
        [[r["scene"], r["resolution"], f"{r['voxels']:,}", f"{r['svo_nodes']:,}", f"{r['nodes']:,}", f"{r['bytes'] / 1e6:.2f}",
          f"{r['bits_per_voxel']:.3f}", f"{r['s_total']:.2f}", f"{r['s_cpu']:.2f}", f"{r['peak_mib']:.0f}"] for r in shown(rows)])


def share(part, whole):
    return f"{part / max(whole, 1e-9):.0%}"


def papers_layout(rows):
    """Seconds after voxelizing (share of sorting): a row per scene, a column per resolution up to 8K."""
    shown = [r for r in rows if r["log2"] <= 13]
    grids = sorted({r["log2"] for r in shown})
    cells = {}
    for r in shown:
        reduction = r["s_sort"] + r["s_merge"] + r["s_write"]
        cells[r["scene"], r["log2"]] = f"{reduction:.3f} ({share(r['s_sort'], reduction)})"
    return table(["scene", *[f"{label(grid)}³" for grid in grids]],
                 [[scene, *[cells.get((scene, grid), "") for grid in grids]]
                  for scene in dict.fromkeys(r["scene"] for r in shown)])


def growth(rows, low, high):
    """Geometric mean of the growth of CPU time per doubling of the resolution between two rows."""
    steps = high["log2"] - low["log2"]
    return (high["s_cpu"] / low["s_cpu"]) ** (1 / steps) if steps else 1.0


def memo(rows):
    lines = []
    for before, r in zip([None, *rows], rows):
        follows = before is not None and before["scene"] == r["scene"]
        counts = [f"{r['memo_' + key]:,}" for key in ("asked", "answered", "computed")]
        lines.append([r["scene"], r["resolution"], *counts,
                      f"{1 - r['divided_16'] / max(r['svo_nodes_16'], 1):.1%}",
                      f"{1e9 * r['s_cpu'] / r['nodes']:,.0f}", f"{growth(rows, before, r):.2f}" if follows else "",
                      f"{r['nodes'] / before['nodes']:.2f}" if follows else ""])
    return table(["scene", "grid", "cubes looked up", "answered", "nodes computed", "16³ cubes not divided",
                  "CPU ns per unique node", "CPU growth", "growth of the DAG"], lines)


def growths(rows, low=14, high=16):
    """A list item per scene that was baked at both resolutions."""
    found = {(r["scene"], r["log2"]): r for r in rows}
    return "\n".join(
        f"* {scene}: CPU grows {growth(rows, found[scene, low], found[scene, high]):.2f} times per doubling from "
        f"{label(low)} to {label(high)} (geometric mean)."
        for scene in dict.fromkeys(r["scene"] for r in rows) if (scene, low) in found and (scene, high) in found)


def without_memo(pairs):
    return table(["scene", "grid", "CPU s", "CPU s without the memo", "times"],
                 [[with_["scene"], with_["resolution"], f"{with_['s_cpu']:.2f}", f"{without['s_cpu']:.2f}",
                   f"{without['s_cpu'] / max(with_['s_cpu'], 1e-9):.1f}"] for with_, without in pairs])


def threads(groups):
    """*At most* is the speed-up if all threads were busy throughout, with the CPU time that they take."""
    return table(["scene", "grid", "threads", "seconds", "CPU", "speed-up", "at most"],
                 [[r["scene"], r["resolution"], str(r["threads"]), f"{r['s_total']:.2f}", f"{r['s_cpu']:.2f}",
                   f"{group[0]['s_total'] / r['s_total']:.2f}", f"{group[0]['s_total'] * r['threads'] / r['s_cpu']:.2f}"]
                  for group in groups for r in group])


def readme(rows):
    """The table of README.md: the highest resolution of each scene."""
    last = {r["scene"]: r for r in rows}.values()
    return table(
        ["scene", "grid", "triangles", "voxels", "as SVO", "DAG nodes", "file", "bits per voxel", "seconds", "peak memory"],
        [[r["scene"], f"{r['resolution']}³", f"{r['triangles']:,}", f"{r['voxels']:,}", f"{r['svo_nodes'] / 1e6:.0f} MB",
          f"{r['nodes']:,}", f"{r['bytes'] / 1e6:.1f} MB", f"{r['bits_per_voxel']:.3f}", f"{r['s_total']:.1f}",
          f"{r['peak_mib']:.0f} MiB"] for r in last])
