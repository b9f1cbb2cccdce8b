// Geometry of a line of the manifest: what is drawn over the picture, and the small view of the pose.
const EDGES = [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

// Of a row-major 4x4 and a point.
const transformed = (m, p) => [0, 1, 2].map(r => m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3]);

// Of a rigid 4x4: the transpose of its turn.
function transformedBack(m, p) {
  const d = [0, 1, 2].map(r => p[r] - m[r][3]);
  return [0, 1, 2].map(c => m[0][c] * d[0] + m[1][c] * d[1] + m[2][c] * d[2]);
}

const corners = ([low, high]) => Array.from({length: 8}, (_, k) => [k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]]);

// World corners of the model's box; null where the line does not tell.
function worldBox(line) {
  if (!line.model_to_world || !line.model_box) return null;
  return corners(line.model_box).map(p => transformed(line.model_to_world, p));
}

// Pixels of a point of the world; null behind the camera.
function projected(line, point) {
  const [x, y, z] = transformedBack(line.camera_to_world, point), k = line.intrinsics;
  return z > 1e-6 ? [k[0][0] * x / z + k[0][2], k[1][1] * y / z + k[1][2]] : null;
}

function segment(a, b, name) {
  return a && b ? [svg('path', {d: `M${a[0].toFixed(2)} ${a[1].toFixed(2)}L${b[0].toFixed(2)} ${b[1].toFixed(2)}`, class: name})] : [];
}

// Model axes, as long as half the box, from its middle.
function worldAxes(line) {
  const [low, high] = line.model_box, middle = low.map((v, k) => (v + high[k]) / 2);
  const long = Math.max(...low.map((v, k) => high[k] - v)) / 2;
  const at = p => transformed(line.model_to_world, p);
  return [at(middle), ...[0, 1, 2].map(axis => at(middle.map((v, k) => v + (k === axis ? long : 0))))];
}

function boxOverPicture(line) {
  const box = worldBox(line);
  if (!box) return [];
  const points = box.map(p => projected(line, p)), [from, ...ends] = worldAxes(line).map(p => projected(line, p));
  const others = (line.objects || []).flatMap(object => {
    const own = worldBox(object).map(p => projected(line, p));
    return EDGES.flatMap(([a, b]) => segment(own[a], own[b], 'box3 other'));
  });
  return [...others, ...EDGES.flatMap(([a, b]) => segment(points[a], points[b], 'box3')), ...ends.flatMap((end, k) => segment(from, end, `axis a${k}`))];
}

// The world from outside: the model's box and axes, the camera and what it sees. A drag or the arrows turn it.
function poseView(line) {
  const box = worldBox(line);
  if (!box) return null;
  const size = 220, drawing = svg('svg', {viewBox: `0 0 ${size} ${size}`, class: 'pose', tabindex: 0, role: 'img', 'aria-label': 'Pose of the model and the camera; the arrows turn it'});
  const eye = line.camera_to_world.slice(0, 3).map(row => row[3]), k = line.intrinsics;
  const middle = [0, 1, 2].map(c => box.reduce((sum, p) => sum + p[c], 0) / 8);
  const far = Math.hypot(...eye.map((v, c) => v - middle[c]));
  const sees = [[0, 0], [line.width, 0], [line.width, line.height], [0, line.height]].map(([u, v]) => {
    const depth = 0.35 * far;
    return transformed(line.camera_to_world, [(u - k[0][2]) / k[0][0] * depth, (v - k[1][2]) / k[1][1] * depth, depth]);
  });
  const centre = middle.map((v, c) => (v + eye[c]) / 2);
  const reach = 1.1 * Math.max(far / 2, ...box.map(p => Math.hypot(...p.map((v, c) => v - centre[c]))), ...sees.map(p => Math.hypot(...p.map((v, c) => v - centre[c]))));
  const floor = Math.min(...box.map(p => p[2]));
  let yaw = 0.7, tilt = 0.5;
  const draw = () => {
    const at = p => {
      const d = p.map((v, c) => v - centre[c]), x = Math.cos(yaw) * d[0] - Math.sin(yaw) * d[1], y = Math.sin(yaw) * d[0] + Math.cos(yaw) * d[1];
      return [size / 2 + x / reach * size / 2, size / 2 - (Math.cos(tilt) * d[2] + Math.sin(tilt) * y) / reach * size / 2];
    };
    const parts = (line.objects || []).map(worldBox).flatMap(own => EDGES.flatMap(([a, b]) => segment(at(own[a]), at(own[b]), 'box3 other')));
    for (let g = -2; g <= 2; ++g) {
      const s = reach / 2;
      parts.push(...segment(at([middle[0] + g * s / 2, middle[1] - s, floor]), at([middle[0] + g * s / 2, middle[1] + s, floor]), 'ground'));
      parts.push(...segment(at([middle[0] - s, middle[1] + g * s / 2, floor]), at([middle[0] + s, middle[1] + g * s / 2, floor]), 'ground'));
    }
    EDGES.forEach(([a, b]) => parts.push(...segment(at(box[a]), at(box[b]), 'box3')));
    const [from, ...ends] = worldAxes(line).map(at);
    ends.forEach((end, a) => parts.push(...segment(from, end, `axis a${a}`), svg('text', {x: end[0] + 3, y: end[1]}, 'xyz'[a])));
    sees.forEach((corner, c) => parts.push(...segment(at(eye), at(corner), 'camera'), ...segment(at(corner), at(sees[(c + 1) % 4]), 'camera')));
    drawing.replaceChildren(...parts);
  };
  let from = null;
  drawing.addEventListener('pointerdown', event => {
    from = [event.clientX, event.clientY];
    drawing.setPointerCapture(event.pointerId);
  });
  drawing.addEventListener('pointermove', event => {
    if (!from) return;
    yaw += (event.clientX - from[0]) / 100;
    tilt = Math.max(0, Math.min(1.57, tilt + (event.clientY - from[1]) / 100));
    from = [event.clientX, event.clientY];
    draw();
  });
  drawing.addEventListener('pointerup', () => { from = null; });
  drawing.addEventListener('keydown', event => {
    const turn = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]}[event.key];
    if (!turn) return;
    yaw += turn[0];
    tilt = Math.max(0, Math.min(1.57, tilt + turn[1]));
    event.preventDefault();
    event.stopPropagation();
    draw();
  });
  draw();
  return drawing;
}
