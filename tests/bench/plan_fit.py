"""Fits the constants of predictions (builder/farm/planner/predict.cpp) to measured bakes and steps.

Seconds are what the pilot measured for voxelizing, and a linear function of counts, with the same constants for bakes,
shards and merges. The fit minimizes the squared logarithms of measured / predicted, so short and long steps have the
same weight, and so have twice and half of a time.
"""
import statistics

import numpy

SECONDS = ["kStart", "kTriangle", "kFound", "kMergeRead"]
FEW_TRIANGLES = 1000


def samples(rows):
    """[(counts in the order of SECONDS, seconds of voxelizing by the pilot, seconds)] of all bakes, plans and merges."""
    found = []
    for row in rows:
        report = row["report"]
        seconds, nodes, voxelize = report["seconds"], sum(report["nodes"]), row["voxelize"]
        found.append(([1, report["triangles"], nodes, 0], voxelize, seconds["cpu"]))
        # The shards of a plan together do the work of the bake, except for scenes of a few large triangles, whose
        # planes every shard computes again.
        shards = [step for step in row["steps"] if not step["inputs"]]
        if report["triangles"] >= FEW_TRIANGLES:
            found.append(([len(shards), sum(s["triangles"] for s in shards), sum(s["keys"] for s in shards), 0], voxelize,
                          sum(s["measured"]["cpu_seconds"] for s in shards)))
        keys = {step["name"]: step["keys"] for step in row["steps"]}
        for merge in (step for step in row["steps"] if step["inputs"]):
            found.append(([1, 0, 0, sum(keys[i] for i in merge["inputs"])], 0, merge["measured"]["cpu_seconds"]))
    return found


def least_squares_of_logarithms(counts, known, seconds):
    """The constants c that minimize |log((known + counts @ c) / seconds)|²: Gauss-Newton from a fit of the relative errors."""
    constants = numpy.linalg.lstsq(counts / seconds[:, None], 1 - known / seconds, rcond=None)[0]
    for _ in range(50):
        predicted = known + counts @ constants
        residuals = numpy.log(predicted / seconds)
        constants -= numpy.linalg.lstsq(counts / predicted[:, None], residuals, rcond=None)[0]
    return constants, residuals


def print_constants(rows):
    counts, known, seconds = (numpy.array(column, float) for column in zip(*samples(rows)))
    constants, residuals = least_squares_of_logarithms(counts, known, seconds)
    for name, value in zip(SECONDS, constants):
        print(f"constexpr double {name} = {value:.3g};" if name == "kStart" else
              f"constexpr double {name} = {round(1e9 * value, 2):.4g}e-9;")
    per_node = [(r["report"]["file_bytes"] - 8 * r["report"]["nodes"][-1]) / sum(r["report"]["nodes"][:-1]) for r in rows]
    print(f"constexpr double kNodeInFile = {statistics.geometric_mean(per_node):.3g};")
    per_triangle = [r["report"]["seconds"]["cpu"] / r["report"]["triangles"] for r in rows
                    if r["report"]["triangles"] >= FEW_TRIANGLES]
    print(f"constexpr double kUnsurveyedTriangle = {statistics.geometric_mean(per_triangle):.3g};")
    factors = sorted(numpy.exp(numpy.abs(residuals)))
    print(f"// {len(seconds)} bakes, plans and merges: off by a factor of {statistics.median(factors):.2f} "
          f"(median), {factors[-1]:.2f} (worst)")
