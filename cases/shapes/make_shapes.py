#!/usr/bin/env python3
"""Makes the meshes of this folder: a duck, a boat and a buoy, as closed surfaces of triangles with colours (PLY).

Each is a smooth union of parts given by distances (Quilez 2008, "Modeling with distance functions"), turned into triangles by surface nets
(Gibson 1998), which are then drawn onto the surface and evened out. Only + - * / and square roots are used, which IEEE 754 rounds in one
way: every machine makes the same bytes. x is forward, y up, and the waterline lies about y = 0.

    python3 make_shapes.py [FOLDER]      writes duck.ply, boat.ply and buoy.ply there (here, where no folder is named)
"""
import pathlib
import struct
import sys
from math import sqrt

YELLOW, ORANGE, BLACK, WHITE = (250, 200, 30), (240, 110, 20), (20, 20, 24), (244, 242, 236)
RED, BLUE, WOOD, DARK, GREY = (196, 40, 34), (24, 72, 132), (196, 150, 96), (40, 52, 70), (120, 124, 130)


# Distances. Those of ellipsoids and hulls are of first order near the surface, which is all that is asked of them.

def ellipsoid(p, c, r):
    x, y, z = (p[0] - c[0]) / r[0], (p[1] - c[1]) / r[1], (p[2] - c[2]) / r[2]
    k0 = sqrt(x * x + y * y + z * z)
    k1 = sqrt((x / r[0]) ** 2 + (y / r[1]) ** 2 + (z / r[2]) ** 2)
    return k0 * (k0 - 1) / k1 if k1 > 0 else -min(r)


def ball(p, c, r):
    return sqrt((p[0] - c[0]) ** 2 + (p[1] - c[1]) ** 2 + (p[2] - c[2]) ** 2) - r


def cone(p, a, b, ra, rb):
    """All points within a radius of a segment, the radius going from ra to rb."""
    d = [b[i] - a[i] for i in range(3)]
    s = sum((p[i] - a[i]) * d[i] for i in range(3)) / sum(x * x for x in d)
    s = min(1.0, max(0.0, s))
    return sqrt(sum((p[i] - a[i] - s * d[i]) ** 2 for i in range(3))) - (ra + s * (rb - ra))


def slab(p, c, half, rounded):
    """A box with rounded edges; half: half its extents, rounding included."""
    q = [abs(p[i] - c[i]) - half[i] + rounded for i in range(3)]
    return sqrt(sum(max(x, 0.0) ** 2 for x in q)) + min(max(q), 0.0) - rounded


def can(p, c, r, half, rounded):
    """An upright cylinder with rounded rims."""
    q = (sqrt((p[0] - c[0]) ** 2 + (p[2] - c[2]) ** 2) - r + rounded, abs(p[1] - c[1]) - half + rounded)
    return sqrt(max(q[0], 0.0) ** 2 + max(q[1], 0.0) ** 2) + min(max(q), 0.0) - rounded


def ring(p, c, r, thick):
    return sqrt((sqrt((p[0] - c[0]) ** 2 + (p[2] - c[2]) ** 2) - r) ** 2 + (p[1] - c[1]) ** 2) - thick


def blend(a, b, k):
    h = max(k - abs(a - b), 0.0) / k
    return min(a, b) - 0.25 * h * h * k


def cut(a, b, k):
    return -blend(-a, -b, k)


def paint(parts):
    """The smooth union of parts (distance, width of the blend, colour), and the colour of the nearest."""
    total, nearest, colour = parts[0][0], parts[0][0], parts[0][2]
    for d, k, c in parts[1:]:
        total = blend(total, d, k)
        if d < nearest:
            nearest, colour = d, c
    return total, colour


# The shapes: each says (distance, colour) of a point.

def duck(p):
    q = (p[0], p[1], abs(p[2]))
    body = ellipsoid(q, (-0.04, 0.03, 0), (0.52, 0.29, 0.37))
    body = blend(body, ellipsoid(q, (0.20, 0.10, 0), (0.30, 0.28, 0.31)), 0.12)
    body = blend(body, cone(q, (-0.34, 0.14, 0), (-0.63, 0.37, 0), 0.19, 0.045), 0.16)
    body = cut(body, -0.21 - q[1], 0.08)
    # a wing: its tip is raised behind
    wing = ellipsoid((q[0] + 0.10, q[1] - 0.13 + 0.38 * (q[0] + 0.10), q[2]), (0, 0, 0.315), (0.29, 0.135, 0.085))
    body = blend(body, wing, 0.035)
    head = ball(q, (0.30, 0.56, 0), 0.235)
    head = blend(head, ball(q, (0.37, 0.50, 0.085), 0.13), 0.08)
    body = blend(body, head, 0.15)
    tuft = cone(q, (0.24, 0.76, 0), (0.17, 0.86, 0), 0.050, 0.026)
    body = blend(body, tuft, 0.06)
    x = q[0] - 0.48
    upper = ellipsoid((x, q[1] - 0.530 - 0.9 * x * x, q[2]), (0.10, 0, 0), (0.155, 0.046, 0.125))
    lower = ellipsoid((x, q[1] - 0.457 - 0.35 * x * x, q[2]), (0.05, 0, 0), (0.130, 0.050, 0.098))
    eye = ellipsoid(q, (0.448, 0.630, 0.140), (0.052, 0.072, 0.046))
    return paint([(body, 1, YELLOW), (blend(upper, lower, 0.02), 0.03, ORANGE), (eye, 0.008, BLACK)])


def boat_hull(p, inset):
    x, y, z = p[0], p[1], abs(p[2])
    bow = max(0.0, x)
    wide = 0.40 * (1 - bow * bow * (0.35 + 0.65 * bow)) if x > 0 else 0.40 * (1 - 0.16 * x * x)
    sheer = 0.20 + (0.20 * x * x if x > 0 else 0.06 * x * x)
    rise = max(0.0, x - 0.35) / 0.65
    keel = -0.26 + 0.40 * rise * rise * rise
    t = min(1.3, max(0.0, (y - keel) / (sheer - keel)))
    full = sqrt(max(0.0, 1 - (1 - min(t, 1.0)) ** 2))
    flare = 0.72 + 0.28 * t if x > 0 else 0.82 + 0.18 * t
    side = (z - wide * full * flare + inset) * 0.8
    d = cut(side, (keel - y) * 0.9 + inset, 0.10)
    d = cut(d, -0.95 - x + inset, 0.06)
    return d, sheer


def boat(p):
    q = (p[0], p[1], abs(p[2]))
    hull, sheer = boat_hull(p, 0)
    inner, _ = boat_hull(p, 0.065)
    deck = sheer - 0.085
    hull = cut(hull, q[1] - sheer, 0.03)
    hull = cut(hull, -cut(inner, deck - q[1], 0.03), 0.02)
    y = q[1]
    if inner < 0.012 and y < sheer - 0.02:
        hue = WOOD
    else:
        hue = RED if y < -0.02 else WHITE if y < 0.035 else BLUE if y < sheer - 0.035 else WHITE
    cabin = slab(q, (-0.12, 0.33, 0), (0.30, 0.22, 0.215), 0.05)
    panes = min(slab(q, (0.20, 0.44, 0.10), (0.06, 0.055, 0.075), 0.02), slab(q, (0.03, 0.44, 0.23), (0.09, 0.055, 0.05), 0.02),
                slab(q, (-0.22, 0.44, 0.23), (0.09, 0.055, 0.05), 0.02), slab(q, (-0.43, 0.44, 0.09), (0.05, 0.055, 0.07), 0.02))
    cabin_hue = DARK if panes < 0.022 else WHITE
    cabin = cut(cabin, -(panes + 0.004), 0.012)
    roof = slab(q, (-0.11, 0.565, 0), (0.355, 0.035, 0.265), 0.034)
    funnel = can(q, (-0.62, 0.40, 0), 0.10, 0.30, 0.03)
    funnel_hue = BLACK if y > 0.61 else WHITE if 0.50 < y < 0.56 else ORANGE
    mast = cone(q, (-0.02, 0.55, 0), (-0.02, 1.00, 0), 0.040, 0.030)
    lamp = ball(q, (-0.02, 1.03, 0), 0.052)
    hatch = slab(q, (0.44, 0.18, 0), (0.11, 0.085, 0.11), 0.03)
    post = can(q, (0.74, 0.30, 0), 0.040, 0.12, 0.02)
    fender = can((q[0] + 0.2, q[2] - 0.37, q[1] - 0.115), (0, 0, 0), 0.10, 0.05, 0.035)
    return paint([(hull, 1, hue), (cabin, 0.015, cabin_hue), (roof, 0.01, RED), (funnel, 0.02, funnel_hue), (mast, 0.02, GREY), (lamp, 0.01, YELLOW),
                  (hatch, 0.02, WOOD), (post, 0.02, GREY), (fender, 0.01, BLACK)])


def buoy(p):
    round_ = sqrt(p[0] * p[0] + p[2] * p[2])
    y = p[1]
    float_ = can(p, (0, 0.02, 0), 0.50, 0.20, 0.12)
    fender = ring(p, (0, 0.06, 0), 0.49, 0.065)
    tower = cut(cut((round_ - 0.235 + 0.155 * (y - 0.15)) * 0.985, y - 1.02, 0.02), 0.05 - y, 0.02)
    tower_hue = WHITE if 0.48 < y < 0.76 else RED
    gallery = can(p, (0, 1.02, 0), 0.20, 0.035, 0.03)
    lantern = can(p, (0, 1.15, 0), 0.10, 0.11, 0.02)
    cap = ellipsoid(p, (0, 1.27, 0), (0.145, 0.075, 0.145))
    knob = ball(p, (0, 1.36, 0), 0.042)
    knobs = ball((abs(p[0]), p[1], p[2]), (0.36, 0.235, 0), 0.06)
    stem = cone(p, (0, -0.15, 0), (0, -0.62, 0), 0.085, 0.075)
    weight = ellipsoid(p, (0, -0.68, 0), (0.20, 0.15, 0.20))
    return paint([(float_, 1, RED), (tower, 0.08, tower_hue), (fender, 0.015, BLACK), (gallery, 0.02, GREY), (lantern, 0.015, YELLOW), (cap, 0.015, RED),
                  (knob, 0.02, GREY), (knobs, 0.03, GREY), (stem, 0.10, GREY), (weight, 0.06, GREY)])


# From distances to triangles.

class Net:
    """Surface nets: a point in each cell that the surface crosses, a square around each edge of the grid that it crosses."""

    def __init__(self, shape, low, high, cell):
        self.shape, self.low, self.cell = shape, low, cell
        self.n = [int((high[a] - low[a]) / cell) + 1 for a in range(3)]
        self.points, self.squares = [], []
        self.sample()
        self.connect()
        for _ in range(3):
            self.draw_onto()
            self.even_out()
        self.draw_onto()
        self.draw_onto()

    def at(self, i, j, k):
        return (self.low[0] + i * self.cell, self.low[1] + j * self.cell, self.low[2] + k * self.cell)

    def sample(self):
        """Values at the nodes; where a node of every fourth is far from the surface, those around it have its value."""
        coarse, n = 4, self.n
        self.d = {}
        far = 2.2 * coarse * self.cell
        for k0 in range(0, n[2], coarse):
            for j0 in range(0, n[1], coarse):
                for i0 in range(0, n[0], coarse):
                    middle = self.shape(self.at(i0 + 0.5 * coarse, j0 + 0.5 * coarse, k0 + 0.5 * coarse))[0]
                    for k in range(k0, min(k0 + coarse, n[2])):
                        for j in range(j0, min(j0 + coarse, n[1])):
                            for i in range(i0, min(i0 + coarse, n[0])):
                                self.d[i, j, k] = middle if abs(middle) > far else self.shape(self.at(i, j, k))[0]

    def connect(self):
        n, d = self.n, self.d
        number = {}
        edges = [(a, b) for a in range(8) for b in range(8) if a < b and (a ^ b) in (1, 2, 4)]
        for k in range(n[2] - 1):
            for j in range(n[1] - 1):
                for i in range(n[0] - 1):
                    values = [d[i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)] for c in range(8)]
                    if all(v < 0 for v in values) or all(v >= 0 for v in values):
                        continue
                    total, count = [0.0, 0.0, 0.0], 0
                    for a, b in edges:
                        if (values[a] < 0) != (values[b] < 0):
                            s = values[a] / (values[a] - values[b])
                            for axis in range(3):
                                total[axis] += (a >> axis & 1) + s * ((b >> axis & 1) - (a >> axis & 1))
                            count += 1
                    number[i, j, k] = len(self.points)
                    self.points.append([self.low[a] + self.cell * ((i, j, k)[a] + total[a] / count) for a in range(3)])
        for (i, j, k) in number:
            for axis in range(3):
                b, c = (axis + 1) % 3, (axis + 2) % 3
                step = [0, 0, 0]
                step[axis] = 1
                here, there = d[i, j, k], d[i + step[0], j + step[1], k + step[2]]
                if (here < 0) == (there < 0):
                    continue
                cells = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    at = [i, j, k]
                    at[b] -= u
                    at[c] -= v
                    cells.append(number[tuple(at)])
                self.squares.append(cells if here < 0 else cells[::-1])

    def draw_onto(self):
        step = 1e-3 * self.cell
        for p in self.points:
            f = self.shape(p)[0]
            g = []
            for a in range(3):
                up, down = list(p), list(p)
                up[a] += step
                down[a] -= step
                g.append((self.shape(up)[0] - self.shape(down)[0]) / (2 * step))
            square = sum(x * x for x in g)
            if square > 1e-6:
                length = f / square
                size = sqrt(length * length * square)
                limit = min(1.0, 0.5 * self.cell / size) if size > 0 else 1.0
                for a in range(3):
                    p[a] -= limit * length * g[a]

    def even_out(self):
        """Each point half the way to the mean of its neighbours."""
        total = [[0.0, 0.0, 0.0, 0] for _ in self.points]
        for q in self.squares:
            for e in range(4):
                a, b = q[e], q[(e + 1) % 4]
                for axis in range(3):
                    total[a][axis] += self.points[b][axis]
                    total[b][axis] += self.points[a][axis]
                total[a][3] += 1
                total[b][3] += 1
        for p, t in zip(self.points, total):
            for axis in range(3):
                p[axis] += 0.5 * (t[axis] / t[3] - p[axis])

    def colour(self, p):
        """The mean of what is around, so that borders of colours are as even as the squares are not."""
        mean = [0.0, 0.0, 0.0]
        for corner in range(8):
            at = [p[a] + (0.4 if corner >> a & 1 else -0.4) * self.cell for a in range(3)]
            for c, value in enumerate(self.shape(at)[1]):
                mean[c] += value / 8
        return [int(c + 0.5) for c in mean]

    def triangles(self):
        def apart(a, b):
            return sum((self.points[a][i] - self.points[b][i]) ** 2 for i in range(3))
        for a, b, c, d in self.squares:
            yield from ((a, b, c), (a, c, d)) if apart(a, c) <= apart(b, d) else ((a, b, d), (b, c, d))


def write(path, net):
    triangles = list(net.triangles())
    header = ["ply", "format binary_little_endian 1.0", "comment made by make_shapes.py", "element vertex %d" % len(net.points), "property float x",
              "property float y", "property float z", "property uchar red", "property uchar green", "property uchar blue",
              "element face %d" % len(triangles), "property list uchar int vertex_indices", "end_header", ""]
    data = bytearray("\n".join(header).encode())
    for p in net.points:
        data += struct.pack("<fff3B", *p, *net.colour(p))
    for t in triangles:
        data += struct.pack("<B3i", 3, *t)
    path.write_bytes(data)
    print("%s: %d points, %d triangles" % (path.name, len(net.points), len(triangles)))


SHAPES = {
    "duck": (duck, (-0.75, -0.30, -0.50), (0.85, 1.00, 0.50), 0.0290),
    "boat": (boat, (-1.10, -0.40, -0.55), (1.20, 1.20, 0.55), 0.0320),
    "buoy": (buoy, (-0.65, -0.95, -0.65), (0.65, 1.50, 0.65), 0.0330),
}


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent
    for name, arguments in SHAPES.items():
        if len(sys.argv) <= 2 or name in sys.argv[2:]:
            write(folder / (name + ".ply"), Net(*arguments))


if __name__ == "__main__":
    main()
