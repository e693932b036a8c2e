"""A scene made of arrays, and of text of the scene language.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import ctypes
import os
import sys
import warnings
import weakref
from typing import Callable, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _library as c
from ._arrays import colors_of, count_of, numbers, pass_on, rows
from ._errors import SceneError, UsageError
from ._session import Session
from .image import Image
from .looks import Look, key_light, look_of

Vector = Sequence[float]
FIT_ANGLE = 40.0
MARGIN = 1.04


def _vector(name: str, value) -> c.Vector:
    array = numbers(name, value, (3,))
    if array.shape != (3,):
        raise UsageError(f"{name} must be three numbers, not of the shape {array.shape}")
    return c.Vector(*array.astype(np.float64))


def _light(name: str, value) -> np.ndarray:
    """A color of light as three numbers; one is grey."""
    light = np.broadcast_to(numbers(name, value, (3,)), 3).astype(np.float64)
    if not np.all(np.isfinite(light)) or np.any(light < 0):
        raise SceneError(f"{name} must be 0 or more, and finite, not {value!r}", "E0460", name)
    return light


def _text(name: str, value: Optional[str]) -> Optional[bytes]:
    if value is not None and not isinstance(value, str):
        raise UsageError(f"{name} must be a str, not {type(value).__name__}")
    return None if value is None else value.encode("utf-8")


class SphereGroup:
    """Spheres that Scene.spheres added, to be given other numbers."""

    def __init__(self, scene: "Scene", number: int, count: int):
        self._scene, self._number, self.count = scene, number, count

    def __len__(self) -> int:
        return self.count

    def update(self, centers: Optional[ArrayLike] = None, radii: Optional[ArrayLike] = None,
               colors: Optional[ArrayLike] = None, first: int = 0) -> None:
        """Other numbers for the spheres from `first` on, as many as the arrays are long; None: as they were.

        centers, radii, colors  shapes and dtypes as of Scene.spheres; without any array, (3,) or a number is for all
        Raises SceneError with the `index` of what is wrong, and UsageError when the group has fewer spheres.

        Other colors alone cost no tree. As long as spheres stay about where they were, the tree stays, too, and its
        boxes are made to fit; a new one is built where that would cost rays too much (Image.built).
        """
        given = {}
        if centers is not None:
            given["centers"] = numbers("centers", centers, (None, 3))
        if radii is not None:
            given["radii"] = numbers("radii", radii, (None,))
        colors, color_numbers = colors_of("colors", colors)
        each = [(name, array, {"centers": 1}.get(name, 0)) for name, array in given.items()] + [("colors", colors, 1)]
        is_one = all(array is None or array.ndim == inner for _, array, inner in each)
        count = self.count - first if is_one else count_of(each)
        if not 0 <= first <= self.count or count > self.count - first:
            raise UsageError(f"spheres {first} to {first + count} are not all in a group of {self.count}")
        spheres = c.Spheres(None, count, pass_on(given.get("centers"), 1), pass_on(given.get("radii"), 0),
                            c.Look(pass_on(colors, 1), color_numbers, None))
        self._scene._session.call("rt_update_spheres", self._number, first, ctypes.byref(spheres), level=4)


class Scene:
    """Shapes, lights and a camera. Lengths are in any one unit, angles in degrees, colors in linear light (`srgb`
    turns others into it).

    Arrays are numpy arrays of float64 or float32, read in place whatever their strides (integers are converted), or
    what numpy makes arrays of. Colors are (n, 3) or (n, 4) with alpha, or (3,) or (4,) for all. `finish` is what stands
    in `finish { }` of the language (docs/language.md): "ambient 0.2 phong 0.5"; None is the language's default.

    All methods raise SceneError when a number is wrong, with the element's `index`; UsageError, a ValueError, for
    arrays of another shape or dtype, a closed scene, or a scene in use by another thread; LimitError when memory is
    exhausted. After one of these the scene is as it was, except after one of `text` and `file`, which lose it.
    """

    def __init__(self, memory: Optional[int] = None, objects: Optional[int] = None,
                 look: Union[str, Look, None] = None):
        """memory: bytes that it may take in all; objects: shapes that it may have.

        look  "publication" (soft light, light from all sides, matte, outlines, a clear background), "soft" (without
              lines, on white), "deep" (far shapes fade into the dark), or a rtlang.Look: what shapes get that have no
              finish of their own, and pictures without lights, samples, alpha and background of their own
        """
        self._look = look_of(look)
        self._session = Session()
        self._session.call("rt_begin_scene")
        self._session.call("rt_set_warning", b"W0211")  # colors that look like bytes
        for name, value in (("memory", memory), ("objects", objects)):
            if value is not None:
                self._session.call("rt_set_limit", c.LIMITS[name], value)
        self._camera, self._set_camera, self._view, self._has_text = None, None, None, False
        self._shapes = 0  # counts what was added, for fit
        self._has_lights, self._has_background, self._has_outline = False, False, False
        if self._look is not None:
            self.sky(self._look.sky)
            if self._look.background is not None:
                self.background(self._look.background)
            if self._look.depth_cue:
                self.depth_cue(self._look.depth_cue)
            self._has_background = self._look.background is not None

    def __enter__(self) -> "Scene":
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._session.is_closed:
            return "<rtlang.Scene, closed>"
        parts = f"{self._shapes} {'part' if self._shapes == 1 else 'parts'}"
        try:
            low, high = self.box()
        except UsageError:
            return f"<rtlang.Scene of {parts}>"
        return (f"<rtlang.Scene of {parts}, from ({low[0]:.4g}, {low[1]:.4g}, {low[2]:.4g}) to "
                f"({high[0]:.4g}, {high[1]:.4g}, {high[2]:.4g})>")

    def close(self) -> None:
        """Gives its memory back; after that all other methods raise UsageError."""
        self._session.close()

    # ---- shapes

    def _finish(self, finish: Optional[str]) -> Optional[bytes]:
        return _text("finish", self._look.finish if finish is None and self._look is not None else finish)

    def spheres(self, centers: ArrayLike, radii: ArrayLike, colors: Optional[ArrayLike] = None,
                finish: Optional[str] = None, name: str = "spheres") -> SphereGroup:
        """Adds n spheres. Returns the group, whose `update` moves and colors it.

        centers  (n, 3) of float64, float32 or integers, finite
        radii    (n,) or a number, in the same unit, at least 0 (0 is not drawn, with a SceneWarning)
        colors   (n, 3) or (n, 4), (3,) or (4,) for all; linear light, the fourth is alpha; None: white
        finish   of all of them, as of the whole Scene
        name     is for messages: "spheres[17]"

        Raises SceneError (a number out of range, with its `index`), UsageError (shape, dtype), LimitError (memory,
        objects).
        """
        centers, radii = numbers("centers", centers, (None, 3)), numbers("radii", radii, (None,))
        colors, color_numbers = colors_of("colors", colors)
        count = count_of([("centers", centers, 1), ("radii", radii, 0), ("colors", colors, 1)])
        spheres = c.Spheres(_text("name", name), count, pass_on(centers, 1), pass_on(radii, 0),
                            c.Look(pass_on(colors, 1), color_numbers, self._finish(finish)))
        group = ctypes.c_size_t()
        self._session.call("rt_add_spheres", ctypes.byref(spheres), ctypes.byref(group))
        self._shapes += 1
        return SphereGroup(self, group.value, count)

    def rods(self, bases: ArrayLike, caps: ArrayLike, radii: ArrayLike, colors: Optional[ArrayLike] = None,
             finish: Optional[str] = None, cap_radii: Optional[ArrayLike] = None, open: bool = False,
             name: str = "rods") -> None:
        """Adds n cylinders, or cones.

        bases, caps  (n, 3), finite: the middles of their ends
        radii        (n,) or a number, at least 0; cap_radii likewise, of the caps where they are cones
        open         without the discs at their ends
        colors, finish, name and what is raised are as of `spheres`
        """
        bases, caps = numbers("bases", bases, (None, 3)), numbers("caps", caps, (None, 3))
        radii = numbers("radii", radii, (None,))
        cap_radii = None if cap_radii is None else numbers("cap_radii", cap_radii, (None,))
        colors, color_numbers = colors_of("colors", colors)
        count = count_of([("bases", bases, 1), ("caps", caps, 1), ("radii", radii, 0), ("cap_radii", cap_radii, 0),
                          ("colors", colors, 1)])
        rods = c.Rods(_text("name", name), count, pass_on(bases, 1), pass_on(caps, 1), pass_on(radii, 0),
                      pass_on(cap_radii, 0), int(open),
                      c.Look(pass_on(colors, 1), color_numbers, self._finish(finish)))
        self._session.call("rt_add_rods", ctypes.byref(rods))
        self._shapes += 1

    def bonds(self, centers: ArrayLike, pairs: ArrayLike, radius: ArrayLike, colors: Optional[ArrayLike] = None,
              center_colors: Optional[ArrayLike] = None, finish: Optional[str] = None, name: str = "bonds") -> None:
        """Adds a rod for each of pairs (m, 2), integers from 0 that name two of centers (n, 3).

        radius  (m,) or a number
        colors  (m, 3) or (3,), of the bonds; or center_colors (n, 3): each half has the color of its end, and messages
                then name halves, two for each bond

        Raises UsageError when a pair names a center that there is not, otherwise as `spheres`.
        """
        centers, pairs = numbers("centers", centers, (None, 3)), np.asarray(pairs)
        if pairs.size == 0:
            return
        if pairs.dtype.kind not in "iu" or pairs.ndim != 2 or pairs.shape[1] != 2:
            raise UsageError(f"pairs must be integers of the shape (m, 2), not {pairs.dtype} of {pairs.shape}")
        wrong = np.flatnonzero(((pairs < 0) | (pairs >= len(centers))).any(axis=1))
        if wrong.size:
            raise UsageError(f"names centers {tuple(pairs[wrong[0]])}, and there are {len(centers)}",
                             place=f"{name}[{wrong[0]}]")
        bases, caps = centers[pairs[:, 0]], centers[pairs[:, 1]]
        if center_colors is None:
            self.rods(bases, caps, radius, colors, finish, name=name)
            return
        middles, at = (bases + caps) / 2, np.asarray(center_colors)
        radius = np.repeat(radius, 2) if np.ndim(radius) else radius
        halves = np.stack((bases, middles, caps, middles), axis=1).reshape(-1, 2, 3)
        self.rods(halves[:, 0], halves[:, 1], radius, at[pairs].reshape(-1, at.shape[-1]), finish, open=True, name=name)

    def triangles(self, corners: ArrayLike, colors: Optional[ArrayLike] = None, finish: Optional[str] = None,
                  normals: Optional[ArrayLike] = None, name: str = "triangles") -> None:
        """Adds n triangles. Those without area are not drawn, with a SceneWarning.

        corners  (n, 3, 3): triangle, corner, coordinate
        normals  (n, 3, 3) of the corners, of any length but 0, make them look round
        colors, finish, name and what is raised are as of `spheres`
        """
        corners = rows(numbers("corners", corners, (None, 3, 3)))
        normals = None if normals is None else rows(numbers("normals", normals, (None, 3, 3)))
        colors, color_numbers = colors_of("colors", colors)
        count = count_of([("corners", corners, 1), ("normals", normals, 1), ("colors", colors, 1)])
        triangles = c.Triangles(_text("name", name), count, pass_on(corners, 1), pass_on(normals, 1),
                                c.Look(pass_on(colors, 1), color_numbers, self._finish(finish)))
        self._session.call("rt_add_triangles", ctypes.byref(triangles))
        self._shapes += 1

    def text(self, text: str, name: str = "text") -> None:
        """Adds a part of the scene in the scene language, as a file would say it. `name` is for messages.

        Raises SceneError with code, `place` ("text:1:15") and `suggestion`; the scene is lost then.
        """
        data = _text("text", text)
        self._has_text = True
        self._session.call("rt_load_text", _text("name", name), data, len(data))
        self._shapes += 1

    def file(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Adds a part of the scene from a file. Raises FileError when it cannot be read, otherwise as `text`."""
        self._has_text = True
        self._session.call("rt_load_file", os.fsencode(path))
        self._shapes += 1

    # ---- camera and light

    def camera(self, location: Optional[Vector] = None, look_at: Optional[Vector] = None,
               up: Vector = (0.0, 1.0, 0.0), angle: Optional[float] = None, width: Optional[float] = None,
               fit: Union[bool, np.ndarray] = False, direction: Vector = (0.0, 0.0, -1.0), right_handed: bool = True,
               aperture: float = 0.0) -> None:
        """The camera, instead of the one before. Without any call, and without text, it is camera(fit=True).

        location, look_at  points; look_at is the middle of the picture
        angle     degrees across the picture, above 0 and less than 180
        width     instead of it: a parallel projection that is so many units wide
        fit       True, or points (n, 3): the camera goes where all shapes, or these points, just fill the picture,
                  looking along `direction`; angle is 40 unless it is given, and with width=0 the projection is parallel
        right_handed  coordinates are right-handed, as they are in most programs with particles; False: as in POV-Ray
        aperture  above 0: a lens, in focus at look_at; render then with samples
        """
        is_fit = fit is not False
        if is_fit and (location is not None or look_at is not None):
            raise UsageError("a camera that is fit has no location and look_at", suggestion="direction")
        if not is_fit and (location is None or look_at is None):
            raise UsageError("a camera needs location and look_at", suggestion="camera(fit=True)")
        if not is_fit and (angle is None) == (width is None):
            raise UsageError("a camera needs either angle or width")
        points = None if isinstance(fit, bool) else numbers("fit", fit, (None, 3)).reshape(-1, 3)
        if angle is not None and not 0 < angle < 180:
            raise SceneError(f"the angle of a camera must be above 0 and less than 180, not {angle!r}", "E0460",
                             "camera")
        self._camera = {
            "fit": is_fit, "points": points, "angle": angle, "width": width,
            "location": None if is_fit else _vector("location", location),
            "look_at": None if is_fit else _vector("look_at", look_at),
            "up": _vector("up", up), "direction": _vector("direction", direction),
            "right_handed": int(right_handed), "aperture": float(aperture),
        }
        self._set_camera = None

    def light(self, position: Vector, color: Union[float, Vector] = (1.0, 1.0, 1.0), radius: float = 0.0,
              size: int = 0, parallel_to: Optional[Vector] = None, shadowless: bool = False) -> None:
        """Adds a light at a point.

        color    of its light at any distance; a number is grey
        radius   above 0: a round area light of `size` x `size` points (4 x 4), with soft shadows
        parallel_to  a point: all its rays go from position to there, as the sun's
        """
        grey = numbers("color", color, (3,))
        light = c.Light(_vector("position", position), c.Vector(*np.broadcast_to(grey, 3).astype(float)),
                        _vector("parallel_to", (0, 0, 0) if parallel_to is None else parallel_to),
                        int(parallel_to is not None), int(shadowless), radius, size)
        self._session.call("rt_add_light", ctypes.byref(light))
        self._has_lights = True

    def sky(self, strength: float = 1.0, color: Union[float, Vector] = (1.0, 1.0, 1.0)) -> None:
        """Light from all sides, as of an even sky: ambient occlusion. Instead of the one before; 0 for none.

        strength  of the light that a surface gets which nothing covers, 0 or more; color multiplies it. It has no
                  highlights, and the background stays what it is. Render with samples: with one ray a pixel it is noisy
        """
        light = _light("strength", strength) * _light("color", color)
        self._session.call("rt_set_sky_light", c.Vector(*light))

    def outline(self, width: float = 1.5, color: Union[float, Vector] = 0.0) -> None:
        """Lines around shapes, 0 to 16 pixels wide, 0 for none: where one ends before something else, and where two
        meet at an angle. They stand before the background of images with alpha."""
        if not 0 <= width <= 16:
            raise SceneError(f"the width of outlines must be 0 to 16 pixels, not {width!r}", "E0460", "outline")
        self._session.call("rt_set_outline", width, c.Vector(*_light("color", color)))
        self._has_outline = True

    def depth_cue(self, strength: float = 0.6, color: Union[float, Vector, None] = None, near: float = 0.0,
                  far: float = 0.0) -> None:
        """Far shapes turn to one color: from nothing of it at `near` to `strength`, 0 to 1, of it at `far` and beyond.

        color      None: that of the background
        near, far  along the camera's direction; both 0: as far as the shapes but planes reach
        """
        if not 0 <= strength <= 1:
            raise SceneError(f"the strength of a depth cue must be 0 to 1, not {strength!r}", "E0460", "depth_cue")
        if not (near == far == 0 or 0 <= near < far < float("inf")):
            raise SceneError(f"near and far must be 0 or more, and near less than far, not {near!r} and {far!r}",
                             "E0460", "depth_cue")
        light = _light("color", 0.0 if color is None else color)
        cue = c.DepthCue(strength, int(color is not None), c.Vector(*light), near, far)
        self._session.call("rt_set_depth_cue", ctypes.byref(cue))

    def clear_lights(self) -> None:
        """Takes all lights of `light` and of texts away; the sky stays."""
        self._session.call("rt_clear_lights")

    def background(self, color: Union[float, Vector]) -> None:
        """What is seen where no shape is: three numbers, or four with alpha; a number is grey."""
        color = numbers("color", color, (None,))
        if color.shape not in ((), (1,), (3,), (4,)):
            raise UsageError(f"color must be 1, 3 or 4 numbers, not of the shape {color.shape}")
        light = list(np.broadcast_to(color, 3) if color.size == 1 else color[:3])
        transmit = 1 - float(color[3]) if color.size == 4 else 0.0
        self._session.call("rt_set_background", (ctypes.c_double * 4)(*map(float, light), transmit))
        self._has_background = True

    def box(self) -> Tuple[np.ndarray, np.ndarray]:
        """The least and the greatest corner of the box around all shapes but planes."""
        low, high = c.Vector(), c.Vector()
        if self._session.ask("rt_get_box", low, high) != c.OK:
            raise UsageError("no shape of the scene has a size, so there is no box around them")
        return np.array(low), np.array(high)

    def _has_box(self) -> bool:
        return self._session.ask("rt_get_box", c.Vector(), c.Vector()) == c.OK

    def _fitted(self, view: dict, aspect: float) -> c.Camera:
        if view["points"] is None:
            low, high = self.box()
            points = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)])
        else:
            points = view["points"].astype(np.float64)
        if not len(points) or not np.all(np.isfinite(points)):
            raise UsageError("fit needs points, all of them finite")
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        ahead, up = (np.array(view[name]) for name in ("direction", "up"))
        side = np.cross(ahead, up)
        if not np.linalg.norm(side) > 0:
            raise UsageError("direction and up of a camera must be two directions")
        ahead, side = ahead / np.linalg.norm(ahead), side / np.linalg.norm(side)
        top, offsets = np.cross(side, ahead), points - middle
        across, along = np.abs(offsets @ side), np.abs(offsets @ top)
        size = float(np.linalg.norm(offsets, axis=1).max()) or 1.0
        if view["width"] is not None:
            width = view["width"] or 2 * MARGIN * (float(max(across.max(), along.max() * aspect)) or size)
            location, angle = middle - 2 * size * ahead, 0.0
        else:
            angle, width = view["angle"] or FIT_ANGLE, 0.0
            slope = np.tan(np.radians(angle) / 2) / MARGIN
            distance = np.max(np.maximum(across, along * aspect) / slope - offsets @ ahead)
            location = middle - max(float(distance), size * 1.01) * ahead
        return c.Camera(c.Vector(*location), c.Vector(*middle), view["up"], angle, width, aspect,
                        view["right_handed"], view["aperture"])

    def _apply_camera(self, aspect: float) -> None:
        if self._camera is None and not self._has_text and self._has_box():
            self.camera(fit=True)
        view = self._camera
        if view is None:
            return
        key = (aspect, self._shapes if view["fit"] else 0)
        if self._set_camera == key and not view["fit"]:
            return
        if view["fit"]:
            camera = self._fitted(view, aspect)
        else:
            camera = c.Camera(view["location"], view["look_at"], view["up"], view["angle"] or 0.0,
                              view["width"] or 0.0, aspect, view["right_handed"], view["aperture"])
        self._session.call("rt_set_camera", ctypes.byref(camera), level=5)
        self._set_camera, self._view = key, camera

    def _apply_look(self, height: int, alpha: bool) -> None:
        """What a look says of light and lines where nobody else did, for the camera and size of now."""
        if self._look is None:
            return
        if not self._has_outline:
            self.outline(min(self._look.outline * height / 1000, 16.0))
            self._has_outline = False
        if not self._has_background:
            self.background((1.0, 1.0, 1.0, 0.0) if alpha else 1.0)
            self._has_background = False
        if self._look.key and not self._has_lights and not self._has_text and self._view is not None and self._shapes:
            place, radius = key_light(self._view, *self.box())
            self.clear_lights()
            self.light(place, self._look.key, radius=radius, size=32)
            self._has_lights = False

    # ---- the picture

    def render(self, width: int = 640, height: int = 480, *, samples: Optional[float] = None,
               target_error: Optional[float] = None, time_limit: Optional[float] = None, adaptive: bool = False,
               sampler: Optional[str] = None, filter: Optional[str] = None, seed: int = 0, alpha: Optional[bool] = None,
               planes: Sequence[str] = (), crop: Optional[Tuple[int, int, int, int]] = None, threads: int = 0,
               max_trace_level: int = 0,
               progress: Union[bool, Callable[[float], None], None] = None) -> Image:
        """Traces the scene. May be repeated; what did not change is not built again.

        width, height  pixels, 1 to 65535
        samples        rays a pixel; without it and the goals below, one through each pixel's middle, or as many as the
                       scene's look wants
        target_error   until the estimated root mean square error is no more than this, in linear light
        time_limit     seconds of tracing; whichever goal is met first ends the run
        adaptive       more samples where the error is
        sampler, filter, seed, max_trace_level  as the program's options of these names (docs/sampling.md)
        alpha          the image says how much each pixel shows of the background; None: no, but with a look of a clear
                       one, unless a goal is given, which leaves the background white
        planes         names of what else it tells of each pixel: "error" and "samples" of a sampled picture; "depth"
                       (distance from the eye, inf where nothing is seen), "normal" (unit, without bumps, of the side that
                       is seen), "object" (place among all shapes in the order in which they were added, from 1; 0 for
                       nothing) and "albedo" (color) of what is seen through the pixel's middle
        crop           (left, top, width, height): a part of the picture only
        threads        0: as many as the machine has; the picture does not depend on it
        progress       called with 0 to 1 meanwhile, from another thread; True: a bar, of tqdm where it is installed.
                       What it raises ends the run and comes out of render

        Ctrl-C ends a sampled run early: the image holds what is done, and its `end` is "interrupted". A run without
        samples then has no picture, and raises KeyboardInterrupt.
        """
        if not all(isinstance(side, (int, np.integer)) for side in (width, height)):
            raise UsageError(f"width and height are whole numbers of pixels, not {width!r} and {height!r}")
        if not (1 <= width <= 65535 and 1 <= height <= 65535):
            raise UsageError(f"width and height are 1 to 65535 pixels, not {width!r} and {height!r}")
        session = self._session
        session.call("rt_set_size", int(width), int(height))
        if crop is not None:
            if len(crop) != 4 or not (0 <= crop[0] < crop[0] + crop[2] <= width and
                                      0 <= crop[1] < crop[1] + crop[3] <= height):
                raise UsageError(f"crop is (left, top, width, height) within {width} x {height} pixels, not {crop!r}")
            session.call("rt_set_crop", *crop)
        has_goal = bool(target_error or time_limit or adaptive)
        if self._look is not None and samples is None and not (target_error or time_limit):
            samples = self._look.samples
        if alpha is None:
            alpha = self._look is not None and not self._has_background and not has_goal
        session.ask("rt_set_alpha", int(alpha))
        unknown = [name for name in planes if name not in c.PLANES]
        if isinstance(planes, str) or unknown:
            raise UsageError(f"planes is a list of names of {', '.join(c.PLANES)}, not {planes!r}")
        session.call("rt_set_planes", sum({c.PLANES[name][0] for name in planes}))
        sampling = c.Sampling(_text("sampler", sampler), _text("filter", filter), samples or 0.0, seed, int(adaptive),
                              target_error or 0.0, time_limit or 0.0, 0, 0, max_trace_level)
        if session.ask("rt_set_sampling", ctypes.byref(sampling)) != c.OK:
            raise UsageError(f"no sampling is like this: samples {samples!r}, target_error {target_error!r}, "
                             f"time_limit {time_limit!r}, adaptive {adaptive!r}, sampler {sampler!r}, "
                             f"filter {filter!r}, seed {seed!r}, max_trace_level {max_trace_level!r}",
                             suggestion="docs/sampling.md")
        self._apply_camera(width / height)
        self._apply_look(height, bool(alpha))
        bar = _Bar() if progress is True else None
        session.render(threads, bar or progress or None)
        if bar:
            bar.close()
        return self._image(planes)

    def _plane(self, name: str, shape: Tuple[int, int]) -> np.ndarray:
        plane, dtype, count = c.PLANES[name]
        values = np.empty(shape if count == 1 else shape + (count,), dtype)
        self._session.call("rt_get_plane", plane, values.ctypes.data, values.nbytes)
        return values

    def _image(self, planes: Sequence[str]) -> Image:
        width, height, error, summary = ctypes.c_int(), ctypes.c_int(), c.SamplingError(), c.Summary()
        self._session.ask("rt_pixels", ctypes.byref(width), ctypes.byref(height))
        shape = (height.value, width.value)
        address = self._session.ask("rt_transparency")
        clear = np.ctypeslib.as_array(ctypes.cast(address, c.FLOATS), shape) if address else None
        alpha = None if clear is None else 1 - clear
        told = {name: self._plane(name, shape) for name in planes}
        self._session.ask("rt_get_error", ctypes.byref(error))
        self._session.ask("rt_get_summary", ctypes.byref(summary))
        known = bool(error.known)
        pixels = _own(self._session.ask("rt_take_pixels", ctypes.byref(width), ctypes.byref(height)), shape + (3,))
        return Image(pixels, alpha, error.samples or 1.0, error.rmse if known else None,
                     (error.low, error.high) if known else None, c.ENDS[error.end],
                     {"prepare": summary.prepare_seconds, "trace": summary.trace_seconds},
                     told, {"trees": summary.trees, "refits": summary.refits})

    def dump(self) -> str:
        """The scene as text of the scene language, which gives the same records, bit for bit."""
        text = ctypes.c_char_p()
        self._session.call("rt_dump_scene", ctypes.byref(text))
        return text.value.decode("utf-8", "replace")


def _own(address: int, shape: Tuple[int, ...]) -> np.ndarray:
    """An array of pixels that the library gave away, which gives their memory back when nobody looks at it any more."""
    memory = (ctypes.c_float * int(np.prod(shape))).from_address(address)
    weakref.finalize(memory, c.LIBRARY.rt_free_pixels, address).atexit = False
    return np.frombuffer(memory, np.float32).reshape(shape)


class _Bar:
    """Progress on the terminal."""

    def __init__(self):
        self._last = 0.0
        try:
            with warnings.catch_warnings():  # where a notebook has no widgets, its bar is text, and tqdm says so
                warnings.simplefilter("ignore")
                from tqdm.auto import tqdm  # pylint: disable=import-outside-toplevel
            self._tqdm = tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")
        except ImportError:
            self._tqdm = None

    def __call__(self, done: float) -> None:
        if self._tqdm is not None:
            self._tqdm.update(done - self._last)
        else:
            sys.stderr.write(f"\r{100 * done:3.0f} %")
        self._last = done

    def close(self) -> None:
        if self._tqdm is not None:
            self._tqdm.update(1.0 - self._last)
            self._tqdm.close()
        else:
            sys.stderr.write("\r100 %\n")
