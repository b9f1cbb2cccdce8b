# SPDX-License-Identifier: CC0-1.0
"""Vertex normals for the environments' meshes, which are used as they are stored."""
import math

from .curves import cross, dot, sub, unit
from .mesh import Mesh


def with_normals(mesh, crease_deg=40.0):
    """Splits points at edges sharper than the crease and gives each copy the mean normal of its faces, weighted by the
    angle they meet the point with. Returns the new mesh and its normals."""
    limit = math.cos(math.radians(crease_deg))
    face_normals, around = [], [[] for _ in mesh.points]
    for f, (a, b, c) in enumerate(mesh.faces):
        p, q, r = mesh.points[a], mesh.points[b], mesh.points[c]
        face_normals.append(unit(cross(sub(q, p), sub(r, p))))
        for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
            u, v = unit(sub(mesh.points[j], mesh.points[i])), unit(sub(mesh.points[k], mesh.points[i]))
            around[i].append((f, math.acos(max(-1.0, min(1.0, dot(u, v))))))
    result, normals, index = Mesh(), [], {}
    for f, face in enumerate(mesh.faces):
        corners = []
        for i in face:
            near = [(face_normals[g], angle) for g, angle in around[i]
                     if dot(face_normals[g], face_normals[f]) >= limit]
            normal = unit(tuple(sum(n[k] * angle for n, angle in near) for k in range(3)))
            key = (i, tuple(round(c, 4) for c in normal))
            if key not in index:
                index[key] = len(result.points)
                result.points.append(mesh.points[i])
                normals.append(normal)
            corners.append(index[key])
        result.faces.append(tuple(corners))
    return result, normals
