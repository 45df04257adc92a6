"""Writers of point files in the layouts that their standards describe: LAS 1.0 to 1.4, PLY, PCD, text."""
import struct

# Of each LAS point format: bytes of a record, offset of its colour.
LAS_FORMATS = [(20, 0), (28, 0), (26, 20), (34, 28), (57, 0), (63, 28), (30, 0), (36, 30), (38, 30), (59, 0), (67, 30)]


def las(points, scale, offset, minor=2, form=0, colours=None, classes=None, extra=0, withheld=()):
    """points: rows of three int32. colours: rows of three uint16."""
    header_bytes = {3: 235, 4: 375}.get(minor, 227)
    record, colour_at = LAS_FORMATS[form]
    header = bytearray(header_bytes)
    header[0:4] = b"LASF"
    header[24], header[25] = 1, minor
    begin = header_bytes + 54  # a variable length record that readers skip
    struct.pack_into("<HI", header, 94, header_bytes, begin)
    struct.pack_into("<I", header, 100, 1)
    struct.pack_into("<BH", header, 104, form, record + extra)
    struct.pack_into("<I", header, 107, 0 if minor == 4 else len(points))
    struct.pack_into("<6d", header, 131, *scale, *offset)
    struct.pack_into("<6d", header, 179, *[0.0] * 6)  # the box: wrong
    if minor == 4:
        struct.pack_into("<Q", header, 247, len(points))
    rows = bytearray()
    for i, point in enumerate(points):
        row = bytearray(record + extra)
        struct.pack_into("<3i", row, 0, *point)
        number = 0 if classes is None else classes[i]
        if form >= 6:
            row[15], row[16] = 4 if i in withheld else 3, number
        else:
            row[15] = number | (128 if i in withheld else 32)
        if colour_at and colours is not None:
            struct.pack_into("<3H", row, colour_at, *colours[i])
        rows += row
    return bytes(header) + bytes(54) + bytes(rows)


def xyz(points, colours=None, separator=" "):
    lines = ["# x y z"]
    for i, point in enumerate(points):
        numbers = [repr(float(v)) for v in point] + ([] if colours is None else [str(c) for c in colours[i]])
        lines.append(separator.join(numbers))
    return ("\n".join(lines) + "\n").encode()


def ply(points, kind="ascii", real="double", colours=None):
    types = [real] * 3 + (["uchar"] * 3 if colours is not None else [])
    names = ["x", "y", "z", "red", "green", "blue"]
    head = [f"ply\nformat {kind} 1.0\nelement camera 2\nproperty list uchar int views\nelement vertex {len(points)}",
            *[f"property {t} {n}" for t, n in zip(types, names)], "property float quality", "end_header\n"]
    rows = [[*map(float, p), *(colours[i] if colours is not None else [])] for i, p in enumerate(points)]
    if kind == "ascii":
        body = "1 7\n0\n" + "".join(" ".join(repr(v) for v in row) + " 0.5\n" for row in rows)
        return ("\n".join(head) + body).encode()
    order = "<" if "little" in kind else ">"
    code = order + {"double": "3d", "float": "3f"}[real] + ("3B" if colours is not None else "") + "f"
    body = struct.pack(order + "BiB", 1, 7, 0) + b"".join(struct.pack(code, *row, 0.5) for row in rows)
    return "\n".join(head).encode() + body


def pcd(points, kind="ascii", size=8, colours=None):
    fields, sizes, types, counts = ["x", "y", "z"], [size] * 3, ["F"] * 3, [1] * 3
    if colours is not None:
        fields, sizes, types, counts = ["normal", *fields, "rgb"], [4, *sizes, 4], ["F", *types, "U"], [2, *counts, 1]
    head = "\n".join(["# .PCD v0.7 - Point Cloud Data file format", "VERSION 0.7", "FIELDS " + " ".join(fields),
                      "SIZE " + " ".join(map(str, sizes)), "TYPE " + " ".join(types), "COUNT " + " ".join(map(str, counts)),
                      f"WIDTH {len(points)}", "HEIGHT 1", "VIEWPOINT 0 0 0 1 0 0 0", f"POINTS {len(points)}", f"DATA {kind}\n"])
    rows = []
    for i, p in enumerate(points):
        row = [float(v) for v in p]
        if colours is not None:
            r, g, b = colours[i]
            row = [0.0, 1.0, *row, r << 16 | g << 8 | b]
        rows.append(row)
    if kind == "ascii":
        return (head + "".join(" ".join(repr(v) for v in row) + "\n" for row in rows)).encode()
    real = {8: "3d", 4: "3f"}[size]
    code = "<" + ("2f" + real + "I" if colours is not None else real)
    return head.encode() + b"".join(struct.pack(code, *row) for row in rows)
