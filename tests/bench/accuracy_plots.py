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
    """Relative error of the solid and of the corrected volume, with the slopes h and h²."""
    figure, panel = pyplot.subplots(figsize=(6.4, 4))
    colours = ["#1f77b4", "#2ca02c", "#d62728", "#ff7f0e"]
    for colour, mesh in zip(colours, dict.fromkeys(r["mesh"] for r in rows)):
        own = [r for r in rows if r["mesh"] == mesh]
        x = [64 * 2**i for i in range(len(own))]
        panel.plot(x, [abs(r["solid_error"]) for r in own], "-o", color=colour, markersize=4, label=f"{mesh}")
        panel.plot(x, [abs(r["corrected_error"]) for r in own], "--o", color=colour, markersize=4,
                   markerfacecolor="white")
    x = [64, 4096]
    panel.plot(x, [0.25, 0.25 / 64], color="#999", linewidth=0.8)
    panel.plot(x, [0.002, 0.002 / 64**2], color="#999", linewidth=0.8)
    panel.annotate("∝ voxel", (4096, 0.25 / 64), xytext=(4, -3), textcoords="offset points", color="#777")
    panel.annotate("∝ voxel²", (4096, 0.002 / 64**2), xytext=(4, -3), textcoords="offset points", color="#777")
    panel.set_xscale("log", base=2)
    panel.set_yscale("log")
    panel.set_xticks(x := [64 * 2**i for i in range(7)], [f"{n}" if n < 1024 else f"{n // 1024}K" for n in x])
    panel.set_xlim(56, 7500)
    panel.set_xlabel("resolution")
    panel.set_ylabel("|volume / exact − 1|")
    panel.grid(alpha=0.25)
    legend = panel.legend(frameon=False, fontsize=7.5, loc="lower left")
    panel.add_artist(legend)
    line = matplotlib.lines.Line2D
    panel.legend([line([], [], color="#444", marker="o", markersize=4),
                  line([], [], color="#444", marker="o", markersize=4, linestyle="--", markerfacecolor="white")],
                 ["solid", "half of the surface voxels"], frameon=False, fontsize=7.5, loc="upper right")
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
