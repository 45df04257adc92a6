// Point, box, layer and colour queries at random voxels, one per pixel, with the buffers of examples/vulkan/trace.comp. A
// box of 1 to 64 voxels on each axis begins at the voxel.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;

#ifndef ROOT
#define ROOT 0u
#endif
#define SVDAG_SET 0
#define SVDAG_BINDING 0
#include "svdag/shaders/svdag.glsl"

struct Query {
  ivec3 voxel;
  uint found;  // bit 0: the voxel is set, bit 1: the box has a voxel
  uint layer, colour;
  uint sides;  // of the box, less 1: 6 bits each
  uint side;   // of the empty cube around the voxel
};
layout(set = 0, binding = 1) buffer Picture {
  ivec4 eye;
  vec4 inside;
  ivec4 size, limbs[3][3];
  Query pixels[];
};

uint random(uint v) {  // pcg
  v = v * 747796405u + 2891336453u;
  v = ((v >> (v >> 28) + 4u) ^ v) * 277803737u;
  return v >> 22 ^ v;
}

void main() {
  uint i = gl_GlobalInvocationID.y * uint(size.x) + gl_GlobalInvocationID.x;
  SvdagDag dag = SvdagDag(0u, ROOT, uint(eye.w));
  int levels = svdag_levels(dag);
  ivec3 voxel = ivec3(uvec3(random(3u * i), random(3u * i + 1u), random(3u * i + 2u)) >> uint(32 - levels));
  uint sides = random(~i) & random(i) & 0x3ffffu;  // small ones more often
  ivec3 box_max = voxel + ivec3(uvec3(sides) >> uvec3(0, 6, 12) & 63u) + 1;
  uint found = uint(svdag_point(dag, voxel)) | uint(svdag_box(dag, voxel, box_max)) << 1;
  uint layer = SVDAG_NONE, colour = SVDAG_NONE;
#ifdef ATTRIBUTES
  layer = svdag_layer(dag, voxel);
  colour = svdag_colour(dag, voxel);
#endif
  pixels[i] = Query(voxel, found, layer, colour, sides, uint(svdag_empty_side(dag, 0, ROOT, voxel)));
}
