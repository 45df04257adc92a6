#!/usr/bin/env python3
"""Writes one small scene as COLLADA and FBX (text), with y up and with z up, 3MF, 3DS and OBJ: NAME.dae, NAME_z.dae, ...

Written from the formats' specifications, independent of the reader. The scene: a quad and a triangle, shown as they are
("floor") and, moved by (0, 0, 10) and mirrored in x, a second time ("copy"). 3MF has triangles only, and 3DS neither
polygons nor instances, so they hold the triangles of the world; in 3DS, z is up.
"""
import struct
import sys
import zipfile

POINTS = [(0, 0, 0), (8, 0, 0), (8, 4, 0), (0, 4, 0), (4, 2, 5)]
FACES = [(0, 1, 2, 3), (0, 1, 4)]
TRIANGLES = [(0, 1, 2), (0, 2, 3), (0, 1, 4)]


def moved(p):
    return (-p[0], p[1], p[2] + 10)


def z_up(p):
    return (p[0], -p[2], p[1])


def words(values):
    return " ".join(str(v) for row in values for v in row)


def dae(up):
    """With z up, in half metres."""
    turned = z_up if up == "Z" else lambda p: p
    scale = 2 if up == "Z" else 1
    points = [[scale * v for v in turned(p)] for p in POINTS]
    x, y, z = (scale * v for v in turned((0, 0, 10)))
    copy = (-1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1)  # row by row
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><created>2026-01-01T00:00:00Z</created><modified>2026-01-01T00:00:00Z</modified>
  <unit name="unit" meter="{1 / scale}"/><up_axis>{up}_UP</up_axis></asset>
 <library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong/></technique></profile_COMMON></effect></library_effects>
 <library_materials><material id="m" name="stone"><instance_effect url="#e"/></material></library_materials>
 <library_geometries><geometry id="g" name="g"><mesh>
  <source id="p"><float_array id="a" count="{3 * len(POINTS)}">{words(points)}</float_array>
   <technique_common><accessor source="#a" count="{len(POINTS)}" stride="3">
    <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <polylist count="{len(FACES)}" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
   <vcount>{" ".join(str(len(f)) for f in FACES)}</vcount><p>{words(FACES)}</p></polylist>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s">
  <node id="floor" name="floor"><instance_geometry url="#g"><bind_material><technique_common>
   <instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node>
  <node id="copy" name="copy"><matrix>{" ".join(map(str, copy))}</matrix><instance_geometry url="#g"/></node>
 </visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""


def three_mf(path):
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in POINTS + [moved(p) for p in POINTS])
    faces = TRIANGLES + [tuple(i + len(POINTS) for i in t) for t in TRIANGLES]
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    model = ('<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xml:lang="en-US" '
             'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh>'
             f"<vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object></resources>"
             '<build><item objectid="1"/></build></model>')
    types = ('<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
             '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
             '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>')
    relations = ('<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                 '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
                 'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (("[Content_Types].xml", types), ("_rels/.rels", relations), ("3D/3dmodel.model", model)):
            archive.writestr(name, text)


def chunk(kind, *parts):
    data = b"".join(parts)
    return struct.pack("<HI", kind, 6 + len(data)) + data


def three_ds():
    def mesh(name, points):
        vertices = struct.pack("<H", len(points)) + b"".join(struct.pack("<3f", *z_up(p)) for p in points)
        faces = struct.pack("<H", len(TRIANGLES)) + b"".join(struct.pack("<4H", *t, 7) for t in TRIANGLES)
        return chunk(0x4000, name.encode() + b"\0", chunk(0x4100, chunk(0x4110, vertices), chunk(0x4120, faces)))
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)),
                 chunk(0x3D3D, mesh("floor", POINTS), mesh("copy", [moved(p) for p in POINTS])))


def fbx(up):
    turned = z_up if up == 2 else lambda p: p
    points = ",".join(str(v) for p in POINTS for v in turned(p))
    move = ",".join(map(str, turned((0, 0, 10))))
    corners = ",".join(str(i if k < len(f) - 1 else -i - 1) for f in FACES for k, i in enumerate(f))
    return f"""; FBX 7.4.0 project file
FBXHeaderExtension:  {{
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}}
GlobalSettings:  {{
	Version: 1000
	Properties70:  {{
		P: "UpAxis", "int", "Integer", "",{up}
		P: "UnitScaleFactor", "double", "Number", "",1
	}}
}}
Objects:  {{
	Geometry: 10, "Geometry::g", "Mesh" {{
		Vertices: *{3 * len(POINTS)} {{
			a: {points}
		}}
		PolygonVertexIndex: *{sum(map(len, FACES))} {{
			a: {corners}
		}}
		GeometryVersion: 124
		LayerElementMaterial: 0 {{
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {{
				a: 0
			}}
		}}
		Layer: 0 {{
			Version: 100
			LayerElement:  {{
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}}
		}}
	}}
	Model: 20, "Model::floor", "Mesh" {{
		Version: 232
	}}
	Model: 30, "Model::copy", "Mesh" {{
		Version: 232
		Properties70:  {{
			P: "Lcl Translation", "Lcl Translation", "", "A",{move}
			P: "Lcl Scaling", "Lcl Scaling", "", "A",-1,1,1
		}}
	}}
	Material: 40, "Material::stone", "" {{
		Version: 102
		ShadingModel: "phong"
	}}
}}
Connections:  {{
	C: "OO",20,0
	C: "OO",30,0
	C: "OO",10,20
	C: "OO",10,30
	C: "OO",40,20
	C: "OO",40,30
}}
"""


def obj():
    world = POINTS + [moved(p) for p in POINTS]
    faces = FACES + [tuple(len(POINTS) + i for i in f) for f in FACES]
    return "".join("v %r %r %r\n" % p for p in world) + "".join("f " + " ".join(str(i + 1) for i in f) + "\n" for f in faces)


def main(name):
    three_mf(name + ".3mf")
    for ending, data in ((".dae", dae("Y")), ("_z.dae", dae("Z")), (".fbx", fbx(1)), ("_z.fbx", fbx(2)), (".obj", obj())):
        with open(f"{name}{ending}", "w", encoding="utf-8") as file:
            file.write(data)
    with open(name + ".3ds", "wb") as file:
        file.write(three_ds())


if __name__ == "__main__":
    main(*sys.argv[1:])
