#!/usr/bin/env python3
"""Makes the models of scenes/models that are ours: duck.gltf, mug.obj with mug.mtl and mug.png,
chair.obj, and toys: balls that share ball.bin, a die, a block, a tin and a bear.

usage: scenes/models/make.py [FOLDER]     (default: its own)

The duck is a smooth union of ellipsoids, meshed by surface nets (Gibson 1998); its texture is
painted as seen from the side, as is the bear. The mug is a turned profile with a bent handle. The
chair is the synthetic room's (src/sim/room.c). Only Python's standard library is used, and the same
files come out every time.
"""
import base64
import json
import math
import os
import struct
import sys
import zlib


# ---- vectors and pictures ------------------------------------------------------------------------
def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def add(a, b, scale=1.0):
    return [x + y * scale for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def mix(a, b, share):
    return [x + (y - x) * share for x, y in zip(a, b)]


def smooth(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3.0 - 2.0 * t)


def png(size, pixel):
    """RGB PNG of (width, height); pixel(x, y) gives three numbers 0..255."""
    width, height = size
    rows = b''
    for y in range(height):
        rows += b'\0' + bytes(int(c + 0.5) for x in range(width) for c in pixel(x, y))

    def chunk(name, data):
        body = name + data
        return struct.pack('>I', len(data)) + body + struct.pack('>I', zlib.crc32(body))

    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(rows, 9)) + chunk(b'IEND', b''))


# ---- the duck: y up, z forward, as glTF wants it -------------------------------------------------
def ellipsoid(p, center, radii):
    q = sub(p, center)
    k0 = math.sqrt(sum((x / r) ** 2 for x, r in zip(q, radii)))
    k1 = math.sqrt(sum((x / (r * r)) ** 2 for x, r in zip(q, radii)))
    return k0 * (k0 - 1.0) / k1 if k1 > 0.0 else -min(radii)


def union(a, b, width):
    h = max(width - abs(a - b), 0.0) / width
    return min(a, b) - h * h * width * 0.25


def tail(p):
    q = sub(p, [0.0, 0.50, -0.50])
    s, c = math.sin(0.75), math.cos(0.75)
    turned = [q[0], c * q[1] + s * q[2], c * q[2] - s * q[1]]
    return ellipsoid(turned, [0, 0, 0], [0.17, 0.08, 0.24])


def duck(p):
    p = [abs(p[0]), p[1], p[2]]
    d = ellipsoid(p, [0, 0.40, -0.02], [0.41, 0.35, 0.55])
    d = union(d, tail(p), 0.18)
    d = union(d, ellipsoid(p, [0, 0.92, 0.27], [0.29, 0.29, 0.30]), 0.14)
    d = union(d, ellipsoid(p, [0.37, 0.47, -0.08], [0.10, 0.19, 0.33]), 0.05)
    d = union(d, ellipsoid(p, [0, 0.87, 0.60], [0.17, 0.055, 0.17]), 0.05)
    return max(d, 0.10 - p[1]) if d < 0.10 - p[1] else d


def gradient(field, p, step=1e-4):
    g = []
    for i in range(3):
        a, b = list(p), list(p)
        a[i] += step
        b[i] -= step
        g.append(field(a) - field(b))
    return unit(g)


def surface_net(field, low, high, cells):
    """One vertex in every cell that the surface crosses, one quad at every edge that crosses it."""
    step = [(h - l) / n for l, h, n in zip(low, high, cells)]
    value = {}

    def at(i, j, k):
        if (i, j, k) not in value:
            value[i, j, k] = field([low[0] + i * step[0], low[1] + j * step[1], low[2] + k * step[2]])
        return value[i, j, k]

    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    edges = [(a, b) for a in corners for b in corners if a < b and sum(x != y for x, y in zip(a, b)) == 1]
    points, place, quads = [], {}, []
    for i in range(cells[0]):
        for j in range(cells[1]):
            for k in range(cells[2]):
                total, count = [0.0, 0.0, 0.0], 0
                for a, b in edges:
                    va, vb = at(i + a[0], j + a[1], k + a[2]), at(i + b[0], j + b[1], k + b[2])
                    if (va < 0) != (vb < 0):
                        total = add(total, mix(a, b, va / (va - vb)))
                        count += 1
                if count:
                    cell = [x / count for x in total]
                    place[i, j, k] = len(points)
                    points.append([l + (n + c) * s for l, n, c, s in zip(low, (i, j, k), cell, step)])
    for i, j, k in sorted(place):
        for axis in range(3):
            b, c = (axis + 1) % 3, (axis + 2) % 3
            here = [i, j, k]
            there = list(here)
            there[axis] += 1
            inside, outside = at(*here) < 0, at(*there) < 0
            ring = []
            for db, dc in ((0, 0), (1, 0), (1, 1), (0, 1)):
                cell = list(here)
                cell[b] -= db
                cell[c] -= dc
                ring.append(place.get(tuple(cell)))
            if inside != outside and None not in ring:
                quads.append(ring if inside else ring[::-1])
    return points, quads


def paint_duck(y, z):
    """Colour of the duck's side at height y and z to the front."""
    yellow, deep = [255, 214, 48], [240, 166, 20]
    color = mix(yellow, deep, 0.75 * smooth(0.55, 0.12, y))
    wing = ((z + 0.08) / 0.36) ** 2 + ((y - 0.47) / 0.22) ** 2
    feather = 0.5 + 0.5 * math.cos(26.0 * (z + 0.6 * y))
    color = mix(color, deep, smooth(1.05, 0.92, wing) * (0.30 + 0.30 * smooth(0.55, 0.9, feather)))
    bill = smooth(0.475, 0.50, z) * smooth(0.76, 0.785, y) * smooth(0.965, 0.94, y)
    color = mix(color, [240, 98, 24], bill)
    color = mix(color, [150, 52, 12], bill * smooth(0.012, 0.004, abs(y - 0.872)))
    eye = math.hypot(z - 0.385, y - 1.005)
    color = mix(color, [255, 255, 255], smooth(0.078, 0.066, eye))
    color = mix(color, [28, 26, 34], smooth(0.052, 0.042, math.hypot(z - 0.398, y - 1.0)))
    color = mix(color, [255, 255, 255], smooth(0.018, 0.011, math.hypot(z - 0.412, y - 1.022)))
    return mix(color, [250, 130, 90], 0.55 * smooth(0.07, 0.02, math.hypot(z - 0.37, y - 0.885)))


DUCK_LOW, DUCK_HIGH = [-0.52, 0.04, -0.84], [0.52, 1.28, 0.84]


def duck_texel(x, y):
    v, u = (y + 0.5) / 256, (x + 0.5) / 256
    return paint_duck(DUCK_HIGH[1] + (DUCK_LOW[1] - DUCK_HIGH[1]) * v,
                      DUCK_LOW[2] + (DUCK_HIGH[2] - DUCK_LOW[2]) * u)


def write_duck(path):
    points, quads = surface_net(duck, DUCK_LOW, DUCK_HIGH, [16, 19, 26])
    normals = []
    for i, p in enumerate(points):
        for _ in range(3):
            p = add(p, gradient(duck, p), -duck(p))
        points[i] = p
        normals.append(gradient(duck, p))
    triangles = []
    for q in quads:
        a, b, c, d = q
        short = dot(sub(points[a], points[c]), sub(points[a], points[c])) < dot(
            sub(points[b], points[d]), sub(points[b], points[d]))
        triangles += [a, b, c, a, c, d] if short else [a, b, d, b, c, d]
    uv = [((p[2] - DUCK_LOW[2]) / (DUCK_HIGH[2] - DUCK_LOW[2]),
           (DUCK_HIGH[1] - p[1]) / (DUCK_HIGH[1] - DUCK_LOW[1])) for p in points]
    parts = [b''.join(struct.pack('<3f', *p) for p in points),
             b''.join(struct.pack('<3f', *n) for n in normals),
             b''.join(struct.pack('<2f', *t) for t in uv),
             struct.pack('<%dH' % len(triangles), *triangles)]
    parts[3] += b'\0' * (-len(parts[3]) % 4)
    parts.append(png((256, 256), duck_texel))
    starts = [sum(len(p) for p in parts[:i]) for i in range(5)]
    views = [{'buffer': 0, 'byteOffset': s, 'byteLength': len(p)} for s, p in zip(starts, parts)]
    count = len(points)
    low = [min(p[i] for p in points) for i in range(3)]
    high = [max(p[i] for p in points) for i in range(3)]
    single = struct.Struct('<3f')
    document = {
        'asset': {'version': '2.0', 'generator': 'scenes/models/make.py'},
        'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0, 'name': 'duck'}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2},
                                    'indices': 3, 'material': 0}]}],
        'materials': [{'name': 'rubber', 'pbrMetallicRoughness': {
            'baseColorTexture': {'index': 0}, 'metallicFactor': 0, 'roughnessFactor': 0.3}}],
        'textures': [{'source': 0}], 'images': [{'bufferView': 4, 'mimeType': 'image/png'}],
        'accessors': [
            {'bufferView': 0, 'componentType': 5126, 'count': count, 'type': 'VEC3',
             'min': single.unpack(single.pack(*low)), 'max': single.unpack(single.pack(*high))},
            {'bufferView': 1, 'componentType': 5126, 'count': count, 'type': 'VEC3'},
            {'bufferView': 2, 'componentType': 5126, 'count': count, 'type': 'VEC2'},
            {'bufferView': 3, 'componentType': 5123, 'count': len(triangles), 'type': 'SCALAR'}],
        'bufferViews': views,
        'buffers': [{'byteLength': sum(len(p) for p in parts),
                     'uri': 'data:application/octet-stream;base64,' +
                            base64.b64encode(b''.join(parts)).decode()}]}
    with open(path, 'w', encoding='utf-8') as out:
        json.dump(document, out, separators=(',', ':'))
        out.write('\n')
    return len(triangles) // 3


# ---- the mug: y down, as OBJ is taken ------------------------------------------------------------
SLICES = 36
# Radius, height above the table, metres; v of the texture: the lower half is painted, the upper
# half is glaze. From the middle of the bottom outside to the middle of the bottom inside.
PROFILE = [(0.0, 0.0, 0.55), (0.034, 0.0, 0.60), (0.038, 0.004, 0.0), (0.040, 0.030, 0.16),
           (0.041, 0.060, 0.32), (0.042, 0.092, 0.48), (0.0405, 0.095, 0.62), (0.039, 0.092, 0.66),
           (0.0375, 0.050, 0.75), (0.036, 0.012, 0.85), (0.030, 0.006, 0.90), (0.0, 0.005, 0.98)]


def mug_texel(x, y):
    u, v = (x + 0.5) / 512, 1.0 - (y + 0.5) / 256
    cream, blue, red = [248, 240, 224], [48, 92, 160], [206, 60, 52]
    if v > 0.5:
        return cream
    color = mix(cream, blue, smooth(0.050, 0.045, abs(v - 0.06)) + smooth(0.030, 0.025, abs(v - 0.44)))
    cell = (u * 8.0) % 1.0 - 0.5
    a, b = cell / 0.34, (v - 0.245) / 0.068
    heart = (a * a + b * b - 1.0) ** 3 - a * a * b * b * b
    return mix(color, red, smooth(0.04, -0.04, heart))


def write_mug(folder):
    lines = ['# Made by scenes/models/make.py: a mug, y down, metres.', 'mtllib mug.mtl', 'usemtl glaze']
    vertices, texels, faces = [], [], []
    for radius, height, v in PROFILE:
        for i in range(SLICES + 1):
            angle = 2.0 * math.pi * i / SLICES
            vertices.append([radius * math.cos(angle), -height, radius * math.sin(angle)])
            texels.append([i / SLICES, v])
    for ring in range(len(PROFILE) - 1):
        for i in range(SLICES):
            a = ring * (SLICES + 1) + i
            quad = [a, a + 1, a + SLICES + 2, a + SLICES + 1]
            if PROFILE[ring][0] == 0.0:
                quad = [quad[0], quad[2], quad[3]]
            elif PROFILE[ring + 1][0] == 0.0:
                quad = quad[:3]
            faces.append(quad)
    first, around, along = len(vertices), 10, 14
    for k in range(along + 1):
        bend = math.pi * (k / along - 0.5)
        center = [0.038 + 0.030 * math.cos(bend), -0.050 - 0.030 * math.sin(bend), 0.0]
        out = [math.cos(bend), -math.sin(bend), 0.0]
        for i in range(around + 1):
            angle = 2.0 * math.pi * i / around
            p = add(center, out, 0.0045 * math.cos(angle))
            vertices.append([p[0], p[1], 0.007 * math.sin(angle)])
            texels.append([i / around, 0.52 + 0.02 * k / along])
    for k in range(along):
        for i in range(around):
            a = first + k * (around + 1) + i
            faces.append([a, a + 1, a + around + 2, a + around + 1])
    lines += ['v %.5f %.5f %.5f' % tuple(p) for p in vertices]
    lines += ['vt %.4f %.4f' % tuple(t) for t in texels]
    lines += ['f ' + ' '.join('%d/%d' % (i + 1, i + 1) for i in face) for face in faces]
    with open(os.path.join(folder, 'mug.obj'), 'w', encoding='utf-8') as out:
        out.write('\n'.join(lines) + '\n')
    with open(os.path.join(folder, 'mug.mtl'), 'w', encoding='utf-8') as out:
        out.write('# Made by scenes/models/make.py.\nnewmtl glaze\nKd 1 1 1\nPr 0.12\nmap_Kd mug.png\n')
    with open(os.path.join(folder, 'mug.png'), 'wb') as out:
        out.write(png((512, 256), mug_texel))
    return sum(len(face) - 2 for face in faces)


# ---- the chair: y down, about the middle of its box ----------------------------------------------
CHAIR_HEIGHT = 0.915


def chair_boxes():
    """(x, base, z, width, height, depth): base above the floor, x and z of the middle."""
    side, seat, base = 0.045, 0.42, 0.43
    out = [(0.0, base, 0.0, seat, 0.035, seat)]
    leg = 0.5 * (seat - 1.6 * side)
    out += [(x, 0.0, z, side, base, side) for z in (-leg, leg) for x in (-leg, leg)]
    out += [(x, 0.465, leg, side, 0.45, side) for x in (-leg, leg)]
    return out + [(0.0, height, leg, 0.35, 0.11, 0.02) for height in (0.6, 0.8)]


def write_chair(path):
    lines = ['# Made by scenes/models/make.py: the chair of the synthetic room, y down, metres.']
    faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    for x, base, z, width, height, depth in chair_boxes():
        for i in range(8):
            lines.append('v %.5f %.5f %.5f' % (
                x + (0.5 if i & 1 else -0.5) * width,
                0.5 * CHAIR_HEIGHT - base - (0.0 if i & 2 else height),
                z + (0.5 if i & 4 else -0.5) * depth))
    for k in range(len(chair_boxes())):
        lines += ['f %d %d %d %d' % tuple(8 * k + i + 1 for i in face) for face in faces]
    with open(path, 'w', encoding='utf-8') as out:
        out.write('\n'.join(lines) + '\n')
    return 12 * len(chair_boxes())


# ---- toys ----------------------------------------------------------------------------------------
def data_uri(kind, data):
    return 'data:%s;base64,%s' % (kind, base64.b64encode(data).decode())


def write_gltf(path, mesh, materials, external=None):
    """mesh: points, normals, uvs, and a list of triangles per material. A material is a dict with
    name, color (linear), metallic, roughness and texture (PNG bytes or None). With `external` the
    geometry goes into that file, which other models name too."""
    points, normals, uvs, parts = mesh
    data = [b''.join(struct.pack('<3f', *p) for p in points),
            b''.join(struct.pack('<3f', *n) for n in normals),
            b''.join(struct.pack('<2f', *t) for t in uvs)]
    data += [struct.pack('<%dH' % len(part), *part) for part in parts]
    data = [d + b'\0' * (-len(d) % 4) for d in data]
    blob = b''.join(data)
    if external is not None:
        with open(os.path.join(os.path.dirname(path), external), 'wb') as out:
            out.write(blob)
    single = struct.Struct('<3f')
    bound = [single.unpack(single.pack(*[pick(p[i] for p in points) for i in range(3)]))
             for pick in (min, max)]
    accessors = [{'bufferView': i, 'componentType': 5126, 'count': len(points),
                  'type': 'VEC3' if i < 2 else 'VEC2'} for i in range(3)]
    accessors[0].update({'min': bound[0], 'max': bound[1]})
    accessors += [{'bufferView': 3 + i, 'componentType': 5123, 'count': len(part), 'type': 'SCALAR'}
                  for i, part in enumerate(parts)]
    document = {
        'asset': {'version': '2.0', 'generator': 'scenes/models/make.py'},
        'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
        'meshes': [{'primitives': [
            {'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'indices': 3 + i,
             'material': i} for i in range(len(parts))]}],
        'materials': [], 'accessors': accessors,
        'bufferViews': [{'buffer': 0, 'byteOffset': sum(len(d) for d in data[:i]),
                         'byteLength': len(d)} for i, d in enumerate(data)],
        'buffers': [{'byteLength': len(blob), 'uri': external if external is not None else
                     data_uri('application/octet-stream', blob)}]}
    for m in materials:
        pbr = {'baseColorFactor': m.get('color', [1, 1, 1]) + [1],
               'metallicFactor': m.get('metallic', 0), 'roughnessFactor': m['roughness']}
        if m.get('texture') is not None:
            pbr['baseColorTexture'] = {'index': len(document.setdefault('textures', []))}
            document['textures'].append({'source': len(document['textures'])})
            document.setdefault('images', []).append({'uri': data_uri('image/png', m['texture'])})
        document['materials'].append({'name': m['name'], 'pbrMetallicRoughness': pbr})
    with open(path, 'w', encoding='utf-8') as out:
        json.dump(document, out, separators=(',', ':'))
        out.write('\n')
    return sum(len(part) for part in parts) // 3


def turned(profile, slices):
    """(radius, height, normal r, normal y, v) from the lower end up, turned round y."""
    points, normals, uvs, triangles = [], [], [], []
    for radius, height, nr, ny, v in profile:
        for i in range(slices + 1):
            angle = 2.0 * math.pi * i / slices
            points.append([radius * math.sin(angle), height, radius * math.cos(angle)])
            normals.append(unit([nr * math.sin(angle), ny, nr * math.cos(angle)]))
            uvs.append([i / slices, v])
    for ring in range(len(profile) - 1):
        for i in range(slices):
            a = ring * (slices + 1) + i
            b = a + slices + 1
            if profile[ring][0] > 0.0:
                triangles += [a, a + 1, b + 1]
            if profile[ring + 1][0] > 0.0:
                triangles += [a, b + 1, b]
    return points, normals, uvs, triangles


def ball_mesh():
    profile = []
    for k in range(17):
        angle = math.pi * (k / 16 - 0.5)
        radius = math.cos(angle) if 0 < k < 16 else 0.0
        profile.append((radius, math.sin(angle), radius, math.sin(angle), 1.0 - k / 16))
    points, normals, uvs, triangles = turned(profile, 32)
    return points, normals, uvs, [triangles]


def on_ball(x, y, size):
    """Unit vector that a texel of (width, height) shows."""
    turn, up = 2.0 * math.pi * (x + 0.5) / size[0], math.pi * (0.5 - (y + 0.5) / size[1])
    return [math.cos(up) * math.sin(turn), math.sin(up), math.cos(up) * math.cos(turn)]


def tennis_texel(x, y):
    p = on_ball(x, y, (128, 64))
    seam = abs(p[1] - 0.55 * math.sin(2.0 * math.atan2(p[0], p[2])))
    fuzz = 10.0 * math.sin(97.0 * p[0] + 41.0 * math.sin(71.0 * p[1])) * math.sin(89.0 * p[2])
    felt = [206 + fuzz, 222 + fuzz, 66 + 0.5 * fuzz]
    return [min(255.0, max(0.0, c)) for c in mix(felt, [236, 236, 226], smooth(0.085, 0.05, seam))]


def marble_texel(x, y):
    p = on_ball(x, y, (128, 64))
    swirl = math.sin(5.0 * p[1] + 2.2 * math.sin(2.6 * p[0] + 1.7 * p[2]) + 1.3 * math.sin(4.1 * p[2]))
    deep = mix([16, 54, 74], [38, 128, 122], 0.5 + 0.5 * math.sin(3.0 * p[0] - 2.0 * p[1]))
    return mix(mix(deep, [236, 244, 240], smooth(0.72, 0.97, swirl)), [214, 132, 44],
               0.9 * smooth(-0.80, -0.98, swirl))


def rubber_texel(x, y):
    p = on_ball(x, y, (64, 64))
    band = smooth(0.24, 0.21, abs(p[1]))
    star = smooth(0.90, 0.92, abs(p[1]))
    return mix(mix([196, 38, 34], [238, 232, 220], band), [36, 78, 158], star)


def box_mesh(half, bevel, atlas):
    """A box with rounded edges; atlas(face) is where a face lies in the texture: u0, v0, u1, v1."""
    points, normals, uvs, triangles = [], [], [], []
    steps = [-1.0, -1.0, -1.0, 1.0, 1.0, 1.0]
    lean = [-1.0, -0.4142, 0.0, 0.0, 0.4142, 1.0]
    for face in range(6):
        axis, sign = face // 2, 1.0 if face % 2 == 0 else -1.0
        across, up = (axis + 1) % 3, (axis + 2) % 3
        if axis == 0:
            across, up = 2, 1
        elif axis == 1:
            across, up = 0, 2
        else:
            across, up = 0, 1
        first = len(points)
        for j in range(6):
            for i in range(6):
                n = [0.0, 0.0, 0.0]
                n[axis], n[across], n[up] = sign, lean[i], lean[j]
                n = unit(n)
                core = [0.0, 0.0, 0.0]
                core[axis] = sign * (half[axis] - bevel)
                core[across] = steps[i] * (half[across] - bevel)
                core[up] = steps[j] * (half[up] - bevel)
                p = add(core, n, bevel)
                u0, v0, u1, v1 = atlas(face)
                s, t = 0.5 + 0.5 * p[across] / half[across], 0.5 - 0.5 * p[up] / half[up]
                points.append(p)
                normals.append(n)
                uvs.append([u0 + (u1 - u0) * s, v0 + (v1 - v0) * t])
        out = cross([float(k == across) for k in range(3)], [float(k == up) for k in range(3)])
        is_outward = dot(out, [float(k == axis) * sign for k in range(3)]) > 0.0
        for j in range(5):
            for i in range(5):
                a = first + 6 * j + i
                quad = [a, a + 1, a + 7, a, a + 7, a + 6]
                triangles += quad if is_outward else quad[::-1]
    return points, normals, uvs, [triangles]


PIPS = {1: [(0, 0)], 2: [(-1, -1), (1, 1)], 3: [(-1, -1), (0, 0), (1, 1)],
        4: [(-1, -1), (1, -1), (-1, 1), (1, 1)], 5: [(-1, -1), (1, -1), (0, 0), (-1, 1), (1, 1)],
        6: [(x, y) for x in (-1, 1) for y in (-1, 0, 1)]}
DIE_FACES = [1, 6, 2, 5, 3, 4]


def die_texel(x, y):
    cell = 40
    face = DIE_FACES[y // cell * 3 + x // cell]
    u, v = (x % cell + 0.5) / cell * 2.0 - 1.0, (y % cell + 0.5) / cell * 2.0 - 1.0
    near = min(math.hypot(u - 0.5 * a, v - 0.5 * b) for a, b in PIPS[face])
    return mix([244, 240, 230], [26, 26, 30], smooth(0.21, 0.15, near))


def hash01(a, b):
    h = (a * 0x9e3779b1 ^ b * 0x85ebca77) & 0xffffffff
    h = ((h ^ h >> 15) * 0x2c1b3c6d) & 0xffffffff
    return ((h ^ h >> 12) & 1023) / 1023.0


def wood_texel(x, y):
    """Beech: years of growth along x, and short dark rays."""
    bent = y + 5.0 * math.sin(0.021 * x + 0.7) + 2.0 * math.sin(0.055 * x)
    years = 0.5 + 0.5 * math.sin(0.55 * bent + 1.6 * math.sin(0.19 * bent))
    fibre = hash01(x // 9, y) - 0.5
    ray = 0.30 if hash01(x // 4 + 991, y) > 0.985 else 0.0
    color = mix([222, 178, 126], [190, 138, 88], 0.75 * years)
    return [min(255.0, max(0.0, c * (1.0 + 0.07 * fibre - ray))) for c in color]


def label_texel(x, y):
    v = (y + 0.5) / 64
    color = mix([176, 34, 30], [240, 226, 196], smooth(0.30, 0.32, v) * smooth(0.72, 0.70, v))
    u = (x + 0.5) / 128 * 4.0 % 1.0 - 0.5
    fruit = math.hypot(u / 0.26, (v - 0.51) / 0.14)
    color = mix(color, [206, 60, 30], smooth(1.0, 0.9, fruit))
    color = mix(color, [74, 120, 48], smooth(0.035, 0.025, math.hypot(u, 2.0 * (v - 0.36))))
    return mix(color, [214, 168, 60], smooth(0.02, 0.012, min(abs(v - 0.27), abs(v - 0.75))))


def tin_mesh():
    """Radius 0.5, height 1.2: lids and rims of metal, a paper label between."""
    ends = [(0.0, -0.57, 0, -1, 0), (0.42, -0.57, 0, -1, 0), (0.45, -0.60, -1, -1, 0),
            (0.48, -0.60, 0.6, -1, 0), (0.50, -0.58, 1, 0, 0), (0.50, -0.56, 1, 0.3, 0),
            (0.49, -0.54, 1, 0, 0)]
    metal = [(r, h, nr, ny, 0.0) for r, h, nr, ny, _ in ends]
    rest = [(r, -h, nr, -ny, 0.0) for r, h, nr, ny, _ in reversed(ends)]
    points, normals, uvs, parts = [], [], [], [[], []]
    for profile, part in ((metal, 0), (rest, 0), ([(0.49, -0.54, 1, 0, 1.0), (0.49, 0.54, 1, 0, 0.0)], 1)):
        p, n, t, triangles = turned(profile, 32)
        parts[part] += [len(points) + i for i in triangles]
        points, normals, uvs = points + p, normals + n, uvs + t
    return points, normals, uvs, parts


def bear(p):
    p = [abs(p[0]), p[1], p[2]]
    d = ellipsoid(p, [0, 0.36, 0.0], [0.30, 0.34, 0.27])
    d = union(d, ellipsoid(p, [0, 0.84, 0.03], [0.25, 0.23, 0.23]), 0.08)
    d = union(d, ellipsoid(p, [0.19, 1.02, 0.0], [0.085, 0.085, 0.05]), 0.04)
    d = union(d, ellipsoid(p, [0, 0.78, 0.22], [0.11, 0.085, 0.09]), 0.05)
    d = union(d, ellipsoid(p, [0.29, 0.46, 0.14], [0.10, 0.10, 0.20]), 0.06)
    return union(d, ellipsoid(p, [0.20, 0.10, 0.24], [0.12, 0.11, 0.22]), 0.06)


BEAR_LOW, BEAR_HIGH = [-0.46, -0.06, -0.34], [0.46, 1.16, 0.52]


def bear_texel(x, y):
    """Seen from the front; the back has the same colours."""
    px = BEAR_LOW[0] + (BEAR_HIGH[0] - BEAR_LOW[0]) * (x + 0.5) / 128
    py = BEAR_HIGH[1] + (BEAR_LOW[1] - BEAR_HIGH[1]) * (y + 0.5) / 128
    plush = 1.0 + 0.16 * (hash01(x, y) - 0.5) + 0.10 * (hash01(x // 2, y // 2) - 0.5)
    color = mix([128, 78, 42], [198, 150, 98], smooth(1.0, 0.85, math.hypot(px / 0.19, (py - 0.36) / 0.23)))
    color = mix(color, [206, 164, 114], smooth(1.0, 0.85, math.hypot(px / 0.11, (py - 0.77) / 0.085)))
    color = [c * plush for c in color]
    for cx, cy, r in ((0.095, 0.90, 0.030), (-0.095, 0.90, 0.030), (0.0, 0.815, 0.038)):
        color = mix(color, [20, 16, 16], smooth(r, 0.7 * r, math.hypot(px - cx, py - cy)))
    return [min(255.0, max(0.0, c)) for c in color]


def bear_mesh():
    points, quads = surface_net(bear, BEAR_LOW, BEAR_HIGH, [12, 16, 11])
    normals, uvs, triangles = [], [], []
    for i, p in enumerate(points):
        for _ in range(3):
            p = add(p, gradient(bear, p), -bear(p))
        points[i] = p
        normals.append(gradient(bear, p))
        uvs.append([(p[0] - BEAR_LOW[0]) / (BEAR_HIGH[0] - BEAR_LOW[0]),
                    (BEAR_HIGH[1] - p[1]) / (BEAR_HIGH[1] - BEAR_LOW[1])])
    for a, b, c, d in quads:
        triangles += [a, b, c, a, c, d]
    return points, normals, uvs, [triangles]


def write_toys(folder):
    whole = lambda face: (0.0, 0.0, 1.0, 1.0)  # noqa: E731
    third = lambda face: (face % 3 / 3, face // 3 / 2, (face % 3 + 1) / 3, (face // 3 + 1) / 2)  # noqa: E731
    toys = [
        ('ball_steel', ball_mesh(), [{'name': 'steel', 'color': [0.56, 0.57, 0.58], 'metallic': 1,
                                      'roughness': 0.15}]),
        ('ball_rubber', ball_mesh(), [{'name': 'rubber', 'roughness': 0.4,
                                       'texture': png((64, 64), rubber_texel)}]),
        ('ball_tennis', ball_mesh(), [{'name': 'felt', 'roughness': 1.0,
                                       'texture': png((128, 64), tennis_texel)}]),
        ('marble', ball_mesh(), [{'name': 'glass', 'roughness': 0.05,
                                  'texture': png((128, 64), marble_texel)}]),
        ('die', box_mesh([0.5] * 3, 0.09, third), [{'name': 'plastic', 'roughness': 0.25,
                                                    'texture': png((120, 80), die_texel)}]),
        ('block', box_mesh([0.5] * 3, 0.04, whole), [{'name': 'beech', 'roughness': 0.6,
                                                      'texture': png((128, 128), wood_texel)}]),
        ('tin', tin_mesh(), [{'name': 'tinplate', 'color': [0.62, 0.61, 0.58], 'metallic': 1,
                              'roughness': 0.3},
                             {'name': 'paper', 'roughness': 0.5,
                              'texture': png((128, 64), label_texel)}]),
        ('bear', bear_mesh(), [{'name': 'plush', 'roughness': 1.0,
                                'texture': png((128, 128), bear_texel)}])]
    for name, mesh, materials in toys:
        is_ball = mesh[3][0] == toys[0][1][3][0] and len(mesh[0]) == len(toys[0][1][0])
        count = write_gltf(os.path.join(folder, name + '.gltf'), mesh, materials,
                           'ball.bin' if is_ball else None)
        print('%s.gltf: %d triangles' % (name, count))


def main():
    if len(sys.argv) > 2 or any(a.startswith('-') for a in sys.argv[1:]):
        print(__doc__.strip(), file=sys.stdout if '--help' in sys.argv else sys.stderr)
        return 0 if '--help' in sys.argv else 2
    own = os.path.dirname(os.path.abspath(__file__))
    folder = sys.argv[1] if len(sys.argv) == 2 else own
    print('duck.gltf: %d triangles' % write_duck(os.path.join(folder, 'duck.gltf')))
    print('mug.obj: %d triangles' % write_mug(folder))
    write_toys(folder)
    print('chair.obj: %d triangles' % write_chair(os.path.join(folder, 'chair.obj')))
    return 0


if __name__ == '__main__':
    sys.exit(main())
