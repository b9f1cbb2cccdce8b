# SPDX-License-Identifier: CC0-1.0
"""Triangle meshes: joining, moving, cleaning, checking, and the PLY file.

Frame of every model: right-handed, Y up, the front towards +Z, any unit. Faces run counter-clockwise seen from outside.
"""
import math
import struct

# Points are rounded to this share of the longest side, so that last-bit differences between C libraries' sin and cos
# cannot change a file, and so that rings that meet do so exactly.
_GRID = 1.0 / (1 << 17)


class Mesh:
    """`points` are (x, y, z), `faces` are index triples. A mesh may consist of several closed shells."""

    def __init__(self, points=(), faces=()):
        self.points = list(points)
        self.faces = list(faces)

    def add(self, other):
        """Joins another mesh as further shells."""
        base = len(self.points)
        self.points.extend(other.points)
        self.faces.extend((a + base, b + base, c + base) for a, b, c in other.faces)
        return self

    def quad(self, a, b, c, d):
        """Two triangles, split along the shorter diagonal."""
        p = self.points
        if math.dist(p[a], p[c]) <= math.dist(p[b], p[d]):
            self.faces += [(a, b, c), (a, c, d)]
        else:
            self.faces += [(a, b, d), (b, c, d)]

    def mapped(self, function):
        """A copy with function(x, y, z) applied to every point; a function that mirrors turns the faces over."""
        mesh = Mesh([function(*p) for p in self.points], self.faces)
        if mesh.volume() * self.volume() < 0:
            mesh.faces = [(a, c, b) for a, b, c in mesh.faces]
        return mesh

    def moved(self, x=0.0, y=0.0, z=0.0):
        return self.mapped(lambda px, py, pz: (px + x, py + y, pz + z))

    def scaled(self, x, y=None, z=None):
        y, z = (x if y is None else y), (x if z is None else z)
        return self.mapped(lambda px, py, pz: (px * x, py * y, pz * z))

    def turned(self, axis, degrees):
        """Rotates counter-clockwise seen against the axis ("x", "y" or "z")."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        if axis == "x":
            return self.mapped(lambda x, y, z: (x, c * y - s * z, s * y + c * z))
        if axis == "y":
            return self.mapped(lambda x, y, z: (c * x + s * z, y, c * z - s * x))
        return self.mapped(lambda x, y, z: (c * x - s * y, s * x + c * y, z))

    def mirrored_x(self):
        return self.mapped(lambda x, y, z: (-x, y, z))

    def volume(self):
        """Signed volume: positive where the faces run counter-clockwise seen from outside."""
        total = 0.0
        for a, b, c in self.faces:
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = self.points[a], self.points[b], self.points[c]
            total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        return total / 6

    def outward(self):
        """Turns the whole mesh over if it is inside out."""
        if self.volume() < 0:
            self.faces = [(a, c, b) for a, b, c in self.faces]
        return self

    def bounds(self):
        return tuple(min(c) for c in zip(*self.points)), tuple(max(c) for c in zip(*self.points))


def area(p, q, r):
    ux, uy, uz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    vx, vy, vz = r[0] - p[0], r[1] - p[1], r[2] - p[2]
    return 0.5 * math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)


def shells(mesh):
    """Splits a mesh into its connected parts, by shared point indices."""
    parent = list(range(len(mesh.points)))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for a, b, c in mesh.faces:
        parent[root(b)] = root(a)
        parent[root(c)] = root(a)
    groups = {}
    for face in mesh.faces:
        groups.setdefault(root(face[0]), []).append(face)
    return [compact(Mesh(mesh.points, faces)) for faces in groups.values()]


def compact(mesh):
    """Drops the points no face uses."""
    used = sorted({i for face in mesh.faces for i in face})
    index = {old: new for new, old in enumerate(used)}
    return Mesh([mesh.points[i] for i in used], [tuple(index[i] for i in f) for f in mesh.faces])


def cleaned(mesh):
    """Rounds the points to the grid, joins equal points within each shell, drops faces that have collapsed.

    Shells stay apart, so two that touch do not become one non-manifold surface.
    """
    low, high = mesh.bounds()
    step = _GRID * max(h - l for l, h in zip(low, high))
    result = Mesh()
    for shell in shells(mesh):
        keys, points, index = {}, [], []
        for p in shell.points:
            key = tuple(round(c / step) for c in p)
            if key not in keys:
                keys[key] = len(points)
                points.append(tuple(k * step for k in key))
            index.append(keys[key])
        faces = [tuple(index[i] for i in f) for f in shell.faces]
        result.add(compact(Mesh(points, [f for f in faces if len(set(f)) == 3])))
    return result


def problems(mesh):
    """What is wrong with a mesh, as lines of text: open or doubly used edges, faces without area, inside-out shells."""
    found = []
    edges = {}
    for a, b, c in mesh.faces:
        for edge in ((a, b), (b, c), (c, a)):
            edges[edge] = edges.get(edge, 0) + 1
    twice = sum(1 for n in edges.values() if n > 1)
    loose = sum(1 for a, b in edges if (b, a) not in edges)
    if twice or loose:
        found.append(f"{loose} open edges, {twice} edges used twice in one direction")
    low, high = mesh.bounds()
    least = 1e-10 * max(h - l for l, h in zip(low, high)) ** 2
    thin = sum(1 for f in mesh.faces if area(*(mesh.points[i] for i in f)) <= least)
    if thin:
        found.append(f"{thin} faces without area")
    inverted = sum(1 for shell in shells(mesh) if shell.volume() <= 0)
    if inverted:
        found.append(f"{inverted} shells inside out")
    return found


def write_ply(path, mesh, comment, normals=None):
    """Writes binary little-endian PLY: float x y z (nx ny nz where `normals` are given), uchar int vertex_indices."""
    fields = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals else [])
    header = ["ply", "format binary_little_endian 1.0", f"comment {comment}", f"element vertex {len(mesh.points)}"]
    header += [f"property float {name}" for name in fields]
    header += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header", ""]
    rows = zip(mesh.points, normals) if normals else ((p,) for p in mesh.points)
    with open(path, "wb") as file:
        file.write("\n".join(header).encode())
        for row in rows:
            values = [c for vector in row for c in vector]
            file.write(struct.pack(f"<{len(values)}f", *values))
        for face in mesh.faces:
            file.write(struct.pack("<B3i", 3, *face))
