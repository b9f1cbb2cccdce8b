// The page as a whole: its state in the address, and what a change of it draws anew.
const SIZES = [64, 128, 256];
// Names in the address that are no column's.
const OWN = ['q', 'sort', 'desc', 'group', 'show', 'size', 'sample', 'seed', 'check', 'mask', 'box', 'plots', 'i'];

function hashOf() {
  const parts = [], put = (key, value) => parts.push(value === true ? key : `${key}=${value}`);
  if (state.text) put('q', encodeURIComponent(state.text));
  for (const [key, values] of state.lists) put(encodeURIComponent(key), [...values].map(v => encodeURIComponent(data.columns.get(key).values[v])).join(','));
  for (const [key, [low, high]] of state.ranges) put(encodeURIComponent(key), `${low}..${high}`);
  if (state.finding >= 0) put('check', state.finding);
  if (state.sort) put('sort', encodeURIComponent(state.sort));
  if (state.desc) put('desc', true);
  if (state.group) put('group', encodeURIComponent(state.group));
  if (state.caption) put('show', encodeURIComponent(state.caption));
  if (state.size !== 128) put('size', state.size);
  if (state.sample > 0) put('sample', state.sample);
  if (state.sample > 0 && state.seed !== 1) put('seed', state.seed);
  for (const [key, on] of [['mask', state.mask], ['box', state.boxes], ['plots', state.plots]]) if (on) put(key, true);
  if (state.image >= 0) put('i', state.image);
  return parts.join('&');
}

function writeHash() {
  const hash = hashOf();
  try {
    if (hash !== location.hash.slice(1)) history.replaceState(null, '', `#${hash}`);
  } catch { /* browsers refuse it where it is asked for too often */ }
}

const decoded = text => {
  try { return decodeURIComponent(text); } catch { return text; }
};

// What the address has no word of is as at first; what it has and the dataset has not is left out.
function readHash() {
  clearFilters();
  Object.assign(state, {sort: '', desc: false, group: '', caption: '', size: 128, seed: 1, mask: false, boxes: false, plots: false, image: -1});
  for (const part of location.hash.slice(1).split('&')) {
    const equals = part.indexOf('='), key = decoded(equals < 0 ? part : part.slice(0, equals)), raw = equals < 0 ? '' : part.slice(equals + 1);
    const value = decoded(raw), number = Number(value), column = data.columns.get(key), known = data.columns.has(value) ? value : '';
    if (key === 'q') state.text = value;
    else if (key === 'sort') state.sort = known;
    else if (key === 'desc') state.desc = true;
    else if (key === 'group') state.group = data.columns.get(value)?.type === 'list' ? value : '';
    else if (key === 'show') state.caption = known;
    else if (key === 'size' && SIZES.includes(number)) state.size = number;
    else if (key === 'sample' && number > 0) state.sample = Math.floor(number);
    else if (key === 'seed' && Number.isFinite(number)) state.seed = number;
    else if (key === 'check' && data.meta.checks[number]) state.finding = number;
    else if (key === 'mask') state.mask = true;
    else if (key === 'box') state.boxes = true;
    else if (key === 'plots') state.plots = true;
    else if (key === 'i' && number >= 0 && number < data.n) state.image = Math.floor(number);
    else if (column && column.type === 'list') {
      const values = raw.split(',').map(name => column.values.indexOf(decoded(name))).filter(v => v >= 0);
      if (values.length > 0) state.lists.set(key, new Set(values));
    } else if (column && raw.includes('..')) {
      const [low, high] = raw.split('..').map(Number);
      if (Number.isFinite(low) && Number.isFinite(high)) state.ranges.set(key, [low, high]);
    }
  }
}

// After every change of the state. `lay`: only sizes changed, and no filter; `keep`: the view stays where it is.
function changed({lay = false, hash = true, keep = lay} = {}) {
  if (!lay) {
    applyFilters();
    drawPanel();
    drawChips();
    drawPlots();
  }
  drawTools();
  layOut();
  if (!keep) {
    grid.cursor = 0;
    $('view').scrollTop = 0;
  }
  if (keep && !lay) drawGrid();
  else bringIntoView(grid.cursor);
  const count = shown.order.length, all = data.n;
  $('count').textContent = count === all ? `${all.toLocaleString('en')} image${all === 1 ? '' : 's'}` : `${count.toLocaleString('en')} of ${all.toLocaleString('en')} images`;
  $('none').hidden = count > 0;
  $('none').textContent = all === 0 ? 'The dataset has no images yet: dsbuild build makes them.' : data.chunks.includes(false) ? 'Reading ...' : 'No image passes these filters.';
  if (hash) writeHash();
}

function toggleState(key) {
  state[key] = !state[key];
  if (key === 'plots') {
    drawPlots();
    drawTools();
    writeHash();
  } else {
    changed({lay: true});
  }
}

function drawTools() {
  $('text').value = state.text;
  $('sort').value = state.sort;
  $('group').value = state.group;
  $('caption').value = state.caption;
  $('size').value = SIZES.indexOf(state.size);
  $('size').setAttribute('aria-valuetext', `${state.size} pixels`);
  $('desc').setAttribute('aria-pressed', state.desc);
  $('mask-button').setAttribute('aria-pressed', state.mask);
  $('box-button').setAttribute('aria-pressed', state.boxes);
  $('plots-button').setAttribute('aria-pressed', state.plots);
  document.body.classList.toggle('has-plots', state.plots);
}

function setUpTools() {
  const option = (value, textContent) => el('option', {value, textContent});
  $('sort').append(option('', 'id'), ...[...data.columns.values()].map(column => option(column.key, column.label)));
  $('group').append(option('', 'nothing'), ...[...data.columns.values()].filter(column => column.type === 'list' && column.values.length < data.n).map(column => option(column.key, column.label)));
  $('caption').append(option('', 'id'), ...[...data.columns.values()].map(column => option(column.key, column.label)));
  for (const [id, key] of [['sort', 'sort'], ['group', 'group']])
    $(id).addEventListener('change', () => {
      state[key] = $(id).value;
      // What is sorted by is what one wants to read.
      if (key === 'sort' && state.sort) state.caption = state.sort;
      changed();
    });
  $('caption').addEventListener('change', () => {
    state.caption = $('caption').value;
    changed({lay: true});
  });
  $('text').addEventListener('input', () => {
    state.text = $('text').value;
    changed();
  });
  $('desc').addEventListener('click', () => {
    state.desc = !state.desc;
    changed();
  });
  $('size').addEventListener('input', () => setSize(SIZES[$('size').value]));
  $('mask-button').addEventListener('click', () => toggleState('mask'));
  $('box-button').addEventListener('click', () => toggleState('boxes'));
  $('plots-button').addEventListener('click', () => toggleState('plots'));
  $('mask-button').hidden = !data.meta.kinds.some(row => row.kind === 'mask');
  $('panel-button').addEventListener('click', () => {
    const hidden = document.body.classList.toggle('no-panel');
    $('panel-button').setAttribute('aria-expanded', !hidden);
  });
  if (window.innerWidth < 800) $('panel-button').click();
}

function goToHash({keep = false} = {}) {
  readHash();
  const image = state.image;
  changed({hash: false, keep});
  if (image >= 0 && data.ids[image] !== undefined && image !== picture.image) {
    const place = shown.order.indexOf(image);
    if (place >= 0) moveCursor(place, false);
    openPicture(image);
  } else if (image < 0 && $('picture').open) {
    $('picture').close();
  }
}

function start() {
  document.title = `${data.meta.name}: ${data.n.toLocaleString('en')} images`;
  $('name').textContent = data.meta.name;
  $('app').hidden = false;
  setUpTools();
  setUpPanel();
  setUpGrid();
  setUpPicture();
  setUpKeys();
  window.addEventListener('hashchange', () => goToHash());
  for (const note of data.meta.notes) complain(note);
  if (data.n === 0) goToHash();
  else loadChunk(0, loadRest);
}

function loadChunk(k, done) {
  load(`data/grid-${k}.js`, () => data.chunks[k], () => {
    // The first is shown at once, the rest when all are there.
    if (k === 0 || !data.chunks.includes(false)) goToHash({keep: k > 0});
    done();
  });
}

function loadRest() {
  requestAnimationFrame(() => data.chunks.forEach((there, k) => there || loadChunk(k, () => {})));
}

try { setTheme(localStorage.getItem('dsbuild-theme') || 'system'); } catch { /* as in switchTheme */ }
load('data/meta.js', () => data.meta !== null, () => {
  if (data.meta.format === 1) start();
  else complain('The data files are of another dsbuild than this page: dsbuild gallery writes both again.');
});
