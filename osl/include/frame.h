// SPDX-License-Identifier: GPL-3.0-or-later
// The local frame of the model: z is the macro-normal, x the tangent that alpha_x belongs to.
#ifndef MICROBOUNCE_FRAME_H
#define MICROBOUNCE_FRAME_H

struct Frame {
  vector x;
  vector y;
  vector z;
  vector ground;  // bending_ground() in these coordinates; grounded() sets it
};

// Smallest cosine between the viewer and the macro-normal. Smooth and bumped normals can turn away
// from the viewer, who would then see no height field. They are bent back just this far.
#define MIN_VIEW_COSINE 1e-4

// The unit normal nearest to `n` that the viewer can see.
vector visible_normal(vector n, vector view)
{
  float cosine = dot(n, view);
  return (cosine >= MIN_VIEW_COSINE) ? n : normalize(n + (MIN_VIEW_COSINE - cosine) * view);
}

// The geometric normal, towards which Cycles bends the normals of closures. Zero on curves, where
// Cycles bends none.
vector bending_ground()
{
  float is_curve = 0;
  getattribute("geom:is_curve", is_curve);
  return (is_curve != 0) ? vector(0) : Ng;
}

// Whether Cycles leaves the normal `n` of a closure alone. It bends one, a refraction's too, if
// the mirrored view would go below the geometric surface (material setting Bump Map Correction).
int is_left_alone(vector n, vector view, vector ground)
{
  float height = dot(view, ground);
  return 2 * dot(n, view) * dot(n, ground) - height >= min(0.9 * height, 0.01);
}

// The normal that Cycles uses instead of `n`: turned towards the geometric one until the mirrored
// view is just above the surface. View and mirrored view are equally far from it.
vector corrected_normal(vector n, vector view, vector ground)
{
  vector along = n - dot(n, ground) * ground;
  if (is_left_alone(n, view, ground) || dot(along, along) <= 0)
    return n;
  along = normalize(along);
  float x = dot(view, along), z = dot(view, ground);
  float lift = min(0.9 * z, 0.01);
  float elevation = 0.5 * (acos(clamp(lift / hypot(x, z), -1, 1)) + atan2(x, z));
  return sin(elevation) * along + cos(elevation) * ground;
}

// An arbitrary unit vector orthogonal to the unit vector `n`.
vector any_tangent(vector n)
{
  return normalize((abs(n[0]) > abs(n[2])) ? vector(-n[1], n[0], 0) : vector(0, -n[2], n[1]));
}

// A shorter cross product of unit vectors is just the rounding of parallel ones.
#define PARALLEL_SQUARED 1e-10

// The frame by Cycles' convention for microfacets: y = N x T, x = y x N, for unit vectors N and T.
// A tangent parallel to the normal gives an arbitrary frame about it.
Frame shading_frame(vector n, vector tangent)
{
  Frame frame;
  vector across = cross(n, tangent);
  frame.z = n;
  frame.y = (dot(across, across) > PARALLEL_SQUARED) ? normalize(across) : any_tangent(n);
  frame.x = cross(frame.y, n);
  return frame;
}

// An arbitrary frame about `n`.
Frame any_frame(vector n)
{
  Frame frame;
  frame.z = n;
  frame.x = any_tangent(n);
  frame.y = cross(n, frame.x);
  return frame;
}

vector to_local(Frame frame, vector w)
{
  return vector(dot(w, frame.x), dot(w, frame.y), dot(w, frame.z));
}

vector to_world(Frame frame, vector w)
{
  return w[0] * frame.x + w[1] * frame.y + w[2] * frame.z;
}

// The same frame, for closures whose normal Cycles may bend. Fitted has few of these, so it does
// not ask.
Frame grounded(Frame frame)
{
  Frame known = frame;
  known.ground = to_local(frame, bending_ground());
  return known;
}

#endif
