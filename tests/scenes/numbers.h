// Arithmetic that gives the same bits on every machine: +, -, *, /, floor and sqrt only.
//
// The sine of a maths library may differ in its last bit between two machines, and one bit may
// move a voxel. Angles are in turns (1 = 360 degrees), so that quarters are exact.
#pragma once

#include <cstdint>

#include "io/triangle.h"

namespace svdag::scenes {

double sin_turns(double turns);
double cos_turns(double turns);

// A well mixed 64-bit hash of (seed, i) (the finaliser of splitmix64).
uint64_t hash(uint64_t seed, uint64_t i);
// Uniform in [0, 1).
double uniform(uint64_t seed, uint64_t i);

double length(const Point& p);
Point normalised(const Point& p);

// Value noise in [-1, 1]: hashed values on the integer lattice, blended by 6t^5 - 15t^4 + 10t^3.
double noise(uint64_t seed, const Point& p);
// Sum of `octaves` noises, each of twice the frequency and half the amplitude; within (-2, 2).
double fractal(uint64_t seed, Point p, int octaves);

// The nearest multiple of 2^-16.
double quantised(double x);
Point quantised(const Point& p);

}  // namespace svdag::scenes
