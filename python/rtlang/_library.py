"""The shared library by ctypes: the structures and functions of rtlang/rtlang.h that the package uses.

It is looked for where RTLANG_LIBRARY says, inside of the package (a wheel), in the checkout that the package is part of, and
where the system has its libraries.
SPDX-License-Identifier: MIT
"""
import ctypes
import ctypes.util
import glob
import os
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_float, c_int, c_size_t, c_ssize_t
from ctypes import c_uint64, c_void_p

OK, FAULT_SCENE, FAULT_USAGE, FAULT_IO, FAULT_LIMIT, CANCELLED = range(6)
WARNING, ERROR, NOTE = range(3)
FLOAT64, FLOAT32 = range(2)
ENDS = ("done", "target", "time", "interrupted")
LIMITS = {"steps": 0, "depth": 1, "objects": 2, "text": 3, "memory": 4, "messages": 5}


class Diagnostic(Structure):
    _fields_ = [("severity", c_int), ("code", c_char_p), ("message", c_char_p), ("file", c_char_p),
                ("line", c_uint64), ("column", c_uint64), ("text", c_char_p)]


DIAGNOSTIC = CFUNCTYPE(None, c_void_p, POINTER(Diagnostic))
MESSAGE = CFUNCTYPE(None, c_void_p, c_int, c_void_p, c_size_t)
PROGRESS = CFUNCTYPE(None, c_void_p, c_double)


class Callbacks(Structure):
    _fields_ = [("client", c_void_p), ("diagnostic", DIAGNOSTIC), ("message", MESSAGE), ("progress", PROGRESS)]


class Array(Structure):
    _fields_ = [("data", c_void_p), ("number", c_int), ("stride", c_ssize_t), ("step", c_ssize_t)]


class Look(Structure):
    _fields_ = [("colors", Array), ("color_numbers", c_int), ("finish", c_char_p)]


class Spheres(Structure):
    _fields_ = [("name", c_char_p), ("count", c_size_t), ("centers", Array), ("radii", Array), ("look", Look)]


class Rods(Structure):
    _fields_ = [("name", c_char_p), ("count", c_size_t), ("bases", Array), ("caps", Array), ("base_radii", Array),
                ("cap_radii", Array), ("open", c_int), ("look", Look)]


class Triangles(Structure):
    _fields_ = [("name", c_char_p), ("count", c_size_t), ("corners", Array), ("normals", Array), ("look", Look)]


Vector = c_double * 3


class Camera(Structure):
    _fields_ = [("location", Vector), ("look_at", Vector), ("up", Vector), ("angle", c_double), ("width", c_double),
                ("aspect", c_double), ("right_handed", c_int), ("aperture", c_double)]


class Light(Structure):
    _fields_ = [("position", Vector), ("color", Vector), ("point_at", Vector), ("parallel", c_int),
                ("shadowless", c_int), ("radius", c_double), ("size", c_int)]


class DepthCue(Structure):
    _fields_ = [("strength", c_double), ("has_color", c_int), ("color", Vector), ("near", c_double), ("far", c_double)]


class Sampling(Structure):
    _fields_ = [("sampler", c_char_p), ("filter", c_char_p), ("samples", c_double), ("seed", c_uint64),
                ("adaptive", c_int), ("target_error", c_double), ("time_limit", c_double), ("no_estimate", c_int),
                ("no_pixel_errors", c_int), ("max_trace_level", c_int)]


class SamplingError(Structure):
    _fields_ = [("known", c_int), ("rmse", c_double), ("low", c_double), ("high", c_double), ("samples", c_double),
                ("slope", c_double), ("bias", c_double), ("bias_by_level", c_double), ("end", c_int),
                ("seconds_left", c_double), ("unmet_shapes", c_double), ("unmet_shape_area", c_double),
                ("unmet_highlights", c_double), ("unmet_highlight_area", c_double), ("unmet_are_about", c_int),
                ("missed_area", c_double), ("missed_error", c_double)]


class Output(Structure):
    _fields_ = [("depth", c_int), ("file_gamma", c_double), ("planes", ctypes.c_uint), ("whole", c_int), ("continues", c_int)]


PLANES = {  # name: (bit of rt_plane, the type of its numbers, how many a pixel has)
    "error": (1, "float32", 1), "samples": (2, "uint32", 1), "depth": (4, "float32", 1), "normal": (8, "float32", 3),
    "object": (16, "uint32", 1), "albedo": (32, "float32", 3)}


class Summary(Structure):
    _fields_ = [("width", c_int), ("height", c_int), ("objects", c_uint64), ("lights", c_uint64),
                ("camera_rays", c_uint64), ("shadow_rays", c_uint64), ("reflected_rays", c_uint64),
                ("transmitted_rays", c_uint64), ("parse_seconds", c_double), ("prepare_seconds", c_double),
                ("trace_seconds", c_double), ("write_seconds", c_double), ("errors", c_uint64),
                ("warnings", c_uint64), ("kernel", c_char_p), ("trees", c_uint64),
                ("refits", c_uint64), ("out_of_range", c_uint64)]


_SESSION = c_void_p
_FUNCTIONS = {  # name: (result, arguments after the session)
    "rt_begin_scene": (c_int, []),
    "rt_load_text": (c_int, [c_char_p, c_char_p, c_size_t]),
    "rt_load_file": (c_int, [c_char_p]),
    "rt_add_include_path": (c_int, [c_char_p]),
    "rt_set_size": (c_int, [c_int, c_int]),
    "rt_set_crop": (c_int, [c_int, c_int, c_int, c_int]),
    "rt_set_warning": (c_int, [c_char_p]),
    "rt_set_limit": (c_int, [c_int, c_uint64]),
    "rt_set_sampling": (c_int, [POINTER(Sampling)]),
    "rt_set_alpha": (None, [c_int]),
    "rt_set_planes": (c_int, [ctypes.c_uint]),
    "rt_get_plane": (c_int, [c_int, c_void_p, c_size_t]),
    "rt_add_spheres": (c_int, [POINTER(Spheres), POINTER(c_size_t)]),
    "rt_update_spheres": (c_int, [c_size_t, c_size_t, POINTER(Spheres)]),
    "rt_add_rods": (c_int, [POINTER(Rods)]),
    "rt_add_triangles": (c_int, [POINTER(Triangles)]),
    "rt_set_camera": (c_int, [POINTER(Camera)]),
    "rt_add_light": (c_int, [POINTER(Light)]),
    "rt_clear_lights": (c_int, []),
    "rt_set_sky_light": (c_int, [Vector]),
    "rt_set_outline": (c_int, [c_double, Vector]),
    "rt_set_depth_cue": (c_int, [POINTER(DepthCue)]),
    "rt_set_background": (c_int, [c_double * 4]),
    "rt_get_box": (c_int, [Vector, Vector]),
    "rt_render": (c_int, [c_int]),
    "rt_resume": (None, []),
    "rt_cancel": (None, []),
    "rt_get_error": (None, [POINTER(SamplingError)]),
    "rt_get_summary": (None, [POINTER(Summary)]),
    "rt_pixels": (c_void_p, [POINTER(c_int), POINTER(c_int)]),
    "rt_take_pixels": (c_void_p, [POINTER(c_int), POINTER(c_int)]),
    "rt_transparency": (c_void_p, []),
    "rt_set_pixels": (c_int, [c_int, c_int, c_void_p, c_void_p]),
    "rt_get_pixels": (c_int, [POINTER(Output), c_void_p, c_size_t]),
    "rt_get_png": (c_int, [POINTER(Output), POINTER(POINTER(ctypes.c_ubyte)), POINTER(c_size_t)]),
    "rt_write": (c_int, [c_char_p, POINTER(Output)]),
    "rt_dump_scene": (c_int, [POINTER(c_char_p)]),
    "rt_session_free": (None, []),
}


def _own_libraries():
    """The library of a wheel, and those beside it that it needs, if the system has none."""
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "_native")
    found = glob.glob(os.path.join(glob.escape(here), "lib", "**", "librtlang.so*"), recursive=True)
    return found[0] if found else None, sorted(glob.glob(os.path.join(glob.escape(here), "needed", "*")))


def _built_library():
    """The library of the checkout that the package is imported from, once it is built."""
    top = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    path = os.path.join(top, ".libs", "librtlang.so")
    return path if os.path.exists(path) and os.path.exists(os.path.join(top, "python", "make_wheel.py")) else None


def _open():
    wanted = os.environ.get("RTLANG_LIBRARY")
    own, needed = _own_libraries()
    path = wanted or own or _built_library() or ctypes.util.find_library("rtlang")
    if not path:
        raise ImportError("rtlang: no librtlang.so in the package or the system; RTLANG_LIBRARY may say where it is")
    if path == own:
        for library in needed:
            name = os.path.basename(library)
            try:
                ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)
            except OSError:
                ctypes.CDLL(library, mode=ctypes.RTLD_GLOBAL)
    return ctypes.CDLL(path)


def _load():
    library = _open()
    for name, (result, arguments) in _FUNCTIONS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, [_SESSION] + arguments
    library.rt_session_new.restype, library.rt_session_new.argtypes = c_void_p, [POINTER(Callbacks)]
    library.rt_free_pixels.restype, library.rt_free_pixels.argtypes = None, [c_void_p]
    library.rt_version.restype, library.rt_version.argtypes = c_char_p, []
    return library


LIBRARY = _load()
FLOATS = POINTER(c_float)
