// What is shown, and in which order. Filters go over the columns as they are: 25,000 images take a few milliseconds.
const state = {
  text: '', lists: new Map(), ranges: new Map(), finding: -1, sort: '', desc: false, group: '', size: 128, caption: '',
  sample: 0, seed: 1, mask: false, boxes: false, plots: false, image: -1,
};
// Images in the order they are shown; `fails`: how many filters refuse each, `by`: which, where it is one.
const shown = {order: new Uint32Array(0), fails: new Uint8Array(0), by: new Int16Array(0), keys: [], groups: []};

// One function a filter, by the key of its column.
function activeFilters() {
  const filters = [];
  for (const [key, values] of state.lists) {
    const column = data.columns.get(key);
    const takes = new Uint8Array(column.values.length);
    for (const value of values) takes[value] = 1;
    filters.push([key, i => takes[column.of[i]] === 1]);
  }
  for (const [key, [low, high]] of state.ranges) {
    const of = data.columns.get(key).of;
    filters.push([key, i => of[i] >= low && of[i] <= high]);
  }
  const wanted = state.text.toLowerCase();
  if (wanted !== '') filters.push(['text', i => data.ids[i].toLowerCase().includes(wanted)]);
  if (state.finding >= 0) {
    const found = imagesOf(data.meta.checks[state.finding]);
    filters.push(['finding', i => found.has(i)]);
  }
  return filters;
}

// Of a finding, kept as first and count of runs.
function imagesOf(finding) {
  const all = new Set();
  for (let k = 0; finding && k < finding.images.length; k += 2)
    for (let i = 0; i < finding.images[k + 1]; ++i) all.add(finding.images[k] + i);
  return all;
}

// A well-mixed number of an image and the seed (the finaliser of MurmurHash3): which are drawn at random.
function mixed(i, seed) {
  let h = Math.imul(i + 1, 0x9e3779b1) ^ Math.imul(seed, 0x85ebca6b);
  h = Math.imul(h ^ (h >>> 16), 0x85ebca6b);
  h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
  return (h ^ (h >>> 16)) >>> 0;
}

const isLoaded = i => data.chunks[Math.floor(i / data.meta.chunk)];

function applyFilters() {
  const n = data.n, filters = activeFilters();
  const fails = new Uint8Array(n), by = new Int16Array(n);
  filters.forEach(([, takes], k) => {
    for (let i = 0; i < n; ++i)
      if (data.ids[i] === undefined || !takes(i)) {
        ++fails[i];
        by[i] = k;
      }
  });
  let order = new Uint32Array(n), count = 0;
  for (let i = 0; i < n; ++i)
    if (fails[i] === 0 && isLoaded(i)) order[count++] = i;
  order = order.subarray(0, count);
  if (state.sample > 0 && state.sample < count) {
    order.sort((a, b) => mixed(a, state.seed) - mixed(b, state.seed));
    order = order.subarray(0, state.sample).sort();
  }
  sortImages(order);
  Object.assign(shown, {order, fails, by, keys: filters.map(([key]) => key), groups: groupsOf(order)});
}

// What is not known comes last either way; equal ones as in the manifest.
function sortImages(order) {
  const column = data.columns.get(state.sort), group = data.columns.get(state.group);
  if (!column && !group && !state.desc) return;
  const sign = state.desc ? -1 : 1, of = column && column.of;
  order.sort((a, b) => {
    if (group && group.of[a] !== group.of[b]) return group.of[a] - group.of[b];
    if (!of) return sign * (a - b);
    const x = of[a], y = of[b];
    if (x === y) return a - b;
    if (x !== x || y !== y) return x !== x ? (y !== y ? a - b : 1) : -1;
    return sign * (x - y);
  });
}

// First place and count of each group of images that follow each other.
function groupsOf(order) {
  const column = data.columns.get(state.group), groups = [];
  if (!column) return groups;
  for (let k = 0; k < order.length; ++k) {
    const value = column.of[order[k]];
    if (groups.length === 0 || groups.at(-1).value !== value) groups.push({value, name: column.values[value], start: k, count: 0});
    ++groups.at(-1).count;
  }
  return groups;
}

// Whether an image would be shown if there were no filter of this column.
function remains(key) {
  const k = shown.keys.indexOf(key), {fails, by} = shown;
  return i => isLoaded(i) && (fails[i] === 0 || (k >= 0 && fails[i] === 1 && by[i] === k));
}

// Of a list: images of each value that would remain.
function countsOf(column) {
  const counts = new Uint32Array(column.values.length), takes = remains(column.key);
  for (let i = 0; i < data.n; ++i)
    if (takes(i)) ++counts[column.of[i]];
  return counts;
}

// Least and greatest of a number's column, of all images that are loaded.
function rangeOf(column) {
  if (column.range) return column.range;
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < data.n; ++i) {
    const value = column.of[i];
    if (value < low) low = value;
    if (value > high) high = value;
  }
  const range = low <= high ? [low, high] : [0, 0];
  if (!data.chunks.includes(false)) column.range = range;
  return range;
}

const BARS = 64;
// Bars of a number's column: all images, and those that would remain.
function barsOf(column) {
  const [low, high] = rangeOf(column), all = new Uint32Array(BARS), left = new Uint32Array(BARS), takes = remains(column.key);
  const scale = high > low ? BARS / (high - low) : 0;
  for (let i = 0; i < data.n; ++i) {
    const value = column.of[i];
    if (value !== value) continue;
    const bar = Math.min(BARS - 1, Math.floor((value - low) * scale));
    ++all[bar];
    if (takes(i)) ++left[bar];
  }
  return {low, high, all, left};
}

function toggleValue(key, value) {
  const values = state.lists.get(key) || new Set();
  if (!values.delete(value)) values.add(value);
  if (values.size > 0) state.lists.set(key, values);
  else state.lists.delete(key);
}

function setRange(key, low, high) {
  const [least, most] = rangeOf(data.columns.get(key));
  if (low <= least && high >= most) state.ranges.delete(key);
  else state.ranges.set(key, [low, high]);
}

function clearFilters() {
  state.text = '';
  state.finding = -1;
  state.sample = 0;
  state.lists.clear();
  state.ranges.clear();
}

// [words, what takes it away] of each filter in use.
function filtersInUse() {
  const list = [];
  if (state.text !== '') list.push([`id has \u201c${state.text}\u201d`, () => { state.text = ''; }]);
  for (const [key, values] of state.lists) {
    const column = data.columns.get(key), names = [...values].map(v => column.values[v] || 'none');
    list.push([`${column.label}: ${names.slice(0, 3).join(', ')}${names.length > 3 ? ` and ${names.length - 3} more` : ''}`, () => state.lists.delete(key)]);
  }
  for (const [key, [low, high]] of state.ranges) {
    const column = data.columns.get(key);
    list.push([`${column.label}: ${numberText(column, low)} to ${numberText(column, high)}`, () => state.ranges.delete(key)]);
  }
  if (state.finding >= 0 && data.meta.checks[state.finding]) list.push([`${data.meta.checks[state.finding].check}: ${data.meta.checks[state.finding].what}`, () => { state.finding = -1; }]);
  if (state.sample > 0) list.push([`${state.sample} at random (seed ${state.seed})`, () => { state.sample = 0; }]);
  return list;
}
