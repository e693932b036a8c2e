// Those of the functions that given_surface.h tells of that are a plane curve, and those that are lines or lumps.
//
// Each takes x, y and z, then its parameters. Owns nothing.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_GIVEN_CURVE_H
#define MATH_GIVEN_CURVE_H

#include "math/noise.h"

// given_curve.c: along z, or turned about the y axis
double given_algebraic1(const Noise *noise, const double *a);
double given_algebraic2(const Noise *noise, const double *a);
double given_algebraic3(const Noise *noise, const double *a);
double given_algebraic4(const Noise *noise, const double *a);
double given_devils_curve(const Noise *noise, const double *a);
double given_folium(const Noise *noise, const double *a);
double given_kampyle(const Noise *noise, const double *a);
double given_lemniscate(const Noise *noise, const double *a);
double given_piriform(const Noise *noise, const double *a);
double given_strophoid(const Noise *noise, const double *a);
double given_witch_of_agnesi(const Noise *noise, const double *a);

// given_line.c
double given_blob(const Noise *noise, const double *a);
double given_blob2(const Noise *noise, const double *a);
double given_cross_ellipsoids(const Noise *noise, const double *a);
double given_isect_ellipsoids(const Noise *noise, const double *a);
double given_flange_cover(const Noise *noise, const double *a);
double given_spikes(const Noise *noise, const double *a);
double given_quantum(const Noise *noise, const double *a);
double given_poly4(const Noise *noise, const double *a);
double given_mesh(const Noise *noise, const double *a);
double given_helix1(const Noise *noise, const double *a);
double given_helix2(const Noise *noise, const double *a);
double given_polytubes(const Noise *noise, const double *a);
double given_spiral(const Noise *noise, const double *a);

#endif
