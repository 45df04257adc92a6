"""The constants of what plans predict (builder/farm/planner/predict.cpp), from measured bakes and steps.

Seconds are linear in what is counted, with the same constants for bakes, shards and merges, none negative. The fit is by
least squares of the logarithms of measured / predicted, so a short step counts as much as a long one and twice too much
as much as half of it.
"""
import statistics

import numpy

SECONDS = ["kStart", "kSceneTriangle", "kPlanTriangle", "kDivided", "kComputed", "kFound", "kMergeRead"]
FEW = 1000  # triangles


def samples(rows):
    """[(counts in the order of SECONDS, seconds)] of all bakes, plans and merges."""
    found = []
    for row in rows:
        report = row["report"]
        work = [sum(report["cubes_divided"]), report["plane_memo"]["computed"]]
        found.append(([1, report["triangles"], 0, *work, sum(report["nodes"]), 0], report["seconds"]["cpu"]))
        # The shards of a plan together do the work of the bake; but not where a few triangles are everywhere, whose
        # planes each shard looks at anew.
        shards = [step for step in row["steps"] if not step["inputs"]]
        if report["triangles"] >= FEW:
            found.append(([len(shards), 0, sum(s["triangles"] for s in shards), *work, sum(s["keys"] for s in shards), 0],
                          sum(s["measured"]["cpu_seconds"] for s in shards)))
        keys = {step["name"]: step["keys"] for step in row["steps"]}
        for merge in (step for step in row["steps"] if step["inputs"]):
            found.append(([1, 0, 0, 0, 0, 0, sum(keys[i] for i in merge["inputs"])], merge["measured"]["cpu_seconds"]))
    return found


def least_squares_of_logarithms(counts, seconds):
    """The constants c > 0 for which log(counts @ c) is nearest to log(seconds): Levenberg and Marquardt, on log(c)."""
    scale = counts.max(axis=0)
    counts = counts / scale
    theta, damping = numpy.full(counts.shape[1], -1.0), 1.0

    def residuals(at):
        return numpy.log(counts @ numpy.exp(at)) - numpy.log(seconds)
    now = residuals(theta)
    for _ in range(2000):
        constants = numpy.exp(theta)
        slope = counts * constants / (counts @ constants)[:, None]
        normal = slope.T @ slope
        step = numpy.linalg.solve(normal + damping * numpy.eye(len(theta)), -slope.T @ now)
        after = residuals(theta + step)
        if after @ after < now @ now:
            theta, now, damping = theta + step, after, max(damping / 3, 1e-9)
        else:
            damping *= 2
        if damping > 1e12:
            break
    return numpy.exp(theta) / scale, now


def print_constants(rows):
    counts, seconds = (numpy.array(column, float) for column in zip(*samples(rows)))
    constants, residuals = least_squares_of_logarithms(counts, seconds)
    for name, value in zip(SECONDS, constants):
        print(f"constexpr double {name} = {value:.3g};" if name == "kStart" else
              f"constexpr double {name} = {round(1e9 * value, 2):.4g}e-9;")
    per_node = [(r["report"]["file_bytes"] - 8 * r["report"]["nodes"][-1]) / sum(r["report"]["nodes"][:-1]) for r in rows]
    print(f"constexpr double kNodeInFile = {statistics.geometric_mean(per_node):.3g};")
    per_triangle = [r["report"]["seconds"]["cpu"] / r["report"]["triangles"] for r in rows if r["report"]["triangles"] >= FEW]
    print(f"constexpr double kUnsurveyed = {statistics.geometric_mean(per_triangle):.3g};")
    factors = sorted(numpy.exp(numpy.abs(residuals)))
    print(f"// {len(seconds)} bakes, plans and merges: off by a factor of {statistics.median(factors):.2f} "
          f"(median), {factors[-1]:.2f} (worst)")
