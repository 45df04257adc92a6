// Traces a picture: one ray per pixel, by shaders/svdag.glsl.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;

#define SVDAG_SET 0
#define SVDAG_BINDING 0
#include "svdag/shaders/svdag.glsl"

struct Pixel {
  ivec3 voxel;
  uint face;    // 0 without a hit; else 1 + the axis
  uint layer;   // SVDAG_NONE without one
  uint colour;  // the same; else r | g << 8 | b << 16, sRGB
  uint shown;   // r | g << 8 | b << 16 | 255 << 24
  float t;
};

layout(set = 0, binding = 1, std430) buffer Picture {
  ivec4 eye;           // its voxel; the first word of the tables
  vec4 inside;         // the rest
  ivec4 size;          // of the picture; whether there are layers, colours
  ivec4 limbs[3][3];   // of first, right and down, in units of 2^-18, 2^-36, 2^-54: a pixel's direction is
                       // first + x * right + y * down
  Pixel pixels[];
};

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size.xy))) return;
  ivec3 direction[3];
  for (int i = 2; i >= 0; --i) {
    direction[i] = limbs[0][i].xyz + at.x * limbs[1][i].xyz + at.y * limbs[2][i].xyz;
    if (i < 2) direction[i] += direction[i + 1] >> 18;
  }
  SvdagDag dag = SvdagDag(0u, 0u, uint(eye.w));
  Pixel pixel = Pixel(ivec3(0), 0u, SVDAG_NONE, SVDAG_NONE, 0xffd8c8b8u, 0.);
  SvdagHit hit;
  if (svdag_trace(dag, SvdagRay(eye.xyz, inside.xyz, direction[0], direction[1] & 0x3ffff), 1e30, hit)) {
    pixel.voxel = hit.voxel;
    pixel.face = 1u + uint(hit.axis);
    pixel.t = hit.t;
    if (size.z > 0) pixel.layer = svdag_layer(dag, hit.voxel);
    if (size.w > 0) pixel.colour = svdag_colour(dag, hit.voxel);
    vec3 base = pixel.colour == SVDAG_NONE ? vec3(.75) : vec3(uvec3(pixel.colour) >> uvec3(0, 8, 16) & 255u) / 255.;
    bool towards = direction[0][hit.axis] < 0;  // the light is at the upper front left
    uvec3 shown = uvec3(255. * base * (hit.axis == 1 ? towards ? 1. : .4 : hit.axis == 0 ? .8 : .6));
    pixel.shown = shown.r | shown.g << 8 | shown.b << 16 | 0xff000000u;
  }
  pixels[at.y * size.x + at.x] = pixel;
}
