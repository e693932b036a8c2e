"""Scenes that programs draw by chance, each by its own numbers: pictures of both, held to be of one distribution.

A picture is cut into blocks of BLOCK × BLOCK pixels, whose means are what is compared. Where some of the pictures
differ, the sum over all blocks and colours of z², the difference of both programs' means against what the pictures
spread, is held against that of every other way to deal the same pictures out to two programs: the true one must not be
the greatest of them all. If both draw from one distribution that happens once in SPLITS times, however blocks hang
together and whatever their distribution is. Where all pictures are the same, the means must be.

POV-Ray's numbers belong to the threads that draw its blocks of pixels: other sizes of these give other numbers, as does
`--seed` to rtlang. Its rays through a lens are no such numbers: they are the same in every picture and nearly so in
every pixel, 0.03 pixels aside in the mean, so that pictures of both are not of one distribution. There the size of the
lens is found: POV-Ray's picture less rtlang's is, by least squares, so much of what moving the picture changes, and so
much of what a lens of another size does. SPDX-License-Identifier: MIT
"""
import itertools
import math
import os
import re

import pictures

BLOCK = 8
DRAWS = 8  # pictures of each program
SPLITS = math.comb(2 * DRAWS, DRAWS) // 2  # exchanging the two is the same
SIZES = [11, 13, 17, 19, 23, 27, 29, 31, 37, 41, 43, 47, 53, 59, 61, 64]  # of POV-Ray's blocks
STILL = 0.25   # of 65535: where the means spread less, nothing is left to chance
CODE_BAR = 2.0 # by which such blocks may differ
MOST_APART = 1e-3  # of a picture's pixels
LENS_STEP = 0.05
LENS_BAR = 0.025  # share by which POV-Ray's lens may seem wider or narrower
LENS_RAYS = [300, 400, 500]  # of POV-Ray's pictures, each with other rays; of rtlang's the middle one
WORDS = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"|\bjitter\b(?:\s+[\d.]+)?'
                   r'|\bcrand\s+[-+]?[\d.]+'
                   r'|\b(?:aperture|blur_samples)\s+[\d.]+(?:\s*,\s*\d+)?', re.DOTALL)


def without(text):
    """A scene's text without the words that leave it to chance."""
    return WORDS.sub(lambda found: found.group() if found.group().startswith(("//", "/*", '"')) else " ", text)


def has_lens(path):
    """Whether a camera's lens is among the words that `without` leaves out."""
    with open(path, encoding="latin-1") as file:
        found = WORDS.findall(file.read())
    return any(word.startswith("aperture") for word in found)


def pixels_apart(scene, folder, folders, size):
    """The pixels in which a scene without chance differs, where they are few: what they show has another cause."""
    pair = [os.path.join(folder, name) for name in ("ours.png", "theirs.png")]
    pictures.render_rtlang(scene, pair[0], folders, *size, folder=os.path.dirname(scene))
    pictures.render_povray(scene, pair[1], folders, *size, folder=os.path.dirname(scene))
    ours, theirs = (pictures.read_png(path, depths=(16,))[2] for path in pair)
    apart = {i // 3 for i, (one, other) in enumerate(zip(ours, theirs)) if abs(one - other) > CODE_BAR}
    return apart if len(apart) <= MOST_APART * size[0] * size[1] else set()


def block_means(path, apart=()):
    """The means of a picture's blocks, in codes of 65535, by colour, as if the pixels `apart` were black."""
    width, height, values = pictures.read_png(path, depths=(16,))
    for i in apart:
        values[3 * i:3 * i + 3] = 0, 0, 0
    means = []
    for top in range(0, height, BLOCK):
        for left in range(0, width, BLOCK):
            rows = range(top, min(top + BLOCK, height))
            columns = min(left + BLOCK, width) - left
            for colour in range(3):
                total = sum(sum(values[3 * (y * width + left) + colour:3 * (y * width + left + columns):3])
                            for y in rows)
                means.append(total / (columns * len(rows)))
    return means


def with_lens(text, factor, rays):
    """A scene's text with a lens of another size and so many rays a pixel."""
    def change(found):
        word = found.group()
        if word.startswith("aperture"):
            return f"aperture {float(word.split()[1]) * factor}"
        return f"blur_samples {rays} variance 0" if word.startswith("blur_samples") else word

    return WORDS.sub(change, text)


def solve(rows):
    """The x of the least squares of rows (b, a1, a2, …): b = a·x."""
    count = len(rows[0]) - 1
    sums = [[sum(row[i] * row[j] for row in rows) for j in (*range(1, count + 1), 0)] for i in range(1, count + 1)]
    for i in range(count):
        sums[i] = [each / sums[i][i] for each in sums[i]]
        for j in range(count):
            if j != i:
                factor = sums[j][i]
                sums[j] = [a - factor * b for a, b in zip(sums[j], sums[i])]
    return [row[count] for row in sums]


def lens_error(scene, folder, folders, size, factor=1.0):
    """The share by which POV-Ray's lens seems wider than rtlang's, whose own is `factor` times what the scene says."""
    with open(scene, encoding="latin-1") as file:
        text = file.read()
    copy = os.path.join(os.path.dirname(scene), "lens_of_" + os.path.basename(scene))
    picture = os.path.join(folder, "lens.png")

    def draw(program, scale, rays, **how):
        with open(copy, "w", encoding="latin-1") as file:
            file.write(with_lens(text, scale, rays))
        program(copy, picture, folders, *size, folder=os.path.dirname(scene), **how)
        return pictures.read_png(picture, depths=(16,))

    middle, narrow, wide = (draw(pictures.render_rtlang, factor * scale, LENS_RAYS[1], more=["--seed=1"])[2]
                            for scale in (1, 1 - LENS_STEP, 1 + LENS_STEP))
    found = []
    for rays in LENS_RAYS:
        width, height, theirs = draw(pictures.render_povray, 1, rays)
        inner = (3 * (y * width + x) + colour
                 for y in range(1, height - 1) for x in range(1, width - 1) for colour in range(3))
        rows = [(theirs[i] - middle[i], middle[i + 3] - middle[i - 3], middle[i + 3 * width] - middle[i - 3 * width],
                 (wide[i] - narrow[i]) / (2 * LENS_STEP)) for i in inner]
        found.append(solve(rows)[2])
    return sum(found) / len(found)


def draw_rtlang(scene, folder, folders, size, count=DRAWS, apart=()):
    picture, found = os.path.join(folder, "ours.png"), []
    for seed in range(1, count + 1):
        pictures.render_rtlang(scene, picture, folders, *size, more=[f"--seed={seed}"], folder=os.path.dirname(scene))
        found.append(block_means(picture, apart))
    return found


def draw_povray(scene, folder, folders, size, sizes=tuple(SIZES[:DRAWS]), apart=()):
    picture, found = os.path.join(folder, "theirs.png"), []
    for each in sizes:
        pictures.render_povray(scene, picture, folders, *size, folder=os.path.dirname(scene),
                               more=[f"Render_Block_Size={each}"])
        found.append(block_means(picture, apart))
    return found


def products(draws):
    """(sums over blocks of the products of each two draws' deviations in units of their spread, how many blocks, how
    many others differ)."""
    count = len(draws)
    sums = [[0.0] * count for _ in draws]
    loose = differ = 0
    for block in zip(*draws):
        mean = sum(block) / count
        apart = [value - mean for value in block]
        variance = sum(each * each for each in apart) / (count - 1)
        if variance <= STILL * STILL:
            half = count // 2
            differ += abs(sum(block[:half]) - sum(block[half:])) / half > CODE_BAR
            continue
        loose += 1
        for i, one in enumerate(apart):
            for j in range(i + 1):
                sums[i][j] += one * apart[j] / variance
    for i, j in itertools.combinations(range(count), 2):
        sums[i][j] = sums[j][i]
    return sums, loose, differ


def judge(ours, theirs):
    """{"like": whether they are of one distribution, "rank": how many of the "splits" have a sum that is not less than
    the true one's, "mean": of its z², "loose": block means by chance, "differ": others that differ}."""
    sums, loose, differ = products(ours + theirs)
    half = len(ours)

    def statistic(members):
        signs = [1 if i in members else -1 for i in range(2 * half)]
        return sum(signs[i] * signs[j] * sums[i][j] for i in range(2 * half) for j in range(2 * half))

    true = statistic(set(range(half)))
    others = [statistic({0, *rest}) for rest in itertools.combinations(range(1, 2 * half), half - 1)]
    rank = sum(each >= true - 1e-9 * abs(true) for each in others)
    return {"like": differ == 0 and (loose == 0 or rank > 1), "rank": rank, "splits": len(others), "loose": loose,
            "mean": true / (2 * half * loose) if loose else 0.0, "differ": differ}


def words(found):
    return (f"{found['loose']} block means by chance, mean z² {found['mean']:.2f}, greater or equal in {found['rank']} "
            f"of {found['splits']} splits, {found['differ']} others differ")
