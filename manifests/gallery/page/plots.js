// Plots of what is shown; each is a filter, too: a click takes a value, a drag a range.
const MOST_BARS = 40, MOST_TILES = 30;
const PAIRS = [['azimuth', 'elevation'], ['box_x', 'box_y']];
const SHAPES = ['s0', 's1', 's2', 's3', 's4', 's5'];

function drawPlots() {
  const holder = $('plots');
  holder.hidden = !state.plots;
  if (!state.plots) return holder.replaceChildren();
  const cards = [];
  const of = key => data.columns.get(key);
  if (of('class')) cards.push(classBars(of('class'), of('split')));
  for (const key of ['material', 'environment']) if (of('class') && of(key)) cards.push(tiles(of('class'), of(key)));
  for (const [x, y] of PAIRS) if (of(x) && of(y)) cards.push(dots(of(x), of(y)));
  for (const column of data.columns.values()) {
    const [low, high] = column.type === 'number' ? rangeOf(column) : [0, 0];
    if (high > low) cards.push(numberPlot(column));
  }
  const at = holder.scrollTop;
  holder.replaceChildren(...cards);
  holder.scrollTop = at;
}

function card(title, ...parts) {
  return el('figure', {className: 'card'}, el('figcaption', {textContent: title}), ...parts);
}

// Values of a column by images that are shown, the most first.
function topValues(column, most) {
  const counts = new Uint32Array(column.values.length);
  for (const i of shown.order) ++counts[column.of[i]];
  const values = [...counts.keys()].filter(v => counts[v] > 0).sort((a, b) => counts[b] - counts[a] || a - b);
  return {counts, values: values.slice(0, most), left: Math.max(0, values.length - most)};
}

function legend(column) {
  return el('p', {className: 'legend'}, ...column.values.map((name, v) => el('span', {}, el('i', {className: `mark ${SHAPES[v % 6]}`}), name || 'none')));
}

function classBars(column, split) {
  const {counts, values, left} = topValues(column, MOST_BARS), most = Math.max(1, ...values.map(v => counts[v]));
  const parts = new Map();
  for (const i of shown.order) {
    const key = column.of[i] * 8 + (split ? Math.min(split.of[i], 7) : 0);
    parts.set(key, (parts.get(key) || 0) + 1);
  }
  const rows = values.map(v => {
    const bar = el('span', {className: 'bar'});
    for (let s = 0; s < (split ? Math.min(split.values.length, 8) : 1); ++s) {
      const count = parts.get(v * 8 + s) || 0;
      if (count === 0) continue;
      const piece = el('i', {className: `mark ${SHAPES[s % 6]}`, title: split ? `${split.values[s] || 'none'}: ${count}` : count});
      piece.style.width = `${count / most * 100}%`;
      bar.append(piece);
    }
    const row = el('button', {type: 'button', className: 'bar-row'}, el('span', {textContent: column.values[v] || 'none', title: column.values[v]}), bar, el('b', {textContent: counts[v]}));
    row.addEventListener('click', () => {
      toggleValue(column.key, v);
      changed();
    });
    return row;
  });
  return card(split ? 'images by class and split' : 'images by class', el('div', {className: 'bars'}, ...rows), ...(left ? [el('p', {className: 'soft', textContent: `and ${left} more classes`})] : []), ...(split ? [legend(split)] : []));
}

function tiles(rows, columns) {
  const down = topValues(rows, MOST_TILES), across = topValues(columns, MOST_TILES), counts = new Map();
  for (const i of shown.order) {
    const key = rows.of[i] * 65536 + columns.of[i];
    counts.set(key, (counts.get(key) || 0) + 1);
  }
  const count = (x, y) => counts.get(down.values[y] * 65536 + across.values[x]) || 0;
  let most = 1;
  for (const value of counts.values()) most = Math.max(most, value);
  const side = 14, left = 110, top = 84, width = left + across.values.length * side + 52, height = top + down.values.length * side + 4;
  const drawing = svg('svg', {viewBox: `0 0 ${width} ${height}`, width, height, class: 'tiles', role: 'img', 'aria-label': `images by ${rows.label} and ${columns.label}`});
  const levels = new Array(9).fill('');
  const cut = text => (text.length > 17 ? `${text.slice(0, 16)}\u2026` : text) || 'none';
  down.values.forEach((v, y) => {
    drawing.append(svg('text', {x: left - 6, y: top + y * side + 11, class: 'end'}, cut(rows.values[v].slice(rows.values[v].lastIndexOf('/') + 1))));
    across.values.forEach((_, x) => {
      const level = count(x, y) === 0 ? 0 : 1 + Math.min(7, Math.floor(count(x, y) / most * 7.99));
      levels[level] += `M${left + x * side} ${top + y * side}h${side - 1}v${side - 1}h${1 - side}z`;
    });
  });
  across.values.forEach((v, x) => drawing.append(svg('text', {transform: `translate(${left + x * side + 11} ${top - 5}) rotate(-60)`}, cut(columns.values[v]))));
  levels.forEach((path, level) => {
    if (path !== '') drawing.append(svg('path', {d: path, class: 'tile', 'fill-opacity': level === 0 ? 0.05 : 0.15 + 0.85 * (level - 1) / 7}));
  });
  const title = svg('title');
  drawing.prepend(title);
  const place = event => {
    const frame = drawing.getBoundingClientRect(), scale = width / frame.width;
    const x = Math.floor(((event.clientX - frame.left) * scale - left) / side), y = Math.floor(((event.clientY - frame.top) * scale - top) / side);
    return x >= 0 && y >= 0 && x < across.values.length && y < down.values.length ? [x, y] : null;
  };
  drawing.addEventListener('pointermove', event => {
    const at = place(event);
    title.textContent = at ? `${rows.values[down.values[at[1]]] || 'none'}, ${columns.values[across.values[at[0]]] || 'none'}: ${count(...at)}` : '';
  });
  drawing.addEventListener('click', event => {
    const at = place(event);
    if (!at) return;
    state.lists.set(rows.key, new Set([down.values[at[1]]]));
    state.lists.set(columns.key, new Set([across.values[at[0]]]));
    changed();
  });
  return card(`${rows.label} and ${columns.label}`, el('div', {className: 'scroll'}, drawing), el('p', {className: 'soft', textContent: `darkest: ${most} images${down.left + across.left > 0 ? '; the most frequent are shown' : ''}`}));
}

// A drag over a plot's area, as shares of its width and height from the lower left.
function onDrag(drawing, area, done) {
  const mark = svg('rect', {class: 'drag', width: 0, height: 0});
  drawing.append(mark);
  let from = null;
  const place = event => {
    const frame = drawing.getBoundingClientRect(), scale = drawing.viewBox.baseVal.width / frame.width;
    const inside = (value, low, size) => Math.max(low, Math.min(low + size, value));
    return [inside((event.clientX - frame.left) * scale, area.x, area.width), inside((event.clientY - frame.top) * scale, area.y, area.height)];
  };
  const span = (a, b) => [Math.min(a, b), Math.abs(a - b)];
  drawing.addEventListener('pointerdown', event => {
    from = place(event);
    drawing.setPointerCapture(event.pointerId);
  });
  drawing.addEventListener('pointermove', event => {
    if (!from) return;
    const to = place(event), [x, width] = span(from[0], to[0]), [y, height] = area.flat ? [area.y, area.height] : span(from[1], to[1]);
    for (const [key, value] of Object.entries({x, y, width, height})) mark.setAttribute(key, value);
  });
  drawing.addEventListener('pointerup', event => {
    if (!from) return;
    const to = place(event), [x, width] = span(from[0], to[0]), [y, height] = span(from[1], to[1]);
    from = null;
    mark.setAttribute('width', 0);
    if (width < 3 || (!area.flat && height < 3)) return;
    done([(x - area.x) / area.width, (x + width - area.x) / area.width], [1 - (y + height - area.y) / area.height, 1 - (y - area.y) / area.height]);
  });
}

function axisWords(drawing, area, x, y, rangeX, rangeY) {
  const foot = area.y + area.height;
  drawing.append(svg('text', {x: area.x, y: foot + 13}, numberText(x, rangeX[0])), svg('text', {x: area.x + area.width, y: foot + 13, class: 'end'}, numberText(x, rangeX[1])));
  if (y) drawing.append(svg('text', {x: area.x - 4, y: foot, class: 'end'}, shortNumber(y.unit === 'share' ? 100 * rangeY[0] : rangeY[0])), svg('text', {x: area.x - 4, y: area.y + 9, class: 'end'}, shortNumber(y.unit === 'share' ? 100 * rangeY[1] : rangeY[1])));
}

function dots(x, y) {
  const split = data.columns.get('split'), area = {x: 44, y: 6, width: 250, height: 140};
  const full = {azimuth: [-180, 180], elevation: [-90, 90], box_x: [0, 1], box_y: [0, 1]};
  const rangeX = full[x.key] || rangeOf(x), rangeY = full[y.key] || rangeOf(y);
  // Rows of a picture count from the top.
  const down = y.key === 'box_y';
  const paths = [], seen = new Set();
  for (const i of shown.order) {
    const u = (x.of[i] - rangeX[0]) / (rangeX[1] - rangeX[0]), v = (y.of[i] - rangeY[0]) / (rangeY[1] - rangeY[0]), s = split ? split.of[i] % 6 : 0;
    if (u !== u || v !== v) continue;
    const d = `M${Math.round(area.x + u * area.width)} ${Math.round(area.y + (down ? v : 1 - v) * area.height)}h0`;
    if (seen.has(s + d)) continue;
    seen.add(s + d);
    paths[s] = (paths[s] || '') + d;
  }
  const drawing = svg('svg', {viewBox: '0 0 304 166', class: 'dots', role: 'img', 'aria-label': `${x.label} and ${y.label} of what is shown`});
  drawing.append(svg('rect', {x: area.x, y: area.y, width: area.width, height: area.height, class: 'area'}));
  paths.forEach((path, s) => drawing.append(svg('path', {d: path, class: `dot ${SHAPES[s]}`})));
  axisWords(drawing, area, x, y, rangeX, down ? [rangeY[1], rangeY[0]] : rangeY);
  const scale = ([low, high], [a, b]) => [low + a * (high - low), low + b * (high - low)];
  onDrag(drawing, area, (u, v) => {
    setRange(x.key, ...scale(rangeX, u));
    setRange(y.key, ...scale(rangeY, down ? [1 - v[1], 1 - v[0]] : v));
    changed();
  });
  return card(`${x.label} and ${y.label}`, drawing, ...(split ? [legend(split)] : []));
}

function numberPlot(column) {
  const bars = barsOf(column), area = {x: 6, y: 6, width: 290, height: 90, flat: true};
  const drawing = svg('svg', {viewBox: '0 0 304 116', class: 'dots', role: 'img', 'aria-label': `${column.label}: how many images have which`});
  const most = Math.max(1, ...bars.all), place = `translate(${area.x} ${area.y})`;
  drawing.append(svg('rect', {x: area.x, y: area.y, width: area.width, height: area.height, class: 'area'}));
  drawing.append(svg('path', {d: barsPath(bars.all, most, area.width, area.height), class: 'all', transform: place}));
  drawing.append(svg('path', {d: barsPath(bars.left, most, area.width, area.height), class: 'left', transform: place}));
  axisWords(drawing, area, column, null, [bars.low, bars.high]);
  onDrag(drawing, area, u => {
    setRange(column.key, bars.low + u[0] * (bars.high - bars.low), bars.low + u[1] * (bars.high - bars.low));
    changed();
  });
  return card(column.label, drawing);
}
