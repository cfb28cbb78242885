"""Every section: what it is about, and who runs it."""

import importlib
import json
import os
import subprocess

# Seeds of the synthetic scenes are noise and throws; they are measured for both profiles.
SCENES = {
    "room": "a person walks in and reaches out",
    "empty": "nobody",
    "thesis": "a walking person before wall and column",
    "chair": "the chair is taken away after 4 s",
    "book": "a book held edge-on, then turned",
    "hand": "a hand close up",
    "steps": "room, by structured light: correlated noise in steps",
    "people": "room, with another person for every seed",
}
OTHERS = {
    "picture": "what hides bodies, at the colour camera",
    "simulator": "the simulated sensor beside table 5.1 of the thesis",
    "planes": "planes without noise, and one with holes",
    "plate": "a moving plate before a still wall",
    "physics": "bodies in free flight, at rest, pushed and thrown",
    "known": "models of known things: poses, what they hide, what hits them",
    "moving": "the camera moves: its pose against the map",
    "standing": "cameras that stand, and that are moved and put down",
    "hands": "scripted hands grasp, carry and throw",
    "grasps": "another's hands, drawn, grasp, begin to and do not, and move among bodies",
    "gestures": "palms, finger tips and gestures of scripted hands",
    "calibration": "cameras from pictures of a board, where they are known",
    "cameras": "two cameras that face each other, and the person between them",
    "map": "the room fused from a moving camera, against the true one",
    "sensed": "the same on what the sensor shows, against the true scene",
}
RANDOM = {
    "random": "rooms, people and sensors drawn at random",
    "push": "in them, what stood there lifts, sweeps and carries",
}
ALL = {**SCENES, **OTHERS, **RANDOM}

# Those in Python: function run(task) of the module gives rows of (scene, key, title, profile, value).
MODULES = {**dict.fromkeys((*SCENES, "random"), "rooms"), "simulator": "points", "planes": "planes", "plate": "planes",
           "cameras": "cameras", "normals": "public", "real": "real"}

HALVES = ("random", "real")  # the rest of them is in C: throws and pushes, and what real.py names

SECTIONS_PROGRAM = os.environ.get("RELIEF_LAB_SECTIONS", "")


class Failed(Exception):
    """One line that says what went wrong, and the exit status."""

    def __init__(self, line, status=1):
        super().__init__(line)
        self.status = status


class Task:
    """One section with one seed; profiles: of ("live", "thesis")."""

    def __init__(self, section, seed, profiles, frames=0, oracle=None, settings=(), is_whole=False, folder=None,
                 silhouettes=None):
        self.section, self.seed, self.profiles, self.frames = section, seed, profiles, frames
        self.oracle, self.settings, self.is_whole = oracle, settings, is_whole
        self.folder, self.silhouettes = folder, silhouettes

    def words(self):
        """The command line of the section in C."""
        profile = self.profiles[0] if len(self.profiles) == 1 else "both"
        words = [self.section, "--seed", str(self.seed), "--profile", profile, "--frames", str(self.frames)]
        for option, value in (("--oracle", self.oracle), ("--folder", self.folder), ("--silhouettes", self.silhouettes)):
            words += [option, value] if value else []
        for text in self.settings:
            words += ["--set", text]
        return words + (["--whole"] if self.is_whole else [])


def run_program(words):
    done = subprocess.run([SECTIONS_PROGRAM, "eval", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines()
        line = lines[-1] if lines else "relief-lab: section %s ended with status %d" % (words[0], done.returncode)
        raise Failed(line, done.returncode)
    return done.stdout


def machine():
    return json.loads(run_program(["machine"]))


def check_settings(settings):
    """Failed when one is not NAME=VALUE of a setting of the surface."""
    run_program(["machine", *(word for text in settings for word in ("--set", text))])


def real_row(words):
    part, key, title, relation, goal, relief, baseline, name = words
    return {"part": part, "key": key, "title": title, "relation": relation, "goal": float(goal),
            "relief": float(relief), "baseline": float(baseline), "baseline_name": name}


def run(task):
    """(rows, rows of real clips) of a task."""
    rows, real = [], []
    if task.section in MODULES:
        module = importlib.import_module("relief_lab." + MODULES[task.section])
        (real if task.section == "real" else rows).extend(module.run(task))
    if task.section in MODULES and task.section not in HALVES:
        return rows, real
    for line in run_program(task.words()).splitlines():
        kind, *words = line.split("\t")
        if kind == "row":
            rows.append((*words[:4], float(words[4])))
        elif kind == "real":
            real.append(real_row(words))
    return rows, real
