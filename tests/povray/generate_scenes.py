#!/usr/bin/env python3
"""Scenes that combine what the language has, so that few of them hold every pair of choices.

Each factor below is a table: name of a choice, its text. In the text `{0.2~0.9}` stands for a number between the two,
`{rgb}` for a colour, `{axis}` for a direction, `{point}` for a place near the origin, `{font}` for one of POV-Ray's and
`{letters}` for two of any. What a newly supported word needs is a row in the table of its kind. A scene has choices of
its own (camera, light, …) and four objects, each with choices of its own (shape, pigment, …); pairs are of two choices of
one object, of two of one scene, or of an object and its scene.

Usage: generate_scenes.py COUNT SEED [NUMBER]   prints a scene, or how many pairs are covered by so many.
SPDX-License-Identifier: MIT
"""
import itertools
import random
import re
import string
import sys

OBJECTS = 4
CANDIDATES = 12  # of which the one with the most new pairs is taken

HEAD = {  # shapes without a closing brace, about 1 in size
    "sphere": "sphere { {point}, {0.7~1}",
    "ellipsoid": "sphere { {point}, 1 scale <{0.5~1.1}, {0.5~1.1}, {0.5~1.1}>",
    "box": "box { <{-0.9~-0.5}, {-0.9~-0.5}, {-0.9~-0.5}>, <{0.5~0.9}, {0.5~0.9}, {0.5~0.9}>",
    "cylinder": "cylinder { <{-0.2~0.2}, {-0.9~-0.6}, 0>, <{-0.2~0.2}, {0.6~0.9}, 0.1>, {0.4~0.7}",
    "open cylinder": "cylinder { <{-0.9~-0.6}, 0, {-0.2~0.2}>, <{0.6~0.9}, 0.1, 0>, {0.4~0.7} open",
    "cone": "cone { {-0.9~-0.6}*y, {0.6~0.9}, {0.6~0.9}*y, {0~0.4}",
    "open cone": "cone { {-0.9~-0.6}*y, {0.6~0.9}, {0.6~0.9}*y, {0.2~0.4} open",
    "disc": "disc { {point}, {axis}, {0.7~1}",
    "disc with a hole": "disc { {point}, {axis}, {0.8~1}, {0.2~0.5}",
    "torus": "torus { {0.5~0.7}, {0.15~0.3} sturm",
    "prism": "prism { linear_spline {-0.8~-0.4}, {0.3~0.7}, 5, <-0.8, -0.6>, <{0.4~0.9}, -0.7>, <0.8, {0.3~0.8}>,"
             " <{-0.6~-0.2}, 0.6>, <-0.8, -0.6>",
    "conic prism": "prism { conic_sweep bezier_spline {0.2~0.4}, 1, 8, <-0.8, 0>, <-0.8, {-1.1~-0.6}>, <0.9, -1>, <0.7, 0.1>,"
                   " <0.7, 0.1>, <{0.5~1}, 1>, <-0.9, {0.6~1}>, <-0.8, 0> translate -0.5*y",
    "lathe": "lathe { bezier_spline 8, <{0.2~0.4}, -0.6>, <{0.6~1}, -0.9>, <0.9, {-0.3~0.1}>, <0.6, 0.2>,"
             " <0.6, 0.2>, <{0.1~0.4}, 0.6>, <0.2, {0.7~0.9}>, <{0.2~0.4}, -0.6> sturm",
    "open lathe": "lathe { cubic_spline 6, <{0.2~0.4}, -0.9>, <0, -0.8>, <{0.6~0.9}, -0.2>, <{0.3~0.5}, 0.4>, <0.5, 0.8>, <0.6, 1>",
    "sphere sweep": "sphere_sweep { linear_spline 4, <-0.8, {-0.5~0.5}, 0>, {0.1~0.3}, <-0.2, {-0.5~0.7}, {-0.4~0.4}>, {0.1~0.3},"
                    " <0.3, {-0.7~0.5}, 0.2>, {0.1~0.3}, <0.8, {-0.3~0.3}, -0.2>, {0.05~0.2} tolerance 1e-5",
    "superellipsoid": "superellipsoid { <{0.2~1.8}, {0.2~1.8}> scale 0.8",
    "polygon": "polygon { 5, <-0.9, {-0.8~-0.4}, 0.13>, <{0.4~0.9}, -0.7, 0.13>, <0.8, {0.3~0.8}, 0.13>, <{-0.3~0.3}, 0, 0.13>,"
               " <-0.7, {0.5~0.8}, 0.13>",
    "text": "text { ttf \"{font}\" \"{letters}\" {0.3~0.7}, {0~0.2}*x translate <-0.7, -0.4, -0.3>",
    "quadric": "quadric { <{1~2}, {1~2}, {1~2}>, <{-0.5~0.5}, 0, {-0.5~0.5}>, <0, {-0.2~0.2}, 0>, -0.8",
    "quartic": "quartic { <1, 0, 0, 0, {0.1~0.5}, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,"
               " 1, 0, 0, {0.1~0.5}, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, -0.5> sturm",
    "triangle": "triangle { <{-1~-0.7}, {-0.7~-0.5}, 0>, <{0.7~1}, {-0.5~-0.2}, 0.3>, <{-0.3~0.3}, {0.7~1}, -0.2>",
    "smooth triangle": "smooth_triangle { <{-1~-0.7}, {-0.7~-0.5}, 0>, <-0.4, -0.2, -1>, <{0.7~1}, {-0.5~-0.2}, 0.3>,"
                       " <0.5, -0.1, -1>, <{-0.3~0.3}, {0.7~1}, -0.2>, <0, 0.6, -1>",
    "mesh": "mesh2 { vertex_vectors { 6, <0, 0.95, 0>, <0.8, 0, 0.1>, <0, 0.1, 0.8>,"
             " <-0.8, 0, 0>, <0.1, 0, -0.8>, <0, -0.9, 0> } face_indices { 8, <0, 1, 2>, <0, 2, 3>, <0, 3, 4>,"
             " <0, 4, 1>, <5, 2, 1>, <5, 3, 2>, <5, 4, 3>, <5, 1, 4> }"
             " inside_vector <0.2, 1, 0.1> hierarchy off",
    "mesh of triangles": "mesh {"
                         " triangle { <0, 0.95, 0>, <0.8, 0, 0.1>, <0, 0.1, 0.8> }"
                         " triangle { <0, 0.95, 0>, <0, 0.1, 0.8>, <-0.8, 0, 0> }"
                         " triangle { <0, 0.95, 0>, <-0.8, 0, 0>, <0.1, 0, -0.8> }"
                         " triangle { <0, 0.95, 0>, <0.1, 0, -0.8>, <0.8, 0, 0.1> }"
                         " triangle { <0, -0.9, 0>, <0, 0.1, 0.8>, <0.8, 0, 0.1> }"
                         " triangle { <0, -0.9, 0>, <-0.8, 0, 0>, <0, 0.1, 0.8> }"
                         " triangle { <0, -0.9, 0>, <0.1, 0, -0.8>, <-0.8, 0, 0> }"
                         " triangle { <0, -0.9, 0>, <0.8, 0, 0.1>, <0.1, 0, -0.8> }"
                         " inside_vector <0.2, 0.1, 1>",
}
FLAT = {"disc", "disc with a hole", "polygon", "triangle", "smooth triangle"}

COMBINED = {  # SHAPE is the head of a shape, BODY what is said of it
    "alone": "SHAPE BODY }",
    "object": "object { SHAPE } BODY }",
    "union": "union { SHAPE } sphere { <{0.4~0.7}, {0.3~0.7}, 0>, {0.3~0.5} } BODY }",
    "union of textured": "union { SHAPE BODY } sphere { <{0.4~0.7}, {0.3~0.7}, 0>, {0.3~0.5} pigment { {rgb} } } }",
    "clipped": "SHAPE clipped_by { plane { {axis}, {0.1~0.3} } } BODY }",
    "clipped by a box": "SHAPE clipped_by { box { <-2, {-0.5~-0.2}, -2>, <{0.2~0.5}, 2, 2> } } BODY }",
    "bounded": "SHAPE bounded_by { sphere { 0, 3 } } BODY }",
    "merge": "merge { SHAPE } sphere { <{0.4~0.7}, {0.3~0.7}, 0>, {0.3~0.5} } BODY }",
    "intersection": "intersection { SHAPE } sphere { {point}, {0.8~0.95} } BODY }",
    "difference": "difference { SHAPE } cylinder { <{-0.3~0.3}, 0.1, -3>, <{-0.3~0.3}, 0, 3>, {0.2~0.4} } BODY }",
    "difference of textured": "difference { SHAPE BODY } sphere { <{0.3~0.6}, {0.3~0.6}, -0.6>, {0.4~0.6} pigment { {rgb} } } }",
    "intersection with an inverse": "intersection { SHAPE } sphere { <0.5, {0.3~0.6}, -0.6>, {0.4~0.6} inverse } BODY }",
    "nested": "difference { union { SHAPE } box { <-0.3, {0.3~0.5}, -0.3>, <0.3, {0.9~1.2}, 0.3> } }"
              " intersection { plane { {axis}, 0.1 } sphere { <0.1, 0.7, {-0.7~-0.5}>, 0.6 } } BODY }",
}
FOR_FLAT = {"alone", "object", "union", "union of textured", "clipped", "clipped by a box", "bounded"}

PATTERN = {  # what a map can be laid along
    "gradient": "gradient {axis}",
    "radial": "radial",
    "onion": "onion",
    "leopard": "leopard scale {0.1~0.3}",
    "spherical": "spherical",
    "planar": "planar rotate {20~70}",
    "boxed": "boxed",
    "cylindrical": "cylindrical",
    "bozo": "bozo scale {0.3~0.6}",
    "granite": "granite scale {0.5~1}",
    "agate": "agate agate_turb {0.5~1.2} scale 0.7",
    "marble": "marble turbulence {0.2~0.8} scale {0.3~0.6}",
    "wood": "wood turbulence {0.02~0.1} scale {0.2~0.4}",
    "crackle": "crackle form <{-1~-0.5}, {0.5~1}, {0~0.3}> metric {1~2.5} offset {0~0.3} scale {0.4~0.7}",
    "crackle solid": "crackle solid scale {0.3~0.6}",
    "cells": "cells scale {0.3~0.6}",
    "spiral1": "spiral1 3 scale {0.4~0.8}",
    "mandel": "mandel 12 scale {0.7~1.2}",
    "julia": "julia <{-0.5~-0.3}, {0.4~0.6}> 12 scale {0.7~1.2}",
    "turbulent": "gradient y turbulence <{0.2~0.6}, {0.2~0.6}, 0.3> octaves 4 omega {0.4~0.6} lambda 2.1",
}
COLOURS = "color_map { [0 {rgb}] [{0.2~0.4} {rgb}] [{0.5~0.7} {rgb}] [1 {rgb}] }"
PIGMENT = {  # with the wave and the transform of the pattern in WAVE
    "plain": "pigment { {rgb} }",
    "filter": "pigment { {rgb} filter {0.5~0.9} }",
    "transmit": "pigment { {rgb} transmit {0.3~0.8} }",
    "checker": "pigment { checker {rgb} {rgb} scale {0.3~0.6} WAVE }",
    "hexagon": "pigment { hexagon {rgb} {rgb} {rgb} scale {0.2~0.4} rotate 80*x WAVE }",
    "brick": "pigment { brick {rgb} {rgb} brick_size <{0.4~0.6}, 0.2037, 0.3071> mortar {0.03~0.06} WAVE }",
    **{name: f"pigment {{ {text} {COLOURS} WAVE }}" for name, text in PATTERN.items()},
    "map with filter": "pigment { gradient y color_map { [0 {rgb} filter 0.8] [{0.4~0.6} {rgb} filter {0.1~0.5}]"
                       " [1 {rgb} transmit {0.2~0.6}] } WAVE }",
    "colours in steps": "pigment { gradient x color_map { [0 0.3 color {rgb} color {rgb}] [0.3 0.6 color {rgb} color {rgb}] [0.6 1 color {rgb} color {rgb}] }"
                        " WAVE }",
    "average": "pigment { average pigment_map { [1 onion color_map { [0 {rgb}] [1 {rgb}] } scale 0.5] [{0.5~2} gradient x color_map"
               " { [0 {rgb}] [1 {rgb}] } WAVE] } }",
    "pigment_map": "pigment { gradient y pigment_map { [0 checker {rgb} {rgb} scale 0.2] [{0.4~0.6} {rgb}]"
                   " [1 onion color_map { [0 {rgb}] [1 {rgb}] } scale 0.4] } WAVE }",
    "texture_map": "texture { gradient x texture_map { [0 pigment { {rgb} } finish { phong {0.2~0.8} }] [{0.4~0.6} pigment"
                   " { checker {rgb} {rgb} scale 0.3 }] [1 pigment { {rgb} } finish { ambient {0.1~0.4} }] } WAVE }",
    "layers": "texture { pigment { {rgb} } } texture { pigment { gradient y color_map { [0 {rgb} transmit {0.5~0.9}]"
              " [1 {rgb} transmit 0.1] } WAVE } FINISH }",
    "texture in braces": "texture { pigment { {rgb} } FINISH rotate {10~50} scale {0.5~2} }",
    "texture of checkers": "texture { checker texture { pigment { {rgb} } } texture { pigment { {rgb} } FINISH }"
                           " scale {0.3~0.6} }",
}
WAVE = {
    "as it is": "",
    "ramp": "ramp_wave frequency {1~3} phase {0.1~0.9}",
    "triangle": "triangle_wave frequency {1~3}",
    "sine": "sine_wave frequency {1~3} scale {0.7~1.5}",
    "scallop": "scallop_wave phase {0.1~0.9} rotate <{10~80}, {10~80}, 0>",
    "cubic": "cubic_wave translate {point}",
    "poly": "poly_wave {0.5~3} frequency {-2~-1} matrix <1, 0.2, 0, 0, {0.8~1.2}, 0.1, 0.1, 0, 1, 0, {0.1~0.3}, 0>",
}
NORMAL = {
    "none": "",
    "onion": "normal { onion {0.2~0.8} sine_wave scale {0.2~0.4} }",
    "bumps": "normal { bumps {0.3~0.9} scale {0.1~0.3} }",
    "noise": "normal { granite {0.03~0.1} scale {0.3~0.8} turbulence {0.1~0.4} }",
    "waves": "normal { average normal_map { [1 ripples {0.2~0.5} frequency {1~3}] [waves {0.1~0.4} scale 0.5] [wrinkles {0.2~0.6} scale 0.3]"
             " [dents {0.3~0.8} scale 0.2] } }",
    "quilted": "normal { quilted {0.2~0.6} control0 {0.2~0.8} control1 {0.5~1} scale {0.2~0.4} }",
    "blocks": "normal { hexagon {0.2~0.5} scale {0.2~0.4} rotate {10~60} }",
    "slope_map": "normal { gradient {axis} bump_size {0.3~0.8} accuracy {0.02~0.1} slope_map { [0 <0, {0.5~1}>] [0.5 <1, 0>] [1 <0, {-1~0}>] }"
                 " scale {0.3~0.6} no_bump_scale }",
    "normal_map": "normal { gradient y normal_map { [0 leopard {0.2~0.5} scale 0.1] [{0.4~0.6} spotted {0.2~0.5} scale 0.2] [1 bozo 0.3] } }",
}
FINISH = {
    "default": "",
    "ambient": "ambient {rgb} diffuse {0.2~0.8}",
    "back": "diffuse albedo {0.4~0.8}, {0.1~0.4} emission {0.05~0.2}",
    "brilliance": "brilliance {0.5~4} diffuse {0.5~0.9}",
    "phong": "phong {0.3~1} phong_size {5~80}",
    "phong metallic": "phong albedo {0.1~0.4} phong_size {5~80} metallic",
    "specular": "specular {0.3~1} roughness {0.01~0.2}",
    "specular metallic": "specular albedo {0.02~0.1} roughness {0.02~0.2} metallic {0.3~0.9}",
    "mirror": "reflection {0.2~0.8}",
    "mirror by angle": "reflection { {0~0.2}, {0.5~1} falloff {0.5~4} }",
    "mirror exponent": "reflection { {rgb} } reflection_exponent {0.5~1.5}",
    "mirror exponent inside": "reflection { {rgb} exponent {0.5~1.5} }",
    "mirror metallic": "reflection { {0.1~0.3}, {0.5~0.9} metallic {0.3~1} }",
    "mirror fresnel": "reflection { {0.1~0.3}, {0.7~1} fresnel } diffuse 0.3",
    "conserve_energy": "reflection {0.2~0.6} conserve_energy specular 0.3",
    "old refraction": "refraction 1 ior {1.1~1.6}",
}
INTERIOR = {
    "none": "",
    "ior": "interior { ior {1.1~1.8} }",
    "fade": "interior { ior {1.05~1.3} fade_distance {0.3~1.5} fade_power {0.5~3} }",
    "fade colour": "interior { fade_distance {0.3~1.5} fade_power 1001 fade_color {rgb} }",
    "caustics": "interior { ior {1~1.4} caustics {0.02~0.6} }",
    "material": "",  # the texture and an interior in one, see object_text
}
TRANSFORM = {
    "none": "",
    "rotate": "rotate <{-90~90}, {-90~90}, {-90~90}>",
    "scale": "scale <{0.6~1.2}, {0.6~1.2}, {0.6~1.2}>",
    "stretched and turned": "scale <{0.6~1}, {0.9~1.3}, {0.6~1}> rotate <{-90~90}, {-90~90}, {-90~90}>",
    "mirrored": "scale <-1, {0.8~1.2}, 1> rotate {-40~40}*z",
    "matrix": "matrix <1, {-0.4~0.4}, 0, {-0.4~0.4}, 1, 0.1, 0, {-0.3~0.3}, 0.9, 0, 0, 0>",
    "transform": "transform { rotate {-60~60}*y scale {0.8~1.1} translate {point} inverse }",
    "declared": "transform { Turn }",
}
FLAG = {
    "none": "",
    "hollow": "hollow",
    "no_shadow": "no_shadow",
    "no_image": "no_image",
    "no_reflection": "no_reflection",
    "several": "no_shadow no_reflection hollow off no_radiosity",
    "inverse": "inverse",
}
CAMERA = {
    "default": "location <0.3, 1.2, -7.5> look_at 0",
    "angle": "location <-2, 2.5, -6.5> right 4/3*x look_at <0, -0.2, 0> angle {45~60}",
    "orthographic": "orthographic location <1, 2, -8> right 6.6*x up 5*y look_at 0",
    "orthographic angle": "orthographic location <1, 1.5, -7> look_at 0 angle {48~60}",
    "direction": "location <0.5, 0.5, -7> direction {1~1.3}*z right 1.4*x up 1.1*y rotate <{1~5}, {1~8}, {5~20}>",
    "skewed": "location <0, 1, -7> up <0.2, 1, 0> right <-1.33, 0.1, 0> sky <{0.2~0.5}, 1, 0> look_at <0.1, 0, 0>",
    "fisheye": "fisheye location <0.2, 1, -6.5> look_at 0 angle {60~90}",
    "ultra_wide_angle": "ultra_wide_angle location <0.2, 1, -6.5> look_at 0 angle {50~80}",
    "panoramic": "panoramic location <0.2, 1, -2.7> look_at 0",
    "spherical": "spherical location <0.2, 1, -5.5> look_at 0 angle {70~90} {50~70}",
    "moved": "location <0, 1, -7> look_at 0 angle 55 translate <{-0.5~0.5}, {0~0.5}, 0> rotate {-15~15}*y",
}
LIGHT = {
    "point": "light_source { <{3~6}, {4~7}, -7>, rgb 1 }",
    "two": "light_source { <{3~6}, {4~7}, -7>, {rgb} } light_source { <{-7~-4}, {2~5}, -5>, {rgb} }",
    "fading": "light_source { <{2~4}, {3~5}, -5>, rgb 1 fade_distance {2~6} fade_power {1~3} }",
    "spotlight": "light_source { <{3~5}, {4~6}, -6>, rgb 1 spotlight radius {10~20} falloff {25~35} point_at 0 }",
    "tight spotlight": "light_source { <{3~5}, 5, -6>, rgb 1 spotlight radius {20~30} falloff {31~40} tightness {1~20}"
                       " point_at <{-1~1}, 0, 0> } light_source { <-9, 3, -4>, rgb 0.3 }",
    "cylinder": "light_source { <{3~5}, {4~6}, -6>, rgb 1 cylinder radius {1~2} falloff {2.2~3} point_at 0 }",
    "parallel": "light_source { <{3~6}, {4~7}, -7>, rgb 1 parallel point_at <{-1~1}, 0, 0> }",
    "shadowless": "light_source { <{3~6}, {4~7}, -7>, rgb 0.7 shadowless } light_source { <-7, 4, -5>, rgb 0.4 }",
    "looks_like": "light_source { <{2~3}, {2~2.5}, {-3~-2}>, rgb 0.8 looks_like { sphere { 0, 0.3 } pigment { {rgb} } finish { ambient 1 } } }",
    "moved": "light_source { 0, {rgb} translate <5, 5, -6> rotate {-30~30}*y }",
    "area": "light_source { <{3~5}, {4~6}, -6>, rgb 1 area_light {0.5~2}*x, {0.5~2}*z, 3, 3 }",
    "area circular": "light_source { <{3~5}, {4~6}, -6>, rgb 1 area_light {0.5~2}*x, {0.5~2}*z, 4, 4 circular }",
    "area turned": "light_source { <{3~5}, {4~6}, -6>, rgb 1 area_light {0.5~2}*x, y, 4, 4 orient }",
    "area adaptive": "light_source { <{3~5}, {4~6}, -6>, rgb 1 area_light {0.5~2}*x, {0.5~2}*z, 5, 5 adaptive 1 }",
}
# POV-Ray forgives a shadow the last 1e-3 of its way: docs/language.md, "Where rtlang differs", measured there at up to 4e-3.
FORGIVING = {"area", "area circular", "area turned", "area adaptive"}
SETTINGS = {
    "plain": "assumed_gamma 1",
    "gamma": "assumed_gamma {1.8~2.4}",
    "srgb": "assumed_gamma srgb",
    "few levels": "assumed_gamma 1 max_trace_level {2~4}",
    "many levels": "assumed_gamma 1 max_trace_level 12 adc_bailout 0.002",
    "ambient": "assumed_gamma 1 ambient_light {rgb}",
}
SKY = {
    "black": "",
    "background": "background { {rgb} }",
    "sky_sphere": "sky_sphere { pigment { gradient y color_map { [0 {rgb}] [0.6 {rgb}] [1 {rgb}] } scale 2 translate -y } }",
    "fog": "background { {rgb} } fog { distance {8~20} color {rgb} }",
    "ground fog": "fog { fog_type 2 distance {8~20} color {rgb} fog_offset {-2~-1} fog_alt {0.5~1.5} }",
    "wall": "background { rgb 0.1 } plane { <{-0.2~0.2}, 0.1, -1>, -{4~6} pigment { gradient y color_map { [0 {rgb}] [1 {rgb}] }"
            " scale 3 } }",
}
FLOOR = {
    "none": "",
    "checker": "plane { y, -{2.6~3} pigment { checker {rgb} {rgb} } }",
    "mirror": "plane { y, -{2.6~3} pigment { {rgb} } finish { reflection {0.2~0.6} } }",
    "room": "sphere { 0, 20 hollow pigment { {rgb} } finish { ambient 0.2 } inverse }",
    "default texture": "plane { <0.1, 1, 0.05>, -{2.6~3} }",
}
DEFAULT = {
    "none": "",
    "finish": "#default { finish { ambient {0.05~0.3} diffuse {0.5~0.9} } }",
    "texture": "#default { texture { pigment { {rgb} } finish { phong {0.1~0.5} } } }",
}

OF_OBJECT = {"shape": HEAD, "combined": COMBINED, "pigment": PIGMENT, "wave": WAVE, "normal": NORMAL, "finish": FINISH, "interior": INTERIOR,
             "transform": TRANSFORM, "flag": FLAG}
OF_SCENE = {"camera": CAMERA, "light": LIGHT, "settings": SETTINGS, "sky": SKY, "floor": FLOOR, "default": DEFAULT}


# Pairs of choices for which the programs are known to differ: docs/language.md, "Where rtlang differs", tells of each.
OPEN = {"open cylinder", "open cone"}
CLIPPED = {"clipped", "clipped by a box"}
COMPOSED = {"union", "union of textured", "nested", "difference", "difference of textured", "intersection with an inverse"}
BENDING = set(INTERIOR) - {"none"} | {"old refraction"}
DIFFERENT = [
    ({"smooth triangle"}, {"declared", "matrix", "transform"}),
    (COMPOSED | OPEN, BENDING | {"inverse"}),
    (FLAT | CLIPPED | {"inverse"}, {"fade", "fade colour", "mirror fresnel"}),
    ({"mirror exponent", "mirror exponent inside", "no_reflection"}, BENDING),
    ({"merge"}, {"mirror fresnel"}),
]


def is_possible(pair):
    """Whether two choices of an object go together."""
    chosen = dict(pair)
    names = {name for _, name in pair}
    if any(names & one and names & other for one, other in DIFFERENT):
        return False
    if chosen.get("shape") in FLAT and chosen.get("combined", "alone") not in FOR_FLAT:
        return False  # has no inside to be cut: an error in rtlang
    if chosen.get("flag") == "inverse" and (chosen.get("shape") in FLAT or chosen.get("combined") == "union of textured"):
        return False  # stands behind a part of a whole there
    return True


def pairs_of_object(choices):
    return itertools.combinations(sorted(choices.items()), 2)


def pairs_between(scene, choices):
    return itertools.product(sorted(scene.items()), sorted(choices.items()))


def all_pairs():
    """Every pair that can be chosen."""
    rows = {factor: [(factor, name) for name in table] for factor, table in {**OF_OBJECT, **OF_SCENE}.items()}
    found = set()
    for one, other in itertools.combinations(sorted(OF_OBJECT), 2):
        found.update(pair for pair in itertools.product(rows[one], rows[other]) if is_possible(pair))
    for one, other in itertools.combinations(sorted(OF_SCENE), 2):
        found.update(itertools.product(rows[one], rows[other]))
    for one, other in itertools.product(sorted(OF_SCENE), sorted(OF_OBJECT)):
        found.update(itertools.product(rows[one], rows[other]))
    return found


def choose(rng, factors, weigh):
    """The best of some random choices."""
    best, most = None, -1
    for _ in range(CANDIDATES):
        choices = {factor: rng.choice(list(table)) for factor, table in factors.items()}
        if all(is_possible(pair) for pair in pairs_of_object(choices)) and weigh(choices) > most:
            best, most = choices, weigh(choices)
    return best or choose(rng, factors, weigh)


def steer(rng, choices, missing, factors):
    """Puts a pair that is still missing into the choices of an object, if it fits there."""
    wanted = [pair for pair in missing if all(factor in factors for factor, _ in pair)]
    if not wanted:
        return choices
    steered = {**choices, **dict(rng.choice(sorted(wanted)))}
    return steered if all(is_possible(pair) for pair in pairs_of_object(steered)) else choices


def plan(count, seed):
    """[(choices of a scene, [choices of its objects])], and the pairs that none of them has."""
    rng = random.Random(seed)
    missing, scenes = all_pairs(), []
    for _ in range(count):
        scene = choose(rng, OF_SCENE, lambda choices: sum(pair in missing for pair in pairs_of_object(choices)))
        missing.difference_update(pairs_of_object(scene))
        objects = []
        for _ in range(OBJECTS):
            def weigh(choices, scene=scene):
                return (sum(pair in missing for pair in pairs_of_object(choices)) +
                        sum(pair in missing for pair in pairs_between(scene, choices)))
            choices = steer(rng, choose(rng, OF_OBJECT, weigh), missing, OF_OBJECT)
            missing.difference_update(pairs_of_object(choices))
            missing.difference_update(pairs_between(scene, choices))
            objects.append(choices)
        scenes.append((scene, objects))
    return scenes, missing


def fill(rng, text):
    """The text with numbers, colours and vectors in the places of its words in braces."""
    def number(low, high, digits=3):
        """Never a round one: a face at 0.600 lies on the edge of a checker of scale 0.3, where rounding decides on all of it."""
        text = f"{rng.uniform(low, high):.{digits}f}"
        return text + "7" if text.endswith("00") else text

    def replace(match):
        word = match.group()
        if word == "{rgb}":
            return f"rgb <{number(0.05, 1)}, {number(0.05, 1)}, {number(0.05, 1)}>"
        if word == "{axis}":
            return f"<{number(-1, 1)}, {number(0.2, 1)}, {number(-1, 1)}>"
        if word == "{point}":
            return f"<{number(-0.15, 0.15)}, {number(-0.15, 0.15)}, {number(-0.15, 0.15)}>"
        if word == "{font}":
            return rng.choice(("timrom.ttf", "cyrvetic.ttf", "crystal.ttf"))
        if word == "{letters}":
            return "".join(rng.choice(string.ascii_letters + string.digits + "!#$%&*+-?@") for _ in range(2))
        low, high = word[1:-1].split("~")
        return number(float(low), float(high))
    return re.sub(r"\{(?:rgb|axis|point|font|letters|-?[\d.]+~-?[\d.]+)\}", replace, text)


def object_text(rng, choices, place, in_fog):
    finish = f"finish {{ {FINISH[choices['finish']]} }}" if FINISH[choices["finish"]] else ""
    finish = f"{NORMAL[choices['normal']]} {finish}"
    surface = PIGMENT[choices["pigment"]].replace("WAVE", WAVE[choices["wave"]])
    surface = surface.replace("FINISH", finish) if surface.startswith("texture") else f"texture {{ {surface} {finish} }}"
    if choices["interior"] == "material":
        surface = f"material {{ {surface} interior {{ ior {{1.1~1.5}} }} rotate {{10~40}}*z }}"
    flag = "hollow" if in_fog and choices["combined"] in COMPOSED else FLAG[choices["flag"]]  # fog: see the same place
    body = f"{surface} {INTERIOR[choices['interior']]} {flag} {TRANSFORM[choices['transform']]}"
    text = COMBINED[choices["combined"]].replace("SHAPE", HEAD[choices["shape"]]).replace("BODY", body)
    return fill(rng, f"object {{ {text} translate <{place[0]}, {place[1]}, {{-0.4~0.4}}> }}")


def settings_text(choices, objects):
    """Between bumps that mirror, rounding grows by an order of magnitude a bounce."""
    settings = SETTINGS[choices["settings"]]
    has_bumps = any(one["normal"] != "none" for one in objects)
    return settings.replace("max_trace_level 12", "max_trace_level 6") if has_bumps else settings


def scene_text(choices, objects, seed, number):
    rng = random.Random(f"{seed} {number}")
    lines = ["#version 3.7;", f"global_settings {{ {settings_text(choices, objects)} }}", DEFAULT[choices["default"]],
             "#declare Turn = transform { rotate <20, 30, 0> scale <1, 1.1, 0.9> }",
             f"camera {{ {CAMERA[choices['camera']]} }}", LIGHT[choices["light"]], SKY[choices["sky"]],
             FLOOR[choices["floor"]]]
    text = "".join(fill(rng, line) + "\n" for line in lines if line)
    for place, one in zip(((-1.35, 1.15), (1.4, 1.2), (-1.3, -1.2), (1.35, -1.15)), objects):
        text += "// " + ", ".join(f"{factor}: {name}" for factor, name in one.items()) + "\n"
        text += object_text(rng, one, place, "fog" in choices["sky"]) + "\n"
    return "// " + ", ".join(f"{factor}: {name}" for factor, name in choices.items()) + "\n" + text


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    scenes, missing = plan(count, seed)
    if len(sys.argv) > 3:
        number = int(sys.argv[3])
        print(scene_text(*scenes[number], seed, number), end="")
    else:
        print(f"{len(all_pairs()) - len(missing)} of {len(all_pairs())} pairs in {count} scenes")
        print(*sorted(missing)[:20], sep="\n")


if __name__ == "__main__":
    main()
