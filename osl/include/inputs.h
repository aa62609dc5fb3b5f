// SPDX-License-Identifier: GPL-3.0-or-later
// What comes into a shader, brought to its legal range. The only place where values are clamped.
#ifndef MICROBOUNCE_INPUTS_H
#define MICROBOUNCE_INPUTS_H

// `value` limited to [low, high]; what is not a finite number becomes `fallback`.
float legal(float value, float low, float high, float fallback)
{
  return isfinite(value) ? clamp(value, low, high) : fallback;
}

color legal(color value, float low, float high, color fallback)
{
  return color(legal(value[0], low, high, fallback[0]), legal(value[1], low, high, fallback[1]),
               legal(value[2], low, high, fallback[2]));
}

// The unit vector along `value`, or `fallback` where it has no direction.
vector direction(vector value, vector fallback)
{
  float squared = dot(value, value);
  return (isfinite(squared) && squared > 0) ? value / sqrt(squared) : fallback;
}

// The tangent Cycles takes where none is given, of any length: about the object's z axis, from the
// generated coordinates; on curves and points, and without those, along the surface's parameter u.
vector default_tangent(vector n)
{
  point generated;
  float is_curve = 0, is_point = 0;
  getattribute("geom:is_curve", is_curve);
  getattribute("geom:is_point", is_point);
  if (is_curve == 0 && is_point == 0 && getattribute("geom:generated", generated)) {
    vector around = vector(0.5 - generated[1], generated[0] - 0.5, 0);
    return cross(n, cross(transform("object", "world", around), n));
  }
  return dPdu;
}

#endif
