// The grid: rows of fixed heights, absolutely placed, of which only those in view and two beyond have nodes.
const GAP = 8, HEADING = 34, BEYOND = 2, FAST = 600, PAUSE_MS = 60;
const grid = {
  columns: 1, width: 0, height: 0, rows: 0, tops: new Float64Array(1), starts: new Int32Array(0), counts: new Int32Array(0),
  nodes: new Map(), spare: [], cursor: 0, top: 0, timer: 0, waits: false, focused: false,
};

const cellWidth = () => state.size + GAP;
const captionHeight = () => (state.size < 128 ? 0 : 36);
const cellHeight = () => state.size + captionHeight() + GAP;

// Where each row begins, for what is shown; a heading is a row of no images (count -1 - group).
function layOut() {
  const view = $('view');
  grid.width = view.clientWidth;
  grid.height = view.clientHeight;
  grid.columns = Math.max(1, Math.floor((grid.width - GAP) / cellWidth()));
  const starts = [], counts = [], heights = [];
  const add = (from, count) => {
    for (let k = 0; k < count; k += grid.columns) {
      starts.push(from + k);
      counts.push(Math.min(grid.columns, count - k));
      heights.push(cellHeight());
    }
  };
  if (shown.groups.length === 0) add(0, shown.order.length);
  shown.groups.forEach((group, g) => {
    starts.push(group.start);
    counts.push(-1 - g);
    heights.push(HEADING);
    add(group.start, group.count);
  });
  grid.rows = starts.length;
  grid.starts = Int32Array.from(starts);
  grid.counts = Int32Array.from(counts);
  grid.tops = new Float64Array(grid.rows + 1);
  heights.forEach((height, r) => { grid.tops[r + 1] = grid.tops[r] + height; });
  const canvas = $('canvas');
  canvas.style.height = `${grid.tops[grid.rows] + GAP}px`;
  canvas.setAttribute('aria-rowcount', grid.rows);
  canvas.setAttribute('aria-colcount', grid.columns);
  canvas.style.setProperty('--size', `${state.size}px`);
  for (const node of grid.nodes.values()) putAway(node);
  grid.nodes.clear();
  grid.cursor = Math.max(0, Math.min(grid.cursor, shown.order.length - 1));
}

// Nodes that stay in the document are faster than those that come and go; hidden ones are read by nobody.
function putAway(node) {
  node.hidden = true;
  grid.spare.push(node);
}

// The last row that begins at `top` or above.
function rowAt(top) {
  let low = 0, high = grid.rows - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (grid.tops[middle] <= top) low = middle;
    else high = middle - 1;
  }
  return low;
}

// The row that holds a place of what is shown.
function rowOf(place) {
  let low = 0, high = grid.rows - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (grid.starts[middle] <= place) low = middle;
    else high = middle - 1;
  }
  return low;
}

function makeCell() {
  const image = el('img', {draggable: false, decoding: 'async'});
  image.onload = () => image.parentNode.classList.remove('waits');
  image.onerror = () => image.parentNode.classList.add('broken');
  return el('div', {className: 'cell', role: 'gridcell', tabIndex: -1}, image);
}

function captionOf(i) {
  const column = data.columns.get(state.caption);
  const value = !column ? data.ids[i] : column.type === 'list' ? valueOf(i, column.key) : numberText(column, column.of[i]);
  return [shortNameOf(i), value];
}

// Masks and boxes lie over the picture as it lies in its square: as large as fits, in the middle.
function drawOver(cell, i) {
  const picture = cell.firstChild;
  if (state.mask && fileOf(i, 'mask')) {
    const mask = el('img', {className: 'over mask', alt: '', src: fileOf(i, 'mask'), draggable: false});
    mask.width = mask.height = state.size;
    picture.after(mask);
  }
  const box = state.boxes && boxOf(i);
  if (box) {
    const drawing = svg('svg', {class: 'over', width: state.size, height: state.size, viewBox: `0 0 ${valueOf(i, 'width')} ${valueOf(i, 'height')}`, 'aria-hidden': 'true'});
    drawing.append(svg('rect', {x: box[0], y: box[1], width: box[2], height: box[3], class: 'box'}));
    picture.after(drawing);
  }
}

function showPicture(cell, i, loads) {
  const picture = cell.firstChild;
  while (picture.nextSibling && !picture.nextSibling.classList.contains('caption')) picture.nextSibling.remove();
  // The one before stays, unseen, until this one is there: without any its text would be laid out.
  cell.classList.add('waits');
  cell.waits = !loads;
  if (!loads) return;
  const source = (state.size > 128 && fileOf(i, 'image')) || thumbnail(i);
  cell.classList.toggle('broken', data.broken.has(i));
  if (picture.getAttribute('src') === source && picture.complete) cell.classList.remove('waits');
  else picture.src = source;
  drawOver(cell, i);
}

function fillCell(cell, place, loads) {
  const i = shown.order[place], picture = cell.firstChild;
  cell.image = i;
  cell.place = place;
  cell.hidden = false;
  cell.tabIndex = place === grid.cursor ? 0 : -1;
  cell.classList.toggle('cursor', place === grid.cursor);
  picture.width = picture.height = state.size;
  picture.alt = nameOf(i);
  cell.title = data.ids[i];
  showPicture(cell, i, loads);
  let caption = cell.querySelector('.caption');
  if (captionHeight() === 0) {
    if (caption) caption.remove();
    return;
  }
  if (!caption) cell.append(caption = el('span', {className: 'caption'}));
  caption.textContent = captionOf(i).join('\n');
}

function fillRow(r, loads) {
  const node = grid.spare.pop() || el('div', {className: 'row', role: 'row'});
  const count = grid.counts[r];
  node.hidden = false;
  node.setAttribute('aria-rowindex', r + 1);
  node.style.transform = `translateY(${grid.tops[r] + GAP / 2}px)`;
  node.classList.toggle('heading', count < 0);
  if (count < 0) {
    const group = shown.groups[-1 - count];
    node.replaceChildren(el('div', {className: 'group', role: 'gridcell', 'aria-colspan': grid.columns, textContent: `${group.name || 'none'}  (${group.count})`}));
    return node;
  }
  if (node.firstChild && node.firstChild.className === 'group') node.replaceChildren();
  while (node.children.length > count) node.lastChild.remove();
  while (node.children.length < count) node.append(makeCell());
  for (let k = 0; k < count; ++k) {
    const cell = node.children[k];
    cell.style.width = `${state.size}px`;
    cell.setAttribute('aria-colindex', k + 1);
    fillCell(cell, grid.starts[r] + k, loads);
  }
  return node;
}

function drawGrid() {
  grid.waits = false;
  const view = $('view'), top = view.scrollTop, moved = Math.abs(top - grid.top);
  grid.top = top;
  const loads = moved <= FAST;
  if (grid.rows === 0) return drawSticky(top);
  const first = Math.max(0, rowAt(top) - BEYOND), last = Math.min(grid.rows - 1, rowAt(top + grid.height) + BEYOND);
  const pinned = grid.focused ? rowOf(grid.cursor) : -1;
  for (const [r, node] of grid.nodes)
    if ((r < first || r > last) && r !== pinned) {
      grid.nodes.delete(r);
      putAway(node);
    }
  const rows = [];
  for (let r = first; r <= last; ++r) rows.push(r);
  if (pinned >= 0 && pinned < grid.rows && (pinned < first || pinned > last)) rows.push(pinned);
  for (const r of rows) {
    const known = grid.nodes.get(r);
    if (!known) {
      const node = fillRow(r, loads);
      grid.nodes.set(r, node);
      if (!node.parentNode) $('canvas').append(node);
    } else if (loads) {
      for (const cell of known.children)
        if (cell.waits) showPicture(cell, cell.image, true);
    }
  }
  while (grid.spare.length > 4) grid.spare.pop().remove();
  clearTimeout(grid.timer);
  if (!loads) grid.timer = setTimeout(queueDraw, PAUSE_MS);
  drawSticky(top);
}

function queueDraw() {
  if (grid.waits) return;
  grid.waits = true;
  requestAnimationFrame(drawGrid);
}

function drawSticky(top) {
  const sticky = $('sticky');
  sticky.hidden = shown.groups.length === 0;
  if (sticky.hidden) return;
  let at = shown.groups[0];
  const place = grid.starts[rowAt(top + HEADING / 2)];
  for (const group of shown.groups)
    if (group.start <= place) at = group;
  sticky.textContent = `${at.name || 'none'}  (${at.count})`;
}

function cellAt(place) {
  const node = grid.nodes.get(rowOf(place));
  return node && [...node.children].find(cell => cell.place === place);
}

// Scrolls so that the place is in view, and draws at once.
function bringIntoView(place) {
  const view = $('view'), r = rowOf(place), above = shown.groups.length > 0 ? HEADING : 0;
  const top = grid.tops[r] - above, bottom = grid.tops[r] + cellHeight() + GAP;
  if (top < view.scrollTop) view.scrollTop = top;
  else if (bottom > view.scrollTop + grid.height) view.scrollTop = bottom - grid.height;
  grid.top = view.scrollTop;
  drawGrid();
}

function moveCursor(place, focus = true) {
  if (shown.order.length === 0) return;
  const before = cellAt(grid.cursor);
  if (before) {
    before.tabIndex = -1;
    before.classList.remove('cursor');
  }
  grid.cursor = Math.max(0, Math.min(place, shown.order.length - 1));
  bringIntoView(grid.cursor);
  const cell = cellAt(grid.cursor);
  cell.tabIndex = 0;
  cell.classList.add('cursor');
  if (focus) cell.focus({preventScroll: true});
}

// The place one row up or down, in the same column where that has one.
function placeBeside(place, direction) {
  let r = rowOf(place);
  const k = place - grid.starts[r];
  do r += direction;
  while (r >= 0 && r < grid.rows && grid.counts[r] < 0);
  if (r < 0 || r >= grid.rows) return place;
  return grid.starts[r] + Math.min(k, grid.counts[r] - 1);
}

function setUpGrid() {
  const view = $('view'), canvas = $('canvas');
  view.addEventListener('scroll', queueDraw, {passive: true});
  new ResizeObserver(() => {
    if (view.clientWidth !== grid.width || view.clientHeight !== grid.height) {
      layOut();
      bringIntoView(grid.cursor);
    }
  }).observe(view);
  canvas.addEventListener('focusin', () => { grid.focused = true; });
  canvas.addEventListener('focusout', () => { grid.focused = false; });
  canvas.addEventListener('click', event => {
    const cell = event.target.closest('.cell');
    if (!cell) return;
    moveCursor(cell.place);
    openPicture(cell.image);
  });
}
