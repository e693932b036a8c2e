// A ray against a blob (scene/blob.h), of which side 0 is all. Knows nothing of transforms of the whole.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BLOB_H
#define TRACE_BLOB_H

#include "math/ray.h"
#include "trace/ray_interval.h"

// The intervals in which the field is greater than the threshold, of those that do not end behind the ray's start, in
// order; `is_first`: no more than the first is wanted, which may be open at its end. Returns how many, at most
// blob_interval_most, for which there is room.
unsigned blob_intervals(const double *list, bool is_first, const Ray *ray, SideLeft left, RayInterval *intervals);

// Of unit length, to where the field is less; along x where it is even.
Vec3 blob_normal(const double *list, Vec3 point);

#endif
