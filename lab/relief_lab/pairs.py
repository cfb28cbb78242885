"""`relief-lab pairs`: what makes a picture believed? Pairs of one picture with and without a part of it, from real
clips, as a page that shows them in any order and counts which were taken for real."""

import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np
import relief

from .sections import SECTIONS_PROGRAM, Failed
from .table import LAB
from .words import Parser, usage

HELP = """usage: relief-lab pairs [FOLDER] [OPTIONS]

Makes FOLDER/index.html (default: out/pairs): pairs of pictures of virtual things in real clips, one with and one
without a part of the picture. Open the page, say which of the two looks real; at the end it prints for each part
how often the picture that has it was taken for real. Nothing is sent anywhere.

  --source CLIP --scene FILE --at N[,N...]   one clip instead of those of the project: these frames

The parts: grain (the camera's noise and blur on bodies), place (light of the room about each body), shadow (contact
darkening and shadows), penumbra (their soft edges), gloss (what is mirrored, and highlights).

example:
  relief-lab pairs /tmp/pairs && xdg-open /tmp/pairs/index.html
"""

ROOT = os.path.dirname(LAB)
CLIPS = (("clips/table", "scenes/table_toys.json", (30, 60, 120)), ("clips/desk", "scenes/desk.json", (10, 90, 110)))
PARTS = {
    "grain": "the camera's noise and blur",
    "place": "light of the place",
    "shadow": "contact darkening and shadows",
    "penumbra": "soft edges of shadows",
    "gloss": "gloss and metal",
}
SEEN = 6  # steps of a code: less is no difference
LEAST = 40  # pixels that must differ
BESIDE = 32  # pixels around them that are shown


class Clip:
    """The same frames, drawn in several ways."""

    def __init__(self, source, scene, frames, folder):
        self.source, self.scene, self.frames, self.folder = source, scene, frames, folder
        self.count = 0

    def draw(self, scene, *options):
        """{frame: RGBA, float}"""
        self.count += 1
        folder = os.path.join(self.folder, str(self.count))
        program = os.path.join(os.path.dirname(os.path.dirname(SECTIONS_PROGRAM)), "app", "relief")
        at = "+".join(map(str, self.frames))
        words = [program, "run", self.source, "--scene", scene, "--headless", "--quiet", "--frames",
                 str(max(self.frames) + 1), "--pictures", "%s?at=%s" % (folder, at), *options]
        done = subprocess.run(words, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            line = done.stderr.strip().splitlines()[-1].removeprefix("relief: ")
            raise Failed("relief-lab pairs: %s" % line, done.returncode)
        return {n: relief.read_picture(os.path.join(folder, "%06d.png" % n)).astype(np.float64) for n in self.frames}

    def matt_scene(self):
        """The scene beside a copy of its models, which mirror nothing."""
        folder = os.path.join(self.folder, "matt")
        shutil.copytree(os.path.dirname(os.path.abspath(self.scene)), folder)
        for base, _, names in os.walk(folder):
            for name in names:
                if name.endswith(".gltf"):
                    make_matt(os.path.join(base, name))
        return os.path.join(folder, os.path.basename(self.scene))


def make_matt(path):
    with open(path, encoding="utf-8") as file:
        model = json.load(file)
    for material in model.get("materials", ()):
        pbr = material.setdefault("pbrMetallicRoughness", {})
        pbr.pop("metallicRoughnessTexture", None)
        pbr.update(metallicFactor=0, roughnessFactor=1)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(model, file)


def light_left(whole, real):
    """Share of the room's light that the bodies leave."""
    return np.minimum((whole.sum(-1, keepdims=True) + 1.0) / (real.sum(-1, keepdims=True) + 1.0), 1.0)


def shaded(whole, real, shown):
    """The room with its shadows, also in pixels that a body covers in part: as dark as beside them."""
    left = np.where(shown > 0.0, 1.0, light_left(whole, real))
    around = [np.roll(left, (y, x), (0, 1)) for y in range(-2, 3) for x in range(-2, 3)]
    return real * np.where(shown > 0.0, np.min(around, 0), left)


def hard_shadows(whole, real):
    """Where more than half of what is lost in the middle of shadows is lost, all of that is."""
    left = light_left(whole, real)
    dark = left[left < 0.95]
    deep = np.percentile(dark, 40) if dark.size else 1.0
    return real * np.where(left < 0.5 * (1.0 + deep), deep, 1.0)


def without_parts(clip):
    """(frame, part, the picture, the picture without the part)"""
    empty = os.path.join(clip.folder, "empty.json")
    with open(empty, "w", encoding="utf-8") as file:
        file.write('{"bodies": []}')
    full, bodies = clip.draw(clip.scene), clip.draw(clip.scene, "--view", "bodies")
    room, alike = clip.draw(empty), clip.draw(clip.scene, "--shade", "cast")
    matt = clip.draw(clip.matt_scene())
    for n in clip.frames:
        whole, real, own = full[n][..., :3], room[n][..., :3], bodies[n][..., :3]
        shown = bodies[n][..., 3:] / 255.0
        yield n, "grain", whole, shown * own + (1.0 - shown) * shaded(whole, real, shown)
        yield n, "place", whole, alike[n][..., :3]
        yield n, "shadow", whole, shown * whole + (1.0 - shown) * real
        yield n, "penumbra", whole, shown * whole + (1.0 - shown) * hard_shadows(whole, real)
        yield n, "gloss", whole, matt[n][..., :3]


def window_of(a, b):
    """Rows and columns of what differs, with what is around; None when it is too little."""
    off = np.abs(a - b).max(-1) >= SEEN
    if off.sum() < LEAST:
        return None
    rows, columns = np.nonzero(off.any(1))[0], np.nonzero(off.any(0))[0]
    return (slice(max(rows[0] - BESIDE, 0), rows[-1] + BESIDE), slice(max(columns[0] - BESIDE, 0), columns[-1] + BESIDE))


def write_png(path, pixels):
    """RGB, 8 bits."""
    data = np.clip(np.rint(pixels), 0, 255).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in data)
    head = struct.pack(">IIBBBBB", data.shape[1], data.shape[0], 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, chunk in ((b"IHDR", head), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b"")):
            file.write(struct.pack(">I", len(chunk)) + kind + chunk + struct.pack(">I", zlib.crc32(kind + chunk)))


def write_pairs(clips, folder):
    pairs = []
    for source, scene, frames in clips:
        with tempfile.TemporaryDirectory() as work:
            clip = Clip(source, scene, frames, work)
            for _, part, whole, less in without_parts(clip):
                window = window_of(whole, less)
                if window is not None:
                    names = ["%02d%s.png" % (len(pairs), letter) for letter in "ab"]
                    write_png(os.path.join(folder, names[0]), whole[window])
                    write_png(os.path.join(folder, names[1]), less[window])
                    pairs.append({"part": part, "with": names[0], "without": names[1]})
    return pairs


def main(words):
    parser = Parser("pairs", HELP)
    parser.add_argument("folder", nargs="?", default=os.path.join("out", "pairs"))
    for name in ("--source", "--scene", "--at"):
        parser.add_argument(name)
    options = parser.parse(words)
    clips = [(os.path.join(ROOT, source), os.path.join(ROOT, scene), frames) for source, scene, frames in CLIPS]
    if options.source or options.scene or options.at:
        frames = (options.at or "").split(",")
        if not options.source or not options.scene or not all(n.isdigit() for n in frames):
            usage("pairs", "--source, --scene and --at, frames such as 10,60, belong together")
        clips = [(options.source, options.scene, sorted(map(int, frames)))]
    os.makedirs(options.folder, exist_ok=True)
    pairs = write_pairs(clips, options.folder)
    page = os.path.join(options.folder, "index.html")
    with open(os.path.join(LAB, "relief_lab", "pairs.html"), encoding="utf-8") as file:
        text = file.read()
    with open(page, "w", encoding="utf-8") as file:
        file.write(text.replace("PAIRS", json.dumps(pairs)).replace("PARTS", json.dumps(PARTS)))
    print("%s: %d pairs of %d parts" % (page, len(pairs), len({pair["part"] for pair in pairs})))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
