"""The plots of docs/accuracy.md."""
import pathlib

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams |= {"svg.hashsalt": "svdag", "font.size": 8, "axes.spines.top": False, "axes.spines.right": False}
from matplotlib import pyplot  # noqa: E402

IMAGES = pathlib.Path(__file__).resolve().parent.parent.parent / "docs" / "images"

# One colour per family of methods; open markers for float.
STYLES = {"svdag": ("#d62728", "*", True), "svdag + reduction": ("#d62728", "*", False),
          "int128": ("#8c564b", "D", True), "AM float": ("#1f77b4", "o", False), "AM double": ("#1f77b4", "o", True),
          "SS float": ("#2ca02c", "s", False), "SS double": ("#2ca02c", "s", True),
          "SS double, ε=1e-6": ("#ff7f0e", "^", True), "CGAL EPICK": ("#7f7f7f", "v", True),
          "CGAL EPECK": ("#7f7f7f", "v", False)}


def save(figure, name):
    IMAGES.mkdir(parents=True, exist_ok=True)
    figure.savefig(IMAGES / f"{name}.svg", metadata={"Date": None})
    figure.savefig(pathlib.Path("build/bench") / f"{name}.png", dpi=110)
    pyplot.close(figure)


def error_plot(cases, name, columns):
    """One panel per case: errors per million voxels on the x axis (0 is set apart), time per pair on the y axis."""
    count = len(cases) + (1 if len(cases) % columns else 0)
    rows = -(-count // columns)
    figure, panels = pyplot.subplots(rows, columns, figsize=(9.6, 2.5 * rows + 0.5), sharex=True, squeeze=False)
    panels = list(panels.flat)
    for panel, (title, methods) in zip(panels, cases.items()):
        draw_panel(panel, title, methods)
    for panel in panels[len(cases):]:
        panel.axis("off")
    for i, panel in enumerate(panels[:len(cases)]):
        if i % columns == 0:
            panel.set_ylabel("CPU ns per pair")
        if i >= len(cases) - columns:
            panel.set_xlabel("misses + extras per million surface voxels")
            panel.tick_params(labelbottom=True)
    handles, labels = panels[0].get_legend_handles_labels()
    if len(panels) > len(cases):
        panels[len(cases)].legend(handles, labels, loc="center", frameon=False, fontsize=8.5)
        figure.tight_layout()
    else:
        figure.legend(handles, labels, loc="lower center", ncol=5, frameon=False, fontsize=8.5)
        figure.tight_layout(rect=(0, 0.07, 1, 1))
    save(figure, name)


def draw_panel(panel, title, methods):
    for method, row in methods.items():
        colour, marker, filled = STYLES[method]
        panel.plot(1e6 * (row["misses"] + row["extras"]) / row["voxels"], row["ns_per_pair"], marker, color=colour,
                   markersize=11 if marker == "*" else 6, markerfacecolor=colour if filled else "white",
                   linestyle="none", label=method, clip_on=False, zorder=3, alpha=0.9)
    panel.set_xscale("symlog", linthresh=1, linscale=0.6)
    panel.set_yscale("log")
    panel.set_xlim(-0.25, 2e6)
    panel.set_xticks([0, 1, 1e2, 1e4, 1e6], ["0", "1", "10²", "10⁴", "10⁶"])
    panel.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    low = min(r["ns_per_pair"] for r in methods.values())
    high = max(r["ns_per_pair"] for r in methods.values())
    panel.set_ylim(low / 1.5, high * 1.5)
    ticks = [t for t in (5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000) if low / 1.5 <= t <= high * 1.5]
    panel.set_yticks(ticks, [f"{t:,}" for t in ticks])
    panel.yaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    panel.axvspan(-0.25, 0.5, color="#f1f6ee", zorder=0)
    panel.grid(alpha=0.25)
    panel.set_title(title, fontsize=9, loc="left")


def volume_plot(rows, name):
    """Left: the volume of the surface rules and the errors of the solid ones, of one mesh; right: those errors of all."""
    figure, (rules, meshes) = pyplot.subplots(1, 2, figsize=(9.6, 4), sharey=True)
    series = {}
    for row in rows:
        series.setdefault(row["mesh"], []).append(row)
    own = next((r for mesh, r in series.items() if "elephant" in mesh), next(iter(series.values())))
    x = [2 ** r["log2"] for r in own]
    for kind, less, colour in (("conservative", 0, "#1f77b4"), ("thin", 0, "#2ca02c"), ("solid", 1, "#d62728"), ("corrected", 1, "#d62728")):
        rules.plot(x, [abs(r[kind] - less) for r in own], "--o" if kind == "corrected" else "-o", color=colour, markersize=4,
                   markerfacecolor="white" if kind == "corrected" else colour,
                   label={"solid": "|solid − 1|", "corrected": "|solid − ½ conservative − 1|"}.get(kind, kind))
    rules.set_title(own[0]["mesh"], fontsize=9, loc="left")
    rules.set_ylabel("volume of the voxels / volume of the solid")
    for colour, (mesh, own) in zip(("#1f77b4", "#2ca02c", "#9467bd", "#ff7f0e", "#d62728", "#8c564b"), series.items()):
        meshes.plot(x, [abs(r["solid"] - 1) for r in own], "-o", color=colour, markersize=4, label=mesh)
        meshes.plot(x, [abs(r["corrected"] - 1) for r in own], "--o", color=colour, markersize=4, markerfacecolor="white")
    meshes.set_title("all meshes: |solid − 1|, dashed |solid − ½ conservative − 1|", fontsize=9, loc="left")
    for panel in (rules, meshes):
        ends = [x[0], x[-1]]
        for start, power, text in ((0.5, 1, "∝ voxel"), (0.002, 2, "∝ voxel²")):
            last = start * (ends[0] / ends[1])**power
            panel.plot(ends, [start, last], color="#999", linewidth=0.8)
            panel.annotate(text, (ends[1], last), xytext=(4, -3), textcoords="offset points", color="#777")
        panel.set_xscale("log", base=2)
        panel.set_yscale("log")
        panel.set_xticks(x[::2], [f"{n}" if n < 1024 else f"{n // 1024}K" for n in x[::2]])
        panel.set_xlim(x[0] / 1.15, x[-1] * 3)
        panel.set_xlabel("resolution")
        panel.grid(alpha=0.25)
        panel.legend(frameon=False, fontsize=7.5, loc="lower left")
    figure.tight_layout()
    save(figure, name)


def rays_plot(rows, name):
    """Rays that hit only the voxels or only the triangles, over resolution."""
    figure, panel = pyplot.subplots(figsize=(6.4, 3.6))
    series = {}
    for row in rows:
        series.setdefault((row["scene"], row["rule"]), []).append(row)
    for (scene, rule), own in series.items():
        panel.plot([2 ** r["log2"] for r in own], [1e6 * r["free_hits"] / r["free_rays"] for r in own],
                   "--o" if rule == "thin" else "-o", markersize=4, label=f"{scene}, {rule}")
    x = [512, 16384]
    panel.plot(x, [4e3, 4e3 * 512 / 16384], color="#999", linewidth=0.8)
    panel.annotate("∝ voxel", (16384, 4e3 * 512 / 16384), xytext=(4, -3), textcoords="offset points", color="#777")
    panel.set_xscale("log", base=2)
    panel.set_yscale("log")
    panel.set_xticks(x := [512 * 2**i for i in range(6)], [f"{n}" if n < 1024 else f"{n // 1024}K" for n in x])
    panel.set_xlim(450, 26000)
    panel.set_xlabel("resolution")
    panel.set_ylabel("hits of one side alone, per million rays")
    panel.grid(alpha=0.25)
    panel.legend(frameon=False, fontsize=7.5)
    figure.tight_layout()
    save(figure, name)
