"""The plots of `make bench`, docs/images/NAME.svg: equal rows give equal bytes."""
import math

from bakes import label

FITTED_FROM = 12  # log2: below 4K, start-up and reading the scene take as long as the bake


def slope(points):
    """The slope of the least-squares line through (log2 of the resolution, log2 of the value)."""
    xs, ys = [x for x, _ in points], [math.log2(max(y, 1e-9)) for _, y in points]
    mean_x, mean_y = sum(xs) / len(xs), sum(ys) / len(ys)
    spread = sum((x - mean_x) ** 2 for x in xs)
    return sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / spread if spread else math.nan


def plot(rows, path, value, title):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "svdag"
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6, 4))
    for scene in dict.fromkeys(r["scene"] for r in rows):
        points = [(r["log2"], value(r)) for r in rows if r["scene"] == scene]
        fitted = [p for p in points if p[0] >= FITTED_FROM]
        name = f"{scene}: slope {slope(fitted):.2f}" if len(fitted) > 1 else scene
        axes.plot([2 ** x for x, _ in points], [y for _, y in points], marker="o", markersize=4, label=name)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    grids = sorted({r["log2"] for r in rows})
    axes.set_xticks([2 ** grid for grid in grids], [label(grid) for grid in grids])
    axes.set_xlabel("resolution")
    axes.set_ylabel(title)
    axes.grid(alpha=0.3)
    axes.legend(title=f"slopes from {label(FITTED_FROM)} on")
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)
