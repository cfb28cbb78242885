"""Bounces of thrown bodies against the true scene: was there something, and did the contact's normal point where
the true surface's does? A bounce is the first touch after a flight."""

import json

import numpy as np

from .draws import Draws
from .measures import Angles, degrees_of, percent

FLIGHT_S = 0.1  # without a touch before it counts as a bounce again
BOUNCE_SPEED = 0.3  # m/s
PHANTOM_DISTANCE = 0.05  # m: a person moves 4 cm in a frame
AHEAD_M = 0.05


def _thrown_cube(draws, index):
    """A 10 to 20 cm cube that flies towards a point of the room, released at its turn."""
    edge = draws.range(0.1, 0.2)
    side = index % 3 - 1.0  # from the left, the camera, the right
    z = 0.5 if side == 0.0 else 1.8
    position = draws.in_box((side * 0.9 - 0.2, -0.5, z - 0.1), (side * 0.9 + 0.2, 0.1, z + 0.3))
    target = draws.in_box((-1, -0.6, 2), (1, 0.8, 3.2))
    way = [b - a for a, b in zip(position, target)]
    length = (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]) ** 0.5
    direction = [x * (1.0 / length) for x in way]
    speed = draws.range(2.0, 5.0)
    return {"name": "cube_%d" % index, "shape": "box", "size": [edge] * 3, "release_time": 0.4 + 0.12 * index,
            "position": position, "velocity": [x * speed for x in direction],
            "angular_velocity": draws.in_box((-6, -6, -6), (6, 6, 6)),
            "collides_with_bodies": False}  # every bounce is one on the real scene


def scene_of(seed, count):
    """A scene that throws cubes into the room from many sides; an open border would ask for no floor behind what
    hides it."""
    draws = Draws(seed)
    return {"gravity": [0.0, 9.81, 0.0], "border": "extend",
            "bodies": [_thrown_cube(draws, i) for i in range(count)]}


def turn_scene(scene, source):
    """For a room that is not the old one: bodies fall to its floor, and what would start inside something starts
    before the camera, where nothing stands."""
    scene["gravity"] = [9.81 * x for x in source.down]
    for body in scene["bodies"]:
        if source.nearest([body["position"]], body["release_time"])[0][0] < 0.15:
            body["position"] = [0.0, 0.0, 0.4]


def write_scene(path, scene):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)


def _degrees(a, b):
    return float(degrees_of(np.dot(a, b)))


class Collisions:
    def __init__(self, source):
        self.source, self.camera = source, source.rig.depth
        self.last_touch, self.was_inside = {}, set()
        self.angles = Angles()
        self.bounces = self.phantom = self.right = self.unexplained = self.entries = 0
        self.off_m = 0.0

    def add(self, step, now):
        for contact in step.contacts:
            if contact.other == "body" or contact.impulse <= 0.0:
                continue
            was_flying = now - self.last_touch.get(contact.body, -FLIGHT_S) >= FLIGHT_S
            self.last_touch[contact.body] = now
            if was_flying and contact.approach_speed > BOUNCE_SPEED:
                self.judge(contact.point, contact.normal)
        self._count_entries([body for body in step.bodies if not body.is_held])

    def judge(self, point, normal):
        """At an edge of the scene all directions between its faces are right: there the true distance grows along
        the contact normal itself. 5 cm on a corner misplaced by 9 mm shows as 10 degrees."""
        distance, normals, _, _ = self.source.nearest([point, point + AHEAD_M * normal])
        self.bounces += 1
        if abs(distance[0]) > PHANTOM_DISTANCE:
            self.phantom += 1
            return
        self.off_m += abs(distance[0])
        degrees = _degrees(normal, normals[0])
        least = min(degrees, _degrees(normal, normals[1]))
        self.angles.add(np.array([degrees]))
        self.right += least <= 10.0
        self.unexplained += least > 30.0

    def _count_entries(self, bodies):
        """A body's centre inside something real; out of view nothing is known of the room, so bodies leave it."""
        if not bodies:
            return
        points = np.array([body.position for body in bodies])
        pixels = self.camera.project(points)
        in_view = np.all((pixels >= 0) & (pixels <= (self.camera.width - 1, self.camera.height - 1)), axis=1)
        inside = (self.source.nearest(points)[0] < 0) & in_view
        for body, is_inside in zip(bodies, inside):
            self.entries += bool(is_inside) and body.name not in self.was_inside
            (self.was_inside.add if is_inside else self.was_inside.discard)(body.name)

    def figures(self):
        count = self.angles.count
        return {"bounces": self.bounces, "bounces_phantom_percent": percent(self.phantom, self.bounces),
                "bounces_off_mm": 1e3 * self.off_m / count if count else float("nan"),
                "bounces_mean_deg": self.angles.mean(), "bounces_right_percent": percent(self.right, count),
                "bounces_within_10_percent": self.angles.within_percent(10.0),
                "bounces_over_30_percent": self.angles.wrong_percent(),
                "bounces_unexplained_percent": percent(self.unexplained, count), "entries": self.entries}
