"""The figures of merit of `make bench`: targets and measurements.

A figure is a function of the bakes and their options, so that it can be measured again with another instruction set.
"""
import subprocess

from bench_tables import growth, table

AVX512 = ("--vectors", "AVX3")  # Highway's name


def of_row(scene, log2, value, *more):
    def measure(bakes, options):
        row = bakes.bake(scene, log2, *options, *more)
        return None if row is None else value(row)
    return measure


def wall(scene, log2):
    return of_row(scene, log2, lambda row: row["s_total"])


def cpu(scene, log2):
    return of_row(scene, log2, lambda row: row["s_cpu"])


def cpu_per_node(scene, log2):
    return of_row(scene, log2, lambda row: 1e9 * row["s_cpu"] / row["nodes"])


def computed_per_node(scene, log2):
    """Measured with one worker, because each worker has its own memo."""
    return of_row(scene, log2, lambda row: row["memo_computed"] / row["nodes"], "-j", "1")


def cpu_growth(scene, low, high):
    """Growth of CPU per doubling over that of the DAG."""
    def measure(bakes, options):
        rows = [bakes.bake(scene, log2, *options) for log2 in (low, high)]
        if None in rows:
            return None
        return growth(rows, *rows) / (rows[1]["nodes"] / rows[0]["nodes"]) ** (1 / (high - low))
    return measure


def two_threads(scene, log2):
    """Wall time with two threads over that with one."""
    def measure(bakes, options):
        rows = [bakes.bake(scene, log2, *options, "-j", n) for n in ("1", "2")]
        return None if None in rows else rows[1]["s_total"] / rows[0]["s_total"]
    return measure


# (work, unit, at most, aim, measure)
FIGURES = [
    ("sponza 64K³, wall", "s", 20, 8, wall("sponza", 16)),
    ("sponza 16K³ → 64K³, CPU growth per doubling over the DAG's", "", 0.99, 0.95, cpu_growth("sponza", 14, 16)),
    ("sponza 16K³, wall with two threads over that with one", "", 0.53, 0.51, two_threads("sponza", 14)),
    ("tilted sheet 64K³, nodes computed on planes per unique node", "", 1.3, 1.1, computed_per_node("sheet", 16)),
    ("tilted sheet 64K³, wall", "s", 1.5, 0.4, wall("sheet", 16)),
    ("city of 10,000 boxes 64K³, wall", "s", 5, 2, wall("city", 16)),
    ("the same city turned by 0.5 rad, wall", "s", 10, 5, wall("city, 0.5 rad", 16)),
    ("dragon 8K³, wall", "s", 2.5, 1.2, wall("dragon", 13)),
    ("scan of 70K triangles 8K³, CPU", "s", 2.4, 1.8, cpu("scan 70K", 13)),
    ("hairball of 2.88M triangles 4K³, CPU", "s", 7.5, 6, cpu("hairball", 12)),
    ("scan of 9M triangles 16K³, CPU", "s", 24, 18, cpu("scan 9M", 14)),
    ("scan of 9M triangles 16K³, peak memory", "MiB", 1290, 920, of_row("scan 9M", 14, lambda row: row["peak_mib"])),
    ("sponza 64K³, CPU per unique node", "ns", 1500, 500, cpu_per_node("sponza", 16)),
]
GIANTS = [("city", 20), ("city, 0.5 rad", 20), ("sheet", 20), ("sponza", 18)]
SAMPLE = 2000  # bricks that svdag-verify compares


def has_avx512():
    with open("/proc/cpuinfo") as file:
        return " avx512f " in file.read().replace("\n", " ")


OPTIONS = [(), AVX512] if has_avx512() else [()]


def shown(value, unit):
    return (f"{value:,.0f} {unit}" if value >= 100 else f"{value:.2f} {unit}").strip()


def figures(bakes, name):
    """A row per figure; `name` is that of the processor's best instruction set."""
    rows = []
    for work, unit, max_value, aim, measure in FIGURES:
        values = [measure(bakes, options) for options in OPTIONS]
        if None in values:
            continue
        targets = [f"{target:,} {unit}".strip() for target in (max_value, aim)]
        rows.append([work, *targets, *[shown(value, unit) + (" **missed**" if value > max_value else "") for value in values]])
    return table(["work", "at most", "aim", *[name, "AVX-512"][:len(OPTIONS)]], rows)


def giant(bakes, scene, log2):
    """(a row of the table, whether it failed)"""
    try:
        row = bakes.bake(scene, log2)
    except subprocess.CalledProcessError as error:
        return [scene, "", f"svdag failed with exit code {error.returncode}", "", "", "", "", ""], True
    check = subprocess.run([bakes.programs / "svdag-verify", "mesh", bakes.dag_file(), bakes.scene(scene),
                            "--sample", str(SAMPLE)], stdout=subprocess.DEVNULL).returncode
    line = [scene, f"{row['resolution']}³", f"{row['s_total']:.1f}", f"{row['s_cpu']:.1f}", f"{row['nodes']:,}",
            f"{row['bytes'] / 1e6:,.0f}", f"{row['peak_mib']:,.0f}", "yes" if check == 0 else f"no: exit code {check}"]
    return line, check != 0


def giants(bakes):
    """(the table, whether a giant failed)"""
    rows = [giant(bakes, scene, log2) for scene, log2 in GIANTS if bakes.scene(scene) is not None]
    head = ["scene", "grid", "seconds", "CPU", "DAG nodes", "MB", "peak MiB", f"{SAMPLE:,} bricks verified"]
    return table(head, [line for line, _ in rows]), any(failed for _, failed in rows)
