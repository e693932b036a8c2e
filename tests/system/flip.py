"""LDR-FLIP by the formulas of its paper as they stand: filters of two dimensions, every pixel on its own.

P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020, doi 10.1145/3406183.
SPDX-License-Identifier: MIT
"""
import math

PER_DEGREE = 0.7 * 3840 / 0.7 * math.pi / 180
TO_XYZ = ((0.4124564, 0.3575761, 0.1804375), (0.2126729, 0.7151522, 0.0721750), (0.0193339, 0.1191920, 0.9503041))
WHITE = [sum(row) for row in TO_XYZ]
GAUSSIANS = (((1, 0.0047), (0, 1e-5)), ((1, 0.0053), (0, 1e-5)), ((34.1, 0.04), (13.5, 0.025)))


def solve(matrix, right):
    """Cramer's rule."""
    def det(m):
        return (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))
    whole = det(matrix)
    return [det([[right[i] if j == k else matrix[i][j] for j in range(3)] for i in range(3)]) / whole for k in range(3)]


def xyz(linear):
    return [sum(m * c for m, c in zip(row, linear)) / white for row, white in zip(TO_XYZ, WHITE)]


def opponents(linear):
    x, y, z = xyz(linear)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def linear_of(y_y, c_x, c_z):
    y = (y_y + 16) / 116
    linear = solve(TO_XYZ, [(y + c_x / 500) * WHITE[0], y * WHITE[1], (y - c_z / 200) * WHITE[2]])
    return [min(max(value, 0), 1) for value in linear]


def lab(linear):
    def f(t):
        return t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29
    x, y, z = (f(value) for value in xyz(linear))
    lightness = 116 * y - 16
    return lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)


def hyab(a, b):
    return abs(a[0] - b[0]) + math.hypot(a[1] - b[1], a[2] - b[2])


def kernel(radius, value):
    return {(x, y): value(x, y) for x in range(-radius, radius + 1) for y in range(-radius, radius + 1)}


def blurring(terms):
    radius = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi ** 2)) * PER_DEGREE)
    taps = kernel(radius, lambda x, y: sum(
        a * math.sqrt(math.pi / b) * math.exp(-math.pi ** 2 * (x * x + y * y) / PER_DEGREE ** 2 / b) for a, b in terms))
    whole = sum(taps.values())
    return {at: value / whole for at, value in taps.items()}


def detecting(order):
    deviation = 0.5 * 0.082 * PER_DEGREE

    def value(x, y):
        bell = math.exp(-(x * x + y * y) / (2 * deviation ** 2))
        return -x * bell if order == 1 else (x * x / deviation ** 2 - 1) * bell
    taps = kernel(math.ceil(3 * deviation), value)
    above = sum(value for value in taps.values() if value > 0)
    below = -sum(value for value in taps.values() if value < 0)
    return {at: value / (above if value > 0 else below) for at, value in taps.items()}


def filtered(plane, width, height, taps):
    def at(x, y):
        return plane[min(max(y, 0), height - 1) * width + min(max(x, 0), width - 1)]
    return [sum(tap * at(x + i, y + j) for (i, j), tap in taps.items()) for y in range(height) for x in range(width)]


def view(width, height, values):
    """Of each pixel the colour as it is seen, the size of the edge and of the point."""
    pixels = [opponents(values[i:i + 3]) for i in range(0, len(values), 3)]
    blurred = [filtered([pixel[c] for pixel in pixels], width, height, blurring(GAUSSIANS[c])) for c in range(3)]
    light = [(pixel[0] + 16) / 116 for pixel in pixels]
    sizes = []
    for order in (1, 2):
        across = detecting(order)
        down = {(y, x): tap for (x, y), tap in across.items()}
        sizes.append([math.hypot(a, b) for a, b in zip(filtered(light, width, height, across),
                                                       filtered(light, width, height, down))])
    return [(lab(linear_of(*colour)), *size) for colour, size in zip(zip(*blurred), zip(*sizes))]


def flip(width, height, ours, theirs):
    """The mean over two pictures of linear values from 0 to 1."""
    most = hyab(lab((0, 1, 0)), lab((0, 0, 1))) ** 0.7
    total = 0
    for a, b in zip(view(width, height, ours), view(width, height, theirs)):
        colour = hyab(a[0], b[0]) ** 0.7
        colour = (0.95 / (0.4 * most) * colour if colour < 0.4 * most else
                  0.95 + (colour - 0.4 * most) / (0.6 * most) * 0.05)
        feature = (max(abs(a[1] - b[1]), abs(a[2] - b[2])) / math.sqrt(2)) ** 0.5
        total += colour ** (1 - feature)
    return total / (width * height)
